#pragma once
// Where an object is, how it is turned and how it is lit and seen, at any time.

#include <span>
#include <umov/attitude/attitude.h>
#include <umov/observation/moving_joints.h>
#include <umov/orbit/ephemeris.h>
#include <umov/orbit/trajectory.h>
#include <umov/scene/pose.h>
#include <vector>

namespace umov {

/// Everything that says where an object is and how it is turned.
struct TrackRequest {
  Trajectory orbit;
  Site site;
  ShadowModel shadow = ShadowModel::Ellipsoid;
  AttitudeLaw attitude;            ///< complete: no table or inertia to be read
  std::vector<MovingJoint> joints; ///< checked against the scene's mesh
  bool has_solar_disk = true;      ///< the Sun as a uniform disk at its distance, or a point
};

/// One epoch of a track.
struct TrackPoint {
  ObservingGeometry geometry;
  Rotation<Body, Gcrs> body_from_gcrs;
  Pose pose;                            ///< Sun and observer in the body frame
  std::vector<double> joint_angles_rad; ///< of all joints, in order
};

/// What a law of attitude may look at, from a geometry.
AttitudeContext context_of(const ObservingGeometry &geometry);
/// Angular radius of the Sun's disk at the object [rad].
double sun_radius_rad(const ObservingGeometry &geometry);

/// Orbit, site, attitude and joints, ready to be asked. Cheap to copy, thread safe.
class Track {
public:
  /// Physics where the attitude's start has none.
  static Result<Track> make(TrackRequest request);

  /// Physics where the orbit cannot be had.
  [[nodiscard]] Result<ObservingGeometry> observe(Epoch<Utc> time) const;
  /// Physics where the attitude or a joint cannot be had.
  [[nodiscard]] Result<TrackPoint> place(const ObservingGeometry &geometry) const;
  /// Both at once: `place` of `observe`.
  [[nodiscard]] Result<TrackPoint> at(Epoch<Utc> time) const;

  /// Largest rate at which the half vector between Sun and observer moves in the body, or in a part
  /// of it that turns [rad/s]: how fast the body can turn by itself, and how fast orbit and Earth
  /// turn the view and joints their parts (measured between neighbouring samples, with a margin of
  /// two).
  [[nodiscard]] double half_vector_rate(std::span<const ObservingGeometry> samples) const;
  /// What the track was made from.
  [[nodiscard]] const TrackRequest &request() const { return *request_; }

private:
  Track(std::shared_ptr<const TrackRequest> request, Attitude attitude)
      : request_(std::move(request)), attitude_(std::move(attitude)) {}
  std::shared_ptr<const TrackRequest> request_;
  Attitude attitude_;
};

} // namespace umov
