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
/// The largest of so few says little of one in twenty: half as much again is said.
constexpr std::size_t poses_per_node = 12;
constexpr double margin = 1.5;
/// Where poses are looked at. The first stands for all below, spread from 30 deg on: there it
/// hardly depends on the phase angle (engine.md). Between two the error is taken as straight, which
/// is more than it is: it grows as one over the width of the strip that is lit and seen.
constexpr double phases_deg[] = {80, 110, 130, 145, 155, 163, 169, 174, 177, 179};
constexpr double first_from_deg = 30;

std::vector<Pose> poses_about(std::size_t node) {
  constexpr std::uint64_t seed = 0;
  std::vector<Pose> out;
  for (std::size_t k = 0; k < poses_per_node; ++k) {
    const double from = node == 0 ? first_from_deg : phases_deg[node];
    const double part = (static_cast<double>(k) + 0.5) / static_cast<double>(poses_per_node);
    out.push_back(random_pose(seed, node * poses_per_node + k,
                              Angle::degrees(from + part * (phases_deg[node] - from))));
    out.back().sun_radius_rad = sun_radius_at_1au_rad;
  }
  return out;
}

/// The first node above a phase angle; as many as there are nodes: none.
std::size_t node_above(double phase_rad) {
  std::size_t out = 0;
  while (out < std::size(phases_deg) && phases_deg[out] * pi / 180 <= phase_rad)
    ++out;
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

Elements elements_of(const Scene &scene, const std::atomic<bool> *cancel) {
  return make_elements(scene, visible_sides(scene.mesh, cancel), cancel);
}

/// Light of poses by the engine and how far the reference's is from it, at a few wavelengths.
struct Looked {
  StokesTable fast;
  std::vector<std::size_t> nodes;
  std::vector<double> difference; ///< of I [pose * nodes + node]
};

} // namespace

/// The engine and the reference of one scene, for all phase angles that are asked for at once.
class CurvedErrors::Beside {
public:
  /// What it is given must live as long.
  Beside(const Scene &scene, const Engine &unhidden, const Elements &elements)
      : unhidden_(unhidden), elements_(elements),
        nodes_(few_nodes(scene.grid.nodes().size())), // what is missed hardly depends on them
        scene_(nodes_.size() < scene.grid.nodes().size() ? at_nodes(scene, nodes_) : scene) {}

  [[nodiscard]] Looked look(const std::vector<Pose> &poses, unsigned threads,
                            const std::atomic<bool> *cancel) const {
    Looked out{{}, nodes_, std::vector<double>(poses.size() * nodes_.size())};
    LightTask task;
    task.threads = threads;
    task.cancel = cancel;
    (void)unhidden_.evaluate(poses, out.fast, task);
    leave_if_stopped(cancel);
    parallel_for(poses.size(), threads, [&](std::size_t k) {
      const LitElements lit =
          light_elements(scene_, elements_, geometry_of(poses[k]), {1, 0, 0, 0}, cancel);
      for (std::size_t n = 0; n < nodes_.size(); ++n)
        out.difference[k * nodes_.size() + n] =
            std::abs(out.fast.i[k * out.fast.bands + nodes_[n]] - lit.total[n]);
    });
    return out;
  }

private:
  const Engine &unhidden_;
  const Elements &elements_;
  std::vector<std::size_t> nodes_;
  Scene scene_; ///< at those wavelengths
};

namespace {

/// What part of the light is missed at most, where light counts as `dim_i` [per band] at least.
double most_missed(const Looked &looked, const std::vector<double> &dim_i) {
  double most = least;
  for (std::size_t k = 0; k < poses_per_node; ++k)
    for (std::size_t n = 0; n < looked.nodes.size(); ++n) {
      const std::size_t band = looked.nodes[n];
      const double refers_to = std::max(looked.fast.i[k * looked.fast.bands + band], dim_i[band]);
      const double missed = looked.difference[k * looked.nodes.size() + n];
      if (refers_to > 0)
        most = std::max(most, margin * missed / refers_to);
    }
  return most;
}

bool has_curves(const Elements &elements) {
  return std::ranges::any_of(elements.list, [](const Element &e) { return !e.is_flat; });
}

} // namespace

CurvedErrors::CurvedErrors(const Scene &scene, const Engine &unhidden, unsigned threads,
                           const std::atomic<bool> *cancel)
    : scene_(scene) {
  static_assert(std::size(phases_deg) == node_count);
  if (scene.normals != NormalMode::Smooth)
    return;
  const Elements elements = elements_of(scene, cancel);
  is_flat_ = !has_curves(elements);
  if (!is_flat_)
    learn(0, Beside(scene, unhidden, elements), threads, cancel);
}

void CurvedErrors::learn(std::size_t node, const Beside &beside, unsigned threads,
                         const std::atomic<bool> *cancel) const {
  const Looked looked = beside.look(poses_about(node), threads, cancel);
  const std::size_t bands = looked.fast.bands;
  Node &out = nodes_[node];
  out.dim_i.assign(bands, 0);
  out.least_i.assign(bands, HUGE_VAL);
  out.of_own = most_missed(looked, out.dim_i);
  for (std::size_t at = 0; at < poses_per_node * bands; ++at) {
    out.dim_i[at % bands] += dim_part / poses_per_node * looked.fast.i[at];
    if (looked.fast.i[at] > 0)
      out.least_i[at % bands] = std::min(out.least_i[at % bands], looked.fast.i[at]);
  }
  out.of_lit = most_missed(looked, out.dim_i);
  is_known_[node] = true;
}

/// The engine is made anew for that: it would take as much memory as the one that is asked.
void CurvedErrors::learn_for(std::span<const Pose> poses, unsigned threads,
                             const std::atomic<bool> *cancel) const {
  std::array<bool, node_count + 1> is_asked{};
  for (const Pose &pose : poses) {
    const std::size_t above = node_above(phase_of(pose));
    is_asked[above] = true;
    is_asked[above > 0 ? above - 1 : 0] = true;
  }
  const auto lacks = [&](std::size_t node) { return is_asked[node] && !is_known_[node]; };
  std::size_t lacking = 0;
  for (std::size_t node = 0; node < node_count; ++node)
    lacking += lacks(node) ? 1 : 0;
  if (lacking == 0)
    return;
  const std::scoped_lock lock(mutex_);
  const Engine unhidden(scene_, {.visibility = Visibility::None, .threads = 1}, cancel);
  const Elements elements = elements_of(scene_, cancel);
  const Beside beside(scene_, unhidden, elements);
  for (std::size_t node = 0; node < node_count; ++node)
    if (lacks(node))
      learn(node, beside, threads, cancel);
}

double CurvedErrors::typical() const { return is_flat_ ? least : nodes_.front().of_lit; }

double CurvedErrors::Node::at(std::size_t band, double i) const {
  const double lit = of_lit * std::max(i, dim_i[band]);
  return i > 0 ? std::min(lit, of_own * std::max(i, least_i[band])) : lit;
}

double CurvedErrors::at(double phase_rad, std::size_t band, double i) const {
  const std::size_t above = node_above(phase_rad);
  if (above == 0)
    return nodes_[0].at(band, i);
  const Node &below = nodes_[above - 1];
  const double from = phases_deg[above - 1] * pi / 180,
               to = above < node_count ? phases_deg[above] * pi / 180 : pi,
               part = std::min((phase_rad - from) / (to - from), 1.0);
  // In line with the Sun all is unknown: as much as there is, or is at the last node in the mean.
  const double next =
      above < node_count ? nodes_[above].at(band, i) : std::max(i, below.dim_i[band] / dim_part);
  return (1 - part) * below.at(band, i) + part * next;
}

void CurvedErrors::add_to(StokesTable &table, std::span<const Pose> poses, unsigned threads,
                          const std::atomic<bool> *cancel) const {
  if (!is_flat_)
    learn_for(poses, threads, cancel);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double phase_rad = phase_of(poses[k]);
    for (std::size_t b = 0; b < table.bands; ++b) {
      const std::size_t at_band = k * table.bands + b;
      const double i = table.i[at_band], more = is_flat_ ? least * i : at(phase_rad, b, i);
      for (std::vector<double> *error : {&table.i_err, &table.q_err, &table.u_err})
        (*error)[at_band] += more;
    }
  }
}

} // namespace umov
