#pragma once
#include "paper/workshop.h"

#include <umov/picture/keyframe.h>

namespace umov {

/// From where a picture is taken.
struct PictureView {
  Vec3<Body> sun, observer, up; ///< any lengths
  std::uint32_t size = 360;
  double half_width_m = 0; ///< 0: the whole object
};

/// An observer, and the Sun at a phase angle from it: at the right of the picture where
/// `sun_side_deg` is 0, above at 90.
PictureView view_from(Vec3<Body> observer, Vec3<Body> up, double phase_deg, double sun_side_deg);

enum class PictureStyle { Colour, Intensity, Polarization, Material };

/// PNG of a scene; in colour from its first three bands as blue, green, red.
Result<std::string> picture_png(const Scene &scene, const PictureView &view, PictureStyle style,
                                unsigned threads);
/// In colour through a polarizer that passes one field.
Result<std::string> picture_through_polarizer(const Scene &scene, const PictureView &view,
                                              bool is_perpendicular, unsigned threads);

} // namespace umov
