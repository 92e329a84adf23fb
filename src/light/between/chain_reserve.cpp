#include "light/between/chain_reserve.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <umov/core/random.h>

namespace umov {
namespace {

constexpr std::uint32_t pick_stream = 0xC4D0;
/// How many chains a pose settles by rays.
constexpr double least_picks = 512, most_picks = 8192;

/// How many tell the whole light to the accuracy asked, if half of what all would carry passes.
double picks_for(double direct_i, double all, double accuracy) {
  const double share = all > 0 ? all / 2 / (direct_i + all / 2) : 0;
  return std::clamp(std::pow(student_of_replicates * share / accuracy, 2), least_picks, most_picks);
}

} // namespace

ChainReserve::ChainReserve(const ChainDrawn &drawn, const ChainMaterials &materials,
                           unsigned threads, const std::atomic<bool> *cancel)
    : ChainSet(drawn, materials, threads, cancel) {
  for (std::uint32_t run = 0; run < runs_.size(); ++run)
    for (std::uint32_t first = 0; is_left_[run] == 0 && first < runs_[run].count;
         first += blocks_of_piece)
      pieces_.push_back(
          {run, first, std::min<std::uint32_t>(blocks_of_piece, runs_[run].count - first)});
  for (std::size_t r = 0; r < replicates; ++r)
    shift_[r] = uniform4(materials.drawing.seed(), pick_stream, r)[0];
  view_ = {drawn.block, matrix_, surfaces_.fast(), {}, bands_, transmitted_};
}

void ChainReserve::weigh(const Piece &piece, const backend::ChainPose &pose, Weights &out) const {
  backend::weigh_chains(view_, runs_[piece.run], piece.first, piece.count, pose, out.data());
}

std::vector<ChainReserve::Told> ChainReserve::add(std::span<const backend::ChainPose> poses,
                                                  std::span<const double> direct_i, double accuracy,
                                                  std::span<backend::ChainSums> sums) const {
  using Lanes = std::array<double, replicates>;
  std::vector<Lanes> sum(pieces_.size() * poses.size());
  std::vector<Way> ways(poses.size());
  std::vector<Told> out(poses.size());
  std::vector<std::vector<Pick>> stopped(poses.size());
  Weights weights;
  // Piece by piece for all poses, while the cache has it.
  for (std::size_t p = 0; p < pieces_.size(); ++p)
    for (std::size_t k = 0; k < poses.size(); ++k) {
      weigh(pieces_[p], poses[k], weights);
      Lanes &to = sum[p * poses.size() + k];
      for (std::size_t at = 0; at < pieces_[p].count * replicates; ++at)
        to[at % replicates] += static_cast<double>(weights[at]);
      for (std::size_t r = 0; r < replicates; ++r)
        ways[k].step[r] += to[r];
    }
  for (std::size_t k = 0; k < poses.size(); ++k) {
    Way &way = ways[k];
    const double all = std::accumulate(way.step.begin(), way.step.end(), 0.0) / replicates,
                 picks = picks_for(direct_i[k], all, accuracy);
    out[k] = {all, static_cast<std::size_t>(picks), {}};
    for (std::size_t r = 0; r < replicates; ++r) {
      way.step[r] *= replicates / picks;
      way.next[r] = shift_[r] * way.step[r];
    }
  }
  for (std::size_t p = 0; p < pieces_.size(); ++p)
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const Lanes &more = sum[p * poses.size() + k];
      Way &way = ways[k];
      Lanes end;
      bool is_any = false;
      for (std::size_t r = 0; r < replicates; ++r) {
        end[r] = way.passed[r] + more[r];
        is_any = is_any || way.next[r] < end[r];
      }
      if (is_any) {
        weigh(pieces_[p], poses[k], weights);
        pick(pieces_[p], weights, poses[k], way, sums[k], stopped[k]);
      }
      way.passed = end;
    }
  for (std::size_t k = 0; k < poses.size(); ++k)
    out[k].hidden = hidden(stopped[k], poses[k]);
  return out;
}

void ChainReserve::pick(const Piece &piece, const Weights &weights, const backend::ChainPose &pose,
                        Way &way, backend::ChainSums &sums, std::vector<Pick> &stopped) const {
  for (std::size_t k = 0; k < piece.count; ++k)
    for (std::size_t r = 0; r < replicates; ++r) {
      const auto weight = static_cast<double>(weights[k * replicates + r]);
      way.passed[r] += weight;
      double steps = 0;
      for (; weight > 0 && way.next[r] < way.passed[r]; way.next[r] += way.step[r])
        ++steps;
      if (steps == 0)
        continue;
      const Pick pick{runs_[piece.run].first + piece.first + k, r, steps,
                      steps * way.step[r] / weight};
      if (settle(pick, pose, sums))
        stopped.clear();
      else if (!(sums.squares > 0))
        stopped.push_back(pick);
    }
}

bool ChainReserve::settle(const Pick &pick, const backend::ChainPose &pose,
                          backend::ChainSums &sums) const {
  bool is_any = false;
  for (const bool is_reversed : {false, true}) {
    const OneChain one{run_at(pick.block), pick.block, pick.lane, is_reversed};
    if (!faces(one, pose) || !is_free(one, pose))
      continue;
    add_one(one, pick.times, pose, sums);
    is_any = true;
  }
  return is_any;
}

/// Of n picks that none passed at most 3/n of all pass (95 %). What these carry for their weight in
/// a band is taken as where most of that band's light is: of one whose light few of them have, more
/// than in the mean.
std::vector<double> ChainReserve::hidden(const std::vector<Pick> &stopped,
                                         const backend::ChainPose &pose) const {
  std::vector<double> light(bands_), square(bands_), out(bands_);
  for (const Pick &pick : stopped) {
    std::vector<backend::ChainLight> one(bands_);
    backend::ChainSums sums;
    sums.bands = one;
    for (const bool is_reversed : {false, true})
      add_one({run_at(pick.block), pick.block, pick.lane, is_reversed}, pick.times, pose, sums);
    for (std::size_t b = 0; b < bands_; ++b) {
      const double i = one[b].i[pick.lane] / replicates;
      light[b] += i;
      square[b] += i * i / pick.steps;
    }
  }
  for (std::size_t b = 0; b < bands_; ++b)
    if (light[b] > 0)
      out[b] = 3 * square[b] / light[b];
  return out;
}

} // namespace umov
