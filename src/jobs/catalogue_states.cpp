#include <umov/jobs/ephemeris.h>

#include "jobs/columns.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <mutex>
#include <umov/core/files.h>
#include <umov/core/parallel.h>
#include <umov/core/text.h>
#include <umov/io/elements_file.h>
#include <umov/orbit/sgp4.h>

namespace umov::jobs {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr TemeState no_state{{none, none, none}, {none, none, none}};

/// Every state that is done, object by object.
Table catalogue_table(const CatalogueStates &all, const std::vector<Epoch<Utc>> &times) {
  Table t;
  std::vector<std::int64_t> ids, codes;
  std::vector<std::string> iso, time_of;
  std::vector<TemeState> rows;
  for (const Epoch<Utc> time : times)
    iso.push_back(to_iso(time));
  for (std::size_t row = 0; row < all.states.size(); ++row) {
    if (all.is_done[row] == 0)
      continue;
    ids.push_back(all.norad_cat_id[row / times.size()]);
    codes.push_back(static_cast<int>(all.codes[row]));
    time_of.push_back(iso[row % times.size()]);
    rows.push_back(all.states[row]);
  }
  t.add("norad_cat_id", "", "catalogue number", std::move(ids));
  t.add("time_utc", "", "UTC", std::move(time_of));
  t.add("error", "", "0, or the SGP4 code with which the object failed", std::move(codes));
  const auto add = [&](const char *name, const char *unit, const char *text, auto take) {
    add_numbers(t, rows, name, unit, text, take);
  };
  using S = const TemeState &;
  add("teme_x", "km", "position, TEME", [](S s) { return s.position_km.x; });
  add("teme_y", "km", "position, TEME", [](S s) { return s.position_km.y; });
  add("teme_z", "km", "position, TEME", [](S s) { return s.position_km.z; });
  add("teme_vx", "km / s", "velocity, TEME", [](S s) { return s.velocity_km_s.x; });
  add("teme_vy", "km / s", "velocity, TEME", [](S s) { return s.velocity_km_s.y; });
  add("teme_vz", "km / s", "velocity, TEME", [](S s) { return s.velocity_km_s.z; });
  return t;
}

/// States that are still to be had, of all objects. Bit by bit, as the system takes seconds to give
/// gigabytes; false where somebody stopped it.
bool make_room(const std::vector<ElementSet> &sets, std::size_t times, const Monitor &monitor,
               CatalogueStates &out) {
  for (const ElementSet &set : sets)
    out.norad_cat_id.push_back(set.norad_cat_id);
  const std::size_t rows = sets.size() * times;
  out.states.reserve(rows);
  out.codes.assign(rows, Sgp4Code::Ok);
  out.is_done.assign(rows, 0);
  constexpr std::size_t at_once = 1u << 20;
  do
    out.states.resize(std::min(rows, out.states.size() + at_once), no_state);
  while (out.states.size() < rows && !monitor.is_cancelled());
  return out.states.size() == rows;
}

/// Objects by times, object by object; parts of blocks of objects are missing after a stop.
void propagate_all(const std::vector<ElementSet> &sets, const std::vector<Epoch<Utc>> &times,
                   unsigned threads, const Monitor &monitor, CatalogueStates &out) {
  std::mutex telling; // one call at a time
  std::size_t done = 0;
  constexpr std::size_t block = 256; // objects side by side in lanes
  parallel_for((sets.size() + block - 1) / block, threads, [&](std::size_t b) {
    const std::size_t first = b * block, count = std::min(block, sets.size() - first);
    std::vector<Sgp4> models;
    for (std::size_t i = 0; i < count; ++i)
      models.emplace_back(sets[first + i]);
    std::vector<double> minutes(count);
    std::vector<TemeState> states(count);
    std::vector<Sgp4Code> codes(count);
    for (std::size_t k = 0; k < times.size() && !monitor.is_cancelled(); ++k) {
      for (std::size_t i = 0; i < count; ++i)
        minutes[i] = clock_days_between(times[k], sets[first + i].epoch) * 1440;
      propagate_objects(models, minutes, states, codes);
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t row = (first + i) * times.size() + k;
        const bool can_start = models[i].init_code() == Sgp4Code::Ok;
        out.codes[row] = can_start ? codes[i] : models[i].init_code();
        out.states[row] = out.codes[row] == Sgp4Code::Ok ? states[i] : no_state;
        out.is_done[row] = 1;
      }
    }
    const std::lock_guard lock(telling);
    monitor.advance("objects", done += count, sets.size());
  });
}

/// A catalogue has many ages: one line for all that are too old to trust, and a refusal only where
/// none is better.
Result<void> check_ages(const StatesRequest &request, bool allow_old,
                        const std::vector<ElementSet> &sets, Diagnostics &diagnostics) {
  if (request.times.empty())
    return {};
  const auto is_earlier = [](Epoch<Utc> a, Epoch<Utc> b) { return seconds_between(a, b) < 0; };
  // The farthest of all times is one of these.
  const auto [first, last] =
      std::minmax_element(request.times.begin(), request.times.end(), is_earlier);
  std::size_t doubtful = 0, old = 0;
  const ElementSet *oldest = nullptr;
  double age_max = 0;
  warn_if_beyond_leap_seconds(*last, diagnostics);
  for (const ElementSet &set : sets) {
    const double age = std::max(std::abs(clock_days_between(*first, set.epoch)),
                                std::abs(clock_days_between(*last, set.epoch)));
    doubtful += age > 7 ? 1u : 0u;
    old += age > 30 ? 1u : 0u;
    if (age > age_max) {
      age_max = age;
      oldest = &set;
    }
  }
  if (doubtful == 0)
    return {};
  const std::string worst =
      fmt::format("the farthest are those of {}, {:.1f} d", oldest->norad_cat_id, age_max);
  if (old == sets.size() && !allow_old)
    return fail(
        ErrorCode::BadInput,
        fmt::format("all elements are more than 30 d from the epochs asked for ({}). Give "
                    "newer ones or pass --allow-old-elements (in Python allow_old_elements=True).",
                    worst),
        {request.orbit, oldest->line});
  diagnostics.warn(
      fmt::format("{} of {} element sets lie more than 7 d from the epochs asked for ({}); expect "
                  "kilometres of error along the track",
                  doubtful, sets.size(), worst),
      {request.orbit, oldest->line});
  return {};
}

/// Warns of the first states that failed; how many did.
std::size_t tell_of_failures(const CatalogueStates &all, const std::vector<Epoch<Utc>> &times,
                             Diagnostics &diagnostics) {
  constexpr std::size_t told_max = 10;
  std::size_t failed = 0;
  for (std::size_t row = 0; row < all.codes.size(); ++row)
    if (all.codes[row] != Sgp4Code::Ok && failed++ < told_max)
      diagnostics.warn(fmt::format("{}: SGP4 fails at {} (code {}, {})",
                                   all.norad_cat_id[row / times.size()],
                                   to_iso(times[row % times.size()]),
                                   static_cast<int>(all.codes[row]), to_text(all.codes[row])));
  if (failed > told_max)
    diagnostics.warn(fmt::format("{} more states failed; see the column error", failed - told_max));
  return failed;
}

} // namespace

Result<CatalogueStates> propagate_catalogue(const StatesRequest &request, const JobOptions &options,
                                            const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_ASSIGN(text, read_file(request.orbit));
  UMOV_ASSIGN(sets, read_elements(text, request.orbit,
                                  {options.allow_bad_checksum, request.keep_going}, diagnostics));
  UMOV_TRY(check_ages(request, options.allow_old_elements, sets, diagnostics));
  CatalogueStates out;
  if (!make_room(sets, request.times.size(), monitor, out))
    return fail(ErrorCode::Interrupted, "stopped by the user before the first state");
  propagate_all(sets, request.times, options.threads, monitor, out);
  const auto done =
      static_cast<std::size_t>(std::count(out.is_done.begin(), out.is_done.end(), char{1}));
  const std::size_t failed = tell_of_failures(out, request.times, diagnostics);
  out.is_partial = done < out.states.size();
  if (out.is_partial)
    out.error = Error{ErrorCode::Interrupted,
                      fmt::format("stopped by the user after {} of {}", done,
                                  counted(out.states.size(), "state")),
                      {}};
  else if (failed == done)
    out.error = Error{
        ErrorCode::Physics, "SGP4 failed for every object; give newer elements", {request.orbit}};
  return out;
}

Result<TableOutcome> catalogue_states(const StatesRequest &request, const JobOptions &options,
                                      const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_ASSIGN(all, propagate_catalogue(request, options, monitor, diagnostics));
  return TableOutcome{catalogue_table(all, request.times), all.is_partial, all.error};
}

} // namespace umov::jobs
