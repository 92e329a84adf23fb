#pragma once
// Private: one band at one epoch, from the light of a pose.

#include <umov/lightcurve/compute.h>
#include <umov/photometry/radiometry.h>

namespace umov {

/// `colour`: the band of `band`.
LightCurveSample sample_from(const BandResult &band, const PhotometricBand &colour,
                             const ObservingGeometry &geometry, const LightCurveRequest &request,
                             bool is_dark);

} // namespace umov
