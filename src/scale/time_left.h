#pragma once
// Private: how long the rest of a job will take, from what its shards have taken so far.

#include <cstddef>
#include <span>
#include <vector>

namespace umov::scale {

/// Clock of the shards. What was predicted holds until the first one is done, drawn out by what it
/// takes longer, as other work may have a share of the machine; then the later half of those that
/// are: the first ones learn masks, and machines get busier or idler.
class TimeLeft {
public:
  /// `unit_s`: predicted for a pose, an object ... ; `first_s`: for all that comes before the
  /// first.
  TimeLeft(double unit_s, double first_s) : unit_s_(unit_s), first_s_(first_s) {}
  /// A shard of so many units took a worker so long. The first one of a worker (`is_first`) says
  /// nothing of the others where much comes before it: masks.
  void took(std::size_t units, double seconds, bool is_first = false);
  /// Seconds until so many units more are done, those in hand among them, of which each worker
  /// (`units_in_hand`, `busy_s`) has done a part.
  [[nodiscard]] double left_s(std::size_t units, std::span<const std::size_t> units_in_hand,
                              std::span<const double> busy_s) const;

private:
  struct Sum {
    double units, seconds;
  };
  double unit_s_, first_s_;
  double slower_ = 1; ///< than predicted, by first shards
  bool is_first_over_ = false;
  std::vector<Sum> sums_{{0, 0}}; ///< of all shards up to each
};

} // namespace umov::scale
