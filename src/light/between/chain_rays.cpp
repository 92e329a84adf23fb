#include "light/between/chain_rays.h"

#include "light/between/beam_axes.h"
#include "light/between/chain_matrices.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <umov/core/random.h>
#include <umov/core/stop.h>

namespace umov {
namespace {

constexpr std::uint32_t shift_stream = 0xC4A1, walk_stream = 0xC4A2, look_stream = 0xC4E2,
                        thinning_stream = 0xC4A0 + 0x80;
constexpr double least_cosine = 1e-6;

/// Kronecker's sequence in the four dimensions of a ray with the powers of the root of x^5 = x + 1
/// (Roberts 2018), shifted.
std::array<double, 4> lattice(const std::array<double, 4> &shift, std::size_t index) {
  constexpr double root = 1.1673039782614187;
  std::array<double, 4> out{};
  double power = 1;
  for (std::size_t d = 0; d < out.size(); ++d) {
    power /= root;
    const double x = shift[d] + power * static_cast<double>(index);
    out[d] = x - std::floor(x);
  }
  return out;
}

/// Cosine from the shading normal over that from the facet.
double bend_of(const Vertex &at, Vec3<Body> d) {
  return dot(at.normal, d) / std::max(dot(at.face, d), least_cosine);
}

Vec3<Body> axis_of(const Vertex &at, Vec3<Body> along) {
  const Vec3<Body> s = cross(at.normal, along);
  return norm(s) > 1e-9 ? normalized(s) : any_perpendicular(along);
}

} // namespace

/// A way as far as it has come.
struct ChainRays::Walk {
  Vertex first;
  Vec3<Body> along;
  double forward = 0, backward = 0;
  std::vector<ChainVertex> between;
  std::vector<ChainMatrices> matrices; ///< of each member of the cover
};

ChainRays::ChainRays(const BounceScene &scene, const Occluder &occluder, const ChainCover &cover,
                     std::size_t bounces, std::uint64_t seed)
    : scene_(scene), occluder_(occluder), cover_(cover), bounces_(bounces), seed_(seed) {
  double sum = 0;
  for (const bool is_back : {false, true})
    for (std::uint32_t t = 0; t < scene.areas().size(); ++t)
      if (is_back ? scene.sides()[t].back : scene.sides()[t].front) {
        side_.push_back(2 * t + (is_back ? 1 : 0));
        sum_.push_back(sum += scene.areas()[t]);
      }
}

Vertex ChainRays::start(double x, double v) const {
  const double at = x * sum_.back();
  const std::size_t k = std::min<std::size_t>(
      sum_.size() - 1,
      static_cast<std::size_t>(std::upper_bound(sum_.begin(), sum_.end(), at) - sum_.begin()));
  const std::uint32_t t = side_[k] / 2;
  const double part = std::clamp(1 - (sum_[k] - at) / scene_.areas()[t], 0.0, 1.0);
  const double root = std::sqrt(part);
  const Vec3<Body> n = scene_.normal(t);
  return scene_.vertex_on(t, root * (1 - v), root * v, side_[k] % 2 != 0 ? -n : n);
}

ChainEnd ChainRays::end_at(const Vertex &at, Vec3<Body> along) const {
  ChainEnd out;
  out.point = occluder_.to_point(at.point);
  put_floats(at.face, out.face);
  put_floats(at.normal, out.normal);
  put_floats(along, out.along);
  put_floats(axis_of(at, along), out.axis);
  out.triangle = at.triangle;
  out.slot = at.slot;
  out.kind = cover_.kind_of(at.slot);
  return out;
}

void ChainRays::put(const Walk &walk, const Vertex &last, Vec3<Body> back, ChainList &out) const {
  if (!(dot(last.normal, back) > least_cosine))
    return;
  Chain c;
  c.p = end_at(walk.first, walk.along);
  c.q = end_at(last, back);
  if (!cover_.is_any(c.p.kind, c.q.kind))
    return;
  c.from_p = walk.forward * bend_of(walk.first, walk.along);
  c.from_q = walk.backward * bend_of(last, back);
  c.first = static_cast<std::uint32_t>(out.between.size());
  c.count = static_cast<std::uint32_t>(walk.between.size());
  out.between.insert(out.between.end(), walk.between.begin(), walk.between.end());
  for (const ChainMatrices &of : walk.matrices)
    out.transmitted.push_back(c.count == 0 ? 1 : static_cast<float>(of.transmitted()));
  out.chains.push_back(c);
}

bool ChainRays::step(Walk &walk, Vertex &at, Vec3<Body> &back,
                     const std::array<double, 4> &u) const {
  const Direction d = cover_.draw(at.slot, at.normal, back, u);
  Vertex to;
  double distance = 0;
  if (!(d.density > 0) || !scene_.next(occluder_, at, d.to, to, distance))
    return false;
  if (!(dot(at.normal, d.to) > 0) || !(dot(at.normal, back) > 0))
    return false;
  ChainVertex &kept = walk.between.emplace_back();
  put_floats(at.normal, kept.normal);
  put_floats(d.to, kept.to);
  kept.density = static_cast<float>(d.density);
  kept.triangle = at.triangle;
  kept.slot = at.slot;
  kept.is_by_mirror = d.is_by_mirror ? 1 : 0;
  double strongest = 0;
  for (ChainMatrices &of : walk.matrices) {
    of.pass(kept);
    strongest = std::max(strongest, of.strongest());
  }
  walk.backward *= bend_of(at, back) / bend_of(at, d.to);
  at = to;
  back = -d.to;
  return strongest > 0;
}

ChainList ChainRays::draw(std::size_t replicate, std::size_t first, std::size_t count,
                          const std::atomic<bool> *cancel) const {
  ChainList out;
  const auto shift = uniform4(seed_, shift_stream, replicate);
  const double weight = pi * sum_.back() / static_cast<double>(count);
  Walk walk;
  for (std::size_t m = 0; m < cover_.members(); ++m)
    walk.matrices.emplace_back(cover_.sides(m), scene_.scene().mesh);
  for (std::size_t i = first; i < first + count && !is_stopped(cancel); ++i) {
    const auto x = lattice(shift, i);
    walk.first = start(x[0], x[1]);
    const Vec3<Body> n = walk.first.face, a = any_perpendicular(n), b = cross(n, a);
    const double sine = std::sqrt(1 - x[2]), turn = 2 * pi * x[3];
    walk.along = n * std::sqrt(x[2]) + a * (sine * std::cos(turn)) + b * (sine * std::sin(turn));
    Vertex at;
    double distance = 0;
    if (!(dot(walk.first.normal, walk.along) > least_cosine) ||
        !scene_.next(occluder_, walk.first, walk.along, at, distance))
      continue;
    walk.forward = walk.backward = weight;
    walk.between.clear();
    for (ChainMatrices &of : walk.matrices)
      of.start(axis_of(walk.first, walk.along), walk.along);
    Vec3<Body> back = -walk.along;
    put(walk, at, back, out);
    const std::uint64_t stream = (static_cast<std::uint64_t>(replicate) << 56U) + i;
    for (std::size_t k = 2; k < bounces_; ++k) {
      if (!step(walk, at, back,
                uniform4(seed_, walk_stream + static_cast<std::uint32_t>(k), stream)))
        break;
      put(walk, at, back, out);
    }
  }
  return out;
}

double ChainRays::freedom(const ChainEnd &end, const std::vector<Sampler> &ways,
                          std::uint64_t stream) const {
  // All ways alike: several looks at each of a few, and of many every so manieth from any of them.
  constexpr std::size_t fewest = 4, most = 8;
  const std::size_t all = (fewest + ways.size() - 1) / ways.size() * ways.size();
  const std::size_t looks = std::min(all, most);
  const Vec3<Body> normal = vector_of(end.normal), along = vector_of(end.along),
                   face = vector_of(end.face);
  std::size_t free = 0, first = 0;
  for (std::size_t k = 0; k < looks; ++k) {
    constexpr unsigned beyond_streams = 40; // numbers of chains leave these bits (number_of_first)
    const auto x = uniform4(seed_, look_stream + static_cast<std::uint32_t>(k % fewest),
                            stream + (static_cast<std::uint64_t>(k / fewest) << beyond_streams));
    if (k == 0 && looks < all)
      first = std::min(static_cast<std::size_t>(x[3] * static_cast<double>(ways.size())),
                       ways.size() - 1);
    const Direction d =
        ways[(first + k * all / looks) % ways.size()].draw(normal, along, x[0], x[1], x[2]);
    if (!(dot(d.to, face) > 0))
      continue;
    unsigned char is_free = 0;
    const Occluder::Point to{static_cast<float>(d.to.x), static_cast<float>(d.to.y),
                             static_cast<float>(d.to.z)};
    occluder_.is_free(std::span(&end.point, 1), std::span(&to, 1), std::span(&is_free, 1));
    free += is_free;
  }
  return std::sqrt((static_cast<double>(free) + 0.25) / static_cast<double>(looks));
}

double ChainRays::strength(const ChainList &all, std::size_t chain) const {
  const Chain &c = all.chains[chain];
  const double cosine_p = cosine_of(c.p), cosine_q = cosine_of(c.q);
  const std::size_t members = cover_.members();
  double square = 0;
  for (std::size_t m = 0; m < members; ++m) {
    const double one = static_cast<double>(all.transmitted[chain * members + m]) *
                       cover_.strength(m, c.p.kind, cosine_p) *
                       cover_.strength(m, c.q.kind, cosine_q);
    square += one * one / static_cast<double>(members);
  }
  return std::sqrt(square);
}

double ChainRays::matters(const ChainList &all, std::size_t chain, std::uint64_t number) const {
  const Chain &c = all.chains[chain];
  return (c.from_p + c.from_q) * strength(all, chain) *
         freedom(c.p, cover_.samplers(c.p.slot), 2 * number) *
         freedom(c.q, cover_.samplers(c.q.slot), 2 * number + 1);
}

std::uint64_t likeness(const Chain &chain) {
  const auto cell = [](Vec3<Body> a, double cells) {
    const auto f = [&](double x) {
      return static_cast<std::uint64_t>(std::clamp((x * 0.5 + 0.5) * cells, 0.0, cells - 1));
    };
    const auto n = static_cast<std::uint64_t>(cells);
    return (f(a.x) * n + f(a.y)) * n + f(a.z);
  };
  std::uint64_t out = chain.count == 0 ? 0 : 1;
  out = out << 12U | (chain.p.kind & 4095U);
  out = out << 12U | (chain.q.kind & 4095U);
  out = out << 9U | cell(vector_of(chain.p.normal), 8);
  out = out << 9U | cell(vector_of(chain.q.normal), 8);
  return out << 8U | cell(vector_of(chain.p.along), 6);
}

ChainList ChainRays::thinned(const ChainList &all, std::size_t replicate, std::size_t first,
                             std::size_t kept, const std::atomic<bool> *cancel) const {
  std::vector<double> matters;
  const std::uint64_t begin = number_of_first(replicate, first);
  for (std::size_t k = 0; k < all.chains.size(); ++k) {
    if (is_stopped(cancel))
      return {};
    matters.push_back(this->matters(all, k, begin + k));
  }
  // Chances are `scale` times what matters, at most 1, and add up to `kept`.
  double low = 0, high = 1e30;
  for (int k = 0; k < 200; ++k) {
    const double middle = k < 100 ? std::sqrt(std::max(low, 1e-30) * high) : (low + high) / 2;
    double sum = 0;
    for (const double x : matters)
      sum += std::min(1.0, middle * x);
    (sum > static_cast<double>(kept) ? high : low) = middle;
  }
  std::vector<std::size_t> order(all.chains.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<std::uint64_t> key;
  for (const Chain &c : all.chains)
    key.push_back(likeness(c));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return key[a] < key[b]; });
  ChainList out;
  double reached = uniform4(seed_, thinning_stream, begin)[0];
  for (const std::size_t k : order) {
    const double chance = std::min(1.0, low * matters[k]);
    reached += chance;
    if (reached < 1)
      continue;
    reached -= 1;
    Chain &c = out.chains.emplace_back(all.chains[k]);
    c.from_p /= chance;
    c.from_q /= chance;
    const auto from = all.between.begin() + static_cast<std::ptrdiff_t>(c.first);
    c.first = static_cast<std::uint32_t>(out.between.size());
    out.between.insert(out.between.end(), from, from + static_cast<std::ptrdiff_t>(c.count));
  }
  return out;
}

} // namespace umov
