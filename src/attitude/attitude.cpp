// Laws made ready: docs/theory/attitude.md.

#include <umov/attitude/attitude.h>

#include "attitude/directions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/quantity.h>
#include <umov/core/random.h>

namespace umov {

class Attitude::Model {
public:
  Model() = default;
  Model(const Model &) = delete;
  Model &operator=(const Model &) = delete;
  virtual ~Model() = default;
  [[nodiscard]] virtual Result<Rotation<Body, Gcrs>> at(const AttitudeContext &now) const = 0;
  [[nodiscard]] virtual AttitudeRates rates() const = 0;
};

namespace {

using attitude::inertial, attitude::offset_rotation, attitude::start_attitude, attitude::turned,
    attitude::two_axis;

class TwoAxisModel : public Attitude::Model {
public:
  explicit TwoAxisModel(const TwoAxisLaw &law) : law_(law), offset_(offset_rotation(law.offset)) {}
  [[nodiscard]] Result<Rotation<Body, Gcrs>> at(const AttitudeContext &now) const override {
    UMOV_ASSIGN(plain, two_axis(law_, now));
    return offset_ * plain;
  }
  [[nodiscard]] AttitudeRates rates() const override { return {0, true}; }

private:
  TwoAxisLaw law_;
  Rotation<Body, Body> offset_;
};

class FixedModel : public Attitude::Model {
public:
  explicit FixedModel(const InertialLaw &law) : attitude_(inertial(law)) {}
  [[nodiscard]] Result<Rotation<Body, Gcrs>> at(const AttitudeContext &) const override {
    return attitude_;
  }
  [[nodiscard]] AttitudeRates rates() const override { return {}; }

private:
  Rotation<Body, Gcrs> attitude_;
};

class SpinModel : public Attitude::Model {
public:
  SpinModel(const SpinLaw &law, const Rotation<Body, Gcrs> &start) : law_(law), start_(start) {}
  [[nodiscard]] Result<Rotation<Body, Gcrs>> at(const AttitudeContext &now) const override {
    const double turns = seconds_between(now.time, law_.epoch) * (law_.rate_rad_s / (2 * pi));
    return turned(law_.axis, 2 * pi * (turns - std::floor(turns))) * start_;
  }
  [[nodiscard]] AttitudeRates rates() const override { return {std::abs(law_.rate_rad_s), false}; }

private:
  SpinLaw law_;
  Rotation<Body, Gcrs> start_;
};

class TumbleModel : public Attitude::Model {
public:
  TumbleModel(const TorqueFreeMotion &motion, Epoch<Utc> epoch, const Rotation<Body, Gcrs> &start)
      : motion_(motion), epoch_(epoch), start_(start) {}
  [[nodiscard]] Result<Rotation<Body, Gcrs>> at(const AttitudeContext &now) const override {
    return motion_.turned(seconds_between(now.time, epoch_)) * start_;
  }
  [[nodiscard]] AttitudeRates rates() const override { return {motion_.rate_bound_rad_s(), false}; }

private:
  TorqueFreeMotion motion_;
  Epoch<Utc> epoch_;
  Rotation<Body, Gcrs> start_;
};

class TableModel : public Attitude::Model {
public:
  explicit TableModel(std::shared_ptr<const AttitudeTable> table) : table_(std::move(table)) {}
  [[nodiscard]] Result<Rotation<Body, Gcrs>> at(const AttitudeContext &now) const override {
    return attitude_in(*table_, now.time);
  }
  [[nodiscard]] AttitudeRates rates() const override { return {rate_bound_rad_s(*table_), false}; }

private:
  std::shared_ptr<const AttitudeTable> table_;
};

class PiecewiseModel : public Attitude::Model {
public:
  PiecewiseModel(std::vector<Epoch<Utc>> from, std::vector<Attitude> pieces)
      : from_(std::move(from)), pieces_(std::move(pieces)) {}
  [[nodiscard]] Result<Rotation<Body, Gcrs>> at(const AttitudeContext &now) const override {
    std::size_t k = from_.size();
    while (k > 0 && seconds_between(now.time, from_[k - 1]) < 0)
      --k;
    if (k == 0)
      return fail(ErrorCode::Physics,
                  fmt::format("the attitude is not given for {}: its first piece begins at {}",
                              to_iso(now.time), to_iso(from_.front())));
    return pieces_[k - 1].at(now);
  }
  [[nodiscard]] AttitudeRates rates() const override {
    AttitudeRates out;
    for (const Attitude &piece : pieces_) {
      const AttitudeRates one = piece.rates();
      out.own_rad_s = std::max(out.own_rad_s, one.own_rad_s);
      out.follows_orbit = out.follows_orbit || one.follows_orbit;
    }
    return out;
  }

private:
  std::vector<Epoch<Utc>> from_;
  std::vector<Attitude> pieces_;
};

/// Waves about each body axis; sums of incommensurable periods look random and are the same for
/// any order of times.
class LibrationModel : public Attitude::Model {
public:
  LibrationModel(const LibrationLaw &law, Attitude base)
      : base_(std::move(base)), amplitude_(law.rms_rad * std::sqrt(2.0 / waves)) {
    for (std::size_t k = 0; k < 3 * waves; ++k) {
      constexpr std::uint32_t stream = 0x11B7;
      const auto u = uniform4(law.seed, stream, k);
      wave_[k] = {2 * pi / (law.period_s * (0.7 + 0.6 * u[0])), 2 * pi * u[1]};
    }
  }
  [[nodiscard]] Result<Rotation<Body, Gcrs>> at(const AttitudeContext &now) const override {
    UMOV_ASSIGN(plain, base_.at(now));
    const double t = seconds_between(now.time, Epoch<Utc>{2451544.5, 0});
    std::array<double, 3> angle{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t k = 0; k < waves; ++k) {
        const Wave &w = wave_[axis * waves + k];
        angle[axis] += amplitude_ * std::sin(w.rate * t + w.phase);
      }
    const Vec3<Body> vector{angle[0], angle[1], angle[2]};
    return norm(vector) > 0 ? turned(vector, norm(vector)) * plain : plain;
  }
  [[nodiscard]] AttitudeRates rates() const override {
    AttitudeRates out = base_.rates();
    for (const Wave &w : wave_)
      out.own_rad_s += amplitude_ * w.rate;
    return out;
  }

private:
  static constexpr std::size_t waves = 5;
  struct Wave {
    double rate = 0, phase = 0;
  };
  Attitude base_;
  double amplitude_;
  std::array<Wave, 3 * waves> wave_{};
};

using ModelResult = Result<std::shared_ptr<const Attitude::Model>>;

ModelResult model_of(const TwoAxisLaw &law, const ContextAt &) {
  return std::make_shared<TwoAxisModel>(law);
}
ModelResult model_of(const InertialLaw &law, const ContextAt &) {
  return std::make_shared<FixedModel>(law);
}
ModelResult model_of(const SpinLaw &law, const ContextAt &context) {
  UMOV_ASSIGN(at, context(law.epoch));
  UMOV_ASSIGN(start, start_attitude(law.start, at));
  return std::make_shared<SpinModel>(law, start);
}
ModelResult model_of(const TumbleLaw &law, const ContextAt &context) {
  UMOV_ASSIGN(at, context(law.epoch));
  UMOV_ASSIGN(start, start_attitude(law.start, at));
  UMOV_ASSIGN(motion, TorqueFreeMotion::make(law.inertia, law.rate_rad_s));
  return std::make_shared<TumbleModel>(motion, law.epoch, start);
}
ModelResult model_of(const TableLaw &law, const ContextAt &) {
  if (!law.table)
    return fail(ErrorCode::Internal, "the attitude table " + law.file + " has not been read");
  return std::make_shared<TableModel>(law.table);
}
ModelResult model_of(const PiecewiseLaw &law, const ContextAt &context) {
  std::vector<Epoch<Utc>> from;
  std::vector<Attitude> pieces;
  for (const AttitudePiece &piece : law.pieces) {
    UMOV_ASSIGN(one, Attitude::make(*piece.law, context));
    from.push_back(piece.from);
    pieces.push_back(one);
  }
  return std::make_shared<PiecewiseModel>(std::move(from), std::move(pieces));
}
ModelResult model_of(const LibrationLaw &law, const ContextAt &context) {
  UMOV_ASSIGN(base, Attitude::make(*law.law, context));
  return std::make_shared<LibrationModel>(law, base);
}

} // namespace

Result<Vec3<Gcrs>> direction_to(const Direction &direction, const AttitudeContext &now) {
  return attitude::unit_along(direction, now);
}

Result<Attitude> Attitude::make(const AttitudeLaw &law, const ContextAt &context) {
  UMOV_ASSIGN(model, std::visit([&](const auto &one) { return model_of(one, context); }, law));
  Attitude out;
  out.model_ = model;
  return out;
}

AttitudeRates Attitude::rates() const { return model_->rates(); }

Result<Rotation<Body, Gcrs>> Attitude::at(const AttitudeContext &now) const {
  return model_->at(now);
}

} // namespace umov
