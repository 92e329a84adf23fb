#include "scale/exact_sum.h"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <numbers>

namespace umov::scale {
namespace {

constexpr int mantissa_bits = 53;
/// 2^63 summands of 2^-200 are less than 2^-136 of the highest.
constexpr std::int64_t seen_powers = 200;
/// Above those of all x from `least` on. Zeros stand here, until they cannot be seen beside others.
constexpr std::int64_t power_of_zero = std::int64_t{1} << 42;
/// Of what can be counted, so that sums of a thousand such do not wrap.
constexpr std::uint64_t most_high = std::uint64_t{1} << 53;

} // namespace

void ExactSum::add_exp(double x) {
  if (std::isnan(x))
    return;
  if (x < least) {
    add(power_of_zero, {});
    return;
  }
  const double power = std::ceil(-x / std::numbers::ln2);
  const double part = std::exp(x + power * std::numbers::ln2); // from 1 to 2
  add(static_cast<std::int64_t>(power),
      {0, static_cast<std::uint64_t>(std::llround(std::ldexp(part, mantissa_bits - 1)))});
}

void ExactSum::add(std::int64_t power, const Whole &whole) {
  if (!wholes_.empty() && power > wholes_.begin()->first + seen_powers)
    return;
  Whole &to = wholes_[power];
  to.low += whole.low;
  to.high += whole.high + (to.low >> mantissa_bits);
  to.low &= (std::uint64_t{1} << mantissa_bits) - 1;
  if (wholes_.begin()->first == power) // which may be a new one
    wholes_.erase(wholes_.upper_bound(power + seen_powers), wholes_.end());
}

double ExactSum::log() const {
  if (wholes_.empty())
    return std::numeric_limits<double>::quiet_NaN();
  const std::int64_t highest = wholes_.begin()->first;
  double sum = 0;
  for (auto at = wholes_.rbegin(); at != wholes_.rend(); ++at) {
    const auto &[power, whole] = *at;
    sum += std::ldexp(std::ldexp(static_cast<double>(whole.high), mantissa_bits) +
                          static_cast<double>(whole.low),
                      static_cast<int>(highest - power) - mantissa_bits + 1);
  }
  return std::log(sum) - static_cast<double>(highest) * std::numbers::ln2;
}

std::string ExactSum::text() const {
  std::string out;
  for (const auto &[power, whole] : wholes_)
    fmt::format_to(std::back_inserter(out), "{} {} {};", power, whole.high, whole.low);
  return out;
}

bool ExactSum::add(const std::string &text) {
  const char *at = text.data(), *const end = at + text.size();
  const auto number = [&](auto &to, char behind) {
    const auto read = std::from_chars(at, end, to);
    at = read.ptr;
    return read.ec == std::errc() && at != end && *at++ == behind;
  };
  while (at != end) {
    std::int64_t power = 0;
    Whole whole;
    if (!number(power, ' ') || !number(whole.high, ' ') || !number(whole.low, ';') ||
        whole.low >> mantissa_bits != 0 || whole.high > most_high || power < 0 ||
        power > power_of_zero || (whole.high == 0 && whole.low == 0) != (power == power_of_zero))
      return false;
    add(power, whole);
  }
  return true;
}

} // namespace umov::scale
