#include <umov/core/random.h>

namespace umov {
namespace {

// Multipliers and Weyl increments of Philox 4x32 (Salmon et al. 2011, section 4 and Random123).
constexpr std::uint64_t multiplier_0 = 0xD2511F53, multiplier_1 = 0xCD9E8D57;
constexpr std::uint32_t weyl_0 = 0x9E3779B9, weyl_1 = 0xBB67AE85;

constexpr std::uint32_t high(std::uint64_t v) { return static_cast<std::uint32_t>(v >> 32); }
constexpr std::uint32_t low(std::uint64_t v) { return static_cast<std::uint32_t>(v); }

} // namespace

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> c,
                                    std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = multiplier_0 * c[0], b = multiplier_1 * c[2];
    c = {high(b) ^ c[1] ^ key[0], low(b), high(a) ^ c[3] ^ key[1], low(a)};
    key = {key[0] + weyl_0, key[1] + weyl_1};
  }
  return c;
}

std::array<double, 4> uniform4(std::uint64_t seed, std::uint32_t stream, std::uint64_t index) {
  const auto words = philox({low(index), high(index), stream, 0}, {low(seed), high(seed)});
  std::array<double, 4> out{};
  for (std::size_t i = 0; i < 4; ++i) // centred in its cell of 2^-32: never 0, never 1
    out[i] = (static_cast<double>(words[i]) + 0.5) * 0x1p-32;
  return out;
}

} // namespace umov
