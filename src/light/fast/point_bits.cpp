#include "light/fast/point_bits.h"

#include <bit>

namespace umov {
namespace {

/// The words of a class in the three directions around one.
class Words {
public:
  Words(const backend::Masks &masks, const backend::GroupMask &group,
        const backend::MaskTable &table, const backend::GridLook &look, std::uint32_t lane)
      : is_large_(group.is_large), lane_(lane) {
    const std::size_t entry = group.entry + (group.is_large ? lane : 0);
    for (std::size_t k = 0; k < 3; ++k)
      block_[k] = masks.pool.data() + table.offset[look.direction[k] * table.entries + entry];
  }
  [[nodiscard]] std::uint32_t all(std::size_t w) const { return of(0, w) & of(1, w) & of(2, w); }
  [[nodiscard]] std::uint32_t any(std::size_t w) const { return of(0, w) | of(1, w) | of(2, w); }

private:
  [[nodiscard]] std::uint32_t of(std::size_t k, std::size_t w) const {
    return is_large_ ? block_[k][w / backend::lanes].word[w % backend::lanes]
                     : block_[k][w].word[lane_];
  }
  const backend::MaskBlock *block_[3]{};
  bool is_large_;
  std::uint32_t lane_;
};

} // namespace

std::size_t split_points(const backend::Masks &masks, const backend::PoseData<double> &pose,
                         std::uint32_t group, std::uint32_t lane, std::uint32_t of,
                         std::vector<DoubtfulPoint> &doubtful) {
  const backend::GroupMask &mask = masks.groups[group];
  const backend::MaskTable &table = mask.is_large ? masks.large : masks.small;
  const Words sun(masks, mask, table, mask.is_large ? pose.large_sun : pose.small_sun, lane);
  const Words seen(masks, mask, table, mask.is_large ? pose.large_observer : pose.small_observer,
                   lane);
  std::size_t free = 0;
  for (std::uint32_t w = 0; w < mask.words; ++w) {
    const std::uint32_t lit = sun.all(w), visible = seen.all(w), sure = lit & visible;
    free += static_cast<std::size_t>(std::popcount(sure));
    for (std::uint32_t rest = sun.any(w) & seen.any(w) & ~sure; rest != 0; rest &= rest - 1) {
      const auto bit = static_cast<std::uint32_t>(std::countr_zero(rest));
      doubtful.push_back(
          {of, 32 * w + bit, ((lit >> bit) & 1u) == 0, ((visible >> bit) & 1u) == 0});
    }
  }
  return free;
}

} // namespace umov
