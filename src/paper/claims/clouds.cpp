// Lines and planes in Q-RGB space.

#include "paper/claims/claims.h"
#include "paper/q_cloud.h"
#include "paper/row_table.h"
#include "paper/statistics.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/random.h>
#include <umov/io/index_file.h>

namespace umov {
namespace {

/// Greatest distance of the locus of two materials from its chord, over the chord's length.
double departure(const Surface &one, const Surface &other, double phase_deg) {
  const double c = std::cos(phase_deg * degree);
  const auto mixed = [&](double w) {
    QPoint out{};
    for (std::size_t b = 0; b < 3; ++b) {
      const FresnelFactors f = one.fresnel(b, c), g = other.fresnel(b, c);
      out[b] = (w * f.b + (1 - w) * g.b) / (w * f.a + (1 - w) * g.a);
    }
    return out;
  };
  const QPoint from = mixed(0), to = mixed(1);
  double length = 0;
  for (std::size_t b = 0; b < 3; ++b)
    length += (to[b] - from[b]) * (to[b] - from[b]);
  length = std::sqrt(length);
  double out = 0;
  for (int i = 1; i < 4000; ++i) {
    // Logarithmic in the ratio of weights: materials differ in brightness by up to 400.
    const double w = 1 / (1 + std::exp(-12 + 24. * i / 4000));
    const QPoint p = mixed(w);
    double along = 0, square = 0;
    for (std::size_t b = 0; b < 3; ++b) {
      along += (p[b] - from[b]) * (to[b] - from[b]) / length;
      square += (p[b] - from[b]) * (p[b] - from[b]);
    }
    out = std::max(out, std::sqrt(std::max(0., square - along * along)));
  }
  return out / length;
}

/// Stokes I and Q of all bands of each lit pose, over its own sum of I.
std::vector<std::vector<double>> flat_coordinates(const StokesTable &light) {
  std::vector<std::vector<double>> out;
  for (std::size_t i = 0; i < light.is_dark.size(); ++i) {
    std::vector<double> row;
    double sum = 0;
    for (std::size_t b = 0; b < light.bands; ++b) {
      row.push_back(light.at(i, b).stokes.i);
      row.push_back(light.at(i, b).stokes.q);
      sum += light.at(i, b).stokes.i;
    }
    if (!(sum > 0))
      continue;
    for (double &v : row)
      v /= sum;
    out.push_back(std::move(row));
  }
  return out;
}

/// Random mixtures of measured indices at other wavelengths.
Result<std::vector<QPoint>> measured_mixtures(const std::array<double, 3> &wavelengths,
                                              double phase_deg) {
  const char *const names[] = {"Au_Johnson",  "Al_Rakic",   "Cu_Johnson",
                               "NBK7_Schott", "aSi_Pierce", "TiO2_Siefke"};
  std::vector<std::array<MuellerEntries, 3>> factors;
  for (const char *name : names) {
    UMOV_ASSIGN(table, find_index(name));
    std::array<MuellerEntries, 3> f{};
    for (std::size_t b = 0; b < 3; ++b) {
      UMOV_ASSIGN(eta, index_at(table, Wavelength::nm(wavelengths[b])));
      f[b] = Interface(eta).reflection(std::cos(phase_deg / 2 * degree));
    }
    factors.push_back(f);
  }
  std::vector<QPoint> points;
  for (std::size_t i = 0; i < 4000; ++i) {
    const auto u = uniform4(1, 24, 2 * i), v = uniform4(1, 24, 2 * i + 1);
    const double shares[] = {u[0], u[1], u[2], u[3], v[0], v[1]};
    QPoint q{};
    for (std::size_t b = 0; b < 3; ++b) {
      double s0 = 0, s1 = 0;
      for (std::size_t k = 0; k < factors.size(); ++k) {
        s0 -= std::log(shares[k]) * factors[k][b].a;
        s1 -= std::log(shares[k]) * factors[k][b].b;
      }
      q[b] = s1 / s0;
    }
    points.push_back(q);
  }
  return points;
}

} // namespace

Result<PaperFigure> make_claim_locus(PaperWorkshop &workshop) {
  PaperFigure out;
  out.id = "claim_locus";
  out.title = "Do two materials make a straight line?";
  out.claim = "Q of a composite is a sum c1 Q1 + c2 Q2 + ... with coefficients that depend on pose "
              "alone (equation 22); two materials then lie on a straight line.";
  struct Pair {
    const char *a, *b, *title;
    std::map<double, std::pair<double, double>> known; ///< phase -> value, tolerance
  };
  // tests/data/anchors/departures.csv, three or four digits: half a unit of the last one.
  const Pair pairs[] = {
      {"paper_au",
       "paper_al",
       "gold - aluminium",
       {{60, {.0216, 6e-5}}, {100, {.0202, 6e-5}}, {140, {.0244, 6e-5}}, {160, {.0489, 6e-5}}}},
      {"paper_au", "paper_bk7", "gold - BK7", {{60, {.0819, 6e-5}}, {140, {.0322, 6e-5}}}},
      {"paper_au", "paper_asi", "gold - silicon", {{60, {.0456, 6e-5}}, {140, {.0381, 6e-5}}}},
      {"paper_al", "paper_mylar", "aluminium - Mylar", {{60, {.315, 6e-4}}, {140, {.109, 6e-4}}}},
      {"paper_bk7", "paper_mylar", "BK7 - Mylar", {{60, {.0899, 6e-5}}, {140, {.0433, 6e-5}}}},
      {"paper_al", "paper_bk7", "aluminium - BK7", {{60, {.0022, 6e-5}}, {140, {.0024, 6e-5}}}}};
  RowTable rows({{"pair", "", "two materials"},
                 {"phase_angle", "deg", "Sun-object-observer"},
                 {"departure", "", "largest distance from the chord over its length, in Q-RGB"}});
  PlotFigure plot{
      "Bow of the locus of two materials", "phase angle [deg]", "departure / chord [%]", {}};
  double largest = 0;
  for (const Pair &pair : pairs) {
    const Surface a = compiled(paper_material(pair.a, false)),
                  b = compiled(paper_material(pair.b, false));
    const char *const dashes[] = {"solid", "dash", "dot", "dashdot"};
    PlotLine line{pair.title, {}, {}, plot.lines.size(), dashes[plot.lines.size() % 4]};
    for (double phase = 20; phase <= 160; phase += 10) {
      const double value = departure(a, b, phase);
      largest = std::max(largest, value);
      rows.row({pair.title, phase, value});
      line.x.push_back(phase);
      line.y.push_back(100 * value);
    }
    for (const auto &[phase, known] : pair.known)
      out.checks.push_back({fmt::format("bow of {} at {:g} deg", pair.title, phase),
                            departure(a, b, phase), known.first, known.second,
                            "tests/data/anchors/departures, last digit"});
    plot.lines.push_back(std::move(line));
  }
  const auto mli = relative_singular_values(
      flat_coordinates(workshop.light("mli_crumpled", random_poses(21, 1000, 140), out)));
  const Scene four = paper_scene(paper_object("box_wing"), [](Material m) {
    m.body.reset();
    if (m.name == "paper_spectralon") // has no interface: another material stands in
      m = paper_material("paper_mylar");
    return m;
  });
  const auto model = workshop.model(four, {.method = LightMethod::Masks});
  const auto box_wing = relative_singular_values(
      flat_coordinates(workshop.light(*model, random_poses(21, 1000, 140), out)));
  out.plots = {std::move(plot)};
  out.data = {{"claim_locus", rows.table()}};
  out.checks.push_back({"third singular value of (I, S1) of two materials, over the first", mli[2],
                        0, 1e-5, "rank 2 exactly; 32-bit sums"});
  out.checks.push_back({"fifth singular value of (I, S1) of four materials, over the first",
                        box_wing[4], 0, 1e-5, "rank 4 exactly; 32-bit sums"});
  out.verdict = Verdict::Differs;
  out.summary = fmt::format("a bowed line, by up to {:.0f} % of its length", 100 * largest);
  out.found = {
      "The coefficients of equation 22 are shares of intensity, and a material's share of "
      "intensity "
      "differs between bands. The locus is a rational curve, straight only where two materials "
      "have "
      "the same colour.",
      fmt::format(
          "Exactly flat are the Stokes parameters themselves: the vectors (I, S1 in each "
          "band), divided by the sum of I, of k materials lie in a simplex of k - 1 "
          "dimensions. Crumpled insulation of two materials: third singular value {:.0e} of "
          "the first. Box-wing of four: {:.1e}, {:.1e}, {:.1e}, then {:.0e}. Unmixing should "
          "use these, not Q-RGB.",
          mli[2], box_wing[1], box_wing[2], box_wing[3], box_wing[4])};
  return out;
}

Result<PaperFigure> make_claim_plane(PaperWorkshop &) {
  PaperFigure out;
  out.id = "claim_plane";
  out.title = "Why planes, and how do they turn with phase?";
  out.claim =
      "For a given composite object all poses lie on a two-dimensional surface, a plane, since "
      "only two of three rotations count; planes change very slowly with phase angle.";
  RowTable rows({{"phase_angle", "deg", "Sun-object-observer; 0: all together"},
                 {"thickness", "", "off-plane rms over largest rms"},
                 {"offset", "", "distance of the plane from the origin"},
                 {"normal_blue", "", "unit normal"},
                 {"normal_green", "", "unit normal"},
                 {"normal_red", "", "unit normal"},
                 {"turn", "deg", "from the plane at 40 deg"}});
  std::vector<QPoint> all;
  PlaneFit first, last;
  double thinnest = 1, thickest = 0, offset = 0;
  for (double phase = 40; phase <= 140; phase += 20) {
    const auto points = random_mixtures(phase, 4000);
    const PlaneFit plane = fit_plane(points);
    if (phase == 40)
      first = plane;
    last = plane;
    thinnest = std::min(thinnest, plane.thickness());
    thickest = std::max(thickest, plane.thickness());
    offset = std::max(offset, std::abs(plane.offset));
    rows.row({phase, plane.thickness(), plane.offset, plane.normal[0], plane.normal[1],
              plane.normal[2], angle_between_deg(first, plane)});
    all.insert(all.end(), points.begin(), points.end());
  }
  const PlaneFit together = fit_plane(all);
  rows.row({0., together.thickness(), together.offset, together.normal[0], together.normal[1],
            together.normal[2], angle_between_deg(first, together)});
  UMOV_ASSIGN(measured_points, measured_mixtures({425, 550, 650}, 100));
  UMOV_ASSIGN(wide_points, measured_mixtures({380, 550, 800}, 100));
  const PlaneFit measured = fit_plane(measured_points), wide = fit_plane(wide_points);
  const QCloud table1{random_mixtures(100, 4000), {}, {}}, real{measured_points, {}, {}};
  out.plots = {{"Random mixtures at 100 deg, each cloud edge on",
                "along its plane",
                "off its plane",
                {edge_line("measured indices", 1, real, measured),
                 edge_line("Table 1", 0, table1, fit_plane(table1.q))}}};
  out.data = {{"claim_plane", rows.table()}};
  const double turn = angle_between_deg(first, last);
  out.verdict = Verdict::Partly;
  out.summary = fmt::format(
      "planes, yes ({:.1f}-{:.1f} % thick), but from dispersion, not from counting angles",
      100 * thinnest, 100 * thickest);
  out.found = {
      fmt::format(
          "No object, no pose: random mixtures of the six materials lie on planes through the "
          "origin (within {:.4f}), normal {} at 40 deg and {} at 140 deg, a turn of {:.1f} deg, "
          "with a thickness of {:.1f} to {:.1f} % of their size; all phase angles together "
          "{:.1f} %.",
          offset, normal_text(first), normal_text(last), turn, 100 * thinnest, 100 * thickest,
          100 * together.thickness()),
      "The reason: the green Q of every material of Table 1 is nearly one and the same linear "
      "combination of its blue and red Q. The paper's argument of two angles cannot be it: a "
      "surface "
      "of two parameters need not be flat.",
      fmt::format(
          "It is a property of Table 1. Six measured indices (gold, aluminium, copper, BK7, "
          "amorphous silicon, titania) at 100 deg make clouds {:.0f} % thick in the paper's "
          "bands and {:.0f} % at 380, 550 and 800 nm: no planes.",
          100 * measured.thickness(), 100 * wide.thickness()),
      "So flatness is weak evidence for the number of angles that matter, and no evidence for "
      "shape."};
  const char *const source = "tests/data/anchors/planes: other random mixtures";
  const double at40[] = {-.137, .772, -.621}, at140[] = {-.130, .767, -.628};
  const char *const names[] = {"blue", "green", "red"};
  for (std::size_t k = 0; k < 3; ++k) {
    out.checks.push_back({fmt::format("{} part of the normal at 40 deg", names[k]), first.normal[k],
                          at40[k], .01, source});
    out.checks.push_back({fmt::format("{} part of the normal at 140 deg", names[k]), last.normal[k],
                          at140[k], .01, source});
  }
  out.checks.push_back(
      {"thickness, all phase angles together", together.thickness(), .0076, .003, source});
  return out;
}

Result<PaperFigure> make_claim_faint(PaperWorkshop &workshop) {
  PaperFigure out;
  out.id = "claim_faint";
  out.title = "Are points off the plane the faint ones?";
  out.claim =
      "Some points of HST lie off the plane; they come from poses with very low signal and can "
      "be ignored.";
  RowTable rows(
      {{"object", "", "name"},
       {"phase_angle", "deg", "Sun-object-observer"},
       {"off_plane_share_faint", "", "of the 5 % farthest off the plane: share below the median I"},
       {"rank_correlation", "", "of distance off the plane and I (Spearman)"}});
  StoryTable shown{
      "Of the 5 % of poses farthest off the plane, how many are fainter than the median",
      {"object", "phase angle", "share", "rank correlation of distance and I"},
      {}};
  PlotFigure plot{
      "HST at 100 deg: distance off the plane", "I [m2/sr], log10", "off the plane", {}};
  double lowest = 1, highest = 0;
  for (const std::size_t k : {0u, 1u})
    for (const double phase : {60., 100., 140.}) {
      const char *const title = k == 0 ? "HST" : "Agena";
      const QCloud cloud =
          q_cloud(workshop.light(k == 0 ? "hst" : "agena", random_poses(23 + k, 1000, phase), out));
      const PlaneFit plane = fit_plane(cloud.q);
      std::vector<double> distance;
      for (const QPoint &q : cloud.q)
        distance.push_back(std::abs(plane.distance(q)));
      const double limit = quantile(distance, 0.95), middle = quantile(cloud.intensity, 0.5);
      double faint = 0, far = 0;
      for (std::size_t i = 0; i < distance.size(); ++i)
        if (distance[i] >= limit) {
          ++far;
          faint += cloud.intensity[i] < middle ? 1 : 0;
        }
      const double correlation = rank_correlation(distance, cloud.intensity);
      rows.row({title, phase, faint / far, correlation});
      shown.rows.push_back({title, fmt::format("{:g} deg", phase),
                            fmt::format("{:.0f} %", 100 * faint / far),
                            fmt::format("{:+.2f}", correlation)});
      if (k == 0) {
        lowest = std::min(lowest, faint / far);
        highest = std::max(highest, faint / far);
      }
      if (k == 0 && phase == 100) {
        PlotLine line{"1000 poses", {}, {}, 0, "solid"};
        line.has_markers = true;
        for (std::size_t i = 0; i < distance.size(); ++i) {
          line.x.push_back(std::log10(cloud.intensity[i]));
          line.y.push_back(plane.distance(cloud.q[i]));
        }
        plot.lines = {line};
      }
    }
  out.plots = {std::move(plot)};
  out.tables = {shown};
  out.data = {{"claim_faint", rows.table()}};
  out.verdict = lowest > 0.75   ? Verdict::Agrees
                : highest < 0.6 ? Verdict::Differs
                                : Verdict::Partly;
  out.summary =
      fmt::format("of HST's, {:.0f} to {:.0f} % are fainter than the median (50 % by chance)",
                  100 * lowest, 100 * highest);
  out.found = {
      "Without any noise: distance off the best plane against intensity. Chance alone would "
      "make half of the farthest points fainter than the median. Points far off the plane "
      "are mixtures that the plane does not describe. For HST they are mostly bright ones, "
      "glints of one part; for Agena brightness hardly matters."};
  return out;
}

} // namespace umov
