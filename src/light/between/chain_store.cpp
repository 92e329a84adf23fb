#include "light/between/chain_store.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <umov/core/parallel.h>

namespace umov {
namespace {

/// Poses that are lit in turn by the chains that the cache has.
constexpr std::size_t poses_together = 16;
/// Fewer chains than this, counted by their light, (sum I)^2 / sum I^2, are too few to tell how far
/// off they are.
constexpr double least_chains = 48;
/// Of the reserve, which is asked for those that carry most: below `least_chains` half-widths are
/// as much wider as the root of what lacks.
constexpr double least_of_reserve = 24;

/// How well chains in doubt are settled: to a part of the standard error that the replicates have
/// anyway, or of that wanted.
constexpr double mended_to = 0.5;

constexpr double weight_of(std::size_t level) {
  return static_cast<double>(ChainDrawing::chains_of[level]);
}
constexpr double all_weights =
    std::accumulate(ChainDrawing::chains_of.begin(), ChainDrawing::chains_of.end(), 0.0);

/// What is left of the error of visibility, in parts of the light: where the directions of a grid
/// agree about what lies between them, and are wrong. At least this much, since few are asked
/// (docs/theory/bounces.md).
constexpr double visibility_error = 0.005;

/// `left`: that error, and `wider`: how many times the replicates' spread counts.
BandResult result_of(const backend::ChainLight &sum, double weight, double left, double wider = 1) {
  BandResult out;
  const auto put = [&](const double(&from)[replicates], double &mean, double &half_width) {
    std::array<double, replicates> value{};
    for (std::size_t r = 0; r < replicates; ++r)
      value[r] = from[r] / weight;
    const MeanOfReplicates found = mean_of_replicates(value);
    mean = found.mean;
    half_width = wider * student_of_replicates * found.deviation;
  };
  put(sum.i, out.stokes.i, out.half_width.i);
  put(sum.q, out.stokes.q, out.half_width.q);
  put(sum.u, out.stokes.u, out.half_width.u);
  put(sum.v, out.stokes.v, out.half_width.v);
  const Stokes<ScatteringPlane> &s = out.stokes;
  const double polarized = left * std::hypot(s.q, s.u, s.v);
  out.half_width.i = std::hypot(out.half_width.i, left * s.i);
  for (double *part : {&out.half_width.q, &out.half_width.u, &out.half_width.v})
    *part = std::hypot(*part, polarized);
  return out;
}

double total_of(const backend::ChainLight &sum) {
  double out = 0;
  for (const double x : sum.i)
    out += x;
  return out;
}

/// What the reserve told of a pose; false if it rests on too few chains.
bool put_reserve(const backend::ChainSums &sums, const ChainReserve::Told &told,
                 IndirectLight &out) {
  const double total = total_of(sums.bands[0]);
  double all = 0;
  for (const backend::ChainLight &band : sums.bands)
    all += total_of(band);
  if (!std::isfinite(told.all) || !std::isfinite(all))
    return false;
  out.bands.assign(sums.bands.size(), {});
  if (!(all > 0)) {
    for (std::size_t b = 0; b < out.bands.size(); ++b)
      out.bands[b].half_width = {told.hidden[b], told.hidden[b], told.hidden[b], told.hidden[b]};
    return true;
  }
  if (!(sums.squares > 0))
    return false; // light that the first band, which tells how many carry it, has none of
  const double met = total * total / sums.squares,
               wider = std::sqrt(std::max(1.0, least_chains / met));
  for (std::size_t b = 0; b < out.bands.size(); ++b)
    out.bands[b] = result_of(sums.bands[b], 1, 0, wider);
  return met >= least_of_reserve;
}

} // namespace

/// What the poses have gathered so far.
struct ChainStore::Climb {
  std::vector<std::size_t> open;        ///< poses
  std::vector<backend::ChainLight> sum; ///< [pose * bands + band], weighted by level
  std::vector<double> squares;          ///< per pose
  std::vector<double> mistaken;         ///< per pose: I that the grids call free, and is not
  std::vector<double> narrow_i, narrow_squares; ///< per pose: of light between narrow lobes
};

bool draws_reserve(std::size_t poses_in_all) {
  constexpr std::size_t few = 24; // docs/theory/bounces.md
  return poses_in_all == 0 || poses_in_all > few;
}

ChainStore::ChainStore(std::shared_ptr<const ChainDrawing> drawing, const Scene &scene,
                       std::shared_ptr<const ChainSurfaces> surfaces)
    : drawing_(std::move(drawing)),
      surfaces_(std::move(surfaces)), materials_{scene, *surfaces_, *drawing_},
      bands_(scene.grid.nodes().size()) {}

const ChainLevel *ChainStore::level(std::size_t index, unsigned threads,
                                    const std::atomic<bool> *cancel) const {
  const ChainDrawn *drawn = drawing_->drawn(index, threads, cancel);
  return drawn == nullptr ? nullptr : level_[index].get(cancel, [&] {
    return std::make_unique<const ChainLevel>(*drawn, materials_, index, threads, cancel);
  });
}

const ChainReserve *ChainStore::reserve(unsigned threads, const std::atomic<bool> *cancel) const {
  const ChainDrawn *drawn = drawing_->drawn(levels, threads, cancel);
  return drawn == nullptr ? nullptr : reserve_.get(cancel, [&] {
    return std::make_unique<const ChainReserve>(*drawn, materials_, threads, cancel);
  });
}

void ChainStore::add_level(std::size_t index, std::span<const Pose> poses,
                           std::span<const double> direct_i, const IntegrationOptions &options,
                           Climb &climb, unsigned threads, const std::atomic<bool> *cancel) const {
  const ChainLevel *found_level = level(index, threads, cancel);
  if (found_level == nullptr)
    return;
  const ChainLevel &from = *found_level;
  const std::size_t groups = (climb.open.size() + poses_together - 1) / poses_together;
  parallel_for(groups, threads, [&](std::size_t group) {
    if (is_stopped(cancel))
      return;
    const std::size_t begin = group * poses_together,
                      count = std::min(poses_together, climb.open.size() - begin);
    std::vector<backend::ChainPose> at;
    std::vector<backend::ChainLight> light(count * bands_);
    std::vector<backend::ChainSums> sums(count);
    // Of which few pages are ever touched: most chains carry nothing to a pose.
    const auto notes = std::make_unique_for_overwrite<backend::ChainNote[]>(count * from.blocks());
    for (std::size_t k = 0; k < count; ++k) {
      at.push_back(chain_pose(poses[climb.open[begin + k]]));
      sums[k].bands = {light.data() + k * bands_, bands_};
      sums[k].notes = {notes.get() + k * from.blocks(), from.blocks()};
    }
    from.add(at, sums);
    const double weight = weight_of(index);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t pose = climb.open[begin + k];
      const MeanOfReplicates found = mean_of_replicates(light[k * bands_].i);
      from.mend(at[k],
                mended_to * std::max(found.deviation, options.accuracy / student_of_replicates *
                                                          (direct_i[pose * bands_] + found.mean)),
                sums[k]);
      climb.squares[pose] += weight * weight * sums[k].squares;
      climb.narrow_i[pose] += weight * sums[k].narrow_i;
      climb.narrow_squares[pose] += weight * weight * sums[k].narrow_squares;
      climb.mistaken[pose] += weight * from.mistaken(at[k], sums[k]);
      for (std::size_t b = 0; b < bands_; ++b) {
        backend::ChainLight &to = climb.sum[pose * bands_ + b];
        const backend::ChainLight &more = sums[k].bands[b];
        for (std::size_t r = 0; r < replicates; ++r) {
          to.i[r] += weight * more.i[r];
          to.q[r] += weight * more.q[r];
          to.u[r] += weight * more.u[r];
          to.v[r] += weight * more.v[r];
        }
      }
    }
  });
}

void ChainStore::ask_reserve(std::span<const Pose> poses, std::span<const double> direct_i,
                             const IntegrationOptions &options, Answer &answer, unsigned threads,
                             const std::atomic<bool> *cancel) const {
  std::vector<std::size_t> few;
  for (std::size_t k = 0; k < poses.size(); ++k)
    if (answer.is_enough[k] == 0)
      few.push_back(k);
  const ChainReserve *from = few.empty() ? nullptr : reserve(threads, cancel);
  if (from == nullptr)
    return;
  parallel_for((few.size() + poses_together - 1) / poses_together, threads, [&](std::size_t group) {
    if (is_stopped(cancel))
      return;
    const std::size_t begin = group * poses_together,
                      count = std::min(poses_together, few.size() - begin);
    std::vector<backend::ChainPose> at;
    std::vector<double> beside;
    std::vector<backend::ChainLight> light(count * bands_);
    std::vector<backend::ChainSums> sums(count);
    for (std::size_t k = 0; k < count; ++k) {
      at.push_back(chain_pose(poses[few[begin + k]]));
      beside.push_back(direct_i[few[begin + k] * bands_]);
      sums[k].bands = {light.data() + k * bands_, bands_};
    }
    const auto told = from->add(at, beside, options.accuracy, sums);
    for (std::size_t k = 0; k < count; ++k) {
      // What levels met is not mixed in: that they met few is a choice by what they met.
      IndirectLight &light = answer.light[few[begin + k]];
      light.rays = 4 * told[k].picks;
      answer.is_enough[few[begin + k]] = put_reserve(sums[k], told[k], light) ? 1 : 0;
    }
  });
}

ChainStore::Answer ChainStore::light(std::span<const Pose> poses, std::span<const double> direct_i,
                                     const IntegrationOptions &options, unsigned threads,
                                     const std::atomic<bool> *cancel) const {
  Answer out;
  out.light.resize(poses.size());
  out.is_enough.assign(poses.size(), 1);
  const bool asks_reserve =
      surfaces_->are_fast() && static_cast<double>(options.max_points) >= all_weights;
  const bool has_reserve = asks_reserve && draws_reserve(options.poses_in_all);
  if (asks_reserve && surfaces_->are_narrow())
    out.is_enough.assign(poses.size(), 0);
  else
    climb(poses, direct_i, options, out, threads, cancel);
  if (has_reserve)
    ask_reserve(poses, direct_i, options, out, threads, cancel);
  if (is_stopped(cancel))
    return {};
  for (std::size_t k = 0; k < poses.size(); ++k)
    if (!has_scattering_plane(poses[k]))
      for (BandResult &band : out.light[k].bands)
        band.stokes.q = band.stokes.u = band.half_width.q = band.half_width.u = 0;
  return out;
}

void ChainStore::climb(std::span<const Pose> poses, std::span<const double> direct_i,
                       const IntegrationOptions &options, Answer &out, unsigned threads,
                       const std::atomic<bool> *cancel) const {
  Climb climb;
  climb.sum.resize(poses.size() * bands_);
  climb.squares.resize(poses.size());
  climb.mistaken.resize(poses.size());
  climb.narrow_i.resize(poses.size());
  climb.narrow_squares.resize(poses.size());
  for (std::size_t k = 0; k < poses.size(); ++k)
    climb.open.push_back(k);
  double weight = 0;
  for (std::size_t index = 0; index < levels && !climb.open.empty(); ++index) {
    if (index > 0 && weight + weight_of(index) > static_cast<double>(options.max_points))
      break;
    add_level(index, poses, direct_i, options, climb, threads, cancel);
    if (is_stopped(cancel))
      return;
    weight += weight_of(index);
    std::vector<std::size_t> left;
    for (const std::size_t k : climb.open) {
      IndirectLight &light = out.light[k];
      light.bands.assign(bands_, {});
      const double total = total_of(climb.sum[k * bands_]);
      const double narrow = climb.narrow_i[k];
      // Light of narrow lobes counts where it is more of the whole than the accuracy asked.
      const bool is_narrow_light =
          narrow / (replicates * weight) >
          options.accuracy * (direct_i[k * bands_] + total / (replicates * weight));
      const bool is_enough =
          !(total > 0) ||
          (total * total >= least_chains * climb.squares[k] &&
           (!is_narrow_light || narrow * narrow >= least_chains * climb.narrow_squares[k]));
      // Where 16 k chains meet nothing there is nothing, beside any direct light.
      bool is_met = is_enough && (total > 0 || direct_i[k * bands_] > 0);
      for (std::size_t b = 0; b < bands_; ++b) {
        light.bands[b] =
            result_of(climb.sum[k * bands_ + b], weight,
                      std::hypot(visibility_error, total > 0 ? climb.mistaken[k] / total : 0));
        is_met =
            is_met && light.bands[b].half_width.i <=
                          options.accuracy * (direct_i[k * bands_ + b] + light.bands[b].stokes.i);
      }
      out.is_enough[k] = is_enough ? 1 : 0;
      if (!is_met)
        left.push_back(k);
    }
    climb.open = std::move(left);
  }
}

} // namespace umov
