// The light of one chain, by the functions of its surfaces.

#include "light/between/beam_axes.h"
#include "light/between/chain_set.h"

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

using Light = Stokes<ScatteringPlane>;
using Matrix = Mueller<ScatteringPlane, ScatteringPlane>;

/// f (n.in), and the lobe's part of it, of light that comes from direction `in`.
struct EndMatrices {
  Matrix whole, lobe;
};

struct GeneralEnd {
  Vec3<Body> normal, along, axis, field;
  const Surface &surface;
  [[nodiscard]] EndMatrices matrices(std::size_t band, Vec3<Body> in, Vec3<Body> out) const {
    const auto on = directions_on(normal, field, in, out, std::clamp(dot(in, out), -1.0, 1.0), 0);
    EndMatrices f{surface.brdf(band, on), surface.mueller(band, on.l_v)};
    const double outside = dot(normal, in);
    const double lobe = surface.specular(band, on) / dot(normal, out);
    for (auto &row : f.whole.m)
      for (double &x : row)
        x *= outside;
    for (auto &row : f.lobe.m)
      for (double &x : row)
        x *= lobe;
    return f;
  }
};

/// A chain from the end that the observer sees to the one that the Sun lights.
struct GeneralChain {
  GeneralEnd seen, lit;
  bool is_reversed = false;
  const backend::ChainMatrix *between = nullptr; ///< of the first band; null: straight
  std::size_t lane = 0;

  /// Light that leaves `lit` into the chain with axis `from`, as it reaches `seen` in axis `to`.
  [[nodiscard]] Light passed(const Light &light, std::size_t band, Vec3<Body> from,
                             Vec3<Body> to) const {
    const Light x = turned(light, from, lit.axis, lit.along);
    if (between == nullptr)
      return turned(turned(x, lit.axis, seen.axis, lit.along), seen.axis, to, -seen.along);
    const auto &m = between[band].m;
    const double in[4] = {x.i, x.q, is_reversed ? -x.u : x.u, x.v};
    double out[4] = {};
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t c = 0; c < 4; ++c)
        out[r] += static_cast<double>(m[is_reversed ? 4 * c + r : 4 * r + c][lane]) * in[c];
    return turned(Light{out[0], out[1], is_reversed ? -out[2] : out[2], out[3]}, seen.axis, to,
                  -seen.along);
  }

  /// f (n.v) and f (n.l) of both ends about what lies between.
  [[nodiscard]] Light carried(std::size_t band, Vec3<Body> sun, Vec3<Body> observer,
                              Vec3<Body> plane, bool is_without_lobes) const {
    const Vec3<Body> from = plane_normal(lit.along, sun), to = plane_normal(observer, seen.along);
    const EndMatrices in = lit.matrices(band, sun, lit.along),
                      out = seen.matrices(band, seen.along, observer);
    const Light sunlight{1, 0, 0, 0};
    Light light = out.whole * passed(in.whole * sunlight, band, from, to);
    if (is_without_lobes)
      light += out.lobe * passed(in.lobe * sunlight, band, from, to) * -1;
    // The matrices hold the cosine of where light comes from, and the chain has that one.
    const double other = dot(seen.normal, observer) / dot(seen.normal, seen.along);
    return turned(light, to, plane, observer) * other;
  }
};

void put(const Light &light, std::size_t lane, backend::ChainLight &to) {
  to.i[lane] += light.i;
  to.q[lane] += light.q;
  to.u[lane] += light.u;
  to.v[lane] += light.v;
}

} // namespace

bool ChainSet::faces(const OneChain &one, const backend::ChainPose &pose) const {
  const backend::ChainBlock &at = drawn_.block[one.block];
  return dot(vector_of((one.is_reversed ? at.q : at.p).normal, one.lane),
             vector_of(pose.observer)) > 0 &&
         dot(vector_of((one.is_reversed ? at.p : at.q).normal, one.lane), vector_of(pose.sun)) > 0;
}

void ChainSet::add_one(const OneChain &one, double free, const backend::ChainPose &pose,
                       backend::ChainSums &sums) const {
  const Vec3<Body> sun = vector_of(pose.sun), observer = vector_of(pose.observer);
  const backend::ChainBlock &at = drawn_.block[one.block];
  const auto end = [&](bool is_q) {
    const backend::ChainEnds &e = is_q ? at.q : at.p;
    const std::uint32_t kind = is_q ? one.run.kind_q : one.run.kind_p;
    return GeneralEnd{vector_of(e.normal, one.lane), vector_of(e.along, one.lane),
                      vector_of(e.axis, one.lane),
                      field_of(kind, (is_q ? drawn_.triangle_q : drawn_.triangle_p)[one.at()]),
                      surfaces_.surface(kind)};
  };
  const GeneralChain chain{end(one.is_reversed), end(!one.is_reversed), one.is_reversed,
                           one.run.is_straight
                               ? nullptr
                               : &matrix_[one.run.matrix + (one.block - one.run.first) * bands_],
                           one.lane};
  if (!faces(one, pose))
    return;
  const double weight =
      static_cast<double>(one.is_reversed ? at.from_q[one.lane] : at.from_p[one.lane]) * free;
  for (std::size_t band = 0; band < bands_; ++band) {
    const Light light =
        chain.carried(band, sun, observer, vector_of(pose.plane), one.run.is_without_lobes) *
        weight;
    put(light, one.lane, sums.bands[band]);
    sums.squares += band == 0 ? light.i * light.i : 0;
  }
}

} // namespace umov
