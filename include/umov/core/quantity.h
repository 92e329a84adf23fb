#pragma once
// Named constructors for numbers that people mix up.

#include <numbers>

namespace umov {

inline constexpr double pi = std::numbers::pi;

/// Plane angle, held in radians.
class Angle {
public:
  constexpr Angle() = default;
  /// From radians.
  static constexpr Angle radians(double value) { return Angle(value); }
  /// From degrees.
  static constexpr Angle degrees(double value) { return Angle(value * (pi / 180)); }
  /// In radians.
  [[nodiscard]] constexpr double radians() const { return value_; }
  /// In degrees.
  [[nodiscard]] constexpr double degrees() const { return value_ * (180 / pi); }

private:
  constexpr explicit Angle(double value) : value_(value) {}
  double value_ = 0;
};

/// Wavelength in vacuum, held in nm: the number that users write stays as it is.
class Wavelength {
public:
  constexpr Wavelength() = default;
  /// From nanometres.
  static constexpr Wavelength nm(double value) { return Wavelength(value); }
  /// In nanometres.
  [[nodiscard]] constexpr double nm() const { return value_; }
  /// In metres.
  [[nodiscard]] constexpr double metres() const { return value_ * 1e-9; }

private:
  constexpr explicit Wavelength(double value) : value_(value) {}
  double value_ = 0;
};

} // namespace umov
