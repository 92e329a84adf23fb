#pragma once
// A number with its derivative, as a number type for kernels: forward differentiation.

#include <cmath>
#include <numbers>

namespace umov::test {

struct Dual {
  double value = 0, slope = 0;
  Dual() = default;
  explicit Dual(double v, double s = 0) : value(v), slope(s) {}

  friend Dual operator+(Dual a, Dual b) { return Dual(a.value + b.value, a.slope + b.slope); }
  friend Dual operator-(Dual a, Dual b) { return Dual(a.value - b.value, a.slope - b.slope); }
  friend Dual operator*(Dual a, Dual b) {
    return Dual(a.value * b.value, a.slope * b.value + a.value * b.slope);
  }
  friend Dual operator/(Dual a, Dual b) {
    const double q = a.value / b.value;
    return Dual(q, (a.slope - q * b.slope) / b.value);
  }
  friend Dual operator-(Dual a) { return Dual(-a.value, -a.slope); }
  friend bool operator<(Dual a, Dual b) { return a.value < b.value; }
  friend bool operator>(Dual a, Dual b) { return a.value > b.value; }
  friend bool operator<=(Dual a, Dual b) { return a.value <= b.value; }
  friend bool operator>=(Dual a, Dual b) { return a.value >= b.value; }
  friend bool operator==(Dual a, Dual b) { return a.value == b.value; }
};

inline Dual chain(Dual x, double value, double derivative) {
  return Dual(value, x.slope == 0 ? 0 : derivative * x.slope); // 0 times infinity is nothing here
}
inline Dual abs(Dual x) { return x.value < 0 ? -x : x; }
inline Dual sqrt(Dual x) { return chain(x, std::sqrt(x.value), 0.5 / std::sqrt(x.value)); }
inline Dual exp(Dual x) { return chain(x, std::exp(x.value), std::exp(x.value)); }
inline Dual exp2(Dual x) {
  return chain(x, std::exp2(x.value), std::exp2(x.value) * std::numbers::ln2);
}
inline Dual log(Dual x) { return chain(x, std::log(x.value), 1 / x.value); }
inline Dual log1p(Dual x) { return chain(x, std::log1p(x.value), 1 / (1 + x.value)); }
inline Dual sin(Dual x) { return chain(x, std::sin(x.value), std::cos(x.value)); }
inline Dual cos(Dual x) { return chain(x, std::cos(x.value), -std::sin(x.value)); }
inline Dual atan(Dual x) { return chain(x, std::atan(x.value), 1 / (1 + x.value * x.value)); }
inline Dual acos(Dual x) {
  return chain(x, std::acos(x.value), -1 / std::sqrt(1 - x.value * x.value));
}
inline Dual erfc(Dual x) {
  return chain(x, std::erfc(x.value), -2 * std::numbers::inv_sqrtpi * std::exp(-x.value * x.value));
}
/// A whole number does not change with what it was rounded from.
inline Dual nearest(Dual x) { return Dual(std::nearbyint(x.value)); }

} // namespace umov::test
