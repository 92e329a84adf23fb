#include <umov/optics/interface.h>

#include "kernel/films.inl.h"
#include "kernel/gauss.h"

#include <cmath>
#include <limits>

namespace umov {
namespace {

using Kc = kernel::Complex<double>;
using Powers = kernel::Powers<double>;

Kc of(std::complex<double> z) { return {z.real(), z.imag()}; }

MuellerEntries entries(const kernel::Reflection<double> &r) { return {r.a, r.b, {r.z.re, r.z.im}}; }

/// Coherent films between two media that count as infinite.
struct Packet {
  Kc above, below;
  std::vector<kernel::Film<double>> films;

  [[nodiscard]] kernel::StackAmplitudes<double> from_above(double sine_squared) const {
    return kernel::stack(above, sine_squared, films.data(), films.size(), below);
  }
  [[nodiscard]] kernel::StackAmplitudes<double> from_below(double sine_squared) const {
    const std::vector<kernel::Film<double>> turned(films.rbegin(), films.rend());
    return kernel::stack(below, sine_squared, turned.data(), turned.size(), above);
  }
};

Powers reflected(const kernel::StackAmplitudes<double> &a) { return kernel::powers(a.r); }
Powers transmitted(const kernel::StackAmplitudes<double> &a) {
  return kernel::powers(a.t, a.power_s, a.power_p);
}

constexpr double two_pi = 2 * pi;

} // namespace

Mueller<ScatteringPlane, ScatteringPlane> MuellerEntries::matrix() const {
  return {{{{a, b, 0, 0}, {b, a, 0, 0}, {0, 0, z.real(), -z.imag()}, {0, 0, z.imag(), z.real()}}}};
}

Interface::Interface(std::complex<double> substrate) : substrate_(substrate) {}

Interface::Interface(std::complex<double> substrate, std::vector<OpticalLayer> layers,
                     Wavelength wavelength)
    : substrate_(substrate), layers_(std::move(layers)) {
  for (OpticalLayer &layer : layers_) {
    layer.thickness_nm /= wavelength.nm();
    has_thick_ = has_thick_ || !layer.is_coherent;
  }
}

bool Interface::is_void() const { return layers_.empty() && substrate_ == 1.0; }

MuellerEntries Interface::reflection(double cos_incidence) const {
  if (layers_.empty())
    return entries(kernel::reflection(kernel::fresnel(cos_incidence, of(substrate_))));
  const double sine_squared = (1 - cos_incidence) * (1 + cos_incidence);
  // From the substrate up: coherent packets, joined through the thick layers between them.
  Powers beneath{};
  Packet packet{{1, 0}, of(substrate_), {}};
  double depth = -1; // of the thick layer that the packet rests on [wavelengths]; < 0: substrate
  const auto close = [&](Kc above) {
    packet.above = above;
    const auto down = packet.from_above(sine_squared);
    if (depth < 0) {
      beneath = reflected(down);
      return;
    }
    const auto up = packet.from_below(sine_squared);
    const double loss = kernel::admittance(packet.below, sine_squared).q.im;
    beneath = kernel::thick_layer(reflected(down), transmitted(down), transmitted(up),
                                  reflected(up), std::exp(-2 * two_pi * loss * depth), beneath);
  };
  for (std::size_t i = layers_.size(); i-- > 0;) {
    const OpticalLayer &layer = layers_[i];
    if (layer.is_coherent) {
      packet.films.insert(packet.films.begin(), {of(layer.eta), layer.thickness_nm});
      continue;
    }
    close(of(layer.eta));
    depth = layer.thickness_nm;
    packet = {{1, 0}, of(layer.eta), {}};
  }
  close({1, 0});
  return entries(kernel::reflection(beneath));
}

MuellerEntries Interface::transmission(double cos_incidence) const {
  const double sine_squared = (1 - cos_incidence) * (1 + cos_incidence);
  Packet packet{{1, 0}, of(substrate_), {}};
  for (const OpticalLayer &layer : layers_)
    packet.films.push_back({of(layer.eta), layer.thickness_nm});
  return entries(kernel::reflection(transmitted(packet.from_above(sine_squared))));
}

double Interface::mean_reflectance() const {
  if (is_void())
    return 0;
  // In sqrt(mu), where R is smooth at grazing incidence.
  return gauss_integral(0, 1, [this](double x) { return 4 * x * x * x * reflection(x * x).a; });
}

namespace {

struct Slab {
  kernel::StackAmplitudes<double> in, out;
};

Slab slab(std::complex<double> eta, double cos_incidence) {
  const double sine_squared = (1 - cos_incidence) * (1 + cos_incidence);
  const Packet face{{1, 0}, of(eta), {}};
  return {face.from_above(sine_squared), face.from_below(sine_squared)};
}

} // namespace

MuellerEntries slab_reflection(std::complex<double> eta, double cos_incidence, double tau) {
  const Slab s = slab(eta, cos_incidence);
  return entries(
      kernel::reflection(kernel::thick_layer(reflected(s.in), transmitted(s.in), transmitted(s.out),
                                             reflected(s.out), tau, reflected(s.out))));
}

MuellerEntries slab_transmission(std::complex<double> eta, double cos_incidence, double tau) {
  const Slab s = slab(eta, cos_incidence);
  const Powers in = transmitted(s.in), out = transmitted(s.out), r = reflected(s.out);
  const double t2 = tau * tau;
  const auto through = kernel::multiply(in.z, out.z);
  const auto loop = kernel::multiply(r.z, r.z);
  const Powers total{
      in.s * out.s * tau / (1 - r.s * r.s * t2), in.p * out.p * tau / (1 - r.p * r.p * t2),
      kernel::divide(Kc{through.re * tau, through.im * tau}, Kc{1 - loop.re * t2, -loop.im * t2})};
  return entries(kernel::reflection(total));
}

} // namespace umov
