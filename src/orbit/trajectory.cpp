#include <umov/orbit/trajectory.h>

#include "orbit/interpolation.h"

#include <algorithm>
#include <cmath>
#include <erfa.h>
#include <erfam.h>
#include <fmt/format.h>
#include <limits>
#include <umov/core/quantity.h>
#include <umov/orbit/sgp4.h>
#include <umov/time/span.h>

namespace umov {

struct Trajectory::Body {
  std::string name;
  int norad_cat_id = 0;
  std::optional<ElementSet> elements;
  std::optional<Sgp4> model;
  OrbitEphemeris ephemeris;
};

namespace {

template <class Frame> Vec3<Frame> vec(const std::array<double, 3> &v) {
  return {v[0], v[1], v[2]};
}

/// EME2000 to GCRS: the frame bias of the mean equator and equinox of J2000 (IERS 2010, section
/// 5.4.4).
Vec3<Gcrs> gcrs_from_eme2000(const std::array<double, 3> &v) {
  double bias[3][3], precession[3][3], both[3][3], in[3] = {v[0], v[1], v[2]}, out[3];
  eraBp00(ERFA_DJ00, 0, bias, precession, both); // bias: from GCRS to EME2000
  eraTrxp(bias, in, out);
  return {out[0], out[1], out[2]};
}

const EphemerisSegment *segment_at(const OrbitEphemeris &ephemeris, Epoch<Utc> time) {
  for (const EphemerisSegment &segment : ephemeris.segments)
    if (covers(segment, time))
      return &segment;
  return nullptr;
}

tl::unexpected<Error> not_covered(const OrbitEphemeris &e, Epoch<Utc> time) {
  return fail(ErrorCode::Physics,
              fmt::format("{}: the ephemeris does not cover {}; it holds {}. Shorten the span or "
                          "give a longer ephemeris.",
                          e.name, to_iso(time), spans_text(e.segments)));
}

tl::unexpected<Error> sgp4_failure(const ElementSet &set, Epoch<Utc> time, Sgp4Code code) {
  return fail(
      ErrorCode::Physics,
      fmt::format("{}: SGP4 fails at {} (code {}, {}); the set is {:.1f} d old. Shorten the "
                  "span or give newer elements.",
                  set.norad_cat_id, to_iso(time), static_cast<int>(code), to_text(code),
                  clock_days_between(time, set.epoch)));
}

} // namespace

OrbitState state_in(const EphemerisState &s, OrbitFrame frame) {
  switch (frame) {
  case OrbitFrame::Teme:
    return TemeState{vec<Teme>(s.position_km), vec<Teme>(s.velocity_km_s)};
  case OrbitFrame::Itrs:
    return ItrsState{vec<Itrs>(s.position_km), vec<Itrs>(s.velocity_km_s)};
  case OrbitFrame::Eme2000:
    return GcrsState{gcrs_from_eme2000(s.position_km), gcrs_from_eme2000(s.velocity_km_s)};
  case OrbitFrame::Gcrs:
    break;
  }
  return GcrsState{vec<Gcrs>(s.position_km), vec<Gcrs>(s.velocity_km_s)};
}

Result<void> check_ephemeris(const OrbitEphemeris &ephemeris) {
  if (ephemeris.segments.empty())
    return fail(ErrorCode::BadInput, "the ephemeris has no segment");
  for (const EphemerisSegment &segment : ephemeris.segments) {
    if (segment.states.size() < 2)
      return fail(ErrorCode::BadInput, "a segment of the ephemeris has fewer than two states");
    if (segment.degree < 1 || segment.degree > 31)
      return fail(
          ErrorCode::BadInput,
          fmt::format("the degree of interpolation is {}, expected 1 to 31", segment.degree));
    for (std::size_t k = 0; k < segment.states.size(); ++k) {
      const EphemerisState &s = segment.states[k];
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (!std::isfinite(s.position_km[axis]) || !std::isfinite(s.velocity_km_s[axis]))
          return fail(ErrorCode::BadInput, "the state of " + to_iso(s.time) + " is not finite");
      if (k > 0 && !(seconds_between(s.time, segment.states[k - 1].time) > 0))
        return fail(ErrorCode::BadInput,
                    fmt::format("the state of {} follows that of {}, expected a later time",
                                to_iso(s.time, 6), to_iso(segment.states[k - 1].time, 6)));
    }
    if (seconds_between(segment.first, segment.states.front().time) < -span_edge_s ||
        seconds_between(segment.states.back().time, segment.last) < -span_edge_s ||
        seconds_between(segment.last, segment.first) < 0)
      return fail(ErrorCode::BadInput,
                  fmt::format("the usable span {} to {} is not within the states, {} to {}",
                              to_iso(segment.first), to_iso(segment.last),
                              to_iso(segment.states.front().time),
                              to_iso(segment.states.back().time)));
  }
  return {};
}

Trajectory::Trajectory(const ElementSet &elements) {
  auto body = std::make_shared<Body>();
  body->name = elements.name;
  body->norad_cat_id = elements.norad_cat_id;
  body->elements = elements;
  body->model.emplace(elements);
  body_ = std::move(body);
}

Trajectory::Trajectory(OrbitEphemeris ephemeris) {
  auto body = std::make_shared<Body>();
  body->name = ephemeris.name;
  body->norad_cat_id = ephemeris.norad_cat_id;
  body->ephemeris = std::move(ephemeris);
  body_ = std::move(body);
}

const std::string &Trajectory::name() const { return body_->name; }
int Trajectory::norad_cat_id() const { return body_->norad_cat_id; }
std::string Trajectory::id() const {
  if (body_->norad_cat_id > 0 || body_->elements)
    return std::to_string(body_->norad_cat_id);
  return body_->ephemeris.object_id.empty() ? body_->name : body_->ephemeris.object_id;
}
const ElementSet *Trajectory::elements() const {
  return body_->elements ? &*body_->elements : nullptr;
}
double Trajectory::element_age_days(Epoch<Utc> time) const {
  return body_->elements ? clock_days_between(time, body_->elements->epoch)
                         : std::numeric_limits<double>::quiet_NaN();
}

double Trajectory::search_step_s() const {
  constexpr double shortest = 20, longest = 300;
  if (!body_->elements)
    return shortest;
  const ElementSet &set = *body_->elements;
  const double period_s = 60 * 2 * pi / set.mean_motion;
  return std::clamp(period_s / 48 * std::pow(1 - set.eccentricity, 1.5), shortest, longest);
}

Result<OrbitState> Trajectory::at(Epoch<Utc> time) const {
  if (body_->elements) {
    const ElementSet &set = *body_->elements;
    TemeState state;
    Sgp4Code code = body_->model->init_code();
    if (code == Sgp4Code::Ok)
      code = body_->model->propagate(clock_days_between(time, set.epoch) * 1440, state);
    if (code != Sgp4Code::Ok)
      return sgp4_failure(set, time, code);
    return OrbitState(state);
  }
  const EphemerisSegment *segment = segment_at(body_->ephemeris, time);
  if (segment == nullptr)
    return not_covered(body_->ephemeris, time);
  return state_in(interpolate(*segment, time), segment->frame);
}

std::size_t Trajectory::at(std::span<const Epoch<Utc>> times, std::span<OrbitState> states) const {
  if (!body_->elements) {
    for (std::size_t k = 0; k < times.size(); ++k) {
      const auto state = at(times[k]);
      if (!state)
        return k;
      states[k] = *state;
    }
    return times.size();
  }
  if (body_->model->init_code() != Sgp4Code::Ok)
    return 0;
  std::vector<double> minutes(times.size());
  for (std::size_t k = 0; k < times.size(); ++k)
    minutes[k] = clock_days_between(times[k], body_->elements->epoch) * 1440;
  std::vector<Sgp4Code> codes(times.size());
  std::vector<TemeState> teme(times.size());
  body_->model->propagate(minutes, teme, codes);
  std::copy(teme.begin(), teme.end(), states.begin());
  const auto bad =
      std::find_if(codes.begin(), codes.end(), [](Sgp4Code code) { return code != Sgp4Code::Ok; });
  return static_cast<std::size_t>(bad - codes.begin());
}

} // namespace umov
