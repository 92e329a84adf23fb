// The light of one chain: by the forms that the vector unit has, or by the functions of its
// surfaces.

#include "light/between/beam_axes.h"
#include "light/between/chain_set.h"

#include "kernel/chain_end.inl.h"

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

using Light = Stokes<ScatteringPlane>;
using Matrix = Mueller<ScatteringPlane, ScatteringPlane>;

Matrix times(Matrix f, double factor) {
  for (auto &row : f.m)
    for (double &x : row)
      x *= factor;
  return f;
}

struct GeneralEnd {
  Vec3<Body> normal, along, axis, field;
  const Surface &surface;
  /// f (n.in) of light that comes from direction `in`.
  [[nodiscard]] Matrix whole(std::size_t band, Vec3<Body> in, Vec3<Body> out) const {
    return times(surface.brdf(band, on(in, out)), dot(normal, in));
  }
  /// The lobe's part of it.
  [[nodiscard]] Matrix lobe(std::size_t band, Vec3<Body> in, Vec3<Body> out) const {
    const SurfaceDirections at = on(in, out);
    return times(surface.mueller(band, at.l_v), surface.specular(band, at) / dot(normal, out));
  }

private:
  [[nodiscard]] SurfaceDirections on(Vec3<Body> in, Vec3<Body> out) const {
    return directions_on(normal, field, in, out, std::clamp(dot(in, out), -1.0, 1.0), 0);
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
    const Light sunlight{1, 0, 0, 0};
    Light light = seen.whole(band, seen.along, observer) *
                  passed(lit.whole(band, sun, lit.along) * sunlight, band, from, to);
    if (is_without_lobes)
      light += seen.lobe(band, seen.along, observer) *
               passed(lit.lobe(band, sun, lit.along) * sunlight, band, from, to) * -1;
    // The matrices hold the cosine of where light comes from, and the chain has that one.
    const double other = dot(seen.normal, observer) / dot(seen.normal, seen.along);
    return turned(light, to, plane, observer) * other;
  }
};

using Axes = kernel::Triple<float>;
Axes axes_of(const float (&v)[3]) { return {v[0], v[1], v[2]}; }
Axes axes_of(const float (&v)[3][backend::lanes], std::size_t lane) {
  return {v[0][lane], v[1][lane], v[2][lane]};
}
kernel::ChainEndAxes<float> axes_of(const backend::ChainEnds &end, std::size_t lane) {
  return {axes_of(end.normal, lane), axes_of(end.along, lane), axes_of(end.axis, lane)};
}

/// The same of surfaces that have forms, in single precision: a tenth of the time.
struct FastChain {
  kernel::ChainAt<float> at;
  const backend::ChainSurface *seen, *lit;       ///< of the first band
  const backend::ChainMatrix *between = nullptr; ///< as above
  std::size_t lane = 0;
  bool is_reversed = false, is_without_lobes = false;

  FastChain(const backend::ChainBlock &block, std::size_t of_lane, bool from_behind,
            const backend::ChainPose &pose, const backend::ChainSurface *seen_surface,
            const backend::ChainSurface *lit_surface)
      : seen(seen_surface), lit(lit_surface), lane(of_lane), is_reversed(from_behind) {
    const auto a = axes_of(from_behind ? block.q : block.p, lane),
               b = axes_of(from_behind ? block.p : block.q, lane);
    const Axes sun = axes_of(pose.sun), observer = axes_of(pose.observer);
    at = kernel::chain_at(a, b, kernel::chain_end_at(a.normal, a.along, observer),
                          kernel::chain_end_at(b.normal, b.along, sun), sun, observer,
                          axes_of(pose.plane));
  }
  [[nodiscard]] Light carried(std::size_t band) const {
    const backend::ChainSurface &of_seen = seen[band], &of_lit = lit[band];
    const auto lobe = [](const backend::ChainSurface &of, const kernel::ChainEndAt<float> &end) {
      return of.has_lobe ? kernel::chain_lobe(of.lobe, end) : 0.0f;
    };
    const auto pass = [&](const kernel::Beam<float> &light) {
      if (between == nullptr)
        return kernel::turned(light, at.straight);
      const auto entry = [&](std::uint32_t row, std::uint32_t column) {
        return between[band].m[4 * row + column][lane];
      };
      return kernel::chain_between(entry, is_reversed, light);
    };
    const kernel::Beam<float> light = kernel::chain_carried(
        of_seen, of_lit, lobe(of_seen, at.seen), lobe(of_lit, at.lit), at, is_without_lobes, pass);
    return {light.i, light.q, light.u, light.v};
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
  if (!faces(one, pose))
    return;
  const backend::ChainBlock &at = drawn_.block[one.block];
  const backend::ChainMatrix *between =
      one.run.is_straight ? nullptr
                          : &matrix_[one.run.matrix + (one.block - one.run.first) * bands_];
  const double weight =
      static_cast<double>(one.is_reversed ? at.from_q[one.lane] : at.from_p[one.lane]) * free;
  const auto add = [&](const auto &light_in) {
    for (std::size_t band = 0; band < bands_; ++band) {
      const Light light = light_in(band) * weight;
      put(light, one.lane, sums.bands[band]);
      sums.squares += band == 0 ? light.i * light.i : 0;
    }
  };
  if (is_general_[drawn_.run_of[one.block]] == 0) {
    const auto forms = [&](bool is_q) {
      return &surfaces_.fast()[(is_q ? one.run.kind_q : one.run.kind_p) * bands_];
    };
    FastChain chain(at, one.lane, one.is_reversed, pose, forms(one.is_reversed),
                    forms(!one.is_reversed));
    chain.between = between;
    chain.is_without_lobes = one.run.is_without_lobes;
    add([&](std::size_t band) { return chain.carried(band); });
    return;
  }
  const auto end = [&](bool is_q) {
    const backend::ChainEnds &e = is_q ? at.q : at.p;
    const std::uint32_t kind = is_q ? one.run.kind_q : one.run.kind_p;
    return GeneralEnd{vector_of(e.normal, one.lane), vector_of(e.along, one.lane),
                      vector_of(e.axis, one.lane),
                      field_of(kind, (is_q ? drawn_.triangle_q : drawn_.triangle_p)[one.at()]),
                      surfaces_.surface(kind)};
  };
  const GeneralChain chain{end(one.is_reversed), end(!one.is_reversed), one.is_reversed, between,
                           one.lane};
  const Vec3<Body> sun = vector_of(pose.sun), observer = vector_of(pose.observer),
                   plane = vector_of(pose.plane);
  add([&](std::size_t band) {
    return chain.carried(band, sun, observer, plane, one.run.is_without_lobes);
  });
}

} // namespace umov
