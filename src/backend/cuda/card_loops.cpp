#include "backend/cuda/on_card.h"

#include <algorithm>
#include <deque>

namespace umov::backend {
namespace {

/// Poses at a time: two rounds of all threads of the largest cards.
constexpr std::size_t batch_most = 131'072, batch_least = 256;
/// Of each card: while one computes, the other is copied.
constexpr std::size_t slots_per_card = 2;
/// Fewer poses are not worth sharing out.
constexpr std::size_t share_least = 4096;

/// Memory of the host that a card reads and writes by itself.
class HostMemory {
public:
  HostMemory() = default;
  HostMemory(const HostMemory &) = delete;
  HostMemory &operator=(const HostMemory &) = delete;
  ~HostMemory() {
    if (pointer_ != nullptr)
      driver_->release_host(pointer_);
  }
  Result<void> take(const Card &card, std::size_t bytes, bool &is_full) {
    driver_ = &card.driver();
    const CudaCode code = driver_->allocate_host(&pointer_, std::max<std::size_t>(bytes, 1));
    is_full = code == cuda_out_of_memory;
    return driver_->check(code, "asking for " + std::to_string(bytes) + " bytes of host memory");
  }
  template <class T> [[nodiscard]] T *as() const { return static_cast<T *>(pointer_); }

private:
  const CudaDriver *driver_ = nullptr;
  void *pointer_ = nullptr;
};

} // namespace

void CardRows::read(std::size_t pose, PoseSums &out) const {
  const auto from =
      columns_.sums_at(static_cast<const RunningSum *>(rows_) + pose * columns_.size());
  const auto copy = [](View<const RunningSum> of, View<double> to) {
    for (std::size_t k = 0; k < of.size(); ++k)
      to[k] = of[k].value();
  };
  copy(from.specular, out.specular);
  copy(from.specular_variance, out.specular_variance);
  copy(from.specular_bias, out.specular_bias);
  copy(from.specular_linear, out.specular_linear);
  copy(from.product, out.product);
  copy(from.product_variance, out.product_variance);
  copy(from.product_linear, out.product_linear);
  out.is_any_seen = is_any_seen_[pose] != 0;
}

/// Bytes of one pose.
struct CardLoops::Sizes {
  std::size_t lobes = 0, sums = 0;
  std::size_t reflection = 0, work = 0, light = 0; ///< 0: not asked for
  /// What comes out.
  [[nodiscard]] std::size_t rows() const { return light > 0 ? light : work > 0 ? work : sums; }
  [[nodiscard]] std::size_t all() const {
    return sizeof(PoseDirections) + sizeof(PoseData<float>) + lobes + sums + reflection + work +
           light + 1;
  }
};

CardLoops::Sizes CardLoops::sizes() const {
  Sizes out;
  out.lobes = columns_.lobes * sizeof(kernel::LobeAtPose<float>);
  out.sums = columns_.size() * sizeof(RunningSum);
  if (wants_ == CardWants::Abundances)
    out.work = columns_.weighed_size() * sizeof(float);
  if (wants_ != CardWants::Light)
    return out;
  out.reflection = sizeof(PoseReflection);
  out.work = columns_.work_size(reflections_, bands_) * sizeof(float);
  out.light = light_columns * bands_ * sizeof(float);
  return out;
}

/// Room for a batch on a card and on the host, and the queue that it goes through.
struct CardLoops::Slot {
  explicit Slot(const OnCard &where) : on(where) {}
  Slot(const Slot &) = delete;
  Slot &operator=(const Slot &) = delete;
  ~Slot() {
    if (stream == nullptr)
      return;
    on.card().driver().use_context(on.card().context());
    on.card().driver().wait_for(stream);
    on.card().driver().release_stream(stream);
  }
  Result<void> make_room(std::size_t batch, const Sizes &sizes, bool &is_full);
  CudaCode begin(std::span<const PoseDirections> of, std::size_t at, const Sizes &sizes);
  CudaCode finish() const {
    on.card().driver().use_context(on.card().context());
    return on.card().driver().wait_for(stream);
  }

  const OnCard &on;
  CudaHandle stream = nullptr;
  CardMemory poses, ready, lobes, sums, seen, reflection, work, light;
  HostMemory poses_in, rows_out, seen_out;
  std::size_t first = 0, count = 0;
};

Result<void> CardLoops::Slot::make_room(std::size_t batch, const Sizes &sizes, bool &is_full) {
  const Card &card = on.card();
  UMOV_TRY(card.use());
  constexpr unsigned apart_from_others = 1; // CU_STREAM_NON_BLOCKING
  UMOV_TRY(
      card.driver().check(card.driver().make_stream(&stream, apart_from_others), "making a queue"));
  struct Wanted {
    CardMemory &memory;
    std::size_t bytes;
  };
  const Wanted all[] = {{poses, sizeof(PoseDirections)},
                        {ready, sizeof(PoseData<float>)},
                        {lobes, sizes.lobes},
                        {sums, sizes.sums},
                        {reflection, sizes.reflection},
                        {work, sizes.work},
                        {light, sizes.light},
                        {seen, 1}};
  for (const Wanted &wanted : all) {
    UMOV_ASSIGN(memory, card.allocate(batch * wanted.bytes, is_full));
    wanted.memory = std::move(memory);
  }
  UMOV_TRY(poses_in.take(card, batch * sizeof(PoseDirections), is_full));
  UMOV_TRY(rows_out.take(card, batch * sizes.rows(), is_full));
  return seen_out.take(card, batch, is_full);
}

/// Everything in the queue's order: nothing is waited for here.
CudaCode CardLoops::Slot::begin(std::span<const PoseDirections> of, std::size_t at,
                                const Sizes &sizes) {
  const Card &card = on.card();
  const CudaDriver &driver = card.driver();
  first = at;
  count = of.size();
  if (const CudaCode code = driver.use_context(card.context()); code != cuda_success)
    return code;
  std::copy(of.begin(), of.end(), poses_in.as<PoseDirections>());
  if (const CudaCode code = driver.copy_in_later(poses.pointer(), poses_in.as<PoseDirections>(),
                                                 of.size_bytes(), stream);
      code != cuda_success)
    return code;
  CardBatch batch;
  batch.poses = {poses.as<const PoseDirections>(), count};
  batch.ready = ready.as<PoseData<float>>();
  batch.lobes = lobes.as<kernel::LobeAtPose<float>>();
  batch.sums = sums.as<RunningSum>();
  batch.is_any_seen = seen.as<std::uint8_t>();
  batch.reflection = reflection.as<PoseReflection>();
  batch.work = work.as<float>();
  batch.light = light.as<float>();
  if (const CudaCode code = card.launch(on.scene(), batch, stream); code != cuda_success)
    return code;
  const CudaPointer rows = sizes.light > 0  ? light.pointer()
                           : sizes.work > 0 ? work.pointer()
                                            : sums.pointer();
  if (const CudaCode code =
          driver.copy_out_later(rows_out.as<char>(), rows, count * sizes.rows(), stream);
      code != cuda_success)
    return code;
  return driver.copy_out_later(seen_out.as<std::uint8_t>(), seen.pointer(), count, stream);
}

CardLoops::CardLoops(std::shared_ptr<const CardSet> cards) : cards_(std::move(cards)) {}
CardLoops::~CardLoops() {
  const CallersContext kept(cards_->cards().front()->driver());
  slots_.clear();
  on_cards_.clear();
}

Result<std::unique_ptr<CardLoops>> CardLoops::make(std::shared_ptr<const CardSet> cards,
                                                   const CardSource &source) {
  UMOV_TRY(cards->check_process());
  const auto held = cards; // what does not come out ends before it
  const CallersContext kept(held->cards().front()->driver());
  std::unique_ptr<CardLoops> out(new CardLoops(std::move(cards)));
  out->columns_ = {source.scene.lobes.size(), source.scene.products.size()};
  out->bands_ = source.colours.bands;
  out->reflections_ = source.colours.reflection.columns;
  for (const auto &card : out->cards_->cards()) {
    UMOV_ASSIGN(there, OnCard::make(*card, source));
    out->on_cards_.push_back(std::move(there));
  }
  const OnCard &first = *out->on_cards_.front();
  out->batch_ = std::clamp(first.card().most_poses(first.scene()), share_least, batch_most);
  return out;
}

Result<void> CardLoops::put_masks(const Masks *masks, std::size_t version) {
  UMOV_TRY(cards_->check_process());
  const CallersContext kept(cards_->cards().front()->driver());
  for (const auto &there : on_cards_) {
    if (there->put_masks(masks, version))
      continue;
    // Batches can be made again, smaller.
    slots_.clear();
    UMOV_TRY(there->put_masks(masks, version));
  }
  return {};
}

bool CardLoops::lacks_memory() const {
  return is_full_ || std::any_of(on_cards_.begin(), on_cards_.end(),
                                 [](const auto &there) { return there->is_full(); });
}

/// So many poses for each slot that all have work.
std::size_t CardLoops::share_of(std::size_t poses) const {
  const std::size_t slots = slots_per_card * on_cards_.size();
  return std::min(batch_, std::max((poses + slots - 1) / slots, share_least));
}

/// Two on each card with room for `poses`, in halves until they fit.
Result<void> CardLoops::make_slots(std::size_t poses) {
  if (!slots_.empty() && room_ >= poses)
    return {};
  for (room_ = poses;; room_ = batch_) {
    slots_.clear();
    bool is_full = false;
    Result<void> made;
    for (std::size_t k = 0; k < slots_per_card * on_cards_.size() && made; ++k) {
      slots_.push_back(std::make_unique<Slot>(*on_cards_[k % on_cards_.size()]));
      made = slots_.back()->make_room(room_, sizes(), is_full);
    }
    if (made) {
      is_full_ = false;
      return {};
    }
    slots_.clear();
    is_full_ = is_full;
    if (!is_full)
      return made;
    if (room_ <= batch_least)
      return fail(ErrorCode::Device,
                  made.error().message + ": beside the scene and its masks there is no room for " +
                      std::to_string(room_) + " poses of " + std::to_string(sizes().all()) +
                      " bytes. Take --device cpu or a card with more memory");
    batch_ = room_ / 2;
  }
}

/// Until everything is done, or a card says that it is full: `finished` poses are done then.
Result<void> CardLoops::run_on(std::span<const PoseDirections> poses,
                               const std::atomic<bool> *cancel, const Done &done,
                               std::size_t &finished, bool &is_full) {
  const CudaDriver &driver = cards_->cards().front()->driver();
  const std::string what = "computing on " + cards_->name();
  // What is under way reads the scene and its masks, which the caller may change: it is waited for
  // however this ends, by `done` throwing too.
  struct Waiting : std::deque<Slot *> {
    Waiting() = default;
    Waiting(const Waiting &) = delete;
    Waiting &operator=(const Waiting &) = delete;
    ~Waiting() {
      for (Slot *slot : *this)
        (void)slot->finish(); // nothing of theirs is used: they come again
    }
  } waiting;
  std::deque<Slot *> free;
  for (const auto &slot : slots_)
    free.push_back(slot.get());
  const auto failed = [&](CudaCode code) {
    is_full = code == cuda_out_of_memory;
    return driver.check(code, what);
  };
  const std::size_t share = std::min(share_of(poses.size()), room_);
  std::size_t next = finished;
  const auto is_stopped = [&] { return cancel != nullptr && *cancel; };
  while (finished < poses.size() && !is_stopped()) {
    while (!free.empty() && next < poses.size()) {
      const std::size_t count = std::min(share, poses.size() - next);
      waiting.push_back(free.front()); // some of it may be under way where the rest fails
      free.pop_front();
      if (const CudaCode code = waiting.back()->begin(poses.subspan(next, count), next, sizes());
          code != cuda_success)
        return failed(code);
      next += count;
    }
    Slot &slot = *waiting.front();
    waiting.pop_front();
    if (const CudaCode code = slot.finish(); code != cuda_success)
      return failed(code);
    done(slot.first, slot.count,
         CardRows(wants_, columns_, bands_, slot.rows_out.as<const void>(),
                  slot.seen_out.as<std::uint8_t>()));
    finished = slot.first + slot.count;
    free.push_back(&slot);
  }
  return {};
}

Result<void> CardLoops::run(std::span<const PoseDirections> poses, CardWants wants,
                            const std::atomic<bool> *cancel, const Done &done) {
  UMOV_TRY(cards_->check_process());
  const CallersContext kept(cards_->cards().front()->driver());
  if (wants != wants_)
    slots_.clear();
  wants_ = wants;
  std::size_t finished = 0;
  for (;;) {
    UMOV_TRY(make_slots(share_of(poses.size())));
    bool is_full = false;
    auto ran = run_on(poses, cancel, done, finished, is_full);
    is_full_ = is_full;
    if (ran || !is_full || room_ <= batch_least)
      return ran;
    slots_.clear();
    batch_ = room_ / 2;
  }
}

} // namespace umov::backend
