#include <umov/shape/mass.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/stop.h>
#include <umov/shape/topology.h>

namespace umov {
namespace {

/// Sums over the pieces of a body: amount, first and second moments.
struct Moments {
  double amount = 0;
  Vec3<Body> first{};
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  /// A simplex with corners `p`: the integral of x x^T is amount/((n+1)(n+2)) times
  /// (sum p p^T + (sum p)(sum p)^T) for n dimensions and n + 1 corners.
  template <std::size_t N> void add(const std::array<Vec3<Body>, N> &p, double size) {
    Vec3<Body> sum{};
    for (const Vec3<Body> &corner : p)
      sum += corner;
    amount += size;
    first += sum * (size / N);
    const double scale = size / (N * (N + 1));
    add_product(sum, scale);
    for (const Vec3<Body> &corner : p)
      add_product(corner, scale);
  }

private:
  void add_product(Vec3<Body> v, double scale) {
    xx += scale * v.x * v.x;
    yy += scale * v.y * v.y;
    zz += scale * v.z * v.z;
    xy += scale * v.x * v.y;
    xz += scale * v.x * v.z;
    yz += scale * v.y * v.z;
  }
};

} // namespace

Result<MassProperties> mass_properties(const Mesh &mesh, MassModel model,
                                       const std::atomic<bool> *cancel) {
  return without_failures([&]() -> Result<MassProperties> {
    Moments sum;
    const bool is_solid = model == MassModel::Solid;
    if (is_solid && !inspect(mesh, false, cancel).is_closed)
      return fail(ErrorCode::BadInput,
                  "the mesh is not closed and has no inside; take the inertia of "
                  "its shell, or give numbers");
    // Volumes are taken from a point of the mesh: a far origin would cost digits.
    const Vec3<Body> origin = mesh.positions.empty() ? Vec3<Body>{} : mesh.positions.front();
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
      leave_if_stopped(cancel, k);
      const Triangle &t = mesh.triangles[k];
      const Vec3<Body> a = mesh.positions[t.vertex[0]] - origin,
                       b = mesh.positions[t.vertex[1]] - origin,
                       c = mesh.positions[t.vertex[2]] - origin;
      if (is_solid)
        sum.add<4>({Vec3<Body>{}, a, b, c}, dot(a, cross(b, c)) / 6);
      else
        sum.add<3>({a, b, c}, norm(cross(b - a, c - a)) / 2);
    }
    if (!(std::abs(sum.amount) > 0))
      return fail(ErrorCode::BadInput,
                  is_solid ? "the mesh has no volume" : "the mesh has no area");
    MassProperties out;
    const double per = 1 / sum.amount; // a mesh wound inside out has everything negative
    const Vec3<Body> c = sum.first * per;
    const double xx = sum.xx * per - c.x * c.x, yy = sum.yy * per - c.y * c.y,
                 zz = sum.zz * per - c.z * c.z;
    out.inertia = {yy + zz,
                   xx + zz,
                   xx + yy,
                   c.x * c.y - sum.xy * per,
                   c.x * c.z - sum.xz * per,
                   c.y * c.z - sum.yz * per};
    out.center = c + origin;
    out.amount = std::abs(sum.amount);
    return out;
  });
}

Result<PrincipalAxes> principal_axes(const Inertia &i) {
  Eigen::Matrix3d m;
  m << i.xx, i.xy, i.xz, i.xy, i.yy, i.yz, i.xz, i.yz, i.zz;
  PrincipalAxes out;
  if (m.allFinite()) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m);
    for (int k = 0; k < 3; ++k) {
      out.moment[static_cast<std::size_t>(k)] = solver.eigenvalues()(k);
      const auto v = solver.eigenvectors().col(k);
      out.axis[static_cast<std::size_t>(k)] = {v(0), v(1), v(2)};
    }
    out.axis[2] = cross(out.axis[0], out.axis[1]);
  }
  const auto &p = out.moment;
  if (!m.allFinite() || !(p[0] > 0) || !(p[2] <= (p[0] + p[1]) * (1 + 1e-9)))
    return fail(ErrorCode::BadInput,
                fmt::format("the inertia has the principal moments {:g}, {:g} and {:g}, expected "
                            "positive ones of which none is larger than the sum of the others",
                            p[0], p[1], p[2]));
  return out;
}

} // namespace umov
