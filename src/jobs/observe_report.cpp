// The page of an observation: what was counted, what was there, and what makes the noise.

#include "jobs/observe_pages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <umov/core/median.h>
#include <umov/core/quantity.h>
#include <umov/core/text.h>
#include <umov/io/plot_page.h>
#include <umov/jobs/reduce.h>
#include <umov/time/epoch.h>
#include <utility>

namespace umov::jobs {
namespace {

PlotLine line(std::string name, std::size_t number, bool has_markers) {
  return {std::move(name), {}, {}, number, plot_dash(number), {}, has_markers, {}};
}

/// One line for each name, in the order in which they come.
class Lines {
public:
  explicit Lines(bool has_markers) : has_markers_(has_markers) {}
  PlotLine &of(const std::string &name) {
    const auto [at, is_new] = index_.try_emplace(name, lines_.size());
    if (is_new)
      lines_.push_back(line(name, lines_.size(), has_markers_));
    return lines_[at->second];
  }
  void add(const std::string &name, double x, double y) {
    PlotLine &one = of(name);
    one.x.push_back(x);
    one.y.push_back(y);
  }
  [[nodiscard]] std::vector<PlotLine> all() && { return std::move(lines_); }

private:
  bool has_markers_;
  std::map<std::string, std::size_t> index_;
  std::vector<PlotLine> lines_;
};

/// Seconds since the first row.
class Clock {
public:
  explicit Clock(const Table &table) : table_(table), first_(time(0)) {}
  double operator()(std::size_t row) const { return seconds_between(time(row), first_); }
  [[nodiscard]] std::string title() const { return "seconds since " + to_iso(first_); }

private:
  [[nodiscard]] Epoch<Utc> time(std::size_t row) const {
    return utc_from_iso(table_.text("time_utc", row)).value_or(Epoch<Utc>{});
  }
  const Table &table_;
  Epoch<Utc> first_;
};

/// What the light above the air makes of a row: its own w and sky.
double expected(const Table &counts, std::size_t row, const Table &truth, std::size_t of) {
  const double i = truth.number("I", of);
  const double dark = i > 0 ? 1 : 0; // q, u and v of no light are none
  double out = counts.number("sky", row) + counts.number("w0", row) * i;
  if (dark > 0)
    for (const auto &[w, part] : {std::pair{"w1", "q"}, {"w2", "u"}, {"w3", "v"}})
      out += counts.number(w, row) * i * truth.number(part, of);
  return out;
}

/// Rows of the truth by object and exposure.
std::map<std::pair<std::string, std::string>, std::size_t> truths(const Table &truth) {
  std::map<std::pair<std::string, std::string>, std::size_t> out;
  for (std::size_t k = 0; k < truth.rows(); ++k)
    out[{truth.text("name", k), truth.text("exposure", k)}] = k;
  return out;
}

/// Pages of millions of points open nowhere: every n-th exposure is shown.
std::size_t stride_of(const Table &truth) {
  constexpr std::size_t most = 3000;
  return (truth.rows() + most - 1) / most;
}

/// Values with errors, of which an axis shows those that are known. A set in the penumbra, whose
/// errors are as wide as all there is, would flatten the rest.
class Known {
public:
  void add(double value, double error) {
    if (std::isfinite(value) && error >= 0)
      values_.push_back({value, error});
  }
  /// Of the better known half the values with their errors, and of the others the values whose
  /// errors are no wider than those reach; {0, 0} of none.
  [[nodiscard]] std::array<double, 2> span() const {
    if (values_.empty())
      return {};
    std::vector<double> errors;
    for (const Value &v : values_)
      errors.push_back(v.error);
    const double middle = median_of(std::move(errors));
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Value &v : values_)
      if (v.error <= middle)
        low = std::min(low, v.value - v.error), high = std::max(high, v.value + v.error);
    const double reach = high - low, first = low, last = high;
    for (const Value &v : values_)
      if (2 * v.error <= reach && v.value > first - reach && v.value < last + reach)
        low = std::min(low, v.value - v.error), high = std::max(high, v.value + v.error);
    const double pad = std::max(0.05 * (high - low), 1e-6);
    return {low - pad, high + pad};
  }

private:
  struct Value {
    double value, error;
  };
  std::vector<Value> values_;
};

PlotFigure histogram_of(const std::vector<double> &pulls) {
  PlotFigure out{"How often counts miss by how many errors",
                 "(counts - expected)/error",
                 "share",
                 {},
                 false,
                 false,
                 {}};
  PlotLine found = line("counts", 0, false), normal = line("normal", 1, false);
  constexpr int bins = 24;
  constexpr double width = 0.5, first = -6;
  std::vector<double> sums(bins, 0);
  for (const double pull : pulls)
    if (const double k = std::floor((pull - first) / width); k >= 0 && k < bins)
      sums[static_cast<std::size_t>(k)] += 1 / static_cast<double>(pulls.size());
  for (int k = 0; k < bins; ++k)
    for (const double edge : {0., 1.}) { // steps
      found.x.push_back(first + (k + edge) * width);
      found.y.push_back(sums[static_cast<std::size_t>(k)]);
    }
  for (double x = first; x <= -first; x += 0.1) {
    normal.x.push_back(x);
    normal.y.push_back(width / std::sqrt(2 * pi) * std::exp(-x * x / 2));
  }
  out.lines = {std::move(found), std::move(normal)};
  return out;
}

/// Counts, what they should be, and what is left.
std::vector<PlotFigure> figures_of_counts(const Table &counts, const Table &truth) {
  const auto of = truths(truth);
  const Clock clock(counts);
  const std::size_t stride = stride_of(truth);
  Lines measured(true), model(false), left(true), budget(false);
  std::vector<double> pulls;
  for (std::size_t row = 0; row < counts.rows(); ++row) {
    const auto at = of.find({counts.text("name", row), counts.text("exposure", row)});
    if (at == of.end())
      continue;
    const double n = counts.number("counts", row), mean = expected(counts, row, truth, at->second);
    const double star = std::max(0.0, mean - counts.number("sky", row));
    const double f2 = counts.number("excess2", row),
                 flicker = counts.number("scint_sd", row) * star;
    const double sky = f2 * counts.number("sky", row) + std::pow(counts.number("sky_err", row), 2);
    const double read = counts.number("var_read", row), air = flicker * flicker;
    const double variance = f2 * star + sky + read + air;
    const double pull = (n - mean) / std::sqrt(variance);
    if (counts.text("saturated", row) != "true")
      pulls.push_back(pull);
    if (at->second % stride != 0)
      continue;
    const std::string channel = counts.text("band", row) + " " + counts.text("channel", row);
    const double t = clock(row);
    measured.add(channel, t, n);
    model.add(channel, t, mean);
    left.add(channel, t, pull);
    if (row > 0 && counts.text("exposure", row) == counts.text("exposure", row - 1))
      continue;
    for (const auto &[name, part] : {std::pair{"photons of the object", f2 * star},
                                     {"sky and dark", sky},
                                     {"reading", read},
                                     {"scintillation", air}})
      budget.add(name, t, part / variance);
  }
  std::vector<PlotLine> lines = std::move(model).all(), points = std::move(measured).all();
  for (std::size_t k = 0; k < lines.size(); ++k)
    lines[k].name += ", expected";
  lines.insert(lines.end(), points.begin(), points.end());
  return {{"Counts in the aperture", clock.title(), "electrons", lines, false, false, {}},
          {"What the model leaves",
           clock.title(),
           "(counts - expected)/error",
           std::move(left).all(),
           false,
           false,
           {}},
          histogram_of(pulls),
          {"Noise of the first channel",
           clock.title(),
           "share of the variance",
           std::move(budget).all(),
           false,
           false,
           {}}};
}

/// Of the system that the table's header or its rows tell.
std::string magnitude_title(const Table &table) {
  std::string system = table.text("mag_system", 0);
  for (const auto &[key, value] : table.notes())
    if (key == "mag_system")
      system = value;
  return fmt::format("mag ({}), above the air", system);
}

std::vector<PlotFigure> figures_of_truth(const Table &truth) {
  const Clock clock(truth);
  const std::size_t stride = stride_of(truth);
  Lines mags(false), fractions(false);
  Known known;
  for (std::size_t row = 0; row < truth.rows(); row += stride) {
    const std::string band = truth.text("band", row);
    mags.add(band, clock(row), truth.number("mag", row));
    known.add(truth.number("mag", row), 0);
    fractions.add("q " + band, clock(row), truth.number("q", row));
    fractions.add("u " + band, clock(row), truth.number("u", row));
  }
  constexpr double deepest =
      12.5; // magnitudes: what fades in the penumbra leaves the rest its height
  std::array<double, 2> mag = known.span();
  mag[1] = std::min(mag[1], mag[0] + deepest);
  return {{"What was there: brightness",
           clock.title(),
           magnitude_title(truth),
           std::move(mags).all(),
           false,
           false,
           {},
           {},
           {mag[1], mag[0]}},
          {"What was there: polarization",
           clock.title(),
           "q, u in the sky frame",
           std::move(fractions).all(),
           false,
           false,
           {}}};
}

} // namespace

Result<std::string> observation_page(const Observation &observation, const std::string &title,
                                     const Diagnostics &diagnostics) {
  std::vector<PlotFigure> figures = figures_of_counts(observation.counts, observation.truth);
  for (PlotFigure &one : figures_of_truth(observation.truth))
    figures.push_back(std::move(one));
  std::vector<std::string> notes{
      fmt::format("{}, {} saturated. Expected counts are those of the light that was there, in "
                  "transparent air; clouds and the instrument's own polarization are in the counts "
                  "alone.",
                  counted(observation.exposures, "exposure"), observation.saturated)};
  for (const Warning &warning : diagnostics.warnings())
    notes.push_back("warning: " + warning.text());
  return make_plot_page(title, figures, notes);
}

namespace {

/// Light was seen; the magnitude of noise says nothing.
bool is_seen(const Table &stokes, std::size_t row) {
  return stokes.number("I", row) > 3 * stokes.number("I_err", row);
}

/// The lines of a page of reduced sets, and what their axes reach.
struct StokesLines {
  Lines plane{true}, ellipses{false}, points{true}, bars{false}, degree{true}, intervals{false},
      limits{true}, mags{true}, tests{true}, nulls{true};
  Known q, u, v, p, mag;
  bool has_v = false;
  std::string mag_title;
  std::size_t stride = 1;   ///< every n-th set has an ellipse, if its errors are not far wider
  double widest = INFINITY; ///< than those of most

  void add(const Table &stokes, std::size_t row, double t) {
    const std::string band = stokes.text("band", row);
    if (is_seen(stokes, row)) {
      mags.add(band, t, stokes.number("mag", row));
      mag.add(stokes.number("mag", row),
              1.0857 * stokes.number("I_err", row) / stokes.number("I", row));
    }
    if (stokes.number("dof", row) > 0)
      tests.add(band, t, stokes.number("chi2", row) / stokes.number("dof", row));
    if (!std::isfinite(stokes.number("q", row)))
      return;
    add_fractions(stokes, row, t, band);
    add_degree(stokes, row, t, band);
  }

  void add_fractions(const Table &stokes, std::size_t row, double t, const std::string &band) {
    plane.add(band, stokes.number("q", row), stokes.number("u", row));
    if (row % stride == 0 && stokes.number("cov_qq", row) < widest * widest)
      add_ellipse(stokes, row, band);
    for (const auto &[name, variance, null, known] :
         {std::tuple{"q", "cov_qq", "null_q", &q}, std::tuple{"u", "cov_uu", "null_u", &u}}) {
      const double sd = std::sqrt(stokes.number(variance, row));
      if (const double half = stokes.number(null, row); std::isfinite(half))
        nulls.add(fmt::format("{} {}", name, band), t, half / sd);
      add_point(fmt::format("{} {}", name, band), t, stokes.number(name, row), sd, *known);
    }
    if (const double sd = std::sqrt(stokes.number("cov_vv", row)); std::isfinite(sd)) {
      add_point("v " + band, t, stokes.number("v", row), sd, v);
      has_v = true;
    }
  }

  void add_point(const std::string &name, double t, double value, double sd, Known &known) {
    points.add(name, t, value);
    for (const double y : {value - sd, value + sd, std::nan("")})
      bars.add(name, t, y);
    known.add(value, sd);
  }

  void add_degree(const Table &stokes, std::size_t row, double t, const std::string &band) {
    const double low = stokes.number("p_lo", row), high = stokes.number("p_hi", row);
    if (low > 0)
      degree.add(band, t, stokes.number("p_debiased", row));
    else
      limits.add(band + ", upper limit", t, high);
    p.add(low > 0 ? stokes.number("p_debiased", row) : high, (high - low) / 2);
    for (const double y : {low, high, std::nan("")})
      intervals.add(band + ", 95 %", t, y);
  }

  /// Of one standard deviation, by Cholesky's root.
  void add_ellipse(const Table &stokes, std::size_t row, const std::string &band) {
    const double q0 = stokes.number("q", row), u0 = stokes.number("u", row);
    const double a = stokes.number("cov_qq", row), b = stokes.number("cov_uu", row);
    const double c = stokes.number("cov_qu", row), s = std::sqrt(a);
    constexpr int steps = 24;
    for (int k = 0; k <= steps; ++k) {
      const double x = std::cos(2 * pi * k / steps), y = std::sin(2 * pi * k / steps);
      ellipses.add(band, q0 + s * x, u0 + c / s * x + std::sqrt(std::max(0.0, b - c * c / a)) * y);
    }
    ellipses.add(band, std::nan(""), std::nan(""));
  }
};

/// Of q, over the sets that have one; no bound without any.
double median_error(const Table &stokes) {
  std::vector<double> out;
  for (std::size_t row = 0; row < stokes.rows(); ++row)
    if (const double sd = std::sqrt(stokes.number("cov_qq", row)); std::isfinite(sd))
      out.push_back(sd);
  if (out.empty())
    return INFINITY;
  return median_of(std::move(out));
}

/// Points, and lines of the same colours behind them.
std::vector<PlotLine> with_bars(Lines points, Lines bars) {
  std::vector<PlotLine> out = std::move(bars).all();
  for (PlotLine &one : out) {
    one.dash = "solid"; // of the colour of its points
    one.is_faint = true;
    one.name += one.name.ends_with('%') ? "" : ", error";
  }
  for (PlotLine &one : std::move(points).all())
    out.push_back(std::move(one));
  return out;
}

using Span = std::array<double, 2>;

/// A figure with the reach of its axes; none where nothing was seen: an empty frame says less.
void add_figure(std::vector<PlotFigure> &out, const char *title, const std::string &x,
                const char *y, std::vector<PlotLine> lines, Span x_span, Span y_span) {
  if (!lines.empty())
    out.push_back({title, x, y, std::move(lines), false, false, {}, x_span, y_span});
}

/// No degree lies below 0.
std::array<double, 2> from_zero(std::array<double, 2> span) {
  return span[0] == span[1] ? span : std::array{-0.02 * span[1], std::min(span[1], 1.05)};
}

std::vector<PlotFigure> stokes_figures(StokesLines &lines, const std::string &time) {
  const Span q = lines.q.span(), u = lines.u.span(), mag = lines.mag.span();
  const Span v = lines.has_v ? lines.v.span() : q;
  std::vector<PlotLine> p = with_bars(std::move(lines.degree), std::move(lines.intervals));
  std::size_t colours = 0; // limits are told apart from what is detected
  for (const PlotLine &one : p)
    colours = std::max(colours, one.colour + 1);
  for (PlotLine &one : std::move(lines.limits).all()) {
    one.colour += colours;
    p.push_back(std::move(one));
  }
  std::vector<PlotFigure> out;
  add_figure(out, lines.has_v ? "q, u and v against time" : "q and u against time", time,
             lines.has_v ? "q, u in the sky frame, v" : "q, u in the sky frame",
             with_bars(std::move(lines.points), std::move(lines.bars)), {},
             {std::min({q[0], u[0], v[0]}), std::max({q[1], u[1], v[1]})});
  add_figure(out, "Degree of linear polarization", time, "p", std::move(p), {},
             from_zero(lines.p.span()));
  add_figure(out, "Brightness", time, lines.mag_title.c_str(), std::move(lines.mags).all(), {},
             {mag[1], mag[0]});
  add_figure(out, "Polarization", "q", "u",
             with_bars(std::move(lines.plane), std::move(lines.ellipses)), q, u);
  add_figure(out, "Fits: what noise does not explain", time, "chi2/dof",
             std::move(lines.tests).all(), {}, {});
  add_figure(out, "Null tests: one half turn of the plate against the other", time,
             "half their difference, in errors", std::move(lines.nulls).all(), {}, {});
  return out;
}

/// The page in a sentence or two: how much is known.
std::string stokes_answer(const Table &stokes, bool has_v) {
  std::size_t known = 0, polarized = 0;
  constexpr double infinite = std::numeric_limits<double>::infinity();
  double least = infinite, most = 0, brightest = infinite, faintest = -infinite;
  for (std::size_t row = 0; row < stokes.rows(); ++row) {
    if (const double mag = stokes.number("mag", row); std::isfinite(mag) && is_seen(stokes, row)) {
      brightest = std::min(brightest, mag);
      faintest = std::max(faintest, mag);
    }
    if (!std::isfinite(stokes.number("q", row)))
      continue;
    ++known;
    if (!(stokes.number("p_lo", row) > 0))
      continue;
    ++polarized;
    const double p = stokes.number("p_debiased", row);
    least = std::min(least, p);
    most = std::max(most, p);
  }
  std::string out = known == 0
                        ? fmt::format("No set of {} tells q and u.", stokes.rows())
                        : fmt::format("{} of {} tell {}, to {:.2g} in the median", known,
                                      counted(stokes.rows(), "set"),
                                      has_v ? "q, u and v" : "q and u", median_error(stokes));
  if (known > 0 && polarized == 0)
    out += "; no polarization is beyond doubt.";
  else if (known > 0)
    out += fmt::format("; {} polarized beyond doubt (95 %), p {:.2g} to {:.2g}.",
                       polarized == 1 ? "1 is" : fmt::format("{} are", polarized), least, most);
  if (brightest <= faintest)
    out += fmt::format(" Magnitude {:.1f} to {:.1f}.", brightest, faintest);
  return out;
}

} // namespace

Result<std::string> stokes_page(const Table &stokes, const std::string &title,
                                const Diagnostics &diagnostics) {
  const Clock clock(stokes);
  StokesLines lines;
  constexpr std::size_t most_ellipses = 300; // more hide each other
  lines.stride = (stokes.rows() + most_ellipses - 1) / most_ellipses;
  lines.widest = 4 * median_error(stokes);
  lines.mag_title = magnitude_title(stokes);
  for (std::size_t row = 0; row < stokes.rows(); ++row)
    lines.add(stokes, row, clock(row));
  const std::vector<PlotFigure> figures = stokes_figures(lines, clock.title());
  const std::size_t warned = diagnostics.warnings().size();
  std::vector<std::string> notes{
      stokes_answer(stokes, lines.has_v) +
          (warned > 0 ? fmt::format(" Below: {}.", counted(warned, "warning")) : ""),
      "Ellipses and bars of q, u and v: one standard deviation. Bars of p: 95 % intervals; points "
      "where "
      "it is detected, else the upper limit. Axes reach what is known: sets with errors wider than "
      "that, as in the penumbra, lie outside (a double click shows all).",
  };
  if (lines.stride > 1)
    notes.push_back(fmt::format("One set in {} has its ellipse.", lines.stride));
  for (const Warning &warning : diagnostics.warnings())
    notes.push_back("warning: " + warning.text());
  return make_answer_page(title, figures, notes);
}

} // namespace umov::jobs
