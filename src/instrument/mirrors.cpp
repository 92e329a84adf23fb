#include <umov/instrument/mirrors.h>

#include <algorithm>
#include <cmath>
#include <umov/optics/fresnel.h>

namespace umov {

InstrumentMueller mirror_element(std::complex<double> eta, double cos_incidence) {
  return {fresnel_mueller(cos_incidence, eta).m};
}

InstrumentMueller nasmyth_port(const InstrumentMueller &flat_mirror, NasmythSide side,
                               Angle altitude) {
  const double sign = side == NasmythSide::Right ? -1 : 1;
  return axes_turned(Angle::radians(sign * altitude.radians())) * flat_mirror;
}

TracedBeam::TracedBeam(Vec3<Enu> x, Vec3<Enu> k)
    : x_(normalized(x - k * dot(x, k))), k_(k), image_(x_) {}

void TracedBeam::turn_to(Vec3<Enu> x) {
  const Vec3<Enu> to = normalized(x - k_ * dot(x, k_));
  const double angle = std::atan2(dot(to, cross(k_, x_)), dot(to, x_));
  matrix_ = axes_turned(Angle::radians(angle)) * matrix_;
  x_ = to;
}

void TracedBeam::reflect(Vec3<Enu> normal, std::complex<double> eta) {
  const double along = dot(k_, normal);
  const Vec3<Enu> out = k_ - normal * (2 * along);
  const Vec3<Enu> s = cross(k_, out);
  if (norm(s) > 1e-12) // at normal incidence any plane serves: the axes stay
    turn_to(s);
  matrix_ = mirror_element(eta, std::min(1.0, std::abs(along))) * matrix_;
  k_ = out;
  image_ = image_ - normal * (2 * dot(image_, normal));
}

namespace {

/// Over the ground, of a telescope that looks towards an azimuth.
Vec3<Enu> direction_of(BeamDirection which, Angle azimuth) {
  const double s = std::sin(azimuth.radians()), c = std::cos(azimuth.radians());
  switch (which) {
  case BeamDirection::Up:
    return {0, 0, 1};
  case BeamDirection::Down:
    return {0, 0, -1};
  case BeamDirection::Left:
    return {-c, s, 0};
  case BeamDirection::Right:
    return {c, -s, 0};
  case BeamDirection::Forward:
    return {s, c, 0};
  case BeamDirection::Back:
    return {-s, -c, 0};
  case BeamDirection::North:
    return {0, 1, 0};
  case BeamDirection::East:
    return {1, 0, 0};
  case BeamDirection::South:
    return {0, -1, 0};
  case BeamDirection::West:
    return {-1, 0, 0};
  }
  return {0, 0, 1};
}

} // namespace

TrainFocus trace_train(const MirrorTrain &train, std::span<const std::complex<double>> eta,
                       Angle altitude, Angle azimuth) {
  const Vec3<Enu> forward = direction_of(BeamDirection::Forward, azimuth), up{0, 0, 1};
  const double s = std::sin(altitude.radians()), c = std::cos(altitude.radians());
  TracedBeam beam(up * c - forward * s, (forward * c + up * s) * -1.);
  constexpr std::complex<double> perfect{0, 1e9};
  for (std::size_t k = 0; k < train.mirrors.size(); ++k) {
    const Vec3<Enu> turn = direction_of(train.mirrors[k].to, azimuth) - beam.direction();
    if (norm(turn) > 1e-9) // a beam that goes there already meets no mirror
      beam.reflect(normalized(turn), eta.empty() ? perfect : eta[k]);
  }
  const Vec3<Enu> x = direction_of(train.x_from, azimuth), k = beam.direction();
  beam.turn_to(x);
  const Vec3<Enu> image = beam.image_of_x();
  return {beam.matrix(), Angle::radians(std::atan2(dot(image, cross(k, x)), dot(image, x)))};
}

} // namespace umov
