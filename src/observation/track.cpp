#include <umov/observation/track.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <umov/core/constants.h>

namespace umov {

AttitudeContext context_of(const ObservingGeometry &g) {
  return {g.time, g.gcrs_km, g.gcrs_velocity_km_s, g.to_sun, g.to_observer};
}

double sun_radius_rad(const ObservingGeometry &g) {
  return std::asin(constants::sun_radius_km / g.sun_distance_km);
}

Result<Track> Track::make(TrackRequest request) {
  const auto shared = std::make_shared<const TrackRequest>(std::move(request));
  UMOV_ASSIGN(attitude, Attitude::make(shared->attitude, [&shared](Epoch<Utc> time) {
                return shared->orbit.at(time).map([&](const OrbitState &state) {
                  return context_of(umov::observe(state, time, shared->site, shared->shadow));
                });
              }));
  return Track(shared, std::move(attitude));
}

Result<ObservingGeometry> Track::observe(Epoch<Utc> time) const {
  return request_->orbit.at(time).map([&](const OrbitState &state) {
    return umov::observe(state, time, request_->site, request_->shadow);
  });
}

Result<TrackPoint> Track::place(const ObservingGeometry &geometry) const {
  UMOV_ASSIGN(body, attitude_.at(context_of(geometry)));
  TrackPoint out{geometry, body, {}, {}};
  out.pose = {normalized(body * geometry.to_sun), normalized(body * geometry.to_observer),
              request_->has_solar_disk ? sun_radius_rad(geometry) : 0};
  if (!request_->joints.empty()) {
    UMOV_ASSIGN(angles, joint_angles(request_->joints, context_of(geometry), body));
    out.joint_angles_rad = std::move(angles);
  }
  return out;
}

Result<TrackPoint> Track::at(Epoch<Utc> time) const {
  UMOV_ASSIGN(geometry, observe(time));
  return place(geometry);
}

namespace {

/// Largest rate of a joint between samples [rad/s]; a table's own steps may be shorter than theirs.
double joint_rate(const MovingJoint &joint, std::size_t which,
                  const std::vector<std::vector<double>> &angles,
                  std::span<const ObservingGeometry> samples) {
  double out = 0;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    if (angles[k].empty() || angles[k - 1].empty())
      continue;
    const double turn = std::remainder(angles[k][which] - angles[k - 1][which], 2 * pi);
    const double dt = std::abs(seconds_between(samples[k].time, samples[k - 1].time));
    out = std::max(out, std::abs(turn) / std::max(dt, 1e-3));
  }
  if (const auto *table = std::get_if<AngleTable>(&joint.motion))
    for (std::size_t k = 1; k < table->time.size(); ++k) {
      const double turn = table->angle_rad[k] - table->angle_rad[k - 1];
      out = std::max(out, std::abs(turn / seconds_between(table->time[k], table->time[k - 1])));
    }
  return out;
}

} // namespace

double Track::half_vector_rate(std::span<const ObservingGeometry> samples) const {
  double half = 0, pointing = 0;
  std::optional<Rotation<Body, Gcrs>> before;
  std::vector<std::vector<double>> angles(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto body = attitude_.at(context_of(samples[k]));
    if (body)
      if (auto now = joint_angles(request_->joints, context_of(samples[k]), *body))
        angles[k] = std::move(*now);
    if (k > 0) {
      const ObservingGeometry &a = samples[k - 1], &b = samples[k];
      const double dt = std::max(std::abs(seconds_between(b.time, a.time)), 1e-3);
      const Vec3<Gcrs> h0 = a.to_sun + a.to_observer, h1 = b.to_sun + b.to_observer;
      if (norm(h0) > 1e-3 && norm(h1) > 1e-3)
        half = std::max(half, angle_between(h0, h1) / dt);
      if (body && before)
        for (int axis = 0; axis < 3; ++axis)
          pointing = std::max(pointing, angle_between(body->row(axis), before->row(axis)) / dt);
    }
    if (body)
      before = *body;
  }
  constexpr double margin = 2;
  const AttitudeRates rates = attitude_.rates();
  double parts = 0; // a joint on a joint turns with both
  for (std::size_t j = 0; j < request_->joints.size(); ++j)
    parts += joint_rate(request_->joints[j], j, angles, samples);
  return margin * (half + parts) + rates.own_rad_s +
         (rates.follows_orbit ? margin * 1.5 * pointing : 0);
}

} // namespace umov
