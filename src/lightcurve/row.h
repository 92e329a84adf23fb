#pragma once
// Private: one band at one epoch, from the light of a pose.

#include <umov/lightcurve/compute.h>

namespace umov {

/// `solar`: irradiance at 1 au of the band `colour`.
LightCurveSample sample_from(const BandResult &band, const Band &colour, double solar,
                             const ObservingGeometry &geometry, const LightCurveRequest &request,
                             bool is_dark);

} // namespace umov
