#include <umov/attitude/attitude_table.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/quantity.h>
#include <umov/time/span.h>

namespace umov {
namespace {

using Four = std::array<double, 4>;

Four four(const Quaternion &q) { return {q.w, q.x, q.y, q.z}; }
double dot4(const Four &a, const Four &b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}
Rotation<Body, Gcrs> rotation_of(const Four &q) {
  const double n = std::sqrt(dot4(q, q));
  return rotation_from<Body, Gcrs>({q[0] / n, q[1] / n, q[2] / n, q[3] / n});
}

/// Index of the state before a time, so that it and the next one enclose it.
std::size_t before(const AttitudeSegment &segment, Epoch<Utc> time) {
  const auto after = std::upper_bound(
      segment.states.begin(), segment.states.end(), time,
      [](Epoch<Utc> t, const AttitudeState &s) { return seconds_between(s.time, t) > 0; });
  const auto place = static_cast<std::size_t>(after - segment.states.begin());
  return std::clamp<std::size_t>(place, 1, segment.states.size() - 1) - 1;
}

Rotation<Body, Gcrs> slerp(const AttitudeState &a, const AttitudeState &b, double share) {
  const Four p = four(a.body_from_gcrs);
  Four q = four(b.body_from_gcrs);
  double cosine = dot4(p, q);
  if (cosine < 0) { // q and -q are one attitude: the shorter way
    cosine = -cosine;
    for (double &x : q)
      x = -x;
  }
  const double angle = std::acos(std::min(cosine, 1.0)), sine = std::sin(angle);
  const double wp = sine > 1e-9 ? std::sin((1 - share) * angle) / sine : 1 - share,
               wq = sine > 1e-9 ? std::sin(share * angle) / sine : share;
  Four out{};
  for (std::size_t k = 0; k < 4; ++k)
    out[k] = wp * p[k] + wq * q[k];
  return rotation_of(out);
}

Rotation<Body, Gcrs> lagrange(const AttitudeSegment &segment, Epoch<Utc> time) {
  const std::size_t n = segment.states.size();
  const std::size_t count = std::min(static_cast<std::size_t>(segment.degree) + 1, n);
  const std::size_t at = before(segment, time) + 1;
  const std::size_t first = std::min(at > count / 2 ? at - count / 2 : 0, n - count);
  Four sum{}, last{};
  for (std::size_t j = 0; j < count; ++j) {
    const AttitudeState &state = segment.states[first + j];
    Four q = four(state.body_from_gcrs);
    if (j > 0 && dot4(q, last) < 0)
      for (double &x : q)
        x = -x;
    last = q;
    double weight = 1;
    for (std::size_t k = 0; k < count; ++k)
      if (k != j) {
        const Epoch<Utc> other = segment.states[first + k].time;
        weight *= seconds_between(time, other) / seconds_between(state.time, other);
      }
    for (std::size_t k = 0; k < 4; ++k)
      sum[k] += weight * q[k];
  }
  return rotation_of(sum);
}

double within_half_turn(double angle) { return std::remainder(angle, 2 * pi); }

/// Cubic of two values and two rates at share s of the step h.
double cubic(double a, double b, double rate_a, double rate_b, double h, double s) {
  const double s2 = s * s, s3 = s2 * s;
  return a * (2 * s3 - 3 * s2 + 1) + b * (3 * s2 - 2 * s3) + h * rate_a * (s3 - 2 * s2 + s) +
         h * rate_b * (s3 - s2);
}

/// Body axes of a spin: +Z along the axis, turned about it by `angle` from the meridian (3-2-3).
Rotation<Body, Gcrs> spin_rotation(double alpha, double delta, double angle) {
  const double ca = std::cos(alpha), sa = std::sin(alpha), cd = std::cos(delta),
               sd = std::sin(delta), c = std::cos(angle), s = std::sin(angle);
  const Vec3<Gcrs> south{sd * ca, sd * sa, -cd}, east{-sa, ca, 0}, axis{cd * ca, cd * sa, sd};
  return {south * c + east * s, east * c - south * s, axis};
}

Rotation<Body, Gcrs> between_spins(const AttitudeState &a, const AttitudeState &b, double h,
                                   double share) {
  const SpinState &p = *a.spin, &q = *b.spin;
  const double alpha = p.right_ascension_rad +
                       share * within_half_turn(q.right_ascension_rad - p.right_ascension_rad);
  const double delta = p.declination_rad + share * (q.declination_rad - p.declination_rad);
  const double expected = p.angle_rad + h * 0.5 * (p.rate_rad_s + q.rate_rad_s);
  const double end = expected + within_half_turn(q.angle_rad - expected);
  return spin_rotation(alpha, delta, cubic(p.angle_rad, end, p.rate_rad_s, q.rate_rad_s, h, share));
}

} // namespace

Result<void> check_attitude_table(const AttitudeTable &table) {
  const auto refuse = [](const std::string &text) { return fail(ErrorCode::BadInput, text); };
  if (table.segments.empty())
    return refuse("the attitude table has no segment");
  for (const AttitudeSegment &segment : table.segments) {
    if (segment.states.size() < 2)
      return refuse("a segment of the attitude table has fewer than two attitudes");
    for (std::size_t k = 0; k < segment.states.size(); ++k) {
      const AttitudeState &s = segment.states[k];
      if (s.spin.has_value() != segment.states[0].spin.has_value())
        return refuse("a segment of the attitude table mixes spins and quaternions");
      if (k > 0 && !(seconds_between(s.time, segment.states[k - 1].time) > 0))
        return refuse(fmt::format("the attitude of {} follows that of {}, expected a later time",
                                  to_iso(s.time, 6), to_iso(segment.states[k - 1].time, 6)));
    }
  }
  return {};
}

double rate_bound_rad_s(const AttitudeTable &table) {
  double out = 0;
  for (const AttitudeSegment &segment : table.segments)
    for (std::size_t k = 1; k < segment.states.size(); ++k) {
      const AttitudeState &a = segment.states[k - 1], &b = segment.states[k];
      const double h = seconds_between(b.time, a.time);
      if (b.spin) {
        const double axis =
            std::abs(within_half_turn(b.spin->right_ascension_rad - a.spin->right_ascension_rad)) +
            std::abs(b.spin->declination_rad - a.spin->declination_rad);
        out = std::max(out,
                       1.5 * std::max(std::abs(a.spin->rate_rad_s), std::abs(b.spin->rate_rad_s)) +
                           2 * axis / h);
        continue;
      }
      const double cosine = std::abs(dot4(four(a.body_from_gcrs), four(b.body_from_gcrs)));
      out = std::max(out, 2 * 2 * std::acos(std::min(cosine, 1.0)) / h);
    }
  return out;
}

Result<Rotation<Body, Gcrs>> attitude_in(const AttitudeTable &table, Epoch<Utc> time) {
  for (const AttitudeSegment &segment : table.segments) {
    if (!covers(segment, time))
      continue;
    const std::size_t k = before(segment, time);
    const AttitudeState &a = segment.states[k], &b = segment.states[k + 1];
    const double h = seconds_between(b.time, a.time);
    const double share = std::clamp(seconds_between(time, a.time) / h, 0.0, 1.0);
    if (a.spin)
      return between_spins(a, b, h, share);
    return segment.degree > 1 ? lagrange(segment, time) : slerp(a, b, share);
  }
  return fail(ErrorCode::Physics,
              fmt::format("the attitude of {} is not given for {}; the table holds {}. Shorten "
                          "[time] or give a longer one.",
                          table.name, to_iso(time), spans_text(table.segments)));
}

} // namespace umov
