#include <umov/io/trajectory_file.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/text.h>
#include <umov/io/elements_file.h>
#include <umov/orbit/select.h>

namespace umov {
namespace {

Result<Trajectory> from_message(std::string_view text, const std::string &file,
                                const TrajectoryRequest &request, Diagnostics &diagnostics) {
  UMOV_ASSIGN(message, ccsds::read_message(text, file, diagnostics));
  if (message.kind == ccsds::Kind::Oem) {
    UMOV_ASSIGN(ephemeris, ephemeris_from_oem(message));
    ephemeris.norad_cat_id = request.norad;
    return Trajectory(ephemeris);
  }
  if (message.kind != ccsds::Kind::Opm)
    return fail(ErrorCode::BadInput,
                fmt::format("is a CCSDS {}; an orbit was expected: TLE, 3LE, OMM, OEM or OPM",
                            ccsds::to_text(message.kind)),
                {file});
  UMOV_ASSIGN(state, state_from_opm(message));
  state.norad_cat_id = request.norad;
  const double age = std::max(std::abs(seconds_between(request.first, state.state.time)),
                              std::abs(seconds_between(request.last, state.state.time))) /
                     86400;
  if (age > 7)
    diagnostics.warn(fmt::format("the state is of {}, {:.1f} d from the span; without drag it is "
                                 "kilometres off",
                                 to_iso(state.state.time), age),
                     {file});
  auto orbit = integrate_orbit(state, request.first, request.last);
  if (!orbit)
    return fail(orbit.error().code, orbit.error().message, {file});
  return Trajectory(*orbit);
}

} // namespace

Result<ccsds::Message> oem_from(const Trajectory &orbit, const std::vector<Epoch<Utc>> &times,
                                Epoch<Utc> created) {
  std::vector<OrbitState> states(times.size());
  if (const std::size_t count = orbit.at(times, states); count < times.size())
    return tl::unexpected(orbit.at(times[count]).error());
  const auto date = [](Epoch<Utc> time) {
    std::string text = to_iso(time, 6);
    text.pop_back(); // TIME_SYSTEM says what Z says
    return text;
  };
  ccsds::Message out;
  out.kind = ccsds::Kind::Oem;
  out.version = "2.0";
  out.header = {{"CREATION_DATE", to_iso(created, 3).substr(0, 19), "", 0},
                {"ORIGINATOR", "UMOV", "", 0}};
  const ElementSet *set = orbit.elements();
  const std::string id =
      set != nullptr ? long_designator(set->international_designator) : orbit.id();
  ccsds::Segment segment;
  segment.metadata = {
      {"OBJECT_NAME", orbit.name().empty() ? "UNKNOWN" : orbit.name(), "", 0},
      {"OBJECT_ID", id.empty() ? "UNKNOWN" : id, "", 0},
      {"CENTER_NAME", "EARTH", "", 0},
      {"REF_FRAME", "TEME", "", 0},
      {"TIME_SYSTEM", "UTC", "", 0},
      {"START_TIME", date(times.front()), "", 0},
      {"STOP_TIME", date(times.back()), "", 0},
      // Not Hermite: SGP4's velocity is not the derivative of its position to 1e-5 km/s.
      {"INTERPOLATION", "LAGRANGE", "", 0},
      {"INTERPOLATION_DEGREE", "9", "", 0}};
  constexpr std::array keys{"X", "Y", "Z", "X_DOT", "Y_DOT", "Z_DOT"};
  for (std::size_t k = 0; k < times.size(); ++k) {
    const auto [r, v] = teme_state(states[k], times[k]);
    const std::array<double, 6> numbers{r.x, r.y, r.z, v.x, v.y, v.z};
    ccsds::Record record{"stateVector", {{"EPOCH", date(times[k]), "", 0}}, 0};
    for (std::size_t i = 0; i < keys.size(); ++i)
      record.fields.push_back({keys[i], shortest(numbers[i]), "", 0});
    segment.data.push_back(std::move(record));
  }
  out.segments.push_back(std::move(segment));
  return out;
}

Result<Trajectory> read_trajectory(std::string_view text, const std::string &file,
                                   const TrajectoryRequest &request, Diagnostics &diagnostics) {
  if (ccsds::is_message(text))
    return from_message(text, file, request, diagnostics);
  TleOptions options;
  options.allow_bad_checksum = request.allow_bad_checksum;
  options.keep_going = request.keep_going;
  UMOV_ASSIGN(sets, read_elements(text, file, options, diagnostics));
  UMOV_ASSIGN(set, choose_elements(sets, request.norad, request.first, file));
  UMOV_TRY(check_element_age(set, request.first, request.last, request.allow_old_elements, file,
                             diagnostics));
  return Trajectory(set);
}

} // namespace umov
