#pragma once
// A scene and its masks in the memory of one card.

#include "backend/cuda/card_loops.h"

#include <vector>

namespace umov::backend {

class CardLoops::OnCard {
public:
  /// Device with the number of bytes if the scene does not fit.
  static Result<std::unique_ptr<OnCard>> make(const Card &card, const CardSource &source);
  Result<void> put_masks(const Masks *masks, std::size_t version);
  [[nodiscard]] const Card &card() const { return card_; }
  [[nodiscard]] const CardScene &scene() const { return scene_; }
  /// What failed last did so for want of memory.
  [[nodiscard]] bool is_full() const { return is_full_; }

private:
  using Pieces = std::vector<CardMemory>;
  explicit OnCard(const Card &card) : card_(card) {}
  /// A copy on the card, which `pieces` then owns; none of what is empty.
  template <class T> Result<View<T>> put(View<T> from, Pieces &pieces);
  Result<void> put_colours(const CardColourSource &from);
  Result<void> put_table(const MaskTable &from, MaskTable &to);
  [[nodiscard]] Result<void> check_room(const char *what, std::size_t bytes);

  const Card &card_;
  Pieces scene_pieces_, mask_pieces_;
  CardScene scene_;
  std::size_t version_ = 0;
  bool is_full_ = false;
};

} // namespace umov::backend
