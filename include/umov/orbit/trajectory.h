#pragma once
// Where an object is: mean elements with SGP4, or an ephemeris to interpolate.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <umov/core/result.h>
#include <umov/orbit/elements.h>
#include <umov/orbit/state.h>
#include <vector>

namespace umov {

/// Frame of an ephemeris. EME2000 is GCRS but for a bias of 0.02 arcsec, which is applied.
enum class OrbitFrame : std::uint8_t { Gcrs, Eme2000, Teme, Itrs };
/// What lies between two states.
enum class Interpolation : std::uint8_t { Linear, Lagrange, Hermite };

/// A state in the frame of its segment; in Itrs the velocity is relative to the turning Earth.
struct EphemerisState {
  Epoch<Utc> time{};
  std::array<double, 3> position_km{}, velocity_km_s{};
};

/// The numbers of a state of an ephemeris, in the frame that they are in; EME2000 becomes GCRS.
OrbitState state_in(const EphemerisState &state, OrbitFrame frame);

/// States in order of time; between them the polynomial of `degree` through the nearest ones:
/// Lagrange through degree + 1 of them, position and velocity apart; Hermite through
/// (degree + 1)/2, position and velocity together. Fewer where there are not as many.
struct EphemerisSegment {
  OrbitFrame frame = OrbitFrame::Gcrs;
  Interpolation interpolation = Interpolation::Hermite;
  int degree = 7;
  Epoch<Utc> first{}, last{}; ///< usable span
  std::vector<EphemerisState> states;
};

/// States of an object in segments that need not meet.
struct OrbitEphemeris {
  std::string name, object_id; ///< international designator
  int norad_cat_id = 0;        ///< 0: not known
  std::vector<EphemerisSegment> segments;
};

/// BadInput unless every segment has at least two states of finite numbers in order of time and a
/// usable span within them.
Result<void> check_ephemeris(const OrbitEphemeris &ephemeris);

/// An orbit that can be asked at any time it covers. Cheap to copy, thread safe.
class Trajectory {
public:
  Trajectory() = default; ///< none: nothing may be asked of it
  /// Propagated by SGP4.
  explicit Trajectory(const ElementSet &elements);
  /// `ephemeris` has passed `check_ephemeris`.
  explicit Trajectory(OrbitEphemeris ephemeris);

  /// Name of the object, or "".
  [[nodiscard]] const std::string &name() const;
  /// Catalogue number; 0 if it is not known.
  [[nodiscard]] int norad_cat_id() const;
  /// Catalogue number, or the designator of an object without one; begins names of passes.
  [[nodiscard]] std::string id() const;
  /// Null for an ephemeris.
  [[nodiscard]] const ElementSet *elements() const;
  /// Days from the elements' epoch to `time`; NaN for an ephemeris.
  [[nodiscard]] double element_age_days(Epoch<Utc> time) const;
  /// Longest step [s] that surely meets every passage over a site: a fraction of the time that
  /// perigee takes.
  [[nodiscard]] double search_step_s() const;

  /// In the frame that SGP4 or the ephemeris has it in (EME2000 as GCRS).
  /// Physics where SGP4 fails, or beyond what an ephemeris covers (its gaps too), with the time.
  [[nodiscard]] Result<OrbitState> at(Epoch<Utc> time) const;
  /// The same for many times; returns how many states are there before the first failure.
  [[nodiscard]] std::size_t at(std::span<const Epoch<Utc>> times,
                               std::span<OrbitState> states) const;

private:
  struct Body;
  std::shared_ptr<const Body> body_;
};

} // namespace umov
