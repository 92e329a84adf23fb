#pragma once
// Private: an engine's scene on graphics cards.

#include "backend/cuda/card_loops.h"

#include <umov/core/locks.h>
#include <umov/light/device.h>
#include <vector>

namespace umov {

class Cards {
public:
  std::shared_ptr<const backend::CardSet> set;
};

/// Of one engine.
struct CardEngine {
  std::unique_ptr<backend::CardLoops> loops;
  Mutex one_at_a_time;
  /// Chunks of surfaces without a kernel: the processor lists their facets.
  std::vector<backend::Chunk> general;
};

/// Throws Failure: an evaluation has no other way to say that a card is lost.
[[noreturn]] void give_up(const Error &lost);

} // namespace umov
