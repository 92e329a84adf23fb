#include "light/model/curved_errors.h"

#include "light/reference/elements_lit.h"

#include <algorithm>
#include <cmath>
#include <umov/core/parallel.h>
#include <umov/core/stop.h>
#include <umov/light/poses.h>

namespace umov {
namespace {

constexpr double least = 1e-4;
/// Light below this part of the mean at its phase angle counts as that much.
constexpr double dim_part = 0.1;
/// The largest of so few says little of one in twenty: half as much again is said (tried on
/// cylinders and Agena: 60 poses at each of ten phase angles are covered to .85 to 1).
constexpr std::size_t poses_per_node = 12;
constexpr double margin = 1.5;
/// Where poses are looked at [deg]. The first stands for all below, spread from 30 deg on: there it
/// hardly depends on the phase angle (engine.md). Between two the error is taken as straight, which
/// is more than it is: it grows as one over the width of the strip that is lit and seen.
constexpr double phases_deg[] = {110, 130, 145, 155, 163, 169, 174, 177, 179};
constexpr double first_from_deg = 30;

std::vector<Pose> poses_to_look_at() {
  constexpr std::uint64_t seed = 0;
  std::vector<Pose> out;
  for (const double phase : phases_deg)
    for (std::size_t k = 0; k < poses_per_node; ++k) {
      const double from = out.size() < poses_per_node ? first_from_deg : phase;
      const double part = (static_cast<double>(k) + 0.5) / static_cast<double>(poses_per_node);
      out.push_back(random_pose(seed, out.size(), Angle::degrees(from + part * (phase - from))));
      out.back().sun_radius_rad = sun_radius_at_1au_rad;
    }
  return out;
}

/// Of a grid with the heaviest wavelength first and the others in order: that and both ends.
std::vector<std::size_t> few_nodes(std::size_t count) {
  std::vector<std::size_t> out{0, 1, count - 1};
  out.resize(std::min<std::size_t>(count, 3));
  return out;
}

/// The scene at some nodes of its grid: what compiles at all of them compiles at a few, if each
/// still says which curve asks for it.
Scene at_nodes(const Scene &scene, const std::vector<std::size_t> &which) {
  Scene out = scene;
  out.bands.clear();
  std::vector<Band> nodes;
  for (const std::size_t node : which) {
    nodes.push_back(scene.grid.nodes()[node]);
    out.bands.push_back({nodes.back().name, nodes.back().wavelength});
  }
  out.grid = BandGrid::make(out.bands).value();
  std::vector<std::pair<Surface, Surface>> known; // as it was, as it is now
  for (auto *side : {&out.front, &out.back})
    for (Surface &surface : *side) {
      auto same = std::find_if(known.begin(), known.end(),
                               [&](const auto &pair) { return pair.first.is_same(surface); });
      if (same == known.end())
        same = known.insert(same, {surface, Surface::compile(surface.material(), nodes).value()});
      surface = same->second;
    }
  return out;
}

double phase_of(const Pose &pose) { return std::acos(cos_phase(pose)); }

/// Light of poses by the engine and how far the reference's is from it, at a few wavelengths.
struct Looked {
  StokesTable fast;
  std::vector<std::size_t> nodes;
  std::vector<double> difference; ///< of I [pose * nodes + node]
};

Looked look_at(const Scene &scene, const Engine &unhidden, const std::vector<Pose> &poses,
               unsigned threads, const std::atomic<bool> *cancel) {
  Looked out;
  LightTask task;
  task.threads = threads;
  task.cancel = cancel;
  (void)unhidden.evaluate(poses, out.fast, task);
  leave_if_stopped(cancel);
  out.nodes = few_nodes(out.fast.bands); // what is missed hardly depends on them
  const Elements elements = make_elements(scene, visible_sides(scene.mesh, cancel), cancel);
  const Scene few = out.nodes.size() < out.fast.bands ? at_nodes(scene, out.nodes) : scene;
  out.difference.resize(poses.size() * out.nodes.size());
  parallel_for(poses.size(), threads, [&](std::size_t k) {
    const LitElements lit =
        light_elements(few, elements, geometry_of(poses[k]), {1, 0, 0, 0}, cancel);
    for (std::size_t n = 0; n < out.nodes.size(); ++n)
      out.difference[k * out.nodes.size() + n] =
          std::abs(out.fast.i[k * out.fast.bands + out.nodes[n]] - lit.total[n]);
  });
  return out;
}

/// What part of the light is missed at most, of the poses from `first` on, where light counts as
/// `dim_i` [per band] at least.
double most_missed(const Looked &looked, std::size_t first, const std::vector<double> &dim_i) {
  double most = least;
  for (std::size_t k = first; k < first + poses_per_node; ++k)
    for (std::size_t n = 0; n < looked.nodes.size(); ++n) {
      const std::size_t band = looked.nodes[n];
      const double refers_to = std::max(looked.fast.i[k * looked.fast.bands + band], dim_i[band]);
      const double missed = looked.difference[k * looked.nodes.size() + n];
      if (refers_to > 0)
        most = std::max(most, margin * missed / refers_to);
    }
  return most;
}

} // namespace

CurvedErrors CurvedErrors::measure(const Scene &scene, const Engine &unhidden, unsigned threads,
                                   const std::atomic<bool> *cancel) {
  CurvedErrors out;
  if (scene.normals != NormalMode::Smooth)
    return out;
  const std::vector<Pose> poses = poses_to_look_at();
  const Looked looked = look_at(scene, unhidden, poses, threads, cancel);
  const std::size_t bands = looked.fast.bands;
  for (std::size_t first = 0; first < poses.size(); first += poses_per_node) {
    const double phase_deg = phases_deg[first / poses_per_node];
    Node node{phase_deg * pi / 180, 0, 0, std::vector<double>(bands, 0)};
    node.of_own = most_missed(looked, first, node.dim_i);
    for (std::size_t k = first; k < first + poses_per_node; ++k)
      for (std::size_t b = 0; b < bands; ++b)
        node.dim_i[b] += dim_part / poses_per_node * looked.fast.i[k * bands + b];
    node.of_lit = most_missed(looked, first, node.dim_i);
    out.nodes_.push_back(std::move(node));
  }
  out.nodes_.push_back({pi, 1, 1, out.nodes_.back().dim_i}); // nothing is known in line
  return out;
}

double CurvedErrors::typical() const { return nodes_.empty() ? least : nodes_.front().of_lit; }

double CurvedErrors::Node::at(std::size_t band, double i) const {
  const double lit = of_lit * std::max(i, dim_i[band]);
  return i > 0 ? std::min(lit, of_own * i) : lit;
}

double CurvedErrors::at(double phase_rad, std::size_t band, double i) const {
  if (nodes_.empty())
    return least * i;
  const auto above = std::find_if(nodes_.begin(), nodes_.end(),
                                  [&](const Node &node) { return node.phase_rad > phase_rad; });
  if (above == nodes_.begin())
    return above->at(band, i);
  const Node &below = *(above - 1);
  if (above == nodes_.end())
    return below.at(band, i);
  const double part = (phase_rad - below.phase_rad) / (above->phase_rad - below.phase_rad);
  return (1 - part) * below.at(band, i) + part * above->at(band, i);
}

void CurvedErrors::add_to(StokesTable &table, std::span<const Pose> poses) const {
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double phase_rad = phase_of(poses[k]);
    for (std::size_t b = 0; b < table.bands; ++b) {
      const std::size_t at_band = k * table.bands + b;
      const double more = at(phase_rad, b, table.i[at_band]);
      for (std::vector<double> *error : {&table.i_err, &table.q_err, &table.u_err})
        (*error)[at_band] += more;
    }
  }
}

} // namespace umov
