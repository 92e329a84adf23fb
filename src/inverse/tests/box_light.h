#pragma once
// A body whose light is written down here without the engine, and what observers measure of it.

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/random.h>
#include <umov/inverse/attitude_grid.h>
#include <umov/inverse/pose_search.h>

namespace umov {

/// A box whose six faces have colours of their own: diffuse light and a broad lobe, written down
/// here without the engine.
class Box {
public:
  explicit Box(bool is_plain = false) : is_plain_(is_plain) {}
  bool operator()(std::span<const Pose> poses, StokesTable &out) const {
    out.resize(poses.size(), 2);
    const Vec3<Body> normals[] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                  {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    const double colour[6][2] = {{.2, .9}, {.8, .3}, {.5, .5}, {.9, .8}, {.3, .1}, {.6, .9}};
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const Pose &p = poses[k];
      const Vec3<Body> half = normalized(p.sun + p.observer);
      for (std::size_t b = 0; b < 2; ++b) {
        BandResult light;
        for (std::size_t f = 0; f < 6; ++f) {
          const double s = std::max(0.0, dot(normals[f], p.sun));
          const double o = std::max(0.0, dot(normals[f], p.observer));
          const double lobe =
              s > 0 && o > 0 ? std::pow(std::max(0.0, dot(normals[f], half)), 20) : 0;
          light.stokes.i += (is_plain_ ? .5 : colour[f][b]) * s * o + lobe;
          light.stokes.q += 0.2 * lobe;
        }
        out.put(k, b, light);
      }
    }
    return true;
  }

private:
  bool is_plain_;
};

/// A model that is right.
inline CurveErrors no_floor() {
  CurveErrors out;
  out.floor = out.floor_median = 0;
  return out;
}

/// The same, of an instrument whose zero points are known.
inline CurveErrors noise_alone() {
  CurveErrors out = no_floor();
  out.zero_point_sd = 1e-6;
  return out;
}

/// A pass: the Sun stands, the observer moves by 100 deg.
inline ObservedCurve pass(std::size_t epochs) {
  ObservedCurve out;
  out.bands = {"a", "b"};
  for (std::size_t e = 0; e < epochs; ++e) {
    const double a = 0.5 + 1.75 * static_cast<double>(e) / static_cast<double>(epochs);
    ObservedEpoch one;
    one.seconds = static_cast<double>(e) * 10;
    one.to_sun = normalized(Vec3<Gcrs>{1, 0, 0.2});
    one.to_observer = normalized(Vec3<Gcrs>{std::cos(a), std::sin(a), -0.1 + 0.4 * a});
    out.epochs.push_back(one);
  }
  return out;
}

inline double noise(std::uint64_t seed, std::uint64_t index) {
  const auto u = uniform4(seed, 7, index);
  return std::sqrt(-2 * std::log(u[0])) * std::cos(2 * pi * u[1]);
}

/// What an observer at a signal-to-noise ratio measures of it.
inline void observe(ObservedCurve &curve, const PoseLighting &light, const Turning &truth,
                    double snr, std::uint64_t seed) {
  std::vector<Pose> poses;
  for (const ObservedEpoch &e : curve.epochs)
    poses.push_back(pose_at(truth, e));
  StokesTable table;
  ASSERT_TRUE(light(poses, table));
  curve.samples.clear();
  for (std::size_t e = 0; e < curve.epochs.size(); ++e)
    for (std::size_t b = 0; b < 2; ++b) {
      const std::size_t k = 2 * e + b;
      ObservedSample s;
      s.epoch = e;
      s.band = b;
      s.i_sd = 0.6 / snr;
      s.i = 7 * (table.i[k] + s.i_sd * noise(seed, 3 * k));
      s.i_sd *= 7;
      const double q_sd = std::sqrt(2.0) * s.i_sd / std::max(s.i, s.i_sd);
      s.q = table.q[k] / std::max(table.i[k], 1e-9) + q_sd * noise(seed, 3 * k + 1);
      s.u = q_sd * noise(seed, 3 * k + 2);
      s.cov_qq = s.cov_uu = q_sd * q_sd;
      curve.samples.push_back(s);
    }
}

inline SearchOptions small() {
  SearchOptions out;
  out.errors.floor = 0;
  out.errors.floor_median = 0.001;
  out.grid = 8000; // broad lobes: 12 deg apart is enough
  out.starts = 240;
  out.samples = 600;
  return out;
}

} // namespace umov
