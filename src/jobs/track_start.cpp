#include "jobs/track_start.h"

#include "jobs/invert_tables.h"
#include "jobs/track_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <nlohmann/json.hpp>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/io/modes_file.h>
#include <utility>

namespace umov::jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// A note of modes.ecsv. BadInput without it.
Result<std::string> note_of(const ModesFile &file, const std::string &path, const char *key) {
  const auto found = file.notes.find(key);
  if (found != file.notes.end())
    return found->second;
  return fail(
      ErrorCode::BadInput,
      fmt::format("the header does not say {}, which modes.ecsv of umov invert pose, spin "
                  "and track do: ask again with this version, or write a line \"# {}: ...\"",
                  key, key),
      {path});
}

Result<Epoch<Utc>> time_of(const ModesFile &file, const std::string &path, const char *key) {
  UMOV_ASSIGN(text, note_of(file, path, key));
  const auto time = utc_from_iso(text);
  if (!time)
    return fail(ErrorCode::BadInput, fmt::format("{}: {}", key, time.error().message), {path});
  return *time;
}

Result<double> number_of(const ModesFile &file, const std::string &path, const char *key) {
  UMOV_ASSIGN(text, note_of(file, path, key));
  const auto value = parse_number(text);
  if (!value || !(*value >= 0))
    return fail(
        ErrorCode::BadInput,
        fmt::format("{} = \"{}\"; a number of 0 or more was expected", key, printable(text)),
        {path});
  return *value;
}

/// BadInput where a start is about another body than the scenario's, or about light in another
/// unit. `text_of`: what it says under a key; empty: nothing.
Result<void> check_frame(const TrackFrame &frame, const std::string &path,
                         const std::function<std::string(const char *)> &text_of) {
  const BodyWords body{text_of(mesh_note), text_of(materials_note)};
  if (const auto other = difference_of(body, frame.body, "the start", "the scenario"))
    return fail(ErrorCode::BadInput,
                "the start is about another body than the scenario's: " + *other +
                    ". Take the scenario that the answer was made with, or search anew with umov "
                    "invert pose or spin",
                {path});
  const std::string unit = text_of(unit_note), wanted = unit_of_light(frame.is_absolute);
  if (unit != wanted)
    return fail(ErrorCode::BadInput,
                fmt::format("the start is about light in \"{}\", and these observations are in "
                            "\"{}\": the scale of one says nothing of the other. Give both as "
                            "fluxes of one unit, or both as magnitudes or irradiances",
                            printable(unit), wanted),
                {path});
  return {};
}

/// The same of modes, which tables made by hand may leave unsaid.
Result<void> check_frame(const TrackFrame &frame, const ModesFile &file, const std::string &path,
                         Diagnostics &diagnostics) {
  for (const char *key : {mesh_note, materials_note, unit_note})
    if (!file.notes.contains(key)) {
      diagnostics.warn(fmt::format("the header does not say {}: whether the start is about this "
                                   "body and light of this unit is not checked",
                                   key),
                       {path});
      return {};
    }
  return check_frame(frame, path, [&](const char *key) { return file.notes.at(key); });
}

/// The rate of a body that was taken for one that does not turn.
std::vector<double> with_rate(const std::vector<double> &attitude, double rate_sd) {
  std::vector<double> out(36, 0);
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c)
      out[6 * r + c] = attitude[3 * r + c];
    out[6 * (r + 3) + r + 3] = rate_sd * rate_sd;
  }
  return out;
}

/// Why a mode of a file, which anyone may have changed, cannot be followed; empty: it can.
std::string flaw_of(const TrackMode &mode, const TrackFrame &frame) {
  constexpr double fastest_rad_s = 1000, of_length = 1e-6, rounding = 1e-3;
  std::size_t count = frame.errors.has_clouds ? 1 : frame.bands.size();
  for (const PartKind &part : frame.parts)
    count += part.unknowns();
  const std::size_t n = 6 + count;
  if (mode.nuisances.size() != count || mode.covariance.size() != n * n)
    return fmt::format("{} nuisances and a covariance of {} numbers, where {} and {} were expected",
                       mode.nuisances.size(), mode.covariance.size(), count, n * n);
  const auto is_finite = [](double x) { return std::isfinite(x); };
  if (!std::ranges::all_of(mode.nuisances, is_finite) ||
      !std::ranges::all_of(mode.covariance, is_finite) || !std::isfinite(mode.log_weight))
    return "a number that is not finite";
  const Quaternion &q = mode.turning.attitude;
  if (!(std::abs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < of_length))
    return "an attitude that is no quaternion of length 1";
  if (const double rate = norm(mode.turning.rate_rad_s); !(rate < fastest_rad_s))
    return fmt::format("a rate of {:.4g} rad/s, where less than {} was expected", rate,
                       fastest_rad_s);
  if (!(mode.scale > 0 && std::isfinite(mode.scale)))
    return fmt::format("scale = {}, where a number above 0 was expected", mode.scale);
  if (!(mode.chi2 >= 0))
    return fmt::format("chi2 = {}, where 0 or more was expected", mode.chi2);
  // A variance below 0 would be taken for what is known exactly.
  for (std::size_t r = 0; r < n; ++r)
    for (std::size_t c = 0; c <= r; ++c) {
      const double variance = mode.covariance[r * n + r], one = mode.covariance[r * n + c],
                   other = mode.covariance[c * n + r];
      const double most = std::sqrt(variance * mode.covariance[c * n + c]);
      if (!(variance > 0))
        return fmt::format("a variance of {:.4g}, where one above 0 was expected", variance);
      if (!(std::abs(one - other) <= rounding * most && std::abs(one) <= (1 + rounding) * most))
        return fmt::format("a covariance of {:.4g} and {:.4g}, where standard deviations leave at "
                           "most {:.4g}, alike both ways",
                           one, other, most);
    }
  return {};
}

/// The posterior of a search whose modes do not describe it.
Result<void> take_samples(const TrackStartFile &from, const TrackFrame &frame, double rate_sd,
                          TrackStart &out) {
  UMOV_ASSIGN(rows, read_samples_text(from.samples, from.samples_path));
  std::vector<PoseSample> samples;
  samples.reserve(rows.size());
  for (const SampleRow &row : rows)
    samples.push_back({{row.attitude, {}}, row.weight, 0, 0, row.scale});
  out.modes = track_modes_around(std::move(samples), rate_sd, frame.is_absolute, frame.bands.size(),
                                 frame.parts, frame.errors);
  out.searched = name_of(Verdict::Ambiguous); // all that it allows is followed
  out.memory.was_spread = true;
  out.inputs.push_back({from.samples_path, sha256_hex(from.samples)});
  return {};
}

Result<TrackStart> start_of_modes(const TrackStartFile &from, const TrackFrame &frame,
                                  double rate_sd, Diagnostics &diagnostics) {
  const std::string &path = from.path;
  UMOV_ASSIGN(file, read_modes_text(from.text, path));
  TrackStart out;
  UMOV_ASSIGN(epoch, time_of(file, path, epoch_note));
  UMOV_ASSIGN(until, time_of(file, path, until_note));
  UMOV_ASSIGN(median, number_of(file, path, median_note));
  UMOV_ASSIGN(floor, number_of(file, path, floor_note));
  UMOV_ASSIGN(searched, note_of(file, path, verdict_note));
  UMOV_TRY(check_frame(frame, file, path, diagnostics));
  out.time = until;
  out.median_i = median;
  out.floor = floor;
  out.searched = searched;
  const auto doubt = file.notes.find(doubt_note);
  if (!from.samples.empty() && !file.has_rates && doubt != file.notes.end() &&
      doubt->second == width_alone) {
    UMOV_TRY(take_samples(from, frame, rate_sd, out));
    return out;
  }
  for (const ModesRow &row : file.rows) {
    const auto covariance = file.has_rates ? row.covariance : with_rate(row.covariance, rate_sd);
    TrackMode mode = track_mode({row.attitude, row.rate_rad_s}, covariance, row.scale,
                                frame.is_absolute, frame.bands.size(), frame.parts, frame.errors);
    mode.number = out.modes.size() + 1;
    mode.log_weight = std::log(row.weight);
    if (const std::string flaw = flaw_of(mode, frame); !flaw.empty())
      return fail(ErrorCode::BadInput,
                  fmt::format("row {} has {}; modes.ecsv of umov invert pose, spin or track was "
                              "expected",
                              mode.number, flaw),
                  {path});
    if (file.has_rates)
      mode = turned_on(mode, seconds_between(until, epoch), 0);
    out.modes.push_back(std::move(mode));
  }
  std::ranges::stable_sort(out.modes, std::greater<>(), &TrackMode::log_weight);
  double sum = 0;
  for (const TrackMode &mode : out.modes)
    sum += weight_of(mode);
  for (TrackMode &mode : out.modes)
    mode.log_weight -= std::log(sum);
  return out;
}

/// What the unknowns of a state are, in words that must be the same.
ordered_json frame_json(const TrackFrame &frame) {
  ordered_json parts = ordered_json::array();
  for (const PartKind &part : frame.parts)
    parts.push_back({{"name", part.name}, {"sd", part.sd}, {"slope_sd", part.slope_sd}});
  return {{"bands", frame.bands}, {"parts", parts}, {"clouds", frame.errors.has_clouds}};
}

/// A whole number. The library for JSON would make one of -1 and of 1e30 as well.
std::size_t count_at(const json &object, const char *key) {
  constexpr std::uint64_t most = std::uint64_t{1} << 53;
  const json &value = object.at(key);
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > most)
    throw Failure(Error{ErrorCode::BadInput,
                        fmt::format("{} = {}, where a whole number from 0 on was expected", key,
                                    value.dump(-1, ' ', false, json::error_handler_t::replace)),
                        {}});
  return value.get<std::size_t>();
}

TrackMode mode_of(const json &one) {
  TrackMode out;
  out.number = count_at(one, "number");
  const auto q = one.at("q").get<std::array<double, 4>>();
  const auto w = one.at("rate_rad_s").get<std::array<double, 3>>();
  out.turning = {{q[0], q[1], q[2], q[3]}, {w[0], w[1], w[2]}};
  one.at("nuisances").get_to(out.nuisances);
  one.at("covariance").get_to(out.covariance);
  one.at("log_weight").get_to(out.log_weight);
  one.at("scale").get_to(out.scale);
  one.at("chi2").get_to(out.chi2);
  out.measurements = count_at(one, "measurements");
  return out;
}

/// Why those of a state are none; empty: they are. Names of theirs are counted on.
std::string flaw_of(const TrackStart &start, const TrackFrame &frame) {
  constexpr double rounding = 1e-6;
  if (start.modes.empty() || !(start.median_i >= 0 && start.floor >= 0))
    return "no mode, or a floor below 0";
  double sum = 0;
  for (const TrackMode &mode : start.modes) {
    if (const std::string flaw = flaw_of(mode, frame); !flaw.empty())
      return fmt::format("mode {} has {}", mode.number, flaw);
    sum += weight_of(mode);
  }
  if (!(std::abs(sum - 1) < rounding))
    return fmt::format("the weights of its modes add up to {:.6g}, where 1 was expected", sum);
  return {};
}

Result<TrackStart> start_of_state(const std::string &text, const std::string &path,
                                  const TrackFrame &frame) {
  const json all = json::parse(text, nullptr, false);
  const auto no_state = [&](const std::string &why) {
    return fail(ErrorCode::BadInput,
                fmt::format("{}; state.json of umov invert track was expected", why), {path});
  };
  const auto text_of = [&](const char *key) {
    return all.contains(key) && all[key].is_string() ? all[key].get<std::string>() : "";
  };
  if (!all.is_object() || text_of("question") != "track" || !all.contains("modes"))
    return no_state("no state of a tracking");
  if (!text_of("lost_because").empty())
    return fail(ErrorCode::BadInput,
                fmt::format("that tracking was lost at {}: begin anew, with umov invert pose or "
                            "spin of later observations",
                            printable(text_of("time_utc"))),
                {path});
  UMOV_TRY(check_frame(frame, path, text_of));
  const ordered_json wanted = frame_json(frame);
  for (const char *key : {"bands", "parts", "clouds"})
    if (!all.contains(key) || all[key] != json(wanted[key]))
      return fail(ErrorCode::BadInput,
                  fmt::format("its {} are others than those of this scenario and these options: go "
                              "on with the same, or begin from its modes.ecsv",
                              key),
                  {path});
  TrackStart out;
  try {
    const auto time = utc_from_iso(all.at("time_utc").get<std::string>());
    if (!time)
      return no_state("time_utc: " + time.error().message);
    out.time = *time;
    all.at("median_intensity").get_to(out.median_i);
    all.at("floor").get_to(out.floor);
    all.at("search_verdict").get_to(out.searched);
    out.memory.misses = count_at(all, "misses");
    out.memory.next_number = count_at(all, "next_number");
    all.at("is_wide").get_to(out.memory.is_wide);
    all.at("was_spread").get_to(out.memory.was_spread);
    all.at("missed_utc").get_to(out.missed_utc);
    for (const json &one : all.at("modes"))
      out.modes.push_back(mode_of(one));
  } catch (const json::exception &e) {
    return no_state(e.what());
  } catch (const Failure &e) {
    return no_state(e.error().message);
  }
  if (const std::string flaw = flaw_of(out, frame); !flaw.empty())
    return no_state(flaw);
  return out;
}

} // namespace

Result<TrackStartFile> open_track_start(const std::string &path) {
  namespace fs = std::filesystem;
  if (path.empty())
    return fail(ErrorCode::Usage,
                "--start is missing: a tracking follows attitudes that are known by then. Name the "
                "folder of an answer of umov invert pose or spin about the first observations");
  fs::path file = path, samples;
  std::error_code none;
  if (fs::is_directory(file, none)) {
    const fs::path state = file / "state.json";
    samples = file / "samples.ecsv";
    file = fs::exists(state, none) ? state : file / "modes.ecsv";
    if (!fs::exists(file, none))
      return fail(
          ErrorCode::BadInput,
          "the folder has neither state.json nor modes.ecsv; an answer of umov invert pose, "
          "spin or track was expected",
          {path});
  }
  UMOV_ASSIGN(text, read_file(file));
  TrackStartFile out{file.string(), std::move(text)};
  if (!samples.empty() && fs::exists(samples, none)) {
    UMOV_ASSIGN(rows, read_file(samples));
    out.samples_path = samples.string();
    out.samples = std::move(rows);
  }
  return out;
}

Result<TrackStart> read_track_start(const TrackStartFile &file, const TrackFrame &frame,
                                    double rate_sd, Diagnostics &diagnostics) {
  const bool is_state = file.text.starts_with('{');
  UMOV_ASSIGN(out, is_state ? start_of_state(file.text, file.path, frame)
                            : start_of_modes(file, frame, rate_sd, diagnostics));
  if (out.searched == name_of(Verdict::NoFit))
    return fail(ErrorCode::BadInput,
                "the search or tracking that it began with explains nothing (no_fit): there is no "
                "attitude to be followed",
                {file.path});
  out.inputs.push_back({file.path, sha256_hex(file.text)});
  return out;
}

Result<void> check_brightness(const TrackStartFile &file, const TrackFrame &frame,
                              double start_median, double median,
                              const std::function<Result<LightRange>()> &expected) {
  constexpr double most = 1000; // what a glint is above the rest, and no median
  if (frame.is_absolute || !(start_median > 0) || !(median > 0) ||
      (median < most * start_median && start_median < most * median))
    return {};
  UMOV_ASSIGN(light, expected());
  if (light.most > 0 && median < most * light.most && light.least < most * median)
    return {};
  return fail(ErrorCode::BadInput,
              fmt::format("in the median these observations are {:.2g} times as bright as those "
                          "that the start is about (distance and sunlight taken out): are both "
                          "fluxes of one unit?",
                          median / start_median),
              {file.path});
}

std::string searched_by(const TrackStart &state, Verdict verdict) {
  if (verdict == Verdict::NoFit)
    return name_of(verdict);
  return state.memory.is_wide ? name_of(Verdict::Undetermined) : state.searched;
}

std::string state_json(const TrackStart &state, const TrackFrame &frame, TrackLoss loss,
                       Verdict verdict) {
  ordered_json out;
  out["program"] = "umov";
  out["question"] = "track";
  out["time_utc"] = to_iso_exact(state.time);
  out[mesh_note] = frame.body.mesh;
  out[materials_note] = frame.body.materials;
  out[unit_note] = unit_of_light(frame.is_absolute);
  out.update(frame_json(frame));
  out["median_intensity"] = state.median_i;
  out["floor"] = state.floor;
  out["search_verdict"] = searched_by(state, verdict);
  out["misses"] = state.memory.misses;
  out["missed_utc"] = state.missed_utc;
  out["next_number"] = state.memory.next_number;
  out["is_wide"] = state.memory.is_wide;
  out["was_spread"] = state.memory.was_spread;
  if (loss != TrackLoss::None)
    out["lost_because"] = loss == TrackLoss::Misfit ? "misfit" : "open";
  ordered_json modes = ordered_json::array();
  for (const TrackMode &mode : state.modes) {
    const Quaternion q = mode.turning.attitude;
    const Vec3<Body> w = mode.turning.rate_rad_s;
    modes.push_back({{"number", mode.number},
                     {"log_weight", mode.log_weight},
                     {"q", {q.w, q.x, q.y, q.z}},
                     {"rate_rad_s", {w.x, w.y, w.z}},
                     {"nuisances", mode.nuisances},
                     {"covariance", mode.covariance},
                     {"scale", mode.scale},
                     {"chi2", mode.chi2},
                     {"measurements", mode.measurements}});
  }
  out["modes"] = modes;
  return out.dump(1) + "\n";
}

} // namespace umov::jobs
