#include <umov/io/light_curve_table.h>

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <umov/lightcurve/derived_errors.h>

namespace umov {

namespace {

using E = const LightCurveEpoch &;
using S = const LightCurveSample &;

/// Adds columns whose cells are taken from each row's epoch, sample and band.
class RowColumns {
public:
  RowColumns(const LightCurve &curve, Table &table) : curve_(curve), table_(table) {}

  template <class Value, class Take>
  void add(const char *name, const char *unit, const char *text, Take take) {
    std::vector<Value> cells;
    cells.reserve(curve_.samples.size());
    for (std::size_t i = 0; i < curve_.epochs.size(); ++i)
      for (std::size_t b = 0; b < curve_.bands.size(); ++b)
        cells.push_back(
            take(curve_.epochs[i], curve_.samples[i * curve_.bands.size() + b], curve_.bands[b]));
    table_.add(name, unit, text, std::move(cells));
  }
  template <class Take>
  void of_epoch(const char *name, const char *unit, const char *text, Take take) {
    add<double>(name, unit, text, [&](E e, S, const Band &) { return take(e); });
  }
  template <class Take>
  void of_sample(const char *name, const char *unit, const char *text, Take take) {
    add<double>(name, unit, text, [&](E, S s, const Band &) { return take(s); });
  }

private:
  const LightCurve &curve_;
  Table &table_;
};

void add_names(RowColumns &t, const LightCurve &curve) {
  using B = const Band &;
  t.add<std::string>("time_utc", "", "UTC, ISO 8601",
                     [](E e, S, B) { return to_iso(e.geometry.time); });
  t.of_epoch("mjd_utc", "d", "UTC as modified Julian date",
             [](E e) { return mjd(e.geometry.time); });
  t.add<std::string>("name", "", "object", [&](E, S, B) { return curve.object; });
  t.add<std::int64_t>("norad_cat_id", "", "catalogue number",
                      [&](E, S, B) { return std::int64_t{curve.norad_cat_id}; });
  t.add<std::string>("band", "", "band as in the scenario", [](E, S, B b) { return b.name; });
  t.add<double>("lambda_eff", "nm", "wavelength", [](E, S, B b) { return b.wavelength.nm(); });
  t.add<std::string>("pass_id", "", "catalogue number and culmination",
                     [](E e, S, B) { return e.pass_id; });
}

void add_geometry(RowColumns &t) {
  t.of_epoch("sunlit", "", "visible part of the Sun's disk", [](E e) { return e.geometry.sunlit; });
  t.of_epoch("az", "deg", "azimuth from north through east, geometric",
             [](E e) { return e.geometry.azimuth.degrees(); });
  t.of_epoch("alt", "deg", "altitude, geometric",
             [](E e) { return e.geometry.altitude.degrees(); });
  t.of_epoch("ra", "deg", "right ascension, topocentric, GCRS axes",
             [](E e) { return e.geometry.right_ascension.degrees(); });
  t.of_epoch("dec", "deg", "declination, topocentric, GCRS axes",
             [](E e) { return e.geometry.declination.degrees(); });
  t.of_epoch("range", "km", "distance from the site", [](E e) { return e.geometry.range_km; });
  t.of_epoch("range_rate", "km / s", "positive: receding",
             [](E e) { return e.geometry.range_rate_km_s; });
  t.of_epoch("phase_angle", "deg", "Sun-object-observer, 0 = full",
             [](E e) { return e.geometry.phase_angle.degrees(); });
  t.of_epoch("sun_alt", "deg", "altitude of the Sun at the site, airless",
             [](E e) { return e.geometry.sun_altitude.degrees(); });
  t.of_epoch("airmass", "", "Kasten & Young 1989", [](E e) { return e.airmass; });
}

/// Vega's is no unit that readers of ECSV know.
std::string magnitude_unit(MagnitudeSystem magnitudes) {
  return magnitudes == MagnitudeSystem::Vega ? "mag"
                                             : "mag(" + std::string(name_of(magnitudes)) + ")";
}

void add_light(RowColumns &t, PolarizationFrame frame, MagnitudeSystem magnitudes) {
  const auto axis = [frame](E e) { return scattering_axis(e.geometry, frame).degrees(); };
  t.of_sample("I", "W / (m2 nm)", "irradiance at the observer above the atmosphere",
              [](S s) { return s.irradiance; });
  t.of_sample("intensity", "m2 / sr", "without distance and solar flux",
              [](S s) { return s.intensity; });
  t.of_sample("q", "", "Q/I in the sky frame", [](S s) { return s.sky.q; });
  t.of_sample("u", "", "U/I in the sky frame", [](S s) { return s.sky.u; });
  t.of_sample("v", "", "V/I", [](S s) { return s.sky.v; });
  t.of_sample("p", "", "degree of linear polarization", [](S s) { return s.p; });
  t.of_sample("dop", "", "degree of polarization", [](S s) { return s.dop; });
  t.of_sample("pa", "deg", "position angle of polarization, [0, 180)",
              [](S s) { return s.pa_deg; });
  t.of_sample("q_scat", "", "Q/I, + perpendicular to the scattering plane",
              [](S s) { return s.scattering.q; });
  t.of_sample("u_scat", "", "U/I in the scattering frame", [](S s) { return s.scattering.u; });
  t.of_epoch("pa_scat", "deg", "position angle of the normal of the scattering plane", axis);
  const std::string system = name_of(magnitudes);
  const std::string unit = magnitude_unit(magnitudes);
  t.of_sample("mag", unit.c_str(), (system + " magnitude; empty where no light comes").c_str(),
              [](S s) { return s.magnitude; });
  t.add<bool>("mag_limit", "", "mag is a limit: the object is fainter",
              [](E, S s, const Band &) { return has_magnitude_limit(s); });
  t.add<std::string>("mag_system", "", "system of mag",
                     [system](E, S, const Band &) { return system; });
  t.add<bool>("glint", "", "a flat mirror-like part gives most of the light",
              [](E e, S, const Band &) { return e.has_glint; });
}

/// The same behind the air of the site.
void add_observed(Table &table, const LightCurve &curve) {
  std::vector<double> light, magnitude;
  for (std::size_t k = 0; k < curve.samples.size(); ++k) {
    light.push_back(curve.samples[k].irradiance * curve.transmission[k]);
    magnitude.push_back(curve.samples[k].magnitude - 2.5 * std::log10(curve.transmission[k]));
  }
  table.add("I_obs", "W / (m2 nm)", "I behind the air of the site", std::move(light));
  const std::string system = name_of(curve.magnitudes);
  const std::string unit =
      curve.magnitudes == MagnitudeSystem::Vega ? "mag" : "mag(" + system + ")";
  table.add("mag_obs", unit, "mag behind the air; a limit where mag is one", std::move(magnitude));
}

void add_errors(RowColumns &t, PolarizationFrame frame) {
  t.of_sample("intensity_err", "m2 / sr", "numerical 95 % half-width",
              [](S s) { return s.half_width.i; });
  t.of_sample("stokes_q_err", "m2 / sr", "numerical 95 % half-width, scattering frame",
              [](S s) { return s.half_width.q; });
  t.of_sample("stokes_u_err", "m2 / sr", "numerical 95 % half-width, scattering frame",
              [](S s) { return s.half_width.u; });
  t.of_sample("stokes_v_err", "m2 / sr", "numerical 95 % half-width",
              [](S s) { return s.half_width.v; });
  const auto of = [&t](const char *name, const char *unit, const char *text, auto take) {
    t.add<double>(name, unit, text, [take](E e, S s, const Band &) {
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      return std::isnan(s.sky.q) ? none : take(DerivedErrors(s), e, s);
    });
  };
  using D = const DerivedErrors &;
  of("mag_err", "mag", "numerical 95 % half-width of mag", [](D d, E, S) { return d.mag(); });
  of("q_err", "", "numerical 95 % half-width of q, sky frame", [frame](D d, E e, S s) {
    const double twice = 2 * scattering_axis(e.geometry, frame).radians();
    return d.part(s.sky.q, std::cos(twice), std::sin(twice));
  });
  of("u_err", "", "numerical 95 % half-width of u, sky frame", [frame](D d, E e, S s) {
    const double twice = 2 * scattering_axis(e.geometry, frame).radians();
    return d.part(s.sky.u, std::sin(twice), std::cos(twice));
  });
  of("v_err", "", "numerical 95 % half-width of v", [](D d, E, S) { return d.v(); });
  of("p_err", "", "numerical 95 % half-width of p", [](D d, E, S) { return d.p(); });
  of("pa_err", "deg", "numerical 95 % half-width of pa; empty where p is 0",
     [](D d, E, S s) { return s.p > 0 ? d.pa_deg() : std::numeric_limits<double>::quiet_NaN(); });
}

/// Over the ranges that materials state: [materials] vary.
void add_spread(const LightCurve &curve, Table &table) {
  const auto add = [&](const std::string &name, const std::string &unit, Extent SampleSpread::*of) {
    std::vector<double> low, high;
    for (const SampleSpread &s : curve.spread) {
      low.push_back((s.*of).low);
      high.push_back((s.*of).high);
    }
    table.add(name + "_low", unit, "smallest " + name + " over the ranges of haze", std::move(low));
    table.add(name + "_high", unit, "largest " + name + " over the ranges of haze",
              std::move(high));
  };
  if (curve.spread.empty())
    return;
  add("intensity", "m2 / sr", &SampleSpread::intensity);
  add("mag", magnitude_unit(curve.magnitudes), &SampleSpread::magnitude);
  add("p", "", &SampleSpread::p);
  table.note("spread", "*_low, *_high: of three runs, with the haze of every material as given, at "
                       "the low and at the high end of its stated range; all together, as dust "
                       "and age would have them.");
}

/// Of bands with a curve: what summing them from few wavelengths may leave out.
void add_band_errors(RowColumns &t) {
  const char *text = "error of the band's sum of wavelengths (change if every other is left out)";
  t.of_sample("band_err_i", "m2 / sr", text, [](S s) { return s.band_err.i; });
  t.of_sample("band_err_q", "m2 / sr", text, [](S s) { return s.band_err.q; });
  t.of_sample("band_err_u", "m2 / sr", text, [](S s) { return s.band_err.u; });
  t.of_sample("band_err_v", "m2 / sr", text, [](S s) { return s.band_err.v; });
}

/// Light of other sources, not in I: columns of their own.
void add_second_light(Table &table, const SecondLight &light) {
  const std::string of = light.source == SecondSource::Moon ? "moonlight" : "earthshine",
                    source = name_of(light.source);
  table.add(source + "_I", "W / (m2 nm)", "irradiance at the observer by " + of, light.irradiance);
  const auto add = [&](const char *name, const char *text, double Stokes<SkyNorth>::*part) {
    std::vector<double> values;
    for (const Stokes<SkyNorth> &s : light.intensity)
      values.push_back(s.i > 0 ? s.*part / s.i : std::numeric_limits<double>::quiet_NaN());
    table.add(source + name, "", text + of, std::move(values));
  };
  add("_q", "Q/I in the sky frame of ", &Stokes<SkyNorth>::q);
  add("_u", "U/I in the sky frame of ", &Stokes<SkyNorth>::u);
  add("_v", "V/I of ", &Stokes<SkyNorth>::v);
  std::vector<double> irradiance; // of the half-width: in the ratio that I has to its intensity
  for (std::size_t k = 0; k < light.intensity.size(); ++k)
    irradiance.push_back(light.intensity[k].i > 0
                             ? light.half_width[k].i / light.intensity[k].i * light.irradiance[k]
                             : 0);
  table.add(source + "_I_err", "W / (m2 nm)", "numerical 95 % half-width", irradiance);
  const auto add_error = [&](const char *name, double Stokes<SkyNorth>::*part) {
    std::vector<double> values;
    for (std::size_t k = 0; k < light.intensity.size(); ++k)
      values.push_back(light.intensity[k].i > 0 ? light.half_width[k].*part / light.intensity[k].i
                                                : std::numeric_limits<double>::quiet_NaN());
    table.add(source + name, "", "numerical 95 % half-width, over I", std::move(values));
  };
  add_error("_q_err", &Stokes<SkyNorth>::q);
  add_error("_u_err", &Stokes<SkyNorth>::u);
  add_error("_v_err", &Stokes<SkyNorth>::v);
}

/// A CSV is for people: values to two digits of their numerical error, places to a millimetre.
void set_precisions(Table &table) {
  for (const char *name : {"az", "alt", "ra", "dec", "phase_angle", "sun_alt", "pa_scat", "q_scat",
                           "u_scat", "indirect_i", "indirect_q", "indirect_u", "indirect_v"})
    table.set_precision(name, {.decimals = 7}); // .36 mas
  for (const char *name : {"sunlit", "range", "range_rate", "airmass"})
    table.set_precision(name, {.decimals = 6});
  for (const char *name : {"qw", "qx", "qy", "qz"})
    table.set_precision(name, {.decimals = 9});
  for (const char *name : {"mjd_utc", "elset_age"})
    table.set_precision(name, {.decimals = 8}); // a millisecond
  table.set_precision("lambda_eff", {.decimals = 3});
  table.set_precision("I", {.significant = 7});
  for (const char *name : {"intensity", "mag", "q", "u", "v", "p", "pa"}) {
    const std::string error = std::string(name) + "_err";
    table.set_precision(name, {.error = error});
    table.set_precision(std::string(name) + "_low", {.error = error});
    table.set_precision(std::string(name) + "_high", {.error = error});
  }
  table.set_precision("dop", {.error = "p_err"});
  const std::vector<Column> &columns = table.columns();
  for (std::size_t c = 0; c < columns.size(); ++c)
    if (columns[c].name.ends_with("_err") || columns[c].name.starts_with("band_err_"))
      table.set_precision(columns[c].name, {.significant = 2});
}

} // namespace

Table light_curve_table(const LightCurve &curve, PolarizationFrame frame) {
  Table table;
  RowColumns t(curve, table);
  add_names(t, curve);
  add_geometry(t);
  add_light(t, frame, curve.magnitudes);
  if (!curve.transmission.empty())
    add_observed(table, curve);
  if (curve.bounces > 1) {
    t.of_sample("indirect_i", "", "part of I that touched several surfaces",
                [](S s) { return s.indirect.i; });
    t.of_sample("indirect_q", "", "its Q over the whole I, scattering frame",
                [](S s) { return s.indirect.q; });
    t.of_sample("indirect_u", "", "its U over the whole I, scattering frame",
                [](S s) { return s.indirect.u; });
    t.of_sample("indirect_v", "", "its V over the whole I", [](S s) { return s.indirect.v; });
  }
  if (curve.method != LightMethod::Rays)
    t.add<std::string>("method", "", "how hiding was decided: exact, masks, mended or rays",
                       [](E e, S, const Band &) { return std::string(name_of(e.method)); });
  for (const SecondLight &light : curve.second_lights)
    add_second_light(table, light);
  t.of_epoch("qw", "", "attitude body_from_gcrs, scalar", [](E e) { return e.body_from_gcrs.w; });
  t.of_epoch("qx", "", "attitude body_from_gcrs", [](E e) { return e.body_from_gcrs.x; });
  t.of_epoch("qy", "", "attitude body_from_gcrs", [](E e) { return e.body_from_gcrs.y; });
  t.of_epoch("qz", "", "attitude body_from_gcrs", [](E e) { return e.body_from_gcrs.z; });
  t.of_epoch("elset_age", "d", "time since the epoch of the elements",
             [](E e) { return e.elset_age_days; });
  add_errors(t, frame);
  if (has_curve(curve.bands))
    add_band_errors(t);
  add_spread(curve, table);
  set_precisions(table);
  note_conventions(table);
  note_curves(curve.bands, table);
  table.note("object", curve.object);
  table.note("pol_frame", name_of(frame));
  return table;
}

void note_curves(const std::vector<Band> &bands, Table &table) {
  if (!has_curve(bands))
    return;
  table.note("bands",
             "Of a band with a curve every quantity is the photon-weighted mean over its "
             "response in sunlight (ASTM E490), Stokes components before any ratio; "
             "lambda_eff: its effective wavelength. band_err_*: what the mean changes by if "
             "every other wavelength is left out.");
  for (const Band &band : bands)
    if (band.curve)
      table.note("band " + band.name,
                 fmt::format("{:g}-{:g} nm, pivot {:.2f} nm; {}", band.curve->wavelength_nm.front(),
                             band.curve->wavelength_nm.back(), pivot_nm(*band.curve),
                             band.curve->source));
}

Table passes_table(const std::vector<Pass> &passes, const LightCurve &curve) {
  std::vector<std::string> names, ids, rise, culmination, set;
  std::vector<double> altitude;
  std::vector<std::int64_t> numbers, rows;
  std::vector<bool> open_start, open_end;
  for (const Pass &pass : passes) {
    names.push_back(curve.object);
    numbers.push_back(curve.norad_cat_id);
    ids.push_back(pass.id);
    rise.push_back(to_iso(pass.rise));
    culmination.push_back(to_iso(pass.culmination));
    set.push_back(to_iso(pass.set));
    altitude.push_back(pass.culmination_altitude.degrees());
    rows.push_back(static_cast<std::int64_t>(pass.rows));
    open_start.push_back(pass.is_open_at_start);
    open_end.push_back(pass.is_open_at_end);
  }
  Table table;
  table.add("name", "", "object", std::move(names));
  table.add("norad_cat_id", "", "catalogue number", std::move(numbers));
  table.add("pass_id", "", "catalogue number and culmination", std::move(ids));
  table.add("rise_utc", "", "first epoch above the altitude limit", std::move(rise));
  table.add("culmination_utc", "", "highest point", std::move(culmination));
  table.add("set_utc", "", "last epoch above the altitude limit", std::move(set));
  table.add("culmination_alt", "deg", "highest altitude", std::move(altitude));
  table.add("epochs", "", "number of epochs in the light curve", std::move(rows));
  table.add("open_at_start", "", "the pass began before the span", std::move(open_start));
  table.add("open_at_end", "", "the pass goes on after the span", std::move(open_end));
  note_conventions(table);
  table.note("object", curve.object);
  return table;
}

} // namespace umov
