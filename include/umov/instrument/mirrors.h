#pragma once
// Mirrors of a telescope that polarize.

#include <complex>
#include <span>
#include <umov/core/vec3.h>
#include <umov/instrument/mueller.h>
#include <umov/instrument/telescope.h>

namespace umov {

/// A metal mirror in its own axes: x perpendicular to the plane of incidence, before and after.
InstrumentMueller mirror_element(std::complex<double> eta, double cos_incidence);

/// Which way the beam leaves an alt-azimuth mount.
enum class NasmythSide { Right, Left }; ///< towards azimuth + 90 deg, or - 90 deg

/// From Stokes parameters in zenith axes to those at a Nasmyth focus, +Q vertical: the flat mirror
/// at 45 deg, then the turn by the altitude. The image is mirrored there.
InstrumentMueller nasmyth_port(const InstrumentMueller &flat_mirror, NasmythSide side,
                               Angle altitude);

/// A beam that is followed through mirrors: any train, by one rule. Axes x, y and direction k are
/// right-handed; Stokes parameters refer to x.
class TracedBeam {
public:
  /// Light along k; `x` perpendicular to it.
  TracedBeam(Vec3<Enu> x, Vec3<Enu> k);
  /// A mirror with this normal (either sense); light is afterwards referred to its plane's normal.
  void reflect(Vec3<Enu> normal, std::complex<double> eta);
  /// Turns the axes to `x`, or to its part perpendicular to the beam.
  void turn_to(Vec3<Enu> x);

  /// From the light at the start to the light here.
  [[nodiscard]] const InstrumentMueller &matrix() const { return matrix_; }
  /// Direction of the light.
  [[nodiscard]] Vec3<Enu> direction() const { return k_; }
  /// Where the start's x axis appears now, as a mirror shows it.
  [[nodiscard]] Vec3<Enu> image_of_x() const { return image_; }

private:
  InstrumentMueller matrix_ = identity_element();
  Vec3<Enu> x_, k_, image_;
};

/// A train as it lies where the telescope points.
struct TrainFocus {
  /// From Stokes parameters in zenith axes to those in the focus, +Q along `x_from`.
  InstrumentMueller matrix;
  Angle zenith; ///< where the zenith direction appears, from `x_from`
};
/// Follows a beam through a train. `eta`: of each mirror; none: geometry alone, as if all reflected
/// perfectly.
TrainFocus trace_train(const MirrorTrain &train, std::span<const std::complex<double>> eta,
                       Angle altitude, Angle azimuth);

} // namespace umov
