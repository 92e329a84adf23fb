#include "jobs/track_tables.h"

#include "jobs/columns.h"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/quantity.h>
#include <umov/inverse/attitude_grid.h>

namespace umov::jobs {
namespace {

std::size_t size_of(const TrackMode &mode) { return 6 + mode.nuisances.size(); }

double covariance_at(const TrackMode &mode, std::size_t row, std::size_t column) {
  return mode.covariance[row * size_of(mode) + column];
}

} // namespace

double weight_of(const TrackMode &mode) { return std::exp(mode.log_weight); }

double scale_of(const TrackMode &mode, const TrackFrame &frame) {
  const std::size_t gains = frame.errors.has_clouds ? 1 : frame.bands.size();
  double sum = 0;
  for (std::size_t g = 0; g < gains; ++g)
    sum += mode.nuisances[g];
  return sum / static_cast<double>(gains);
}

PoseAnswer answer_of(const TrackStart &now, const TrackFrame &frame) {
  PoseAnswer out;
  out.errors = frame.errors;
  for (const TrackMode &mode : now.modes) {
    PoseMode one;
    one.turning = mode.turning;
    for (std::size_t r = 0; r < 6; ++r)
      for (std::size_t c = 0; c < 6; ++c)
        one.covariance.push_back(covariance_at(mode, r, c));
    one.weight = weight_of(mode);
    one.chi2 = mode.chi2;
    one.scale = scale_of(mode, frame);
    // Points at sqrt(3) standard deviations along each axis: the same spread, if not the same
    // corners.
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const double sign : {-1.0, 1.0}) {
        const double by = sign * std::sqrt(3 * std::max(covariance_at(mode, axis, axis), 0.0));
        Vec3<Body> turn{};
        (axis == 0 ? turn.x : axis == 1 ? turn.y : turn.z) = by;
        out.samples.push_back({{turned(mode.turning.attitude, turn), mode.turning.rate_rad_s},
                               one.weight / 6,
                               0,
                               mode.chi2});
      }
    out.modes.push_back(std::move(one));
  }
  if (!out.modes.empty()) {
    out.chi2 = now.modes.front().chi2;
    out.measurements = now.modes.front().measurements;
  }
  return out;
}

namespace {

void add_states(Table &table, const std::vector<TrackRow> &rows) {
  const char *const axes[] = {"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k)
    add_numbers(table, rows, fmt::format("rate_{}", axes[k]).c_str(), "deg / s",
                "angular velocity, body axes", [&](const TrackRow &row) {
                  const Vec3<Body> w = row.mode.turning.rate_rad_s * (1 / rad_per_deg);
                  return k == 0 ? w.x : k == 1 ? w.y : w.z;
                });
  for (std::size_t k = 0; k < 6; ++k) {
    const bool is_rate = k >= 3;
    add_numbers(table, rows, fmt::format("{}sd_{}", is_rate ? "rate_" : "", axes[k % 3]).c_str(),
                is_rate ? "deg / s" : "deg",
                is_rate ? "standard deviation of the rate"
                        : "standard deviation of the attitude, body axes",
                [&](const TrackRow &row) {
                  return std::sqrt(std::max(covariance_at(row.mode, k, k), 0.0)) / rad_per_deg;
                });
  }
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = r; c < 3; ++c)
      add_numbers(table, rows, fmt::format("cov_{}{}", axes[r], axes[c]).c_str(), "rad2",
                  "of the rotation vector in body axes",
                  [&](const TrackRow &row) { return covariance_at(row.mode, r, c); });
}

} // namespace

Table track_table(const TrackHistory &history, const TrackFrame &frame) {
  const std::vector<TrackRow> &rows = history.rows;
  std::vector<std::string> time;
  std::vector<std::int64_t> number, measurements;
  std::vector<Quaternion> attitudes;
  for (const TrackRow &row : rows) {
    time.push_back(row.time_utc);
    number.push_back(static_cast<std::int64_t>(row.mode.number));
    measurements.push_back(static_cast<std::int64_t>(row.measurements));
    attitudes.push_back(row.mode.turning.attitude);
  }
  Table out;
  out.add("time_utc", "", "UTC", std::move(time));
  out.add("mode", "", "number of the filter; heaviest first at each epoch", std::move(number));
  add_numbers(out, rows, "weight", "", "share of the probability",
              [](const TrackRow &row) { return weight_of(row.mode); });
  add_attitude_columns(out, attitudes, "body_from_gcrs at that time, scalar first");
  add_states(out, rows);
  add_numbers(out, rows, "scale", "", "observed over model, mean of the bands",
              [&](const TrackRow &row) { return scale_of(row.mode, frame); });
  add_numbers(out, rows, "chi2", "", "of the innovation: what came against what was expected",
              [](const TrackRow &row) { return row.chi2; });
  out.add("measurements", "", "numbers of that epoch", std::move(measurements));
  note_conventions(out);
  out.note("attitude", "qw qx qy qz: body_from_gcrs, scalar first: v_body = conj(q) v_gcrs q");
  return out;
}

} // namespace umov::jobs
