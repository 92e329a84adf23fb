#pragma once
#include <umov/optics/emission.h>
#include <umov/surface/surface.h>

namespace umov {

/// Emissivity of an opaque rough surface towards an angle from its normal, by Kirchhoff's law from
/// its reflection: i = 1 - int M00(l, v)(n.l) dw_l, q = -int of M10 turned to s = n x v. Counts one
/// reflection and whatever diffuse lobes the material has; isotropic distributions only.
Emissivity rough_emissivity(const Surface &surface, std::size_t band, double theta_rad);

} // namespace umov
