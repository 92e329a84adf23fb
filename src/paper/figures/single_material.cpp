// Figures 18 and 20: one material, and two.

#include "paper/figures/figures.h"
#include "paper/row_table.h"

#include <cmath>
#include <fmt/format.h>

namespace umov {
namespace {

constexpr double phase_deg = 140;
/// At 140 deg: tests/data/anchors/q_140.csv.
struct PurePoint {
  const char *material;
  double q[3];
};
constexpr PurePoint pure_points[] = {{"paper_au", {.588949, .117662, .048246}},
                                     {"paper_al", {.082308, .098945, .115130}}};

PlotLine cloud(std::string name, std::size_t colour) {
  PlotLine out{std::move(name), {}, {}, colour, "solid"};
  out.has_markers = true;
  return out;
}

void add_point(PlotLine &line, double x, double y, double z) {
  line.x.push_back(x);
  line.y.push_back(y);
  line.z.push_back(z);
}

std::vector<RowTable::Head> pose_heads() {
  return {{"object", "", "shape"},
          {"material", "", "name in umov"},
          {"pose", "", "number in the random stream"},
          {"band", "", "spelled as in a scenario"},
          {"phase_angle", "deg", "Sun-object-observer"},
          {"intensity", "m2 / sr", "reflected intensity per unit solar irradiance"},
          {"q_scat", "", "Q/I; NaN where nothing is lit and seen"}};
}

} // namespace

Result<PaperFigure> make_fig18(PaperWorkshop &workshop) {
  PaperFigure out;
  out.id = "fig18";
  out.title = "Figure 18: one material, any shape and pose";
  out.claim = "Q of a chamfered cube and a cigar of gold and of aluminium at a phase angle of 140 "
              "deg, in random poses: independent of shape and pose. The cube's points are noisy, "
              "from its few facets.";
  RowTable rows(pose_heads());
  constexpr std::size_t count = 1000;
  const auto poses = random_poses(18, count, phase_deg);
  double worst = 0;
  double faintest = 1e300, brightest = 0;
  for (const char *object : {"cube", "cigar"}) {
    for (const PurePoint &pure : pure_points) {
      const Scene scene = paper_scene(
          paper_object(object), [&](const Material &) { return paper_material(pure.material); });
      const auto model = workshop.model(scene, {.method = LightMethod::Masks});
      const StokesTable light = workshop.light(*model, poses, out);
      PlotFigure plot{fmt::format("{} of {}", object,
                                  pure.material == std::string("paper_au") ? "gold" : "aluminium"),
                      "pose",
                      "Q/I [%]",
                      {}};
      for (std::size_t b = 0; b < 3; ++b) {
        PlotLine line = cloud(paper_bands()[b].name, band_colours[b]);
        for (std::size_t i = 0; i < count; ++i) {
          const auto s = light.at(i, b).stokes;
          const double q = ratio(s.q, s.i);
          rows.row({object, pure.material, static_cast<double>(i), paper_bands()[b].name, phase_deg,
                    s.i, q});
          if (!std::isfinite(q))
            continue;
          worst = std::max(worst, std::abs(q - pure.q[b]));
          faintest = std::min(faintest, s.i);
          brightest = std::max(brightest, s.i);
          line.x.push_back(static_cast<double>(i));
          line.y.push_back(100 * q);
        }
        plot.lines.push_back(std::move(line));
      }
      out.plots.push_back(std::move(plot));
    }
  }
  out.data = {{"fig18", rows.table()}};
  out.verdict = Verdict::Agrees;
  out.summary = fmt::format("every lit pose has the material's Q, to {:.0e}", worst);
  out.found = {
      fmt::format(
          "1000 poses of each: Q/I is the material's own value in every pose that sends "
          "light, cube or cigar, with a largest difference of {:.1e} (32-bit floating point).",
          worst),
      fmt::format("The paper's noise on the cube is not in the physics. Flat faces send nearly all "
                  "light into glints: intensities here span from {:.0e} to {:.0e} m2/sr, and the "
                  "ratio of two sums stays right only if both keep their relative accuracy down "
                  "there. Few facets make a light curve jumpy in I, not in Q.",
                  faintest, brightest)};
  out.checks = {{"largest difference from the pure materials' Q at 140 deg", worst, 0, 2e-5,
                 "six printed digits, and 32-bit sums"}};
  return out;
}

Result<PaperFigure> make_fig20(PaperWorkshop &workshop) {
  PaperFigure out;
  out.id = "fig20";
  out.title = "Figure 20: tumbling insulation in I-RGB and Q-RGB";
  out.claim = "A sheet of gold on one side and aluminium on the other jumps between two points in "
              "Q-RGB space, while the intensities are complicated.";
  RowTable rows(pose_heads());
  PlotFigure intensity{"I-RGB, log10 [m2/sr]", "blue", "green", {}},
      q_space{"Q-RGB", "Q blue", "Q green", {}},
      chord{"Q-RGB, blue against green", "Q blue", "Q green", {}};
  intensity.z_title = "red";
  q_space.z_title = "Q red";
  double worst_flat = 0, worst_curve = 0, departure = 0;
  const auto poses = random_poses(20, 1000, phase_deg);
  const Surface gold = compiled(paper_material("paper_au")),
                al = compiled(paper_material("paper_al"));
  // Every mixture of the two lies on one curve: weights w and 1 - w of their Stokes vectors.
  const auto mixture = [&](double w, std::size_t b) {
    const FresnelFactors f = gold.fresnel(b, std::cos(phase_deg * degree)),
                         g = al.fresnel(b, std::cos(phase_deg * degree));
    return (w * f.b + (1 - w) * g.b) / (w * f.a + (1 - w) * g.a);
  };
  for (const char *object : {"mli", "mli_crumpled"}) {
    const bool is_flat = object == std::string("mli");
    const StokesTable light = workshop.light(object, poses, out);
    PlotLine in = cloud(is_flat ? "flat" : "crumpled", is_flat ? 0 : 1), q = in, flat_q = in;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      double values[3], intensities[3];
      for (std::size_t b = 0; b < 3; ++b) {
        const auto s = light.at(i, b).stokes;
        values[b] = ratio(s.q, s.i);
        intensities[b] = s.i;
        rows.row({object, "paper_au, paper_al", static_cast<double>(i), paper_bands()[b].name,
                  phase_deg, s.i, values[b]});
      }
      if (!std::isfinite(values[0]))
        continue;
      if (intensities[1] > 1e-6)
        add_point(in, std::log10(intensities[0]), std::log10(intensities[1]),
                  std::log10(intensities[2]));
      add_point(q, values[0], values[1], values[2]);
      flat_q.x.push_back(values[0]);
      flat_q.y.push_back(values[1]);
      double nearest_pure = 1;
      for (const PurePoint &pure : pure_points)
        nearest_pure =
            std::min(nearest_pure, std::hypot(values[0] - pure.q[0], values[1] - pure.q[1],
                                              values[2] - pure.q[2]));
      if (is_flat)
        worst_flat = std::max(worst_flat, nearest_pure);
      // The mixture with the same blue Q, by bisection; green and red must follow.
      double low = 0, high = 1;
      for (int step = 0; step < 60; ++step)
        (mixture((low + high) / 2, 0) < values[0] ? low : high) = (low + high) / 2;
      worst_curve = std::max({worst_curve, std::abs(mixture(low, 1) - values[1]),
                              std::abs(mixture(low, 2) - values[2])});
    }
    intensity.lines.push_back(std::move(in));
    q_space.lines.push_back(std::move(q));
    chord.lines.push_back(std::move(flat_q));
  }
  PlotLine curve{"all mixtures of gold and aluminium", {}, {}, 3, "dash"},
      straight{"straight line", {}, {}, 6, "dot"};
  double length = 0;
  for (std::size_t b = 0; b < 3; ++b)
    length += std::pow(mixture(1, b) - mixture(0, b), 2);
  length = std::sqrt(length);
  for (double w = 0; w <= 1.0001; w += 0.005) {
    curve.x.push_back(mixture(w, 0));
    curve.y.push_back(mixture(w, 1));
    double along = 0, square = 0;
    for (std::size_t b = 0; b < 3; ++b) {
      const double d = mixture(w, b) - mixture(0, b), c = (mixture(1, b) - mixture(0, b)) / length;
      along += d * c;
      square += d * d;
    }
    departure = std::max(departure, std::sqrt(std::max(0., square - along * along)));
  }
  for (const double w : {0., 1.}) {
    straight.x.push_back(mixture(w, 0));
    straight.y.push_back(mixture(w, 1));
  }
  chord.lines.push_back(curve);
  chord.lines.push_back(straight);
  out.plots = {intensity, q_space, chord};
  out.data = {{"fig20", rows.table()}};
  out.verdict = Verdict::Agrees;
  out.summary =
      fmt::format("flat: two points, to {:.0e}; crumpled: a curve between them", worst_flat);
  out.found = {
      fmt::format(
          "The flat sheet shows one side at a time: its points are gold's and aluminium's, "
          "to {:.1e}. Crumpled insulation, which is what flies, shows both and fills a curve "
          "between the two points; a mixture formed from the two materials' Stokes vectors "
          "meets every pose within {:.1e}.",
          worst_flat, worst_curve),
      fmt::format("The curve is bowed: {:.4f} off the straight line, {:.2f} % of its length, since "
                  "the weights of equation 22 are weights of intensity and differ between bands.",
                  departure, 100 * departure / length)};
  out.checks = {
      {"flat sheet: distance from the nearer pure point", worst_flat, 0, 3e-5,
       "six printed digits, and 32-bit sums"},
      {"length of the chord", length, .51138, 1e-5, "tests/data/anchors/singles, five digits"},
      {"largest departure from the chord", departure, .01250, 2e-5,
       "tests/data/anchors/singles, five digits"},
      {"crumpled sheet: distance from the curve of mixtures", worst_curve, 0, 1e-4,
       "mixtures of two Stokes vectors; 32-bit sums"}};
  return out;
}

} // namespace umov
