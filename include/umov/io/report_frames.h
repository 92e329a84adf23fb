#pragma once
// Pictures of the object at chosen epochs of a light curve, for the report.

#include <span>
#include <umov/io/report.h>
#include <umov/picture/keyframe.h>
#include <vector>

namespace umov {

/// Vector towards the celestial pole in the body frame, for KeyFrameView::up.
Vec3<Body> celestial_north(const LightCurveEpoch &epoch);

/// Epochs worth a picture: per pass the brightest one and others spread evenly in time, `count` per
/// pass in all; fewer if the pass is short: one, and one more for every 20 s. In order of time;
/// dark epochs are left out.
std::vector<std::size_t> choose_key_epochs(const LightCurve &curve, std::size_t count);

/// The pictures of the chosen epochs in all three shadings, ready for the report. `joints` turn by
/// the angles that the epochs hold.
Result<std::vector<ReportKeyFrame>> make_key_frames(const Scene &scene, const LightCurve &curve,
                                                    std::span<const std::size_t> epochs,
                                                    const KeyFrameOptions &options,
                                                    const std::vector<Joint> &joints = {});

/// The object through its longest lit pass, in at most `count` pictures of brightness, one exposure
/// for all; none where fewer than three epochs are lit.
Result<std::vector<ReportFilmFrame>> make_film(const Scene &scene, const LightCurve &curve,
                                               std::size_t count, const KeyFrameOptions &options,
                                               const std::vector<Joint> &joints = {});

} // namespace umov
