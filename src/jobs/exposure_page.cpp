// The page of umov exposure: what frames of any length reach, on stars of any brightness.

#include "jobs/exposure_rates.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <umov/io/plot_page.h>

namespace umov::jobs {
namespace {

constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();

/// Values in equal ratios, from one to the other.
std::vector<double> steps(double from, double to, int count) {
  std::vector<double> out;
  out.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k)
    out.push_back(from * std::pow(to / from, static_cast<double>(k) / (count - 1)));
  return out;
}

PlotLine line(std::string name, std::size_t number) {
  return {std::move(name), {}, {}, number, plot_dash(number)};
}

/// A level across the figure.
PlotLine level(std::string name, std::size_t number, double y, const std::vector<double> &x) {
  PlotLine out = line(std::move(name), number);
  out.x = {x.front(), x.back()};
  out.y = {y, y};
  return out;
}

PlotFigure figure(const char *title, const char *x, std::string y, bool has_log_x) {
  PlotFigure out{title, x, std::move(y), {}, true};
  out.has_log_x = has_log_x;
  return out;
}

const char *length_title(const ExposureSetup &s) {
  if (s.frame_s > 0)
    return "exposure at each angle of the plate's turn [s]";
  return s.states > 1 ? "exposure of each analyser [s]" : "exposure [s]";
}

/// Frames of these lengths on stars about the one that was asked for; lines end where the brightest
/// pixel is full.
Result<std::vector<PlotFigure>> frames(const ExposureSetup &s, const std::vector<double> &seconds) {
  const char *x = length_title(s);
  PlotFigure errors = figure("Error of p", x, "standard deviation of p", true);
  PlotFigure signal = figure("Signal to noise", x, "S/N of I, scintillation in it", true);
  std::size_t number = 0;
  std::vector<ExposureSetup> of_length;
  of_length.reserve(seconds.size());
  for (const double t : seconds)
    of_length.push_back(of_frames(s, t));
  for (const double step : {-4., -2., 0., 2., 4.}) {
    const double mag = s.request.mag + step;
    UMOV_ASSIGN(rates, star_rates(s, mag));
    errors.lines.push_back(line(fmt::format("magnitude {:g}", mag), number));
    signal.lines.push_back(line(fmt::format("magnitude {:g}", mag), number++));
    for (std::size_t k = 0; k < seconds.size(); ++k) {
      const double t = seconds[k];
      const StarFrame frame = star_frame(of_length[k], rates, t);
      const bool is_shown = frame.full < 1 && frame.sd_p < 1; // p is never above 1
      errors.lines.back().x.push_back(t);
      errors.lines.back().y.push_back(is_shown ? frame.sd_p : nowhere);
      signal.lines.back().x.push_back(t);
      signal.lines.back().y.push_back(frame.full < 1 && frame.snr > 0.1 ? frame.snr : nowhere);
    }
  }
  errors.lines.push_back(
      level(fmt::format("wanted: {:g}", s.request.sd_p), number, s.request.sd_p, seconds));
  return std::vector<PlotFigure>{std::move(errors), std::move(signal)};
}

/// How long, against magnitude.
Result<PlotFigure> times(const ExposureSetup &s) {
  PlotFigure out = figure("How long until p is known", "", "time [s]", false);
  out.x_title = fmt::format("magnitude ({}), above the air", name_of(s.request.magnitudes));
  PlotLine whole = line(fmt::format("p to {:g}, all states together", s.request.sd_p), 0);
  PlotLine full = line("longest frame: the brightest pixel is full", 1);
  for (double mag = s.request.mag - 6; mag <= s.request.mag + 6; mag += 0.25) {
    UMOV_ASSIGN(rates, star_rates(s, mag));
    whole.x.push_back(mag);
    whole.y.push_back(time_for(s, rates));
    full.x.push_back(mag);
    full.y.push_back(rates.fills_s);
  }
  out.lines = {std::move(whole), std::move(full)};
  return out;
}

/// What makes the noise of a frame.
PlotFigure budget(const ExposureSetup &s, const StarRates &r, const std::vector<double> &seconds) {
  PlotFigure out =
      figure("What makes the error of p", length_title(s), "share of the variance", true);
  out.has_log_y = false;
  PlotLine star = line("the object's photons", 0), sky = line("sky", 1), dark = line("dark", 2),
           read = line("reading and rounding", 3);
  for (const double t : seconds) {
    const double all = s.excess2 * (r.star + r.sky + r.dark) * t + r.fixed;
    for (const auto &[one, part] : {std::pair{&star, s.excess2 * r.star * t},
                                    {&sky, s.excess2 * r.sky * t},
                                    {&dark, s.excess2 * r.dark * t},
                                    {&read, r.fixed}}) {
      one->x.push_back(t);
      one->y.push_back(part / all);
    }
  }
  out.lines = {std::move(star), std::move(sky), std::move(dark), std::move(read)};
  return out;
}

/// How much of a star's light a circle holds, and what frames summed in it reach: wide ones have
/// the noise of more pixels.
PlotFigure growth(const ExposureSetup &s, const StarRates &r, double seconds) {
  PlotFigure out =
      figure("How wide to sum: growth curve", "radius of the aperture [widths of a star]",
             "share, and S/N over its largest", false);
  out.has_log_y = false;
  PlotLine light = line("light inside", 0), signal = line("S/N of photons, sky and reading", 1);
  const double summed = s.request.aperture_fwhm; // of which the rates are
  const double one = share_inside(ImageProfile::Moffat, summed);
  double largest = 0;
  for (int k = 1; k <= 120; ++k) {
    const double radius = .025 * k, share = share_inside(ImageProfile::Moffat, radius);
    const double star = r.star * share / one * seconds;
    const double area = radius * radius / (summed * summed);
    const double others = (s.excess2 * (r.sky + r.dark) * seconds + r.fixed) * area;
    light.x.push_back(radius);
    light.y.push_back(share);
    signal.x.push_back(radius);
    signal.y.push_back(star / std::sqrt(s.excess2 * star + others));
    largest = std::max(largest, signal.y.back());
  }
  for (double &y : signal.y)
    y /= largest;
  out.lines = {std::move(light), std::move(signal)};
  return out;
}

} // namespace

Result<std::string> exposure_page(const ExposureRequest &r) {
  UMOV_ASSIGN(setup, exposure_setup(r));
  UMOV_ASSIGN(rates, star_rates(setup, r.mag));
  // From a hundredth of the time that is wanted, or of what a pixel bears, to ten times the longer.
  const double t = time_for(setup, rates) / setup.states;
  const double full = std::isfinite(rates.fills_s) ? rates.fills_s : t;
  const std::vector<double> seconds = steps(std::min(t, full) / 100, 10 * std::max(t, full), 120);
  UMOV_ASSIGN(figures, frames(setup, seconds));
  UMOV_ASSIGN(how_long, times(setup));
  figures.push_back(std::move(how_long));
  figures.push_back(budget(setup, rates, seconds));
  const double frame_s = r.exposure_s > 0 ? r.exposure_s : std::min(t, full);
  figures.push_back(growth(setup, rates, frame_s));
  std::vector<std::string> notes{exposure_verdict(setup, rates) + "."};
  notes.push_back(
      fmt::format("{} in {}: magnitude {} at {:g} deg, site {:g} m high, a star {:g} "
                  "arcsec wide at the zenith, sky of {:g} mag/arcsec2 (AB). Lines end "
                  "where the brightest pixel is full. {}{}.",
                  r.instrument, setup.observer.band().name, magnitude_words(setup), r.altitude_deg,
                  r.height_m, r.seeing_arcsec, r.sky_mag, exposure_terms(setup),
                  mistakes_changes(setup.instrument.polarimeter)
                      ? "; what the object changes from one analyser to the next comes on top "
                        "(--change-per-s)"
                      : ""));
  notes.push_back(
      fmt::format("The growth curve is of Moffat's profile, in frames of {:.3g} s.", frame_s));
  return make_answer_page(fmt::format("How long to expose: {}", r.instrument), figures, notes);
}

} // namespace umov::jobs
