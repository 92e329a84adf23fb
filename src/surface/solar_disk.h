#pragma once
// Private: a distribution of normals seen by a Sun that has a size.

#include <umov/surface/distribution.h>

namespace umov {

/// Mean of D over the half vectors of a uniform solar disk of radius `radius_rad` around l, all
/// other factors taken at its centre. l, v: unit vectors in the facet frame, l_v = l.v given apart
/// because it is better known. Three ways, by the width of the lobe against that of the disk's
/// image in half-vector space: a closed form or seven nodes where the lobe is wide, and the exact
/// contour integral of the image where it is not; the last goes over into the mirror's disk. radius
/// 0: D(h).
double density_over_disk(const Distribution &normals, Vec3<Facet> l, Vec3<Facet> v, double l_v,
                         double radius_rad);

} // namespace umov
