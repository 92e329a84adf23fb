#include "light/between/indirect.h"

#include "light/between/path_sampler.h"
#include "light/between/replicates.h"
#include "light/between/smoothing.h"

#include <algorithm>
#include <array>
#include <umov/core/parallel.h>

namespace umov {
namespace {

using Light = PathSampler::Light;

constexpr std::size_t first_count = 32; ///< paths per replicate of a pose at first
/// Poses closer than this find light in the same places [rad], and what was learnt of them counts
/// for less with each pose that follows. One thread takes up to `run_length` of them in a row.
constexpr double close_rad = 0.1, memory = 0.9;
constexpr std::size_t run_length = 32;
/// Sum of the turns of Sun and observer in the body over which values may be mixed [rad].
constexpr double reach_rad = 0.5;

/// How far the directions have turned since the first pose.
std::vector<double> turns(std::span<const Pose> poses) {
  std::vector<double> out{0};
  for (std::size_t k = 1; k < poses.size(); ++k)
    out.push_back(out.back() + angle_between(poses[k - 1].sun, poses[k].sun) +
                  angle_between(poses[k - 1].observer, poses[k].observer));
  return out;
}

/// Where runs of poses begin, each close to the one before; ends with their number.
std::vector<std::size_t> runs_of(std::span<const double> place) {
  std::vector<std::size_t> out{0};
  for (std::size_t k = 1; k < place.size(); ++k)
    if (place[k] - place[k - 1] > close_rad || k - out.back() >= run_length)
      out.push_back(k);
  out.push_back(place.size());
  return out;
}

/// What the paths of each pose carried so far, and how many there were.
class SeriesSums {
public:
  SeriesSums(std::size_t poses, std::size_t bands)
      : poses_(poses), bands_(bands), draws_(poses), rays_(poses),
        light_(poses * replicates, std::vector<Light>(bands)) {}
  std::vector<Light> &of(std::size_t pose, std::size_t replicate) {
    return light_[pose * replicates + replicate];
  }
  void count(std::size_t pose, std::size_t draws, std::uint64_t rays) {
    draws_[pose] += static_cast<double>(draws);
    rays_[pose] += rays;
  }
  [[nodiscard]] std::span<const double> draws() const { return draws_; }
  [[nodiscard]] std::uint64_t rays(std::size_t pose) const { return rays_[pose]; }
  /// Means of one Stokes parameter: [replicate * poses + pose].
  [[nodiscard]] std::vector<double> means(std::size_t band, double Light::*part) const {
    std::vector<double> out(replicates * poses_);
    for (std::size_t r = 0; r < replicates; ++r)
      for (std::size_t k = 0; k < poses_; ++k)
        out[r * poses_ + k] = light_[k * replicates + r][band].*part / draws_[k];
    return out;
  }
  [[nodiscard]] std::size_t bands() const { return bands_; }

private:
  std::size_t poses_, bands_;
  std::vector<double> draws_; ///< per replicate
  std::vector<std::uint64_t> rays_;
  std::vector<std::vector<Light>> light_;
};

/// One round: each pose that is `open` draws `count` paths more per replicate. Together they take
/// one stretch of each lattice, so that what neighbours draw completes each other.
class Rounds {
public:
  Rounds(const BounceScene &scene, const Occluder &occluder, std::span<const Pose> poses,
         std::span<const double> place, const IntegrationOptions &options, unsigned threads,
         const std::atomic<bool> *cancel, const ThermalEmission *emission,
         const ChainSurfaces *chains)
      : emission_(emission), chains_(chains), scene_(scene), occluder_(occluder), poses_(poses),
        options_(options), threads_(threads), cancel_(cancel), runs_(runs_of(place)),
        learnt_(poses.size()) {
    for (std::size_t r = 0; r < replicates; ++r)
      lattices_.emplace_back(options.seed, r);
  }

  void draw(std::size_t first, std::size_t count, const std::vector<char> &is_open,
            SeriesSums &sums) {
    parallel_for(runs_.size() - 1, threads_, [&](std::size_t run) {
      PathLearning before; // of the poses before, in this round
      for (std::size_t k = runs_[run]; k < runs_[run + 1] && !is_stopped(cancel_); ++k)
        if (is_open[k] != 0)
          draw_pose(k, first + k * count, count, before, sums);
    });
  }

private:
  void draw_pose(std::size_t pose, std::size_t first, std::size_t count, PathLearning &before,
                 SeriesSums &sums) {
    PathSampler sampler(scene_, occluder_, poses_[pose], options_, emission_, chains_);
    if (sampler.has_any()) {
      PathLearning known;
      known.add(before, memory);
      known.add(learnt_[pose], 1);
      sampler.start_from(known);
      for (std::size_t r = 0; r < replicates; ++r)
        for (std::size_t i = first; i < first + count && !is_stopped(cancel_); ++i)
          sampler.add(lattices_[r].at(i), stream_of(r, i), sums.of(pose, r));
      learnt_[pose].add(sampler.learnt(), 1);
      known.add(sampler.learnt(), 1);
      before = std::move(known);
    }
    sums.count(pose, count, sampler.rays());
  }
  static std::uint64_t stream_of(std::size_t replicate, std::size_t index) {
    return (static_cast<std::uint64_t>(replicate) << 56U) + index;
  }

  const ThermalEmission *emission_;
  const ChainSurfaces *chains_;
  const BounceScene &scene_;
  const Occluder &occluder_;
  std::span<const Pose> poses_;
  const IntegrationOptions &options_;
  unsigned threads_;
  const std::atomic<bool> *cancel_;
  std::vector<Lattice> lattices_;
  std::vector<std::size_t> runs_;
  std::vector<PathLearning> learnt_; ///< per pose
};

constexpr std::array stokes_parts{&Light::i, &Light::q, &Light::u, &Light::v};

bool is_light(const Light &s) {
  return s.i >= 0 && s.q * s.q + s.u * s.u + s.v * s.v <= s.i * s.i * (1 + 1e-9);
}

/// One band of one pose, from means of each Stokes parameter. Each has a window of its own; where
/// together they are no light (a parabola may fall below 0), narrower ones: a pose's own paths are.
/// Returns how many draws I rests on.
double smooth_pose(const LocalFits &fits, std::size_t pose,
                   const std::array<std::vector<double>, 4> &means, BandResult &out) {
  std::size_t widest = LocalFits::no_limit;
  for (;;) {
    std::size_t used = 0;
    double draws = 0;
    for (std::size_t p = 0; p < stokes_parts.size(); ++p) {
      const Smoothed found = fits.at(pose, means[p], widest);
      out.stokes.*stokes_parts[p] = found.mean;
      out.half_width.*stokes_parts[p] = found.half_width;
      used = std::max(used, found.window);
      draws = p == 0 ? found.draws : draws;
    }
    if (used == 0 || is_light(out.stokes))
      return draws;
    widest = used - 1;
  }
}

/// The series smoothed as it stands; `draws` per pose: the fewest that a value of I rests on.
void smooth(std::span<const double> place, const SeriesSums &sums, std::vector<IndirectLight> &out,
            std::vector<double> &draws) {
  const LocalFits fits(place, sums.draws(), reach_rad);
  std::fill(draws.begin(), draws.end(), INFINITY);
  for (std::size_t b = 0; b < sums.bands(); ++b) {
    std::array<std::vector<double>, 4> means;
    for (std::size_t p = 0; p < stokes_parts.size(); ++p)
      means[p] = sums.means(b, stokes_parts[p]);
    for (std::size_t k = 0; k < place.size(); ++k)
      draws[k] = std::min(draws[k], smooth_pose(fits, k, means, out[k].bands[b]));
  }
}

} // namespace

std::vector<IndirectLight>
indirect_light(const BounceScene &scene, const Occluder &occluder, std::span<const Pose> poses,
               const IntegrationOptions &options, std::span<const double> direct_i,
               unsigned threads, const std::atomic<bool> *cancel, const ThermalEmission *emission,
               const ChainSurfaces *chains) {
  if (poses.empty())
    return {};
  const std::size_t n = poses.size(), bands = direct_i.size() / n;
  std::vector<IndirectLight> out(n);
  for (IndirectLight &one : out)
    one.bands.resize(bands);
  const std::vector<double> place = turns(poses);
  SeriesSums sums(n, bands);
  Rounds rounds(scene, occluder, poses, place, options, threads, cancel, emission, chains);
  std::vector<char> is_open(n, 1);
  std::vector<double> draws(n);
  const std::size_t most = std::max(trusted_draws, options.max_points / replicates);
  // The whole lattice doubles from round to round, whichever poses draw.
  for (std::size_t whole = first_count; whole <= most; whole *= 2) {
    const bool is_first = whole == first_count;
    const std::size_t count = is_first ? first_count : whole / 2;
    rounds.draw(is_first ? 0 : n * count, count, is_open, sums);
    if (is_stopped(cancel))
      return {};
    smooth(place, sums, out, draws);
    bool is_any_open = false;
    for (std::size_t k = 0; k < n; ++k) {
      bool is_enough = draws[k] >= trusted_draws;
      for (std::size_t b = 0; b < bands; ++b) {
        const BandResult &light = out[k].bands[b];
        is_enough = is_enough && light.half_width.i <=
                                     options.accuracy * (direct_i[k * bands + b] + light.stokes.i);
      }
      is_open[k] = is_enough ? 0 : 1;
      is_any_open = is_any_open || !is_enough;
    }
    if (!is_any_open)
      break;
  }
  for (std::size_t k = 0; k < n; ++k) {
    out[k].rays = sums.rays(k);
    // Light that has no Q or U by its source has none without a plane, by definition.
    if (!has_scattering_plane(poses[k]) && options.source.q == 0 && options.source.u == 0)
      for (BandResult &band : out[k].bands)
        band.stokes.q = band.stokes.u = band.half_width.q = band.half_width.u = 0;
  }
  return out;
}

} // namespace umov
