// The figures as files and as one page.

#include <umov/paper/paper.h>

#include "paper/row_table.h"

#include <algorithm>
#include <fmt/format.h>

namespace umov {
namespace {

const char *word_of(Verdict verdict) {
  switch (verdict) {
  case Verdict::Agrees:
    return "agrees";
  case Verdict::Partly:
    return "partly";
  case Verdict::Differs:
    return "differs";
  case Verdict::Shown:
    break;
  }
  return "shown";
}

/// A check as a line of text cells.
std::vector<std::string> check_line(const PaperCheck &check) {
  return {check.what,
          fmt::format("{:.6g}", check.found),
          fmt::format("{:.6g}", check.expected),
          fmt::format("{:.1g}", check.tolerance),
          check.holds() ? "holds" : "FAILS",
          check.source};
}

StorySection section_of(const PaperFigure &figure, std::vector<std::string> files) {
  StorySection out{
      figure.id,    figure.title, word_of(figure.verdict), figure.summary, figure.claim,
      figure.found, figure.plots, figure.pictures,         figure.tables,  std::move(files)};
  if (!figure.checks.empty()) {
    StoryTable checks{
        "Checks", {"number", "found", "expected", "tolerance", "", "expected from"}, {}};
    for (const PaperCheck &check : figure.checks)
      checks.rows.push_back(check_line(check));
    out.tables.push_back(std::move(checks));
  }
  return out;
}

/// Speed, against the paper's thousands per second.
StorySection speed_section(const std::vector<PaperFigure> &figures) {
  StorySection out;
  out.id = "claim_speed";
  out.title = "Is it real time?";
  out.claim =
      "Thousands of full three-dimensional realizations per second on a graphics card of 2008; "
      "signatures faster than real time.";
  StoryTable table{
      "Realizations (a pose or an epoch with all three bands, or a picture) after set-up",
      {"figure", "realizations", "seconds", "per second"},
      {}};
  PlotFigure plot{"Realizations per second", "row of the table", "per second", {}, true};
  PlotLine ours{"this run", {}, {}, 0, "solid"},
      paper{"the paper's \"thousands\" (1000)", {}, {}, 6, "dash"};
  ours.has_markers = true;
  double fastest = 0;
  for (const PaperFigure &figure : figures) {
    if (figure.realizations == 0 || figure.seconds < 1e-3)
      continue;
    const double rate = static_cast<double>(figure.realizations) / figure.seconds;
    fastest = std::max(fastest, rate);
    ours.x.push_back(static_cast<double>(table.rows.size() + 1));
    ours.y.push_back(rate);
    paper.x.push_back(ours.x.back());
    paper.y.push_back(1000);
    table.rows.push_back({figure.id, std::to_string(figure.realizations),
                          fmt::format("{:.3g}", figure.seconds), fmt::format("{:.3g}", rate)});
  }
  if (table.rows.empty()) {
    out.verdict = "shown";
    out.summary = "no figure of this run was timed";
    return out;
  }
  out.verdict = "agrees";
  out.summary = fmt::format("up to {:.3g} thousand realizations per second on this processor",
                            fastest / 1000);
  out.found = {
      "Times are of this run on this machine, whatever else it was doing. Figures 18, 20 and 23 "
      "and most claims use prepared masks; passes and the light between surfaces use rays; "
      "pictures cast one ray per sample of a pixel. `umov bench` has rates under stated "
      "conditions."};
  plot.lines = {ours, paper};
  out.plots = {std::move(plot)};
  out.tables = {std::move(table)};
  return out;
}

Table speed_table(const std::vector<PaperFigure> &figures) {
  RowTable rows({{"figure", "", "id"},
                 {"realizations", "", "poses, epochs or pictures"},
                 {"seconds", "s", "after set-up"}});
  for (const PaperFigure &figure : figures)
    rows.row({figure.id, static_cast<double>(figure.realizations), figure.seconds});
  return rows.table();
}

Table check_table(const std::vector<PaperFigure> &figures) {
  RowTable rows({{"figure", "", "id"},
                 {"number", "", "what was held against another value"},
                 {"found", "", "by umov"},
                 {"expected", "", "from elsewhere"},
                 {"tolerance", "", "absolute"},
                 {"holds", "", "yes or no"},
                 {"source", "", "of the expected value"}});
  for (const PaperFigure &figure : figures)
    for (const PaperCheck &check : figure.checks)
      rows.row({figure.id, check.what, check.found, check.expected, check.tolerance,
                check.holds() ? "yes" : "no", check.source});
  return rows.table();
}

Table verdict_table(const std::vector<PaperFigure> &figures) {
  RowTable rows({{"figure", "", "id"},
                 {"verdict", "", "agrees, partly, differs or shown"},
                 {"summary", "", "in one line"}});
  for (const PaperFigure &figure : figures)
    rows.row({figure.id, word_of(figure.verdict), figure.summary});
  return rows.table();
}

const std::vector<std::string> introduction{
    "\"Real Time Polarization Light Curves for Space Debris and Satellites\" models the "
    "polarization of "
    "sunlight reflected by satellites with microfacet surfaces, and reads materials from the "
    "Stokes "
    "parameter Q in three colours. Here is each of its figures, computed anew, and each of its "
    "claims, "
    "measured.",
    "The idea in four sentences. Sunlight is unpolarized; a single reflection favours the field "
    "perpendicular to the plane of Sun, object and observer, and Q/I says by how much. On a rough "
    "surface "
    "every microfacet that sends light to the observer is inclined so that the angle of incidence "
    "is half "
    "the phase angle, wherever it sits. So Q/I of one reflection depends on the material and the "
    "phase angle "
    "alone, not on roughness, shape or attitude. What spoils this beautiful fact, and by how much, "
    "is what "
    "the claims are about.",
    "A badge says how the paper fares: agrees, in part, differs; figures that only illustrate say "
    "shown. "
    "Every number on this page was computed in the run that wrote it; the ones with an independent "
    "value "
    "beside them are listed under Checks."};

const std::vector<std::string> conventions{
    "Q/I > 0: perpendicular to the scattering plane. The phase angle is Sun-object-observer, 0 = "
    "full. "
    "Intensity is in m2/sr per unit solar irradiance.",
    "Materials are those of the paper's Table 1 with a Blinn-Phong exponent of 200 (the paper "
    "names none), "
    "the Sun is a point, bands are the wavelengths 425, 550 and 650 nm.",
    "The paper's formulas are corrected where they are misprinted; docs/theory/paper.md has the "
    "list.",
    "Surfaces in colour pictures: red, green and blue are 650, 550 and 425 nm; one exposure per "
    "picture, "
    "compressed so that faint light shows; slate is what no sunlight reaches."};

} // namespace

Result<std::vector<std::pair<std::string, std::string>>>
paper_files(const std::vector<PaperFigure> &figures, const std::vector<std::string> &made_with) {
  std::vector<std::pair<std::string, std::string>> out;
  std::vector<StorySection> remade, claims;
  for (const PaperFigure &figure : figures) {
    std::vector<std::string> names;
    const auto put = [&](std::string name, std::string bytes) {
      names.push_back(name);
      out.emplace_back(std::move(name), std::move(bytes));
    };
    for (const auto &[stem, table] : figure.data)
      put(stem + ".ecsv", to_ecsv(table));
    for (std::size_t k = 0; k < figure.plots.size(); ++k)
      put(fmt::format("{}_{}.svg", figure.id, k + 1), plot_svg(figure.plots[k]));
    for (std::size_t k = 0; k < figure.pictures.size(); ++k)
      put(fmt::format("{}_picture_{}.png", figure.id, k + 1), figure.pictures[k].png);
    (figure.id.starts_with("claim") ? claims : remade)
        .push_back(section_of(figure, std::move(names)));
  }
  claims.push_back(speed_section(figures));
  out.emplace_back("speed.ecsv", to_ecsv(speed_table(figures)));
  out.emplace_back("checks.ecsv", to_ecsv(check_table(figures)));
  out.emplace_back("verdicts.ecsv", to_ecsv(verdict_table(figures)));
  Story story{"The paper remade: polarization light curves, figure by figure",
              introduction,
              {},
              conventions};
  if (!remade.empty())
    story.chapters.emplace_back("Figures", std::move(remade));
  story.chapters.emplace_back("Claims, as measurements", std::move(claims));
  story.notes.insert(story.notes.end(), made_with.begin(), made_with.end());
  UMOV_ASSIGN(page, make_story_page(story));
  out.emplace_back("index.html", std::move(page));
  return out;
}

} // namespace umov
