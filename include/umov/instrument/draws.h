#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <umov/core/random.h>

namespace umov {

/// What random numbers of an observation belong to: any exposure or pixel can be drawn without
/// those before it.
struct DrawKey {
  std::uint64_t seed = 0;
  std::uint32_t object = 0, exposure = 0, channel = 0, pixel = 0;
};

/// Random words of one key (Philox), as the distributions of Boost and the standard library take
/// them. The fifth axis, the number of the word, runs in steps of four through the key.
class Draws {
public:
  /// A word.
  using result_type = std::uint32_t;
  /// At the beginning of a key's stream.
  explicit Draws(const DrawKey &key) : key_(key) {}
  /// The least word.
  static constexpr result_type min() { return 0; }
  /// The largest word.
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  /// The next word.
  result_type operator()();

  /// Poisson number; 0 where the mean is not positive.
  double poisson(double mean);
  /// Standard normal number.
  double normal();
  /// Gamma number of unit scale.
  double gamma(double shape);

private:
  DrawKey key_;
  std::uint32_t block_ = 0;
  unsigned left_ = 0;
  std::array<std::uint32_t, 4> words_{};
};

} // namespace umov
