#include "light/fast/cards.h"

#include "light/fast/state.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace umov {

const char *name_of(DeviceChoice choice) {
  switch (choice) {
  case DeviceChoice::Cpu:
    return "cpu";
  case DeviceChoice::Cuda:
    return "cuda";
  case DeviceChoice::Auto:
    return "auto";
  }
  return "";
}

void give_up(const Error &lost) { throw Failure(lost); }

std::string name_of(const Cards &cards) { return cards.set->name(); }

Result<std::shared_ptr<const Cards>> open_cards(const DeviceOptions &options) {
  // Kept until the program ends, and not closed then: the driver may be gone by that time.
  struct Opened {
    Mutex mutex;
    std::vector<std::filesystem::path> folders;
    std::filesystem::path cache;
    std::shared_ptr<const Cards> cards;
  };
  static auto *const opened = new Opened;
  const WriteLock lock(opened->mutex);
  if (opened->cards && opened->folders == options.folders && opened->cache == options.cache)
    return opened->cards;
  UMOV_ASSIGN(set, backend::CardSet::open(options.folders, options.cache));
  auto cards = std::make_shared<Cards>();
  cards->set = std::move(set);
  opened->folders = options.folders;
  opened->cache = options.cache;
  opened->cards = std::move(cards);
  return opened->cards;
}

Result<std::string> describe_cards(const std::vector<std::filesystem::path> &folders) {
  UMOV_ASSIGN(found, backend::find_cards(folders));
  std::vector<std::string> cards;
  for (const backend::CardFacts &card : found.cards)
    cards.push_back(fmt::format("{} ({:.0f} GB, compute {}.{})", card.name,
                                static_cast<double>(card.memory_bytes) / 1e9, card.capability / 10,
                                card.capability % 10));
  return fmt::format("{}; driver of CUDA {}, compiler {}", fmt::join(cards, ", "),
                     backend::cuda_version_text(found.driver.version), found.compiler.version());
}

Result<void> Engine::use_cards(const std::shared_ptr<const Cards> &cards) {
  State &s = *state_;
  if (s.options.is_double)
    return fail(ErrorCode::Usage, "cards compute in single precision, not the reference in double");
  auto made = std::make_unique<CardEngine>();
  std::vector<backend::Chunk> chunks;
  for (const backend::Chunk &chunk : s.single.chunks)
    (s.single.slots[chunk.slot].is_general ? made->general : chunks).push_back(chunk);
  backend::CardSource source;
  source.scene = s.views.single;
  source.scene.chunks = chunks;
  source.lobes = s.compiled.data.lobes;
  source.has_polarized_body = s.compiled.has_u;
  source.error = s.error_model();
  UMOV_ASSIGN(loops, backend::CardLoops::make(cards->set, source));
  made->loops = std::move(loops);
  s.on_cards = std::move(made);
  return {};
}

} // namespace umov
