#include "light/fast/lazy_masks.h"

#include "light/fast/octahedron.h"

#include <algorithm>
#include <umov/core/parallel.h>
#include <umov/core/stop.h>

namespace umov {
namespace {

const MaskTableStore &table_of(const MaskStore &masks, bool is_large) {
  return is_large ? masks.large : masks.small;
}

} // namespace

LazyMasks::LazyMasks(MaskStore known, MaskTracer tracer)
    : store_(std::move(known)), tracer_(std::move(tracer)), view_(store_.view()) {
  is_complete_ = missing(false).empty() && missing(true).empty();
}

std::size_t LazyMasks::bytes() const {
  return read([](const MaskStore &store) { return memory_of(store); });
}

std::vector<std::uint32_t> LazyMasks::missing(bool is_large) const {
  const auto &rows = table_of(store_, is_large).row;
  std::vector<std::uint32_t> out;
  for (std::uint32_t d = 0; d < rows.size(); ++d)
    if (rows[d].first == untraced)
      out.push_back(d);
  return out;
}

/// Directions around those of the poses that have no row.
std::vector<std::uint32_t> LazyMasks::missing(std::span<const Pose> poses, bool is_large,
                                              unsigned threads) const {
  const MaskTableStore &table = table_of(store_, is_large);
  std::vector<std::uint32_t> out;
  if (table.entries == 0)
    return out;
  std::vector<char> is_wanted(table.row.size(), 0);
  constexpr std::size_t block = 1024;
  parallel_for((poses.size() + block - 1) / block, threads, [&](std::size_t task) {
    for (std::size_t i = task * block; i < std::min(poses.size(), (task + 1) * block); ++i)
      for (const Vec3<Body> &direction : {poses[i].sun, poses[i].observer})
        for (const std::uint32_t d : look_around(table.cells, direction).direction)
          if (table.row[d].first == untraced) // whoever writes writes the same
            std::atomic_ref(is_wanted[d]).store(1, std::memory_order_relaxed);
  });
  for (std::uint32_t d = 0; d < is_wanted.size(); ++d)
    if (is_wanted[d] != 0)
      out.push_back(d);
  return out;
}

/// A few at a time for whoever may want to stop: threads wait for each other after each time.
void LazyMasks::trace(std::span<const std::uint32_t> directions, bool is_large, unsigned threads,
                      const std::atomic<bool> *cancel) {
  const std::size_t at_once = cancel != nullptr ? 64 : 1024;
  while (!directions.empty() && !is_stopped(cancel)) {
    const std::size_t count = std::min(at_once, directions.size());
    tracer_.trace(directions.first(count), is_large, threads, store_, cancel);
    if (is_stopped(cancel))
      break;
    directions = directions.subspan(count);
    has_grown_ = true;
    ++version_;
  }
  view_ = store_.view();
  is_complete_ = missing(false).empty() && missing(true).empty();
}

void LazyMasks::take_rows_of(std::shared_ptr<const LazyMasks> elder) {
  const WriteLock lock(mutex_);
  elder_ = std::move(elder);
  elder_version_ = 0;
}

/// Copies what the elder has more than when it was last asked. A copy of all rows takes less time
/// than tracing one in a hundred of them.
void LazyMasks::take_known() {
  if (!elder_ || elder_->version() == elder_version_)
    return;
  elder_version_ = elder_->version(); // what is traced from here on is copied another time
  elder_->read([this](const MaskStore &known) { add_rows(known, store_); });
  ++version_;
}

ReadLock LazyMasks::ensure(std::span<const Pose> poses, unsigned threads,
                           const std::atomic<bool> *cancel) {
  if (is_complete_)
    return ReadLock(mutex_);
  for (;;) {
    {
      ReadLock lock(mutex_);
      if (is_stopped(cancel) ||
          (missing(poses, false, threads).empty() && missing(poses, true, threads).empty()))
        return lock;
    }
    const WriteLock lock(mutex_);
    take_known();
    for (const bool is_large : {false, true})
      trace(missing(poses, is_large, threads), is_large, threads, cancel);
  }
}

void LazyMasks::ensure_all(unsigned threads, const std::atomic<bool> *cancel) {
  const WriteLock lock(mutex_);
  take_known();
  for (const bool is_large : {false, true})
    trace(missing(is_large), is_large, threads, cancel);
}

} // namespace umov
