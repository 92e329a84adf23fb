#include "light/fast/cards.h"

#include "light/fast/state.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/light/instruction_set.h>

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
std::string identity_of(const Cards &cards) { return cards.set->identity(); }

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
  if (opened->cards) // whatever it was opened with, a fork cannot open it again
    UMOV_TRY(opened->cards->set->check_process());
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

namespace {

/// The compiler that is tried first, and those that are not because of the driver; Device where
/// none knows the card.
Result<std::string> words_of_compilers(const backend::CardFindings &found) {
  const auto knows = [&](const backend::CardCompiler &one) {
    return one.knows(found.cards.front().capability);
  };
  const auto first = std::ranges::find_if(found.compilers, knows);
  if (first == found.compilers.end())
    return fail(ErrorCode::Device, "no compiler knows " + found.cards.front().name +
                                       ": it is too old for " + found.compilers.front().file());
  std::string out = "compiler " + first->version();
  if (first->is_newer_than(found.driver.version))
    out += " (newer than the driver, which may refuse its code)";
  for (const backend::CardCompiler &one : found.compilers)
    if (&one != &*first && one.is_newer_than(found.driver.version))
      out += fmt::format(" ({} of {} is newer than the driver and passed over)", one.version(),
                         one.file());
  return out;
}

} // namespace

Result<std::string> describe_cards(const std::vector<std::filesystem::path> &folders) {
  UMOV_ASSIGN(found, backend::find_cards(folders));
  UMOV_ASSIGN(compilers, words_of_compilers(found));
  std::vector<std::string> cards;
  for (const backend::CardFacts &card : found.cards)
    cards.push_back(fmt::format("{} ({:.0f} GB, compute {}.{})", card.name,
                                static_cast<double>(card.memory_bytes) / 1e9, card.capability / 10,
                                card.capability % 10));
  return fmt::format("{}; driver of CUDA {}, {}", fmt::join(cards, ", "),
                     backend::cuda_version_text(found.driver.version), compilers);
}

void Engine::State::take_light(const backend::CardRows &rows, std::size_t row_of_card,
                               std::size_t row, StokesTable &out) const {
  out.method[row] = masks ? PoseMethod::Masks : PoseMethod::Exact;
  if (!rows.is_any_seen(row_of_card))
    return put_darkness(row, out);
  out.is_dark[row] = 0;
  const std::size_t n = bands(), first = row * n;
  const float *const light = rows.light(row_of_card);
  const auto put = [&](backend::LightRow from, std::vector<double> &to) {
    for (std::size_t b = 0; b < n; ++b)
      to[first + b] = compiled.area_m2 * static_cast<double>(light[from * n + b]);
  };
  put(backend::RowI, out.i);
  put(backend::RowQ, out.q);
  put(backend::RowIErr, out.i_err);
  put(backend::RowQErr, out.q_err);
  if (!compiled.has_u)
    return;
  put(backend::RowU, out.u);
  put(backend::RowUErr, out.u_err);
  put(backend::RowVErr, out.v_err);
}

namespace {

/// A scene's colours in single precision, with the views that cards copy.
struct CardColourStore {
  explicit CardColourStore(const CompiledScene &scene) : rounded_(scene.colours.rounded()) {
    for (const RoundedColours::Slot &slot : rounded_.slots) {
      slots_.push_back(slot.colour);
      backend::SlotColour<float> &to = slots_.back();
      to.lobe = slot.lobe;
      to.single_bounce = slot.single_bounce;
      to.whole = slot.whole;
      to.q = slot.q;
      to.u = slot.u;
    }
    for (const backend::LobeRounding<double> &of : scene.rounding)
      rounding_.push_back({static_cast<float>(of.per_peak), static_cast<float>(of.per_root)});
  }
  [[nodiscard]] backend::CardColourSource view(std::size_t bands) const {
    return {slots_,
            rounding_,
            {rounded_.reflection, rounded_.columns, rounded_.steps},
            static_cast<std::uint32_t>(bands)};
  }

private:
  RoundedColours rounded_;
  std::vector<backend::SlotColour<float>> slots_;
  std::vector<backend::LobeRounding<float>> rounding_;
};

} // namespace

Result<void> Engine::use_cards(const std::shared_ptr<const Cards> &cards, bool may_leave) {
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
  const CardColourStore colours(s.compiled);
  // Abundances need no more than the rounding of lobes.
  source.colours = colours.view(s.compiled.colours.is_tabulated() ? s.bands() : 0);
  UMOV_ASSIGN(loops, backend::CardLoops::make(cards->set, source));
  made->loops = std::move(loops);
  made->may_be_left = may_leave;
  made->name = name_of(*cards);
  made->identity = identity_of(*cards);
  s.on_cards = std::move(made);
  return {};
}

std::string Engine::why_cards_were_left() const {
  return state_->on_cards && state_->on_cards->is_left ? state_->on_cards->why_left : "";
}

std::string Engine::lit_by() const {
  const CardEngine *const cards = state_->on_cards.get();
  if (cards == nullptr || (cards->is_left && cards->lit == 0))
    return "";
  return cards->identity + (cards->left_to_processor > 0 ? " and the processor" : "");
}

Result<std::string> take_cards(Engine &engine, const DeviceOptions &device) {
  if (device.choice == DeviceChoice::Cpu)
    return "";
  const bool is_auto = device.choice == DeviceChoice::Auto;
  const auto cards = open_cards(device);
  const Result<void> used =
      cards ? engine.use_cards(*cards, is_auto) : tl::unexpected(cards.error());
  if (used)
    return name_of(**cards);
  if (!is_auto)
    return tl::unexpected(used.error());
  return "cpu: " + used.error().message;
}

std::string device_now(const Engine &engine, const std::string &at_first) {
  const std::string why = engine.why_cards_were_left();
  if (why.empty())
    return at_first;
  return (engine.lit_by().empty() ? "cpu: " : "cpu in the end, at first " + at_first + ": ") + why;
}

std::string instructions_now(const Engine &engine, const std::string &at_first) {
  if (engine.why_cards_were_left().empty())
    return at_first;
  return (engine.lit_by().empty() ? "" : at_first + " and ") + engine_instruction_set();
}

} // namespace umov
