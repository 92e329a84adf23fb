#pragma once
// Private: an engine's scene on graphics cards.

#include "backend/cuda/card_loops.h"

#include <atomic>
#include <string>
#include <umov/core/locks.h>
#include <umov/light/engine.h>
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
  /// The processor takes over where masks or batches no longer fit: why, once it has. Written under
  /// the lock, before `is_left`.
  bool may_be_left = false;
  std::atomic<bool> is_left{false};
  std::string why_left;
  std::string name, identity;                            ///< as name_of and identity_of
  std::atomic<std::size_t> lit{0}, left_to_processor{0}; ///< poses so far
  /// Chunks of surfaces without a kernel: the processor lists their facets.
  std::vector<backend::Chunk> general;
};

/// What an engine's device is from here on: names of cards, "" for the processor, "cpu: why" where
/// Auto took it. Device where Cuda is asked for and lacks something.
Result<std::string> take_cards(Engine &engine, const DeviceOptions &device);
/// The same now: cards may have been left since.
std::string device_now(const Engine &engine, const std::string &at_first);
/// LightFacts::instruction_set as it is now.
std::string instructions_now(const Engine &engine, const std::string &at_first);

/// Throws Failure: an evaluation has no other way to say that a card is lost.
[[noreturn]] void give_up(const Error &lost);

} // namespace umov
