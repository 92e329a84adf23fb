#pragma once
// A scene on all cards, and batches of poses through them.

#include "backend/cuda/card.h"

#include <atomic>
#include <functional>

namespace umov::backend {

/// What a scene is on the host, to be put on a card. Views are read while the call lasts.
struct CardSource {
  SceneData<float> scene; ///< in chunks of any length; none of its slots is general
  View<const kernel::LobeConstants<double>> lobes;
  bool has_polarized_body = false;
  MaskErrorModel error;
};

/// Poses that came back.
class CardSums {
public:
  CardSums(CardColumns columns, const RunningSum *sums, const std::uint8_t *is_any_seen)
      : columns_(columns), sums_(sums), is_any_seen_(is_any_seen) {}
  /// Puts the sums of one pose of the batch into `out`, which has room for them.
  void read(std::size_t pose, PoseSums &out) const;

private:
  CardColumns columns_;
  const RunningSum *sums_;
  const std::uint8_t *is_any_seen_;
};

/// Not thread safe: one evaluation at a time.
class CardLoops {
public:
  /// Device if the scene does not fit beside what else is on a card.
  static Result<std::unique_ptr<CardLoops>> make(std::shared_ptr<const CardSet> cards,
                                                 const CardSource &source);
  ~CardLoops();
  /// Masks of the scene; null: nothing hides anything. Put again only if `version` is another than
  /// last time. Device with the number of bytes if they do not fit.
  Result<void> put_masks(const Masks *masks, std::size_t version);
  /// Runs `done(first, count, sums)` for batch after batch, in order and on this thread, while the
  /// cards work on the next ones. What a card says it has no memory for is asked for in halves.
  /// Device if a card is lost; what came before was handed to `done`. Ends early once `cancel` is
  /// true.
  using Done = std::function<void(std::size_t first, std::size_t count, const CardSums &sums)>;
  Result<void> sum(std::span<const PoseDirections> poses, const std::atomic<bool> *cancel,
                   const Done &done);
  /// Poses that a card takes at once.
  [[nodiscard]] std::size_t batch() const { return batch_; }
  /// For tests: no more than so many.
  void limit_batch(std::size_t poses);

private:
  class OnCard;
  struct Slot;
  explicit CardLoops(std::shared_ptr<const CardSet> cards);
  [[nodiscard]] std::size_t share_of(std::size_t poses) const;
  Result<void> make_slots(std::size_t poses);
  Result<void> run(std::span<const PoseDirections> poses, const std::atomic<bool> *cancel,
                   const Done &done, std::size_t &finished, bool &is_full);
  [[nodiscard]] std::size_t bytes_per_pose() const;

  std::shared_ptr<const CardSet> cards_;
  std::vector<std::unique_ptr<OnCard>> on_cards_;
  std::vector<std::unique_ptr<Slot>> slots_;
  CardColumns columns_;
  std::size_t batch_ = 0; ///< most poses of a slot
  std::size_t room_ = 0;  ///< of the slots that there are
};

} // namespace umov::backend
