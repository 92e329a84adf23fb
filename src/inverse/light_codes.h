#pragma once
// Private: what the codes of a signature mean.

#include <array>
#include <cmath>
#include <umov/inverse/signature.h>

namespace umov::inverse {

/// I and Q/I of the codes of one signature.
class LightCodes {
public:
  explicit LightCodes(const Signature &signature) {
    for (std::size_t k = 0; k < 256; ++k) {
      const auto at = static_cast<double>(k);
      const double high = signature.ln_least + signature.ln_step * (256 * at - 1);
      high_[k] = static_cast<float>(std::exp(high));
      low_[k] = static_cast<float>(std::exp(signature.ln_step * at));
    }
    lit_ = high_;
    lit_[0] = 0;
  }
  /// exp as a product of two: of the high and the low byte.
  [[nodiscard]] float i(std::uint16_t code) const {
    return code == 0 ? 0.0f : high_[code >> 8] * low_[code & 255];
  }
  /// The same without asking whether the code is none: the dimmest 256 of 65,535 codes, a
  /// thousand-millionth of the brightest, are dark.
  [[nodiscard]] float i_or_dark(std::uint16_t code) const {
    return lit_[code >> 8] * low_[code & 255];
  }
  /// Q of lights that are `i` together, of the sum of their products of I and the code of Q/I.
  [[nodiscard]] static double q(double i_by_code, double i) {
    return (i_by_code - middle * i) / half;
  }
  /// The code of Q/I, -1 to 1, before it is rounded.
  [[nodiscard]] static double code_of_q(double part) { return middle + half * part; }
  [[nodiscard]] static std::uint16_t of_q(double part) {
    return static_cast<std::uint16_t>(std::lround(code_of_q(part)));
  }
  /// How many codes Q/I of 1 is away from none.
  static constexpr double half = 32767;

private:
  static constexpr double middle = 32768;
  std::array<float, 256> high_{}, low_{}, lit_{};
};

} // namespace umov::inverse
