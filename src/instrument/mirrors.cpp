#include <umov/instrument/mirrors.h>

#include <algorithm>
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

} // namespace umov
