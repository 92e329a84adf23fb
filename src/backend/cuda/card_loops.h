#pragma once
// A scene on all cards, and batches of poses through them.

#include "backend/cuda/card.h"

#include <atomic>
#include <functional>

namespace umov::backend {

/// What its materials make of sums, on the host.
struct CardColourSource {
  View<const SlotColour<float>> slots; ///< as SceneData::slots
  View<const LobeRounding<float>> rounding;
  ReflectionTable<float> reflection;
  std::uint32_t bands = 0; ///< 0: cards give sums alone
};

/// What a scene is on the host, to be put on a card. Views are read while the call lasts.
struct CardSource {
  SceneData<float> scene; ///< in chunks of any length; none of its slots is general
  View<const kernel::LobeConstants<double>> lobes;
  bool has_polarized_body = false;
  MaskErrorModel error;
  CardColourSource colours;
};

/// What cards are asked for.
enum class CardWants : std::uint8_t { Sums, Abundances, Light };

/// Poses that came back.
class CardRows {
public:
  CardRows(CardWants what, CardColumns columns, std::size_t bands, const void *rows,
           const std::uint8_t *is_any_seen)
      : what_(what), columns_(columns), bands_(bands), rows_(rows), is_any_seen_(is_any_seen) {}
  [[nodiscard]] CardWants what() const { return what_; }
  /// Puts the sums of one pose of the batch into `out`, which has room for them. Of Sums.
  void read(std::size_t pose, PoseSums &out) const;
  /// Of Abundances.
  [[nodiscard]] Weighed<const float> weighed(std::size_t pose) const {
    return columns_.weighed_at(static_cast<const float *>(rows_) + pose * columns_.weighed_size());
  }
  /// The light of one pose as LightRow has it. Of Light.
  [[nodiscard]] const float *light(std::size_t pose) const {
    return static_cast<const float *>(rows_) + pose * light_columns * bands_;
  }
  [[nodiscard]] bool is_any_seen(std::size_t pose) const { return is_any_seen_[pose] != 0; }

private:
  CardWants what_;
  CardColumns columns_;
  std::size_t bands_;
  const void *rows_;
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
  using Done = std::function<void(std::size_t first, std::size_t count, const CardRows &rows)>;
  Result<void> run(std::span<const PoseDirections> poses, CardWants wants,
                   const std::atomic<bool> *cancel, const Done &done);
  /// CardWants::Light may be asked for.
  [[nodiscard]] bool has_colours() const { return bands_ > 0; }
  /// What failed last did so for want of memory: no card is lost, and whoever has another way can
  /// take it.
  [[nodiscard]] bool lacks_memory() const;

private:
  class OnCard;
  struct Slot;
  explicit CardLoops(std::shared_ptr<const CardSet> cards);
  [[nodiscard]] std::size_t share_of(std::size_t poses) const;
  Result<void> make_slots(std::size_t poses);
  Result<void> run_on(std::span<const PoseDirections> poses, const std::atomic<bool> *cancel,
                      const Done &done, std::size_t &finished, bool &is_full);
  struct Sizes;
  [[nodiscard]] Sizes sizes() const;

  std::shared_ptr<const CardSet> cards_;
  std::vector<std::unique_ptr<OnCard>> on_cards_;
  std::vector<std::unique_ptr<Slot>> slots_;
  CardColumns columns_;
  std::size_t bands_ = 0, reflections_ = 0;
  CardWants wants_ = CardWants::Sums; ///< of the slots that there are
  std::size_t batch_ = 0;             ///< most poses of a slot
  std::size_t room_ = 0;              ///< of the slots that there are
  bool is_full_ = false;              ///< what failed last was a batch for which there is no room
};

} // namespace umov::backend
