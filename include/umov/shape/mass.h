#pragma once
// Where the mass of an object is: its inertia.

#include <array>
#include <atomic>
#include <umov/core/result.h>
#include <umov/shape/mesh.h>

namespace umov {

/// Symmetric inertia tensor about the centre of mass, body axes; any unit (only ratios matter to
/// torque-free motion). Off-diagonals as in the tensor: xy = -sum m x y.
struct Inertia {
  double xx = 1, yy = 1, zz = 1, xy = 0, xz = 0, yz = 0;
};

/// Shell: even mass per area of the triangles. Solid: even density inside a closed mesh.
enum class MassModel { Shell, Solid };

/// Inertia, centre and size of a body of even density.
struct MassProperties {
  Inertia inertia; ///< per unit mass [m2], about the centre of mass
  Vec3<Body> center{};
  double amount = 0; ///< area [m2] or volume [m3]
};

/// Exact integrals over triangles or tetrahedra (Tonon 2004). BadInput for a solid that is not
/// closed or has no volume, Interrupted once `cancel` became true.
Result<MassProperties> mass_properties(const Mesh &mesh, MassModel model,
                                       const std::atomic<bool> *cancel = nullptr);

/// Principal moments in ascending order and their axes (rows: right-handed axes in body
/// components). BadInput if they cannot be those of a rigid body: not positive, or one larger than
/// the sum of the others by more than 1e-9 of it.
struct PrincipalAxes {
  std::array<double, 3> moment{};
  std::array<Vec3<Body>, 3> axis{};
};
/// The axes about which a body turns evenly. BadInput for an inertia that none can have.
Result<PrincipalAxes> principal_axes(const Inertia &inertia);

} // namespace umov
