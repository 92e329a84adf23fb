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

/// What lies between the ends of a chain.
struct BetweenEnds {
  const backend::ChainMatrix *of_bands; ///< null: nothing
  std::size_t lane;
  bool is_reversed; ///< the observer at q
  template <class R, template <class> class Light>
  [[nodiscard]] kernel::Beam<R> carried(std::size_t band, const Light<R> &light) const {
    const auto entry = [&](std::uint32_t row, std::uint32_t column) {
      return static_cast<R>(of_bands[band].m[4 * row + column][lane]);
    };
    return kernel::chain_between(entry, is_reversed, light);
  }
};

/// A chain from the end that the observer sees to the one that the Sun lights.
struct GeneralChain {
  GeneralEnd seen, lit;
  BetweenEnds between;

  /// Light that leaves `lit` into the chain with axis `from`, as it reaches `seen` in axis `to`.
  [[nodiscard]] Light passed(const Light &light, std::size_t band, Vec3<Body> from,
                             Vec3<Body> to) const {
    const Light x = turned(light, from, lit.axis, lit.along);
    if (between.of_bands == nullptr)
      return turned(turned(x, lit.axis, seen.axis, lit.along), seen.axis, to, -seen.along);
    const auto out = between.carried(band, kernel::Beam<double>{x.i, x.q, x.u, x.v});
    return turned(Light{out.i, out.q, out.u, out.v}, seen.axis, to, -seen.along);
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
  BetweenEnds between;
  const backend::ChainSurface *seen, *lit; ///< of the first band
  kernel::ChainAt<float> at;

  FastChain(const backend::ChainBlock &block, const BetweenEnds &with,
            const backend::ChainPose &pose, const backend::ChainSurface *seen_surface,
            const backend::ChainSurface *lit_surface)
      : between(with), seen(seen_surface), lit(lit_surface) {
    const auto a = axes_of(with.is_reversed ? block.q : block.p, with.lane),
               b = axes_of(with.is_reversed ? block.p : block.q, with.lane);
    const Axes sun = axes_of(pose.sun), observer = axes_of(pose.observer);
    at = kernel::chain_at(a, b, kernel::chain_end_at(a.normal, a.along, observer),
                          kernel::chain_end_at(b.normal, b.along, sun),
                          kernel::pose_axes(sun, observer, axes_of(pose.plane)),
                          with.of_bands == nullptr, true);
  }
  [[nodiscard]] Light carried(std::size_t band, bool is_without_lobes) const {
    const backend::ChainSurface &of_seen = seen[band], &of_lit = lit[band];
    const auto lobe = [](const backend::ChainSurface &of, const kernel::ChainEndAt<float> &end) {
      return of.has_lobe ? kernel::chain_lobe(of.lobe, end) : 0.0f;
    };
    const auto pass = [&](const kernel::LinearBeam<float> &light) {
      return between.of_bands == nullptr ? kernel::turned(light, at.straight)
                                         : between.carried(band, light);
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
  const BetweenEnds between{one.run.is_straight
                                ? nullptr
                                : &matrix_[one.run.matrix + (one.block - one.run.first) * bands_],
                            one.lane, one.is_reversed};
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
    const FastChain chain(at, between, pose, forms(one.is_reversed), forms(!one.is_reversed));
    add([&](std::size_t band) { return chain.carried(band, one.run.is_without_lobes); });
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
  const GeneralChain chain{end(one.is_reversed), end(!one.is_reversed), between};
  const Vec3<Body> sun = vector_of(pose.sun), observer = vector_of(pose.observer),
                   plane = vector_of(pose.plane);
  add([&](std::size_t band) {
    return chain.carried(band, sun, observer, plane, one.run.is_without_lobes);
  });
}

} // namespace umov
