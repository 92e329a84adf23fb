#include <umov/jobs/exposure.h>

#include "jobs/exposure_rates.h"
#include "jobs/observe_plan.h"
#include "jobs/observe_warnings.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <umov/core/text.h>
#include <umov/io/passband_file.h>
#include <umov/photometry/radiometry.h>

namespace umov::jobs {
namespace {

/// The band that is asked for, by name.
Result<Band> named_band(const ExposureRequest &r) {
  const std::string name = r.band.empty() ? fmt::format("nm:{:g}", r.nm) : r.band;
  UMOV_ASSIGN(bands, bands_named({name}));
  if (bands.size() != 1)
    return fail(ErrorCode::Usage, fmt::format("--band {} is a group of {} bands; name one, as {}",
                                              r.band, bands.size(), bands.front().name));
  UMOV_TRY(check_air_reaches(bands, {}, {}, r.width_nm));
  return bands.front();
}

/// The same as an observer needs it.
Result<BandResponse> response_of(const ExposureRequest &r, const Band &band) {
  if (!band.curve)
    return narrow_band(r.band.empty() ? fmt::format("nm:{:g}", r.nm) : band.name,
                       band.wavelength.nm(), r.width_nm);
  UMOV_ASSIGN(response, curve_band(*band.curve));
  UMOV_ASSIGN(grid, BandGrid::make({band}));
  return at_nodes(std::move(response), grid, 0);
}

/// AB magnitude less that of another system.
Result<double> ab_less(MagnitudeSystem system, const Band &band) {
  UMOV_ASSIGN(zero, zero_irradiance(band, system));
  UMOV_ASSIGN(zero_ab, zero_irradiance(band, MagnitudeSystem::AB));
  return -2.5 * std::log10(zero / zero_ab);
}

/// A quantity and what it means, row by row.
class Sheet {
public:
  void add(const char *quantity, double value, const char *unit, std::string text) {
    names_.emplace_back(quantity);
    values_.push_back(value);
    units_.emplace_back(unit);
    texts_.push_back(std::move(text));
  }
  Table table() && {
    Table out;
    out.add("quantity", "", "what is told", std::move(names_));
    out.add("value", "", "in its unit", std::move(values_));
    out.add("in", "", "unit", std::move(units_));
    out.add("meaning", "", "what it is", std::move(texts_));
    return out;
  }

private:
  std::vector<std::string> names_, units_, texts_;
  std::vector<double> values_;
};

Result<void> check(const ExposureRequest &r) {
  struct Bound {
    const char *name;
    double value, low, high;
  };
  for (const Bound &b : {Bound{"--mag", r.mag, -30, 40},
                         {"--alt", r.altitude_deg, 3, 90},
                         {"--height-m", r.height_m, -500, 9000},
                         {"--sky-mag", r.sky_mag, sky_mag_range[0], sky_mag_range[1]},
                         {"--change-per-s", r.change_per_s, 0, 100},
                         {"--sd-p", r.sd_p, 1e-7, 1},
                         {"--nm", r.nm, 300, 1200},
                         {"--width-nm", r.width_nm, 1e-3, 1000},
                         {"--seeing", r.seeing_arcsec, 1e-3, 100},
                         {"--exposure-s", r.exposure_s, 0, 1e6}})
    if (!(b.value >= b.low && b.value <= b.high))
      return fail(ErrorCode::Usage,
                  fmt::format("{} {}: {} to {} was expected", b.name, b.value, b.low, b.high));
  if (const auto fits = check_aperture("--aperture-fwhm", r.aperture_fwhm); !fits)
    return fail(ErrorCode::Usage, fits.error().message);
  return {};
}

/// Error of p of a frame, scintillation between frames counted.
double reached_by(const StarFrame &frame) { return std::hypot(frame.sd_p, frame.flicker_p); }

/// How many frames tell p to the wanted error.
double frames_for(const StarFrame &frame, double sd_p) {
  return std::max(1.0, std::ceil(std::pow(reached_by(frame) / sd_p, 2) - 1e-9));
}

/// What a frame reaches, what it fails at, and what helps, in a sentence.
std::string verdict_of(const StarFrame &frame, double sd_p, double fills_s, const char *of) {
  const double reached = reached_by(frame), frames = frames_for(frame, sd_p);
  std::string out = fmt::format(
      "One exposure of {:.3g} s{}: S/N {:.3g}, error of p {:.2g}{}; ", frame.seconds, of, frame.snr,
      frame.sd_p,
      frame.flicker_p > 0 ? fmt::format(", with scintillation {:.2g}", reached) : std::string());
  if (frame.full >= 1)
    return out + fmt::format("it saturates (the brightest pixel is full after {:.3g} s). Expose at "
                             "most {:.3g} s and take more frames, defocus, or take a narrower band",
                             fills_s, fills_s / 2);
  out += fmt::format("the brightest pixel is {} % full, so it does not saturate. ",
                     percent(frame.full));
  constexpr double briefest_s = 1e-5, many = 1000, endless = 1e6;
  if (frame.seconds < briefest_s)
    out += fmt::format("Cameras expose for some {:g} s at least: take a neutral filter, or expose "
                       "longer where that does not saturate. ",
                       briefest_s);
  if (frames <= 1)
    return out + fmt::format("That is the error of p that is wanted (--sd-p {:g})", sd_p);
  out += fmt::format("{:.0f} of them{} tell p to {:g}", frames, of, sd_p);
  if (frames > endless)
    out += ", which nobody waits for";
  if (frames > many && !(frame.seconds < briefest_s))
    out += frame.full < 0.1
               ? "; longer ones read less noise, and a wider band or more aperture has "
                 "more light"
               : "; a wider band or more aperture has more light";
  return out;
}

/// Where the air's flicker gets into q and u.
enum class Flicker {
  InI,              ///< nowhere: the channels of an exposure share it and tell q, u by their ratios
  FromStateToState, ///< one beam, one state after the other
  FromLensToLens
};

Flicker flicker_of(const Polarimeter &p) {
  if (p.has_separate_pupils)
    return Flicker::FromLensToLens;
  const bool has_one_beam =
      p.type == PolarimeterType::PolarizerWheel || p.type == PolarimeterType::RotatingRetarder;
  return has_one_beam ? Flicker::FromStateToState : Flicker::InI;
}

/// The exposure that a plate's turn is counted by; 0 where none turns by itself. Sixteen to a turn
/// where nobody says (MOPTOP: Shrestha et al. 2020).
double frame_of(const ExposureRequest &r, const Polarimeter &p) {
  if (p.type != PolarimeterType::SpinningHwpDualBeam)
    return 0;
  return r.exposure_s > 0 ? r.exposure_s : p.period_s / 16;
}

/// Exposures of a set: of a quarter turn, one after the other, where a plate turns by itself.
double frames_of(const Polarimeter &p, double frame_s) {
  return static_cast<double>(usual_states(p.type).size()) * turn_of(p, frame_s, frame_s).frames();
}

/// Of a set, by exposures of that length where a plate turns by itself. No more than stand for
/// all: what a turn tells in so many electrons does not depend on how finely it is cut.
std::vector<PolarimeterState> states_of(const Polarimeter &p, double frame_s) {
  constexpr double most = 32;
  std::vector<PolarimeterState> out = usual_states(p.type);
  const PlateTurn turn = turn_of(p, frame_s, std::max(frame_s, p.period_s / 4 / most));
  out.resize(out.size() * static_cast<std::size_t>(turn.frames()), out.front());
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = turn.at(out[k], k);
  return out;
}

/// What a set of states makes of electrons, by the rows that a reduction gets of it.
Result<void> put_states(ExposureSetup &s, const std::vector<PolarimeterState> &states) {
  const Polarimeter &p = s.instrument.polarimeter;
  ExposureLight light;
  light.flux.resize(s.observer.band().nm.size());
  light.airmass = s.airmass;
  light.altitude = Angle::degrees(s.request.altitude_deg);
  const double whole =
      s.observer.rate_per_flux() * s.observer.mean_transmission(s.airmass) * s.port;
  std::vector<StokesRow> rows;
  for (const PolarimeterState &state : states) {
    UMOV_TRY(s.observer.prepare(state));
    UMOV_ASSIGN(channels, s.observer.expected({0, 1, state}, light, 1, 0));
    for (const ChannelCounts &channel : channels)
      rows.push_back(channel.row * (1 / whole));
  }
  UMOV_ASSIGN(quality, told_by(rows, p, "polarimeter", s.observer.band()));
  s.states = static_cast<double>(states.size());
  if (parameters_of(p.type) < 3) {
    s.factor = std::numeric_limits<double>::infinity();
    return {};
  }
  // Variance of q, u in that of a row, (V/rows) over (electrons/through)^2 (docs/theory, 6).
  const double channels = static_cast<double>(rows.size()) / s.states;
  s.factor = s.states * quality.linear_variance * s.through * s.through / channels;
  return {};
}

/// How many telescopes of the instrument's size there are, in words where they are more than one.
std::size_t lenses_of(const Polarimeter &p) {
  return p.has_separate_pupils ? p.angles_deg.size() : 1;
}
std::string of_one_lens(const Polarimeter &p) {
  return p.has_separate_pupils ? fmt::format(", of one of {} lenses", lenses_of(p)) : "";
}

} // namespace

Result<ExposureSetup> exposure_setup(const ExposureRequest &r) {
  UMOV_TRY(check(r));
  UMOV_ASSIGN(instrument, read_instrument(r.instrument));
  if (parameters_of(instrument.polarimeter.type) < 3)
    return fail(ErrorCode::BadInput,
                "polarimeter.type = \"none\" counts I alone, and how long p takes is asked for; an "
                "instrument with a polarimeter was expected (umov instrument list)",
                {r.instrument});
  UMOV_ASSIGN(band, named_band(r));
  UMOV_ASSIGN(response, response_of(r, band));
  UMOV_ASSIGN(to_ab, ab_less(r.magnitudes, band));
  const double frame_s = frame_of(r, instrument.polarimeter);
  auto out = exposure_setup(r, instrument, response, states_of(instrument.polarimeter, frame_s));
  if (!out && out.error().where.file.empty())
    return fail(out.error().code, out.error().message, {r.instrument});
  if (!out)
    return out;
  out->to_ab = to_ab;
  out->frame_s = frame_s;
  out->states = frames_of(instrument.polarimeter, frame_s);
  return out;
}

Result<ExposureSetup> exposure_setup(const ExposureRequest &r, const Instrument &instrument,
                                     const BandResponse &band,
                                     const std::vector<PolarimeterState> &states) {
  ObservingConditions conditions;
  conditions.air.pressure_hpa = standard_pressure_hpa(r.height_m);
  conditions.seeing = {r.seeing_arcsec, 500, 25};
  conditions.aperture_fwhm = r.aperture_fwhm;
  conditions.scintillation = ScintillationSite{r.height_m, 1.5};
  UMOV_ASSIGN(metals, port_metals(instrument.telescope, band.nm));
  UMOV_ASSIGN(observer, BandObserver::make(instrument, band, conditions, metals));
  ExposureSetup out{r, instrument, std::move(observer), excess_variance(instrument.detector)};
  out.airmass = airmass(Angle::degrees(r.altitude_deg));
  out.port = out.observer.port_transmission(Angle::degrees(r.altitude_deg), {});
  UMOV_ASSIGN(channels, polarimeter_channels(instrument.polarimeter, {}, band.pivot_nm));
  out.through = 0;
  for (const PolarimeterChannel &channel : channels)
    out.through += channel.row[0];
  UMOV_TRY(put_states(out, states));
  return out;
}

ExposureSetup of_frames(const ExposureSetup &s, double seconds) {
  const Polarimeter &p = s.instrument.polarimeter;
  ExposureSetup out = s;
  if (p.type != PolarimeterType::SpinningHwpDualBeam || seconds == s.frame_s)
    return out;
  out.frame_s = seconds;
  if (!put_states(out, states_of(p, seconds))) // in so long an exposure the plate blurs q or u
    out.factor = std::numeric_limits<double>::infinity();
  out.states = frames_of(p, seconds);
  return out;
}

const char *of_each_state(const ExposureSetup &s) {
  if (s.instrument.polarimeter.type == PolarimeterType::SpinningHwpDualBeam)
    return " at each angle of a quarter turn of the plate";
  return s.states > 1 ? " of each analyser" : "";
}

Result<StarRates> star_rates(const ExposureSetup &s, double mag) {
  const BandResponse &band = s.observer.band();
  const double x = s.airmass, zero = band.zero_flux * s.observer.rate_per_flux() * s.port;
  StarRates out;
  out.whole = zero * std::pow(10, -0.4 * (mag + s.to_ab)) * s.observer.mean_transmission(x);
  UMOV_ASSIGN(channels, polarimeter_channels(s.instrument.polarimeter, {}, band.pivot_nm));
  double largest = 0; // of unpolarized light
  for (const PolarimeterChannel &channel : channels)
    largest = std::max(largest, channel.row[0]);
  out.star = out.whole * share_inside(ImageProfile::Moffat, s.request.aperture_fwhm) * s.through;
  const double lattice = pixel_parts(s.instrument.polarimeter);
  const double arcsec2 =
      s.observer.aperture_pixels(x) * lattice * std::pow(s.observer.pixel_arcsec(), 2);
  const double sky_arcsec2 = zero * std::pow(10, -0.4 * s.request.sky_mag);
  out.sky = sky_arcsec2 * arcsec2 * s.through;
  const double pixels = s.observer.aperture_pixels(x) * static_cast<double>(channels.size());
  double collecting = 0; // times the exposure, of all channels
  for (const PolarimeterChannel &channel : channels)
    collecting += channel.time_share;
  out.dark = s.instrument.detector.dark_e_s * s.observer.aperture_pixels(x) * collecting;
  out.fixed = pixels * fixed_variance(s.instrument.detector);
  const double sky_of_pixel = sky_arcsec2 * std::pow(s.observer.pixel_arcsec(), 2);
  out.peak = (out.whole * s.observer.peak_share(x) + sky_of_pixel) * largest * lattice +
             s.instrument.detector.dark_e_s * channels.front().time_share;
  out.fills_s = saturation_e(s.instrument.detector) / out.peak;
  return out;
}

StarFrame star_frame(const ExposureSetup &s, const StarRates &r, double seconds) {
  const double star = r.star * seconds;
  const double variance = s.excess2 * (r.star + r.sky + r.dark) * seconds + r.fixed;
  const Polarimeter &p = s.instrument.polarimeter;
  const auto lenses = static_cast<double>(lenses_of(p));
  const double flicker2 = std::pow(s.observer.scintillation_sd(seconds, s.airmass, 0), 2);
  // Of one state against the others it acts as the noise of so many counts does.
  const double of_p = flicker_of(p) == Flicker::InI ? 0 : s.factor / std::max(s.states, lenses);
  return {seconds, 1 / std::sqrt(variance / (star * star) + flicker2 / lenses),
          std::sqrt(s.factor / s.states * variance) / star, seconds / r.fills_s,
          std::sqrt(of_p * flicker2)};
}

double time_for(const ExposureSetup &s, const StarRates &r) {
  // sd^2 (s t)^2 = factor (F^2 (s + b) t + v): a quadratic in t; v of every frame where a plate
  // turns by itself, else of each state once.
  const double a = std::pow(s.request.sd_p * r.star, 2);
  const double b = s.factor * s.excess2 * (r.star + r.sky + r.dark);
  if (s.frame_s > 0)
    return (b + s.factor * r.fixed / s.frame_s) / a;
  const double c = s.factor * r.fixed * s.states;
  return (b + std::sqrt(b * b + 4 * a * c)) / (2 * a);
}

bool mistakes_changes(const Polarimeter &p) { return flicker_of(p) == Flicker::FromStateToState; }

namespace {

/// What is taken for polarization while brightness changes as told, over a set of so many seconds:
/// of four states that follow each other; of a balanced retarder in any order, q, u and v together.
double false_p(const ExposureSetup &s, double set_s) {
  const bool is_full = parameters_of(s.instrument.polarimeter.type) == 4;
  return (is_full ? std::sqrt(15.0) / 2 : std::sqrt(2.0)) * s.request.change_per_s * set_s / 4;
}

} // namespace

std::string exposure_verdict(const ExposureSetup &s, const StarRates &rates) {
  const double own = s.request.exposure_s;
  const double wanted = s.frame_s > 0 ? s.frame_s : time_for(s, rates) / s.states;
  const double taken = own > 0 ? own : std::min(wanted, rates.fills_s / 2);
  const ExposureSetup of_taken = of_frames(s, taken);
  std::string out = verdict_of(star_frame(of_taken, rates, taken), s.request.sd_p, rates.fills_s,
                               of_each_state(of_taken));
  if (mistakes_changes(s.instrument.polarimeter) && s.request.change_per_s > 0)
    out += fmt::format(". A brightness that changes by {:g} of itself a second makes a false p of "
                       "{:.2g} in such a set, which more of them do not lessen; shorter ones do",
                       s.request.change_per_s, false_p(of_taken, taken * of_taken.states));
  return out;
}

std::string magnitude_words(const ExposureSetup &s) {
  const double ab = s.request.mag + s.to_ab;
  std::string out = fmt::format("{:.4g} AB above the air", ab);
  const auto band = named_band(s.request);
  if (const auto less = band ? ab_less(MagnitudeSystem::Vega, *band) : Result<double>(0);
      band && less)
    out += fmt::format(", {:.4g} Vega", ab - *less);
  return out;
}

std::string exposure_terms(const ExposureSetup &s) {
  const auto of_p = [&] {
    switch (flicker_of(s.instrument.polarimeter)) {
    case Flicker::FromStateToState:
      return " alone: scintillation between exposures comes on top of it";
    case Flicker::FromLensToLens:
      return " alone: scintillation, which each lens has of its own, comes on top of it";
    default:
      return ": scintillation is the same in all channels of an exposure and leaves p alone";
    }
  };
  return fmt::format(
      "S/N is that of I: photons, sky, dark current, reading and scintillation. The error of p is "
      "of photons, sky, dark current and reading{}. Summed within {:g} of a star's width "
      "(--aperture-fwhm; umov observe: observation.aperture_fwhm, 2 unless told)",
      of_p(), s.request.aperture_fwhm);
}

namespace {

/// The exposure that a frame has, where that is told; 0: as long as p needs.
double told_frame(const ExposureSetup &s) {
  return s.request.exposure_s > 0 ? s.request.exposure_s : s.frame_s;
}

/// In whole sets of frames, where those have a length: an instrument takes no part of one, reads
/// each, and meets scintillation between them.
void add_time_of_frames(const ExposureSetup &s, const StarRates &rates, Sheet &out) {
  const double seconds = told_frame(s);
  if (!(seconds > 0))
    return;
  const ExposureSetup of_told = of_frames(s, seconds);
  const double sets = frames_for(star_frame(of_told, rates, seconds), s.request.sd_p);
  out.add("time_of_frames", sets * of_told.states * seconds, "s",
          fmt::format("the same in whole exposures of {:g} s{}", seconds,
                      of_told.states > 1
                          ? fmt::format(", {:.0f} of them a set of all states", of_told.states)
                          : std::string()));
}

/// What the row of scintillation is.
const char *flicker_words(const Polarimeter &p) {
  switch (flicker_of(p)) {
  case Flicker::FromStateToState:
    return "relative, of each exposure of that length";
  case Flicker::FromLensToLens:
    return "relative, of each lens in an exposure of that length";
  default:
    return "relative, of I alone: channels share it";
  }
}

} // namespace

Result<Table> exposure(const ExposureRequest &r) {
  UMOV_ASSIGN(setup, exposure_setup(r));
  UMOV_ASSIGN(rates, star_rates(setup, r.mag));
  const Polarimeter &polarimeter = setup.instrument.polarimeter;
  const BandResponse &band = setup.observer.band();
  const double t = time_for(setup, rates), f2 = setup.excess2;
  const double read = rates.fixed * (setup.frame_s > 0 ? t / setup.frame_s : setup.states);
  const double all = f2 * (rates.star + rates.sky + rates.dark) * t + read;
  Sheet out;
  out.add("zero_point", 2.5 * std::log10(setup.observer.rate_per_flux() * band.zero_flux),
          "mag(AB)", "of 1 electron a second, no air, no polarizer" + of_one_lens(polarimeter));
  out.add("rate_whole", rates.whole, "electron / s",
          (setup.port < 1 ? "through the air and the mirrors of the port, before polarizers"
                          : "through the air, before polarizers") +
              of_one_lens(polarimeter));
  out.add("rate", rates.star, "electron / s",
          fmt::format("detected in all channels, within {:g} of a star's width", r.aperture_fwhm));
  out.add("time", t, "s",
          std::string(parameters_of(polarimeter.type) == 4
                          ? "of a whole sequence, until q and u are known to sd_p"
                          : "of all states together, until p is known to sd_p") +
              ", by the electrons alone: of exposures as long as that takes");
  add_time_of_frames(setup, rates, out);
  out.add("electrons", rates.star * t, "electron", "detected in that time");
  out.add("saturation", rates.fills_s, "s", "exposure that fills the brightest pixel");
  out.add("share_star", f2 * rates.star * t / all, "", "of the variance: the object's own photons");
  out.add("share_sky", f2 * rates.sky * t / all, "", "the sky's");
  out.add("share_dark", f2 * rates.dark * t / all, "", "dark current");
  out.add("share_read", read / all, "",
          setup.frame_s > 0 ? fmt::format("reading and rounding, every {:g} s", setup.frame_s)
                            : "reading and rounding, once of each state");
  out.add("scintillation", setup.observer.scintillation_sd(t, setup.airmass, 0), "",
          flicker_words(polarimeter));
  if (mistakes_changes(polarimeter) && r.change_per_s > 0) {
    const bool is_full = parameters_of(polarimeter.type) == 4;
    out.add("false_p", false_p(setup, t), "",
            is_full ? "of q, u and v together, while brightness changes as told"
                    : "of four states in a row while brightness changes as told");
  }
  Table table = std::move(out).table();
  table.note("band", band.name);
  table.note("magnitude", magnitude_words(setup));
  table.note("terms", exposure_terms(setup));
  table.note("verdict", exposure_verdict(setup, rates));
  if (r.change_per_s > 0 && !mistakes_changes(polarimeter))
    table.note("warning", fmt::format("--change-per-s {:g} says nothing to a polarimeter of type "
                                      "\"{}\": channels of an exposure see the same change",
                                      r.change_per_s, name_of(polarimeter.type)));
  if (std::string brief = brief_words(fmt::format("--exposure-s {:g}", r.exposure_s), r.exposure_s,
                                      setup.instrument.telescope.aperture_m);
      r.exposure_s > 0 && !brief.empty())
    table.note("warning", std::move(brief));
  return table;
}

Result<Table> instrument_list() {
  std::vector<std::string> names, types, texts;
  std::vector<double> apertures;
  for (const std::string &name : instrument_names()) {
    UMOV_ASSIGN(one, read_instrument(name));
    names.push_back(name);
    apertures.push_back(one.telescope.aperture_m);
    types.emplace_back(name_of(one.polarimeter.type));
    texts.push_back(one.description);
  }
  Table table;
  table.add("name", "", "of the instrument", std::move(names));
  table.add("aperture", "m", "diameter", std::move(apertures));
  table.add("polarimeter", "", "type", std::move(types));
  table.add("description", "", "what it is", std::move(texts));
  return table;
}

} // namespace umov::jobs
