#pragma once
// Which way the body points: laws as the user states them, and the attitude that they give.

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <umov/attitude/attitude_table.h>
#include <umov/attitude/tumble.h>
#include <umov/core/result.h>
#include <umov/core/rotation.h>
#include <umov/frames/site.h>
#include <umov/shape/mass.h>
#include <umov/time/epoch.h>
#include <variant>
#include <vector>

namespace umov {

/// What an axis can be pointed at.
enum class Target { Nadir, Zenith, Velocity, OrbitNormal, Sun, Observer };
/// A fixed direction: right ascension and declination in GCRS.
struct CelestialDirection {
  double right_ascension_rad = 0, declination_rad = 0;
};
/// A place on the Earth, geometric.
struct GroundTarget {
  Site site;
};
/// Anything that an axis can be pointed at.
using Direction = std::variant<Target, CelestialDirection, GroundTarget>;

/// Turns about the body's own axes after a law has been obeyed: yaw about +Z first, then pitch
/// about the new +Y, then roll about the new +X (Diebel 2006, sequence 3-2-1).
struct AttitudeOffset {
  double roll_rad = 0, pitch_rad = 0, yaw_rad = 0;
};

/// `point` exactly at one direction, `then` as near as possible towards another.
struct TwoAxisLaw {
  Vec3<Body> point{0, 0, 1};
  Direction at = Target::Nadir;
  Vec3<Body> then{1, 0, 0};
  Direction toward = Target::Velocity;
  AttitudeOffset offset{};
};
/// Fixed among the stars.
struct InertialLaw {
  Quaternion body_from_gcrs;
};
/// What a turning law starts from; a two-axis attitude is frozen at the law's epoch.
using StartLaw = std::variant<TwoAxisLaw, InertialLaw>;

/// Turns at a constant rate about a body axis from `start` at `epoch` on. Positive: right-handed
/// about the axis.
struct SpinLaw {
  StartLaw start;
  Vec3<Body> axis{0, 0, 1};
  double rate_rad_s = 0;
  Epoch<Utc> epoch{};
};
/// Torque-free motion from `start` and an angular velocity at `epoch` on.
struct TumbleLaw {
  StartLaw start;
  Inertia inertia;
  std::optional<MassModel> from_mesh; ///< `inertia` is yet to be taken from the mesh
  Vec3<Body> rate_rad_s;
  Epoch<Utc> epoch{};
};
/// A table of attitudes (CCSDS AEM); `table` is null until `file` has been read.
struct TableLaw {
  std::string file;
  std::shared_ptr<const AttitudeTable> table;
};

struct AttitudeLaw;
/// A law from a time on.
struct AttitudePiece {
  Epoch<Utc> from{};
  std::shared_ptr<const AttitudeLaw> law;
};
/// The last piece that has begun holds; before the first one there is no attitude.
struct PiecewiseLaw {
  std::vector<AttitudePiece> pieces;
};
/// Another law with a small unsteadiness: about each body axis a sum of five waves with periods
/// around `period_s` and random phases, of `rms_rad` in the mean square per axis.
struct LibrationLaw {
  std::shared_ptr<const AttitudeLaw> law;
  double rms_rad = 0, period_s = 60;
  std::uint64_t seed = 0;
};

struct AttitudeLaw : std::variant<TwoAxisLaw, InertialLaw, SpinLaw, TumbleLaw, TableLaw,
                                  PiecewiseLaw, LibrationLaw> {
  using variant::variant;
};

/// What a law may look at.
struct AttitudeContext {
  Epoch<Utc> time;
  Vec3<Gcrs> position_km, velocity_km_s; ///< inertial
  Vec3<Gcrs> to_sun, to_observer;        ///< unit vectors at the object
};
/// The context at any time; fails where the orbit does.
using ContextAt = std::function<Result<AttitudeContext>(Epoch<Utc>)>;

/// Unit vector of a direction at the object. Physics where it has no length.
Result<Vec3<Gcrs>> direction_to(const Direction &direction, const AttitudeContext &now);

/// How fast an attitude can change.
struct AttitudeRates {
  double own_rad_s = 0;       ///< bound on turns that the law makes by itself (spin, tumbling)
  bool follows_orbit = false; ///< turns with its targets besides
};

/// A law ready to be asked; cheap to copy, thread safe.
class Attitude {
public:
  /// Physics if the law's start has no attitude (see `at`), or the orbit none at its epoch.
  static Result<Attitude> make(const AttitudeLaw &law, const ContextAt &context);

  /// Physics error if the two directions of a two-axis law are parallel within 1e-9 rad, if a
  /// direction has no length (no velocity), or where a table or a piece says nothing. Nadir is
  /// towards the Earth's centre; the orbit normal is position x velocity.
  [[nodiscard]] Result<Rotation<Body, Gcrs>> at(const AttitudeContext &now) const;

  /// How fast it can turn, at any time.
  [[nodiscard]] AttitudeRates rates() const;

  class Model;

private:
  std::shared_ptr<const Model> model_;
};

/// Checks what a law says on its own: finite numbers, axes of a length, `point` and `then` not
/// parallel within 1e-9 rad, unit quaternion within 1e-6, a finite rate, an inertia that a rigid
/// body can have, pieces in order of time. BadInput otherwise.
Result<void> check_attitude(const AttitudeLaw &law);

/// True if some law within wants the inertia of the mesh.
bool needs_mesh(const AttitudeLaw &law);
/// The law with the inertia of the mesh where it wants that, and with tables read by `read`;
/// Interrupted once `cancel` became true.
Result<AttitudeLaw> completed(
    const AttitudeLaw &law, const Mesh &mesh,
    const std::function<Result<std::shared_ptr<const AttitudeTable>>(const std::string &)> &read,
    const std::atomic<bool> *cancel = nullptr);

/// A quaternion as the user gave it: normalised if within 1e-6 of unit length, else BadInput.
Result<Quaternion> unit_quaternion(Quaternion q);

} // namespace umov
