#include "orbit/interpolation.h"

#include <algorithm>
#include <array>

namespace umov {
namespace {

constexpr std::size_t nodes_max = 32;

struct Window {
  std::size_t first = 0, count = 0;
};

/// The `count` states around a time, as evenly to both sides as the ends allow.
Window window_at(const EphemerisSegment &segment, Epoch<Utc> time, std::size_t count) {
  const auto &states = segment.states;
  count = std::min({count, states.size(), nodes_max});
  const auto above = std::upper_bound(
      states.begin(), states.end(), time,
      [](Epoch<Utc> t, const EphemerisState &s) { return seconds_between(s.time, t) > 0; });
  const auto place = static_cast<std::size_t>(above - states.begin());
  const std::size_t half = count / 2;
  const std::size_t first = place > half ? place - half : 0;
  return {std::min(first, states.size() - count), count};
}

struct Value {
  double value = 0, derivative = 0;
};

/// The polynomial through values (and derivatives) at the nodes, by divided differences with
/// repeated nodes (Stoer & Bulirsch 2002, section 2.1.5). Times are relative to the one asked for:
/// the value is wanted at 0.
Value newton(const std::array<double, 2 * nodes_max> &t, std::array<double, 2 * nodes_max> c,
             const std::array<double, 2 * nodes_max> &slope, std::size_t count) {
  for (std::size_t order = 1; order < count; ++order)
    for (std::size_t k = count - 1; k >= order; --k)
      c[k] = t[k] == t[k - order] ? slope[k] : (c[k] - c[k - 1]) / (t[k] - t[k - order]);
  Value out{c[count - 1], 0};
  for (std::size_t k = count - 1; k-- > 0;) {
    out.derivative = out.derivative * (0 - t[k]) + out.value;
    out.value = out.value * (0 - t[k]) + c[k];
  }
  return out;
}

EphemerisState lagrange(const EphemerisSegment &segment, Epoch<Utc> time, std::size_t count) {
  const Window w = window_at(segment, time, count);
  std::array<double, 2 * nodes_max> t{}, c{};
  for (std::size_t k = 0; k < w.count; ++k)
    t[k] = seconds_between(segment.states[w.first + k].time, time);
  EphemerisState out{time, {}, {}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < w.count; ++k)
      c[k] = segment.states[w.first + k].position_km[axis];
    out.position_km[axis] = newton(t, c, {}, w.count).value;
    for (std::size_t k = 0; k < w.count; ++k)
      c[k] = segment.states[w.first + k].velocity_km_s[axis];
    out.velocity_km_s[axis] = newton(t, c, {}, w.count).value;
  }
  return out;
}

EphemerisState hermite(const EphemerisSegment &segment, Epoch<Utc> time, std::size_t count) {
  const Window w = window_at(segment, time, count);
  std::array<double, 2 * nodes_max> t{}, c{}, slope{};
  for (std::size_t k = 0; k < w.count; ++k)
    t[2 * k] = t[2 * k + 1] = seconds_between(segment.states[w.first + k].time, time);
  EphemerisState out{time, {}, {}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < w.count; ++k) {
      c[2 * k] = c[2 * k + 1] = segment.states[w.first + k].position_km[axis];
      slope[2 * k + 1] = segment.states[w.first + k].velocity_km_s[axis];
    }
    const Value value = newton(t, c, slope, 2 * w.count);
    out.position_km[axis] = value.value;
    out.velocity_km_s[axis] = value.derivative;
  }
  return out;
}

} // namespace

EphemerisState interpolate(const EphemerisSegment &segment, Epoch<Utc> time) {
  const auto degree = static_cast<std::size_t>(std::max(segment.degree, 1));
  switch (segment.interpolation) {
  case Interpolation::Linear:
    return lagrange(segment, time, 2);
  case Interpolation::Lagrange:
    return lagrange(segment, time, degree + 1);
  case Interpolation::Hermite:
    break;
  }
  return hermite(segment, time, (degree + 1) / 2);
}

} // namespace umov
