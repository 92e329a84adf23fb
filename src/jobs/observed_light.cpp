#include <umov/jobs/observed_light.h>

#include "jobs/observations_counts.h"
#include "jobs/observations_tdm.h"
#include "jobs/observed_site.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <tuple>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/io/ccsds.h>
#include <umov/io/sites.h>
#include <umov/lightcurve/derived_errors.h>
#include <umov/observation/track.h>
#include <umov/photometry/radiometry.h>

namespace umov::jobs {
namespace {

/// Orbit and site, ready to be asked; nothing here asks how the body is turned.
Result<Track> track_of(const Trajectory &orbit, const Site &site) {
  return Track::make({orbit, site, ShadowModel::Ellipsoid, InertialLaw{}, {}, true});
}

/// One row, or one channel of an exposure, with what it needs to be understood.
struct Placed {
  Epoch<Utc> time{};
  const ObservedRow *row = nullptr;
  const CountRow *count = nullptr;
  const ObservationsFile *file = nullptr;
  std::size_t band = 0; ///< among the scenario's
  Site site;
  std::string_view site_name;
};

/// Rows and counts of one kind.
struct RowTally {
  std::size_t rows = 0, counts = 0;
  void add(std::span<const Placed> all) {
    for (const Placed &one : all)
      ++(one.count != nullptr ? counts : rows);
  }
  /// "24 of 400 counts": of counts, whose rows are made of them; else of rows.
  [[nodiscard]] std::string of(const RowTally &all) const {
    return all.counts > 0 ? fmt::format("{} of {}", counts, counted(all.counts, "count"))
                          : fmt::format("{} of {}", rows, counted(all.rows, "row"));
  }
};

class CurveMaker {
public:
  CurveMaker(const Scenario &scenario, const Trajectory &orbit,
             std::vector<PhotometricBand> colours)
      : scenario_(scenario), orbit_(orbit), colours_(std::move(colours)) {}

  Result<void> add_file(const ObservationsFile &file);
  Result<ObservedLightCurve> make(Diagnostics &diagnostics);

private:
  Result<std::size_t> band_of(const ObservationsFile &file, const std::string &name,
                              std::size_t line) const;
  Result<Site> site_of(const ObservationsFile &file, const ObservedRow &row);
  Result<void> add_epoch(std::span<const Placed> rows, ObservedLightCurve &out);
  [[nodiscard]] ObservedCount count_of(const Placed &placed, const ObservingGeometry &g) const;
  std::size_t set_of(const Placed &placed, std::int64_t set) {
    return sets_.try_emplace({placed.file, placed.band, set}, sets_.size()).first->second;
  }
  void add_count(const Placed &placed, ObservedLightCurve &out);
  [[nodiscard]] ObservedSample sample_of(const Placed &placed, const ObservingGeometry &g) const;
  void warn_of_rows(Diagnostics &diagnostics) const;

  const Scenario &scenario_;
  const Trajectory &orbit_;
  std::vector<PhotometricBand> colours_;
  std::map<std::string, Site> sites_;
  std::vector<Placed> rows_;
  /// Sets of counts by file, band and their number there: each has one for the whole curve.
  std::map<std::tuple<const ObservationsFile *, std::size_t, std::int64_t>, std::size_t> sets_;
  RowTally in_shadow_, below_horizon_, without_error_;
};

Result<std::size_t> CurveMaker::band_of(const ObservationsFile &file, const std::string &name,
                                        std::size_t line) const {
  std::vector<std::string> known;
  for (const Band &band : scenario_.bands)
    known.push_back(band.name);
  if (name.empty() && known.size() == 1)
    return std::size_t{0};
  const auto found = std::ranges::find(known, name);
  if (found != known.end())
    return static_cast<std::size_t>(found - known.begin());
  const auto near = nearest_name(name, known);
  return fail(ErrorCode::BadInput,
              fmt::format("band \"{}\" is not among those of {} ({}){}", printable(name),
                          scenario_.file, fmt::join(known, ", "),
                          near ? fmt::format(". Did you mean \"{}\"?", *near)
                               : "; put it into its bands.set"),
              {file.path, line});
}

Result<Site> CurveMaker::site_of(const ObservationsFile &file, const ObservedRow &row) {
  if (row.site.empty()) {
    if (scenario_.observer)
      return *scenario_.observer;
    return fail(ErrorCode::BadInput,
                "neither the row names a site nor the scenario an [observer]; one of them is "
                "needed",
                {file.path, row.line});
  }
  const auto known = sites_.find(row.site);
  if (known != sites_.end())
    return known->second;
  const auto site = site_from(row.site);
  if (!site)
    return fail(ErrorCode::BadInput, site.error().message, {file.path, row.line});
  sites_[row.site] = *site;
  return *site;
}

Result<void> CurveMaker::add_file(const ObservationsFile &file) {
  UMOV_TRY(check_site(file, scenario_));
  for (const ObservedRow &row : file.rows) {
    UMOV_ASSIGN(band, band_of(file, row.band, row.line));
    UMOV_ASSIGN(site, site_of(file, row));
    rows_.push_back({row.time, &row, nullptr, &file, band, site, row.site});
  }
  for (const CountRow &count : file.counts) { // of the scenario's site, as their rows are
    UMOV_ASSIGN(band, band_of(file, count.band, 0));
    UMOV_ASSIGN(site, site_of(file, file.rows.front()));
    rows_.push_back({count.time, nullptr, &count, &file, band, site, file.rows.front().site});
  }
  return {};
}

ObservedSample CurveMaker::sample_of(const Placed &placed, const ObservingGeometry &g) const {
  ObservedSample out;
  const ObservedRow &row = *placed.row;
  const PhotometricBand &colour = colours_[placed.band];
  const double per_intensity =
      irradiance_at_observer(1, colour.solar, g.sun_distance_km, g.sunlit, g.range_km);
  if (!std::isnan(row.flux)) {
    out.i = row.flux / per_intensity;
    out.i_sd = std::isnan(row.flux_err) ? 0 : row.flux_err / per_intensity;
  } else if (!std::isnan(row.mag)) {
    out.i = colour.zero * std::pow(10, -0.4 * row.mag) / per_intensity;
    const double relative = std::log(10.0) / 2.5 * (std::isnan(row.mag_err) ? 0 : row.mag_err);
    out.i_sd = out.i * relative;
  }
  if (std::isnan(row.q))
    return out;
  const double twice = 2 * scattering_axis(g, placed.file->frame).radians();
  const double c = std::cos(twice), s = std::sin(twice);
  const double qq = std::isnan(row.cov_qq) ? 0 : row.cov_qq;
  const double uu = std::isnan(row.cov_uu) ? 0 : row.cov_uu;
  out.q = row.q * c + row.u * s;
  out.u = row.u * c - row.q * s;
  out.cov_qq = c * c * qq + s * s * uu + 2 * c * s * row.cov_qu;
  out.cov_uu = s * s * qq + c * c * uu - 2 * c * s * row.cov_qu;
  out.cov_qu = c * s * (uu - qq) + (c * c - s * s) * row.cov_qu;
  return out;
}

ObservedCount CurveMaker::count_of(const Placed &placed, const ObservingGeometry &g) const {
  const CountRow &row = *placed.count;
  const double per_intensity = irradiance_at_observer(1, colours_[placed.band].solar,
                                                      g.sun_distance_km, g.sunlit, g.range_km);
  const double twice = 2 * scattering_axis(g, placed.file->frame).radians();
  const double c = std::cos(twice), s = std::sin(twice);
  ObservedCount out;
  out.net = row.counts - row.sky;
  out.sky = row.sky;
  out.fixed_variance = row.var_read + row.sky_err * row.sky_err;
  out.excess2 = row.excess2;
  out.scintillation = row.scintillation;
  out.has_own_pupil = placed.file->has_separate_pupils;
  out.by_i = row.row[0] * per_intensity;
  out.by_q = (row.row[1] * c + row.row[2] * s) * per_intensity;
  out.by_u = (row.row[2] * c - row.row[1] * s) * per_intensity;
  return out;
}

void CurveMaker::add_count(const Placed &placed, ObservedLightCurve &out) {
  ObservedCount count = count_of(placed, out.geometry.back());
  count.epoch = out.curve.epochs.size() - 1;
  count.set = set_of(placed, placed.count->set);
  const auto at = std::ranges::find(out.column, placed.band);
  count.band = static_cast<std::size_t>(at - out.column.begin());
  out.curve.counts.push_back(count);
}

bool is_same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// Two telescopes of a site may measure at one time, but not the same number to its last digit.
bool is_copy(const Placed &a, const Placed &b) {
  if (a.file == b.file || a.band != b.band)
    return false;
  if (a.count != nullptr && b.count != nullptr)
    return a.count->channel == b.count->channel && a.count->counts == b.count->counts &&
           a.count->sky == b.count->sky;
  return a.row != nullptr && b.row != nullptr && a.file->counts.empty() && b.file->counts.empty() &&
         is_same(a.row->flux, b.row->flux) && is_same(a.row->mag, b.row->mag) &&
         is_same(a.row->q, b.row->q) && is_same(a.row->u, b.row->u);
}

Result<void> check_no_row_in_two_files(std::span<const Placed> rows) {
  for (std::size_t b = 1; b < rows.size(); ++b)
    for (std::size_t a = 0; a < b; ++a)
      if (is_copy(rows[a], rows[b]))
        return fail(ErrorCode::BadInput,
                    fmt::format("what was measured at {} stands in {} too: a measurement counts "
                                "once",
                                to_iso(rows[b].time), rows[a].file->path),
                    {rows[b].file->path, rows[b].row != nullptr ? rows[b].row->line : 0});
  return {};
}

/// Rows of one time and site.
Result<void> CurveMaker::add_epoch(std::span<const Placed> rows, ObservedLightCurve &out) {
  UMOV_TRY(check_no_row_in_two_files(rows));
  UMOV_ASSIGN(track, track_of(orbit_, rows.front().site));
  const auto geometry = track.observe(rows.front().time);
  if (!geometry)
    return fail(geometry.error().code, geometry.error().message,
                {rows.front().file->path, rows.front().row ? rows.front().row->line : 0});
  constexpr double least_sunlit = 0.5; // in less, the Earth's air decides what arrives
  if (geometry->sunlit < least_sunlit) {
    in_shadow_.add(rows);
    return {};
  }
  constexpr double least_altitude_deg = -1; // refraction lifts by half a degree
  if (geometry->altitude.degrees() < least_altitude_deg) {
    below_horizon_.add(rows);
    return {};
  }
  ObservedCurve &curve = out.curve;
  const double seconds =
      out.geometry.empty() ? 0 : seconds_between(geometry->time, out.geometry.front().time);
  curve.epochs.push_back({seconds, geometry->to_sun, geometry->to_observer,
                          scenario_.has_solar_disk ? sun_radius_rad(*geometry) : 0,
                          scattering_axis(*geometry, rows.front().file->frame).radians(),
                          irradiance_at_observer(1, 1, geometry->sun_distance_km, geometry->sunlit,
                                                 geometry->range_km)});
  out.geometry.push_back(*geometry);
  for (const Placed &placed : rows) {
    if (placed.count != nullptr) {
      add_count(placed, out);
      continue;
    }
    const ObservedRow &row = *placed.row;
    if ((!std::isnan(row.flux) && std::isnan(row.flux_err)) ||
        (!std::isnan(row.mag) && std::isnan(row.mag_err)))
      without_error_.add({&placed, 1});
    ObservedSample sample = sample_of(placed, *geometry);
    sample.epoch = curve.epochs.size() - 1;
    if (row.set >= 0 && !placed.file->counts.empty())
      sample.set = set_of(placed, row.set);
    const auto at = std::ranges::find(out.column, placed.band);
    sample.band = static_cast<std::size_t>(at - out.column.begin());
    curve.samples.push_back(sample);
  }
  return {};
}

/// Something was seen: brightness above 0, or q and u where none was measured.
bool has_light(const ObservedCurve &curve) {
  const bool is_without_i =
      std::ranges::all_of(curve.samples, [](const ObservedSample &s) { return std::isnan(s.i); });
  return std::ranges::any_of(curve.samples, [&](const ObservedSample &s) {
    return s.i > 0 || (is_without_i && !std::isnan(s.q));
  });
}

/// How many of how many, and why.
void CurveMaker::warn_of_rows(Diagnostics &diagnostics) const {
  RowTally all;
  all.add(rows_);
  const auto warn = [&](const RowTally &some, const char *why) {
    if (some.rows + some.counts > 0)
      diagnostics.warn(some.of(all) + why);
  };
  warn(in_shadow_, " left out: the object was in the Earth's shadow by its orbit");
  warn(below_horizon_, " left out: the object was below the horizon by its orbit; are times, site "
                       "and orbit right?");
  if (all.counts == 0) // those of counts follow from them
    warn(without_error_, " with no error of I: taken as good as --floor allows");
}

Result<ObservedLightCurve> CurveMaker::make(Diagnostics &diagnostics) {
  std::ranges::stable_sort(rows_, [](const Placed &a, const Placed &b) {
    const double apart = seconds_between(a.time, b.time);
    if (std::abs(apart) > 1e-6)
      return apart < 0;
    const auto place = [](const Placed &p) { // channels stand together, by bands
      return p.count != nullptr ? p.band + 1 : std::size_t{0};
    };
    return place(a) < place(b);
  });
  ObservedLightCurve out;
  for (std::size_t b = 0; b < scenario_.bands.size(); ++b)
    if (std::ranges::any_of(rows_, [&](const Placed &p) { return p.band == b; })) {
      out.column.push_back(b);
      out.curve.bands.push_back(scenario_.bands[b].name);
    }
  if (std::ranges::any_of(rows_, [](const Placed &p) { return p.count != nullptr; }) &&
      std::ranges::any_of(rows_, [](const Placed &p) { return p.file->counts.empty(); }))
    return fail(ErrorCode::BadInput,
                "counts beside light curves: one fit takes one or the other. Reduce the counts "
                "(umov reduce), or leave the light curves out",
                {rows_.front().file->path});
  out.curve.is_absolute = std::ranges::all_of(rows_, [](const Placed &p) {
    return p.count != nullptr || p.file->is_absolute || std::isnan(p.row->flux);
  });
  for (std::size_t begin = 0; begin < rows_.size();) {
    std::size_t end = begin + 1;
    while (end < rows_.size() && rows_[end].site_name == rows_[begin].site_name &&
           std::abs(seconds_between(rows_[end].time, rows_[begin].time)) < 1e-6)
      ++end;
    UMOV_TRY(add_epoch(std::span(rows_).subspan(begin, end - begin), out));
    begin = end;
  }
  warn_of_rows(diagnostics);
  if (out.curve.epochs.empty())
    return fail(ErrorCode::BadInput,
                "no row is of a time at which the object stood in sunlight by its orbit, above the "
                "site's horizon: do times, orbit and site belong together?",
                {rows_.front().file->path});
  if (!has_light(out.curve))
    return fail(
        ErrorCode::BadInput,
        "no row has light above 0: nothing was seen of the object, or the sky that was taken "
        "off is too bright. Are units and signs right?",
        {rows_.front().file->path});
  return out;
}

/// The scenario at the times of the observations: its orbit is asked for those.
Scenario over_the_rows(const Scenario &scenario, const std::vector<ObservationsFile> &files) {
  Scenario out = scenario;
  ScenarioTime span = scenario.time.value_or(ScenarioTime{});
  span.start = span.stop = files.front().rows.front().time;
  for (const ObservationsFile &file : files)
    for (const ObservedRow &row : file.rows) {
      if (seconds_between(row.time, span.start) < 0)
        span.start = row.time;
      if (seconds_between(row.time, span.stop) > 0)
        span.stop = row.time;
    }
  out.time = span;
  return out;
}

} // namespace

Result<std::vector<ObservationsFile>> read_observations(const std::vector<std::string> &paths,
                                                        bool has_polarization, unsigned threads,
                                                        std::vector<InputFile> &inputs,
                                                        Diagnostics &diagnostics) {
  std::vector<ObservationsFile> out;
  constexpr std::size_t largest = 1u << 30;
  for (const std::string &path : paths) {
    UMOV_ASSIGN(text, read_file(path, largest));
    const std::string hash = sha256_hex(text);
    if (const auto same = std::ranges::find(inputs, hash, &InputFile::sha256); same != inputs.end())
      return fail(ErrorCode::BadInput,
                  same->path == path
                      ? "is named twice: a measurement counts once"
                      : fmt::format("holds what {} holds: a measurement counts once", same->path),
                  {path});
    UMOV_ASSIGN(file, ccsds::is_message(text) ? observations_of_tdm(text, path, diagnostics)
                      : is_counts_table(text) ? observations_of_counts(text, path, has_polarization,
                                                                       threads, diagnostics)
                                              : read_observations_text(text, path, diagnostics));
    out.push_back(std::move(file));
    inputs.push_back({path, hash});
  }
  return out;
}

Result<ObservedLightCurve> observed_light_curve(const Scenario &scenario,
                                                const std::vector<ObservationsFile> &files,
                                                bool allow_old_elements, Diagnostics &diagnostics,
                                                bool reads_shape, const std::atomic<bool> *cancel) {
  if (!scenario.objects.front().orbit)
    return fail(ErrorCode::BadInput,
                "holds no orbit: object.orbit = { file = ... } says where the object was",
                {scenario.file});
  UMOV_ASSIGN(object, load_object(over_the_rows(scenario, files), 0,
                                  {.allow_old_elements = allow_old_elements,
                                   .reads_shape = reads_shape,
                                   .cancel = cancel},
                                  diagnostics));
  UMOV_ASSIGN(colours, photometric_bands(scenario.bands, scenario.magnitudes));
  CurveMaker maker(scenario, *object.orbit, std::move(colours));
  for (const ObservationsFile &file : files)
    UMOV_TRY(maker.add_file(file));
  UMOV_ASSIGN(out, maker.make(diagnostics));
  out.inputs = object.inputs;
  return out;
}

} // namespace umov::jobs
