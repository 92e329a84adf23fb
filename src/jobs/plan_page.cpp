#include "jobs/fit_figures.h"
#include "jobs/plan_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <umov/core/text.h>
#include <umov/io/plot_page.h>

namespace umov::jobs {
namespace {

/// A number of each pass, with q and u and without, against the time of its first row.
PlotFigure by_pass(const Plan &plan, const std::string &title, const std::string &y_title,
                   double Discrimination::*number) {
  const Epoch<Utc> start = plan.kept.geometry.front().time;
  PlotFigure out{title, "days since " + to_iso(start), y_title, {}};
  for (const bool has_polarization : {true, false}) {
    PlotLine line{has_polarization ? "I, q, u" : "I alone", {}, {}, has_polarization ? 0u : 1u};
    line.has_markers = true;
    for (const PlannedPass &pass : plan.passes) {
      line.x.push_back(seconds_between(plan.kept.geometry[pass.epochs.front()].time, start) /
                       86400);
      line.y.push_back(pass.choices[has_polarization ? 0 : 1].told.*number);
    }
    out.lines.push_back(std::move(line));
  }
  return out;
}

/// What each pass would tell, and how sure of the two that are most alike.
std::vector<PlotFigure> pass_figures(const Plan &plan) {
  std::vector<PlotFigure> out{
      by_pass(plan, "What each pass tells",
              fmt::format("information [bit], of {:.3g} at most",
                          std::log2(static_cast<double>(plan.names.size()))),
              &Discrimination::information_bits),
      by_pass(plan, "The two that are most alike", "expected ln Bayes factor",
              &Discrimination::hardest_log_bayes)};
  out[1].has_log_y = true;
  constexpr double least = 1e-3; // less is nothing
  for (PlotLine &line : out[1].lines)
    for (double &y : line.y)
      y = std::max(y, least);
  return out;
}

/// From the brightest to 12.5 magnitudes below it, or the faintest: light that fades out as the lit
/// side turns away goes on for thirty decades, and nobody sees it.
std::array<double, 2> span_of_light(const Plan &plan, const PlannedPass &pass, std::size_t band) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const Alternative &a : plan.alternatives)
    for (const std::size_t e : pass.epochs)
      if (const double i = a.light.i[e * plan.bands.size() + band]; i > 0) {
        least = std::min(least, i);
        most = std::max(most, i);
      }
  if (!(most > 0))
    return {};
  return {std::max(least, 1e-5 * most) / 1.5, most * 1.5};
}

/// The best pass under each alternative, in the band that stands for it: I and q.
void add_light(std::vector<PlotFigure> &figures, const Plan &plan, std::size_t band) {
  const PlannedPass &pass = plan.passes.front();
  const Epoch<Utc> start = plan.kept.geometry[pass.epochs.front()].time;
  const std::string time = "seconds since " + to_iso(start);
  PlotFigure light{"Best pass: brightness in " + plan.bands[band], time, "I [m2/sr]", {}};
  PlotFigure polarization{
      "Best pass: polarization in " + plan.bands[band], time, "q (scattering plane)", {}};
  light.has_log_y = true;
  light.y_span = span_of_light(plan, pass, band);
  for (std::size_t n = 0; n < plan.alternatives.size(); ++n) {
    const Alternative &a = plan.alternatives[n];
    for (PlotFigure *figure : {&light, &polarization}) {
      PlotLine line{a.light.name, {}, {}, n, plot_dash(n)};
      PlotLine bars{{}, {}, {}, n};
      bars.is_faint = true;
      for (const std::size_t e : pass.epochs) {
        const std::size_t k = e * plan.bands.size() + band;
        const double x = seconds_between(plan.kept.geometry[e].time, start), i = a.light.i[k];
        const bool is_light = figure == &light;
        const double y = i > 0 ? is_light ? i : a.light.q[k] / i : std::nan("");
        const double sd = is_light ? a.errors.i_sd[k] : a.errors.q_sd[k];
        line.x.push_back(x);
        line.y.push_back(y);
        for (const double end : {y - sd, y + sd, std::nan("")}) {
          bars.x.push_back(x);
          bars.y.push_back(is_light && !(end > 0) ? std::nan("") : end);
        }
      }
      figure->lines.push_back(std::move(bars));
      figure->lines.push_back(std::move(line));
    }
  }
  figures.push_back(std::move(light));
  figures.push_back(std::move(polarization));
}

/// What each band by itself would tell in the best pass.
std::vector<std::string> band_lines(const Plan &plan) {
  std::vector<std::string> out;
  for (const PlanChoice &choice : plan.passes.front().choices)
    out.push_back(
        fmt::format("best pass, {}, {}: {:.3g} bit, decided with a chance of {} %, ln Bayes factor "
                    "of the hardest pair {:.3g}",
                    choice.bands == "all" ? "all bands" : choice.bands,
                    choice.has_polarization ? "I, q, u" : "I alone", choice.told.information_bits,
                    percent(choice.told.decided), choice.told.hardest_log_bayes));
  return out;
}

} // namespace

std::string plan_page(const std::string &title, const Plan &plan) {
  std::vector<PlotFigure> figures;
  if (plan.passes.size() > 1) // the lines below say it of one
    figures = pass_figures(plan);
  for (std::size_t b = 0; b < plan.bands.size(); ++b)
    add_light(figures, plan, b);
  std::vector<std::string> notes = page_lines(plan_summary(plan));
  for (std::string &line : band_lines(plan))
    notes.push_back(std::move(line));
  const auto page = make_answer_page(title, figures, notes);
  return page ? *page : std::string();
}

} // namespace umov::jobs
