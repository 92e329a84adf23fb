#include "jobs/invert_page.h"

#include "jobs/fit_figures.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/quantity.h>
#include <umov/core/rotation.h>
#include <umov/frames/sky.h>
#include <umov/inverse/attitude_grid.h>
#include <umov/io/plot_page.h>

namespace umov::jobs {
namespace {

constexpr std::size_t drawn_samples = 1000; ///< as many as a page draws without delay
using Numbers = std::vector<double>;

/// Samples of equal weight: at even steps of the sum of the weights.
std::vector<Quaternion> equal_samples(const PoseAnswer &answer) {
  std::vector<Quaternion> out;
  double sum = 0;
  for (const PoseSample &sample : answer.samples) {
    sum += sample.weight;
    while (static_cast<double>(out.size()) + 0.5 < sum * drawn_samples &&
           out.size() < drawn_samples)
      out.push_back(sample.turning.attitude);
  }
  return out;
}

/// Where the axes of the body point at the first epoch.
PlotFigure axes_figure(const std::vector<Quaternion> &samples) {
  PlotFigure out{"Where the body's axes point at the first epoch: samples of the posterior",
                 "right ascension [deg]",
                 "declination [deg]",
                 {}};
  out.x_span = {0, 360};
  out.y_span = {-90, 90};
  for (int axis = 0; axis < 3; ++axis) {
    PlotLine line{fmt::format("+{}", "XYZ"[axis]), {}, {}, static_cast<std::size_t>(axis)};
    line.has_markers = true;
    for (const Quaternion &q : samples) {
      const SkyDirection to = sky_direction(rotation_from<Body, Gcrs>(q).row(axis));
      line.x.push_back(to.right_ascension.degrees());
      line.y.push_back(to.declination.degrees());
    }
    out.lines.push_back(std::move(line));
  }
  return out;
}

/// Turn from one attitude to another [deg], as a vector in body axes.
std::array<double, 3> turn_deg(Quaternion from, Quaternion to) {
  const Quaternion d =
      quaternion_from(rotation_from<Body, Gcrs>(to) * rotation_from<Body, Gcrs>(from).inverse());
  const double sine = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
  const double scale = sine > 0 ? Angle::radians(2 * std::atan2(sine, d.w)).degrees() / sine : 0;
  return {scale * d.x, scale * d.y, scale * d.z};
}

/// The errors of the heaviest mode, two axes at a time.
void add_corner(std::vector<PlotFigure> &figures, const PoseAnswer &answer,
                const std::vector<Quaternion> &samples) {
  if (answer.modes.empty())
    return;
  const PoseMode &mode = answer.modes.front();
  // Those that are nearer to it than to any other mode.
  std::array<Numbers, 3> turn;
  for (const Quaternion &q : samples) {
    const double own = angle_between(q, mode.turning.attitude);
    if (std::ranges::any_of(answer.modes, [&](const PoseMode &other) {
          return angle_between(q, other.turning.attitude) < own;
        }))
      continue;
    const std::array<double, 3> v = turn_deg(mode.turning.attitude, q);
    for (std::size_t k = 0; k < 3; ++k)
      turn[k].push_back(v[k]);
  }
  for (const auto &[a, b] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
    PlotLine line{{}, turn[static_cast<std::size_t>(a)], turn[static_cast<std::size_t>(b)]};
    line.has_markers = true;
    figures.push_back(
        {fmt::format("Errors of the heaviest attitude: about +{} and +{}", "XYZ"[a], "XYZ"[b]),
         fmt::format("turn about +{} [deg]", "XYZ"[a]),
         fmt::format("turn about +{} [deg]", "XYZ"[b]),
         {line}});
  }
}

std::vector<std::string> lines_of(const std::string &summary, const PoseAnswer &answer) {
  std::vector<std::string> out = page_lines(summary);
  for (std::size_t k = 0; k < std::min<std::size_t>(answer.modes.size(), 10); ++k) {
    const Quaternion q = answer.modes[k].turning.attitude;
    const double sign = q.w < 0 ? -1 : 1;
    out.push_back(fmt::format("mode {}: weight {:.3f}, q = ({:.5f}, {:.5f}, {:.5f}, {:.5f})", k + 1,
                              answer.modes[k].weight, sign * q.w, sign * q.x, sign * q.y,
                              sign * q.z));
  }
  return out;
}

} // namespace

std::string inversion_page(const std::string &title, const Table &fit, const PoseAnswer &answer,
                           Verdict verdict, const Contributions &contributions,
                           const std::string &summary) {
  std::vector<PlotFigure> figures;
  add_data_figures(figures, fit);
  // Of an object that is not in the data no attitude is probable.
  if (verdict == Verdict::NoFit) {
    const auto page = make_answer_page(title, figures, page_lines(summary));
    return page ? *page : std::string();
  }
  if (const std::vector<Quaternion> samples = equal_samples(answer); !samples.empty()) {
    figures.push_back(axes_figure(samples));
    add_corner(figures, answer, samples);
  }
  if (!contributions.all.empty())
    figures.push_back(contributions_figure(contributions));
  const auto page = make_answer_page(title, figures, lines_of(summary, answer));
  return page ? *page : std::string();
}

} // namespace umov::jobs
