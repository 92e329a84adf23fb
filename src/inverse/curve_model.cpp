#include <umov/inverse/curve_model.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <umov/core/parallel.h>
#include <umov/inverse/attitude_grid.h>

namespace umov {

Quaternion attitude_at(const Turning &turning, double seconds) {
  return turned(turning.attitude, turning.rate_rad_s * seconds);
}

Pose pose_at(const Turning &turning, const ObservedEpoch &epoch) {
  const auto body = rotation_from<Body, Gcrs>(attitude_at(turning, epoch.seconds));
  return {normalized(body * epoch.to_sun), normalized(body * epoch.to_observer),
          epoch.sun_radius_rad};
}

CurveModel::CurveModel(const ObservedCurve &curve, PoseLighting light,
                       std::vector<std::size_t> column)
    : curve_(curve), light_(std::move(light)), column_(std::move(column)),
      all_(curve.epochs.size()) {
  std::iota(all_.begin(), all_.end(), std::size_t{0});
}

bool CurveModel::for_each(std::span<const Turning> turnings, std::span<const std::size_t> epochs,
                          unsigned threads,
                          const std::function<void(std::size_t, const ModelLight &)> &take) const {
  if (epochs.empty())
    epochs = all_;
  const std::size_t bands = column_.size(), per = epochs.size();
  constexpr std::size_t poses_at_once = 1u << 16; // some megabytes of light
  const std::size_t block = std::max<std::size_t>(1, poses_at_once / std::max<std::size_t>(per, 1));
  StokesTable table;
  std::vector<Pose> poses;
  for (std::size_t begin = 0; begin < turnings.size(); begin += block) {
    const std::size_t count = std::min(block, turnings.size() - begin);
    poses.resize(count * per);
    parallel_for(count, threads, [&](std::size_t k) {
      for (std::size_t e = 0; e < per; ++e)
        poses[k * per + e] = pose_at(turnings[begin + k], curve_.epochs[epochs[e]]);
    });
    if (!light_(poses, table))
      return false;
    poses_lit_ += poses.size();
    const std::size_t size = curve_.epochs.size() * bands;
    const bool has_widths = table.i_err.size() == table.i.size();
    constexpr std::size_t chunk = 64; // turnings that share one buffer
    parallel_for((count + chunk - 1) / chunk, threads, [&](std::size_t c) {
      std::vector<double> i(size), q(size), u(size), width(size);
      for (std::size_t k = c * chunk; k < std::min(count, (c + 1) * chunk); ++k) {
        for (std::size_t e = 0; e < per; ++e)
          for (std::size_t b = 0; b < bands; ++b) {
            const std::size_t from = (k * per + e) * table.bands + column_[b];
            const std::size_t to = epochs[e] * bands + b;
            // A pose whose light is no number counts as dark.
            const bool is_lit = std::isfinite(table.i[from]) && std::isfinite(table.q[from]);
            i[to] = is_lit ? table.i[from] : 0;
            q[to] = is_lit ? table.q[from] : 0;
            u[to] = is_lit ? table.u[from] : 0;
            width[to] = is_lit && has_widths ? table.i_err[from] : 0;
          }
        take(begin + k, {i, q, u, width});
      }
    });
  }
  return true;
}

} // namespace umov
