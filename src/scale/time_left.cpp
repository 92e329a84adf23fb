#include "scale/time_left.h"

#include <algorithm>

namespace umov::scale {

void TimeLeft::took(std::size_t units, double seconds, bool is_first) {
  const double shard_s = unit_s_ * static_cast<double>(units);
  if (is_first && first_s_ > 0.2 * shard_s) {
    is_first_over_ = true;
    slower_ = std::max(slower_, seconds / (first_s_ + shard_s));
    return;
  }
  const Sum before = sums_.back();
  sums_.push_back({before.units + static_cast<double>(units), before.seconds + seconds});
}

double TimeLeft::left_s(std::size_t units, std::span<const std::size_t> units_in_hand,
                        std::span<const double> busy_s) const {
  const Sum &all = sums_.back(), &early = sums_[(sums_.size() - 1) / 2];
  const bool is_known = all.units > early.units;
  const auto of = [this](std::size_t some) { return unit_s_ * static_cast<double>(some); };
  double slower = slower_;
  for (std::size_t k = 0; k < busy_s.size() && !is_known; ++k)
    slower = std::max(slower, busy_s[k] / std::max(first_s_ + of(units_in_hand[k]), 1e-9));
  const double unit_s =
      is_known ? (all.seconds - early.seconds) / (all.units - early.units) : slower * unit_s_;
  const double first_s = is_known || is_first_over_ ? 0 : slower * first_s_;
  double work = unit_s * static_cast<double>(units), longest = 0;
  for (std::size_t k = 0; k < busy_s.size(); ++k) {
    const double whole = first_s + unit_s * static_cast<double>(units_in_hand[k]);
    work += first_s - std::min(busy_s[k], whole);
    longest = std::max(longest, whole - busy_s[k]);
  }
  return std::max(longest, work / static_cast<double>(std::max<std::size_t>(1, busy_s.size())));
}

} // namespace umov::scale
