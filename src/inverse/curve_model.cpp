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

namespace {

/// A direction that stands still, in a body that turned about an axis (Rodrigues).
Vec3<Body> turned_back(const Vec3<Body> &v, const Vec3<Body> &axis, double cosine, double sine) {
  return normalized(v * cosine - cross(axis, v) * sine + axis * (dot(axis, v) * (1 - cosine)));
}

/// A turning as what it does to directions: one rotation for all epochs, and for each the turn
/// about one axis since. Searches ask for a hundred million of them.
class Motion {
public:
  explicit Motion(const Turning &turning)
      : begin_(rotation_from<Body, Gcrs>(turning.attitude)), rate_(norm(turning.rate_rad_s)),
        axis_(rate_ > 0 ? turning.rate_rad_s * (1 / rate_) : Vec3<Body>{0, 0, 1}) {}
  [[nodiscard]] Pose at(const ObservedEpoch &epoch) const {
    const Vec3<Body> sun = begin_ * epoch.to_sun, observer = begin_ * epoch.to_observer;
    if (!(rate_ > 0))
      return {normalized(sun), normalized(observer), epoch.sun_radius_rad};
    const double angle = rate_ * epoch.seconds, c = std::cos(angle), s = std::sin(angle);
    return {turned_back(sun, axis_, c, s), turned_back(observer, axis_, c, s),
            epoch.sun_radius_rad};
  }

private:
  Rotation<Body, Gcrs> begin_;
  double rate_;
  Vec3<Body> axis_;
};

} // namespace

Pose pose_at(const Turning &turning, const ObservedEpoch &epoch) {
  return Motion(turning).at(epoch);
}

CurveModel::CurveModel(const ObservedCurve &curve, PoseLighting light,
                       std::vector<std::size_t> column, std::vector<PartKind> parts)
    : curve_(curve), light_(std::move(light)), column_(std::move(column)),
      all_(curve.epochs.size()), parts_(std::move(parts)) {
  std::iota(all_.begin(), all_.end(), std::size_t{0});
}

namespace {

/// Light of one turning, and room for the next.
class Room {
public:
  Room(std::size_t size, const std::vector<PartKind> &kinds) : width_(size), blocks_(1) {
    std::size_t tilts = 0;
    for (const PartKind &kind : kinds) {
      blocks_ += kind.blocks();
      tilts += kind.tilt_sd_rad > 0 ? 3 : 0;
    }
    for (auto *one : {&i_, &q_, &u_})
      one->resize(blocks_ * size);
    tilted_.resize(tilts * size);
    const auto of = [&](const std::vector<double> &all, std::size_t block) {
      return std::span(all).subspan(block * size, size);
    };
    std::size_t at = 1;
    for (const PartKind &kind : kinds) {
      PartLight part{of(i_, at), of(q_, at), of(u_, at), {}, {}, kind.sd};
      if (kind.slope_sd > 0) {
        part.smooth = of(i_, at + 1);
        part.rough = of(i_, at + 2);
      }
      for (std::size_t axis = 0; axis < 3 && kind.tilt_sd_rad > 0; ++axis) {
        part.tilted[axis] = of(tilted_, tilt_blocks_.size());
        tilt_blocks_.push_back({at, axis});
      }
      part.tilts_with_last = kind.tilts_with_last;
      at += kind.blocks();
      parts_.push_back(part);
    }
  }
  [[nodiscard]] std::size_t blocks() const { return blocks_; }
  /// Row `from` of the table, of all bands of which `column` is one, becomes number `to`.
  void take(const StokesTable &table, std::size_t pose, std::size_t column, std::size_t to) {
    const std::size_t bands = table.bands / blocks_, size = width_.size();
    for (std::size_t block = 0; block < blocks_; ++block) {
      const std::size_t from = pose * table.bands + block * bands + column;
      // A pose whose light is no number counts as dark.
      const bool is_lit = std::isfinite(table.i[from]) && std::isfinite(table.q[from]);
      i_[block * size + to] = is_lit ? table.i[from] : 0;
      q_[block * size + to] = is_lit ? table.q[from] : 0;
      u_[block * size + to] = is_lit ? table.u[from] : 0;
      if (block == 0)
        width_[to] = is_lit && table.i_err.size() == table.i.size() ? table.i_err[from] : 0;
    }
  }
  /// The same of a pose that is turned about an axis.
  void take_tilted(const StokesTable &table, std::size_t pose, std::size_t axis, std::size_t column,
                   std::size_t to) {
    const std::size_t bands = table.bands / blocks_, size = width_.size();
    for (std::size_t k = 0; k < tilt_blocks_.size(); ++k)
      if (const auto [block, about] = tilt_blocks_[k]; about == axis) {
        const double light = table.i[pose * table.bands + block * bands + column];
        tilted_[k * size + to] = std::isfinite(light) ? light : 0;
      }
  }
  [[nodiscard]] ModelLight light() const {
    const std::size_t size = width_.size();
    return {std::span(i_).first(size), std::span(q_).first(size), std::span(u_).first(size), width_,
            parts_};
  }

private:
  struct TiltBlock {
    std::size_t block = 0, axis = 0;
  };
  std::vector<double> i_, q_, u_, width_, tilted_;
  std::vector<TiltBlock> tilt_blocks_;
  std::vector<PartLight> parts_;
  std::size_t blocks_;
};

/// What all surfaces show that are turned about the body axes: the directions, turned back. The
/// phase angle stays, and with it what is kept for it.
class Tilts {
public:
  explicit Tilts(double angle_rad) : cosine_(std::cos(angle_rad)), sine_(std::sin(angle_rad)) {}
  [[nodiscard]] Pose about(std::size_t axis, const Pose &pose) const {
    constexpr Vec3<Body> axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    return {turned_back(pose.sun, axes[axis], cosine_, sine_),
            turned_back(pose.observer, axes[axis], cosine_, sine_), pose.sun_radius_rad};
  }

private:
  double cosine_, sine_;
};

/// The step of all parts, which share the turned poses; 0: all are aligned as the mesh says.
double tilt_of(const std::vector<PartKind> &parts) {
  double out = 0;
  for (const PartKind &part : parts)
    out = std::max(out, part.tilt_sd_rad);
  return out * tilt_step;
}

} // namespace

bool CurveModel::for_each(std::span<const Turning> turnings, std::span<const std::size_t> epochs,
                          unsigned threads,
                          const std::function<void(std::size_t, const ModelLight &)> &take) const {
  if (epochs.empty())
    epochs = all_;
  const double tilt = tilt_of(parts_);
  const Tilts tilts(tilt);
  const std::size_t ways = tilt > 0 ? 4 : 1; // as it is, and turned about three axes
  const std::size_t bands = column_.size(), per = epochs.size();
  constexpr std::size_t poses_at_once = 1u << 16; // some megabytes of light
  const std::size_t block =
      std::max<std::size_t>(1, poses_at_once / std::max<std::size_t>(per * ways, 1));
  StokesTable table;
  std::vector<Pose> poses;
  for (std::size_t begin = 0; begin < turnings.size(); begin += block) {
    const std::size_t count = std::min(block, turnings.size() - begin);
    poses.resize(count * per * ways);
    parallel_for(count, threads, [&](std::size_t k) {
      const Motion motion(turnings[begin + k]);
      for (std::size_t e = 0; e < per; ++e) {
        const Pose pose = motion.at(curve_.epochs[epochs[e]]);
        poses[(k * per + e) * ways] = pose;
        for (std::size_t way = 1; way < ways; ++way)
          poses[(k * per + e) * ways + way] = tilts.about(way - 1, pose);
      }
    });
    if (!light_(poses, table))
      return false;
    poses_lit_ += poses.size();
    const std::size_t size = curve_.epochs.size() * bands;
    // Turnings that share one buffer: parts are fitted to each, so that few are work for a thread.
    const std::size_t chunk = parts_.empty() ? 64 : 8;
    parallel_for((count + chunk - 1) / chunk, threads, [&](std::size_t c) {
      Room room(size, parts_);
      for (std::size_t k = c * chunk; k < std::min(count, (c + 1) * chunk); ++k) {
        for (std::size_t e = 0; e < per; ++e)
          for (std::size_t b = 0; b < bands; ++b) {
            const std::size_t row = (k * per + e) * ways, to = epochs[e] * bands + b;
            room.take(table, row, column_[b], to);
            for (std::size_t way = 1; way < ways; ++way)
              room.take_tilted(table, row + way, way - 1, column_[b], to);
          }
        take(begin + k, room.light());
      }
    });
  }
  return true;
}

} // namespace umov
