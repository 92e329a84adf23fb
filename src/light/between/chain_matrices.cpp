#include "light/between/chain_matrices.h"

#include "light/between/beam_axes.h"
#include "light/reference/elements.h"

#include <algorithm>

namespace umov {
namespace {

using Light = Stokes<ScatteringPlane>;
using Matrix = ChainMatrices::Matrix;

/// Light that travels along k, from axes s to axes t, as a matrix.
Matrix turn_of(Vec3<Body> s, Vec3<Body> t, Vec3<Body> k) {
  Matrix out;
  for (std::size_t c = 0; c < 4; ++c) {
    Light e{c == 0 ? 1.0 : 0, c == 1 ? 1.0 : 0, c == 2 ? 1.0 : 0, c == 3 ? 1.0 : 0};
    e = turned(e, s, t, k);
    const double column[4] = {e.i, e.q, e.u, e.v};
    for (std::size_t r = 0; r < 4; ++r)
      out.m[r][c] = column[r];
  }
  return out;
}

} // namespace

ChainMatrices::ChainMatrices(const Scene &sides, const Mesh &mesh)
    : sides_(sides), mesh_(mesh), matrix_(sides.grid.nodes().size()) {}

void ChainMatrices::start(Vec3<Body> axis, Vec3<Body> along) {
  axis_ = axis;
  back_ = -along;
  std::fill(matrix_.begin(), matrix_.end(), turn_of(axis, axis, back_));
}

void ChainMatrices::pass(const ChainVertex &at) {
  const Surface &surface = surface_of_slot(sides_, at.slot);
  const Vec3<Body> normal = vector_of(at.normal), to = vector_of(at.to),
                   plane = plane_normal(back_, to);
  const double cosine = dot(normal, to);
  const Matrix last = turn_of(plane, axis_, back_);
  const auto on = directions_on(normal, direction_field(mesh_, surface, at.triangle), to, back_,
                                std::clamp(dot(to, back_), -1.0, 1.0), 0);
  for (std::size_t b = 0; b < matrix_.size(); ++b) {
    Matrix f = at.is_by_mirror != 0 ? surface.mueller(b, on.l_v) : surface.brdf(b, on);
    const double scale = (at.is_by_mirror != 0 ? surface.mirror_part(b, cosine) : cosine) /
                         static_cast<double>(at.density);
    for (auto &row : f.m)
      for (double &x : row)
        x *= scale;
    matrix_[b] = matrix_[b] * (last * f);
  }
  axis_ = plane;
  back_ = -to;
}

ChainMatrices::Matrix ChainMatrices::from(Vec3<Body> axis, std::size_t band) const {
  return matrix_[band] * turn_of(axis, axis_, back_);
}

double ChainMatrices::strongest() const {
  double out = 0;
  for (const Matrix &m : matrix_)
    out = std::max(out, m.m[0][0]);
  return out;
}

double ChainMatrices::transmitted() const {
  double out = 0;
  for (const Matrix &m : matrix_) // the turns of axes leave M00
    out += m.m[0][0] / static_cast<double>(matrix_.size());
  return out;
}

} // namespace umov
