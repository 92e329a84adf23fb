#pragma once
// Private: masks whose rows are traced when a pose first asks for their direction.

#include "light/fast/masks.h"

#include <atomic>
#include <memory>
#include <umov/core/locks.h>
#include <umov/scene/pose.h>

namespace umov {

/// A short series asks for few directions, a million random poses for all: each is traced once.
/// What a row holds does not depend on when it was traced. Thread safe.
class LazyMasks {
public:
  /// `known`: empty_masks, or what a file held.
  LazyMasks(MaskStore known, MaskTracer tracer);

  /// Traces what poses lack. As long as the lock is held `view` stays as it is. Some of it may
  /// still be lacking once `cancel` is true.
  [[nodiscard]] ReadLock ensure(std::span<const Pose> poses, unsigned threads,
                                const std::atomic<bool> *cancel);
  void ensure_all(unsigned threads, const std::atomic<bool> *cancel);
  /// Rows that `elder` has are copied from now on, not traced again: it is of the same points and
  /// directions. Never both ways, or around: each would wait for the other.
  void take_rows_of(std::shared_ptr<const LazyMasks> elder);

  /// What the loops read: it holds for poses that were ensured, while their lock is held.
  [[nodiscard]] const backend::Masks &view() const { return view_; }
  /// Points of a class, in the order of their bits.
  [[nodiscard]] std::span<const Occluder::Point> points(std::uint32_t group,
                                                        std::uint32_t lane) const {
    return tracer_.points(view_.groups[group], lane);
  }
  [[nodiscard]] std::size_t bytes() const;
  /// Another number whenever there are more rows.
  [[nodiscard]] std::size_t version() const { return version_; }
  /// Rows were traced since the masks were made or read.
  [[nodiscard]] bool has_grown() const { return has_grown_; }
  /// Runs `body(const MaskStore &)` while nobody changes it.
  template <class Body> auto read(const Body &body) const {
    const ReadLock lock(mutex_);
    return body(store_);
  }

private:
  [[nodiscard]] std::vector<std::uint32_t> missing(std::span<const Pose> poses, bool is_large,
                                                   unsigned threads) const;
  [[nodiscard]] std::vector<std::uint32_t> missing(bool is_large) const;
  void trace(std::span<const std::uint32_t> directions, bool is_large, unsigned threads,
             const std::atomic<bool> *cancel);
  void take_known();

  MaskStore store_;
  MaskTracer tracer_;
  backend::Masks view_;
  mutable Mutex mutex_;
  std::atomic<bool> is_complete_{false}, has_grown_{false};
  std::atomic<std::size_t> version_{1};
  std::shared_ptr<const LazyMasks> elder_; ///< null: none
  std::size_t elder_version_ = 0;          ///< whose rows were copied
};

} // namespace umov
