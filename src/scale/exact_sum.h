#pragma once
// Private: a sum of exponentials that is the same in any order.

#include <cstdint>
#include <map>
#include <string>

namespace umov::scale {

/// Sum of exp(x), x <= 0, each rounded once to 52 bits behind its first: whole numbers are added,
/// one for each power of two, and no addition rounds. Powers so far below the highest that they
/// cannot be seen in it are dropped.
class ExactSum {
public:
  /// Where a double holds x to 2e-4. What is less counts as a summand of 0.
  static constexpr double least = -2e12;
  /// Nothing for what is not a number.
  void add_exp(double x);
  /// What `text` gave; false for anything else.
  [[nodiscard]] bool add(const std::string &text);
  /// Its natural logarithm; -infinity where all are 0, NaN of no summand.
  [[nodiscard]] double log() const;
  /// All of it; equal sums have equal texts.
  [[nodiscard]] std::string text() const;

private:
  /// high 2^53 + low; low < 2^53.
  struct Whole {
    std::uint64_t high = 0, low = 0;
  };
  void add(std::int64_t power, const Whole &whole);
  std::map<std::int64_t, Whole> wholes_; ///< by k: times 2^(-k - 52)
};

} // namespace umov::scale
