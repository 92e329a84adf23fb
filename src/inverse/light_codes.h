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
  }
  /// exp as a product of two: of the high and the low byte.
  [[nodiscard]] float i(std::uint16_t code) const {
    return code == 0 ? 0.0f : high_[code >> 8] * low_[code & 255];
  }
  [[nodiscard]] static double q(std::uint16_t code) { return (code - middle) / half; }
  /// The code of Q/I, -1 to 1.
  [[nodiscard]] static std::uint16_t of_q(double part) {
    return static_cast<std::uint16_t>(std::lround(middle + half * part));
  }

private:
  static constexpr double middle = 32768, half = 32767;
  std::array<float, 256> high_{}, low_{};
};

} // namespace umov::inverse
