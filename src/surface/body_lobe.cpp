#include "surface/body_lobe.h"

#include "kernel/body.inl.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <umov/core/quantity.h>

namespace umov {
namespace {

kernel::Transmitted<double> transmitted(const Interface &surface, double cosine) {
  const MuellerEntries r = surface.reflection(std::min(cosine, 1.0));
  // In total reflection the rounding of 1 - a would be light, or polarize more than there is.
  const double mean = std::max(0.0, 1 - r.a);
  return {mean, std::clamp(-r.b, -mean, mean)};
}

} // namespace

BodyLight::BodyLight(double reflectance, AlbedoTable reflected)
    : factor_(reflectance / (pi * (1 - reflected.mean()))), reflectance_(reflectance),
      reflected_(std::move(reflected)) {}

BodyLight::BodyLight(double reflectance, const Interface &surface)
    : factor_(reflectance / (pi * (1 - surface.mean_reflectance()))), reflectance_(reflectance),
      surface_(surface) {}

double BodyLight::entering(double n_k) const {
  return surface_ ? transmitted(*surface_, n_k).mean : 1 - reflected_(std::clamp(n_k, 0.0, 1.0));
}

double BodyLight::polarizing(double n_k) const {
  constexpr double most = 1 - 1e-6; // nearer to the normal it is the limit, to that accuracy
  const double c = std::clamp(n_k, 0.0, most);
  return surface_ ? transmitted(*surface_, c).half_difference / ((1 - c) * (1 + c)) : 0;
}

double BodyLight::albedo(double n_k) const {
  // int f_b mu dw over the hemisphere: R_sub (1 - R(k)), since int (1 - R) mu dw = pi (1 - Rbar).
  return reflectance_ * entering(n_k);
}

Stokes<ScatteringPlane> BodyLight::operator()(const SurfaceDirections &at,
                                              const Stokes<ScatteringPlane> &in) const {
  const double n_l = at.l.z, n_v = at.v.z;
  if (!(n_l > 0 && n_v > 0))
    return {};
  const double scale = factor_ * n_l * n_v;
  if (!surface_)
    return {scale * entering(n_l) * entering(n_v) * in.i, 0, 0, 0};
  const auto turn = kernel::emission_planes(at.l.x, at.l.y, at.l.z, at.v.x, at.v.y, at.v.z);
  const auto enters = transmitted(*surface_, n_l), leaves = transmitted(*surface_, n_v);
  // t_in . S: only what is transmitted of the incoming light counts.
  const double inside =
      enters.mean * in.i + enters.half_difference * (turn.cos_in * in.q + turn.sin_in * in.u);
  return {scale * leaves.mean * inside, scale * leaves.half_difference * turn.cos_out * inside,
          scale * leaves.half_difference * turn.sin_out * inside, 0};
}

Interreflected::Interreflected(std::shared_ptr<const AlbedoTable> furnace, double mean_reflectance)
    : furnace_(std::move(furnace)) {
  const double e = furnace_->mean(), f = mean_reflectance;
  f_ms_ = f * f * e / (1 - f * (1 - e));
}

double Interreflected::factor() const {
  const double lost = 1 - furnace_->mean();
  // Narrow lobes lose nothing: the limit is no light, not 0/0.
  return lost < 1e-9 ? 0 : f_ms_ / (pi * lost);
}

double Interreflected::lost(double n_k) const {
  return std::max(0.0, 1 - (*furnace_)(std::clamp(n_k, 0.0, 1.0)));
}

double Interreflected::operator()(double n_l, double n_v) const {
  if (!(n_l > 0 && n_v > 0))
    return 0;
  return factor() * lost(n_l) * lost(n_v) * n_l * n_v;
}

double Interreflected::albedo(double n_k) const { return f_ms_ * lost(n_k); }

} // namespace umov
