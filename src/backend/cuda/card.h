#pragma once
// The cards of this machine: what they are, and ready to compute.

#include "backend/cuda/card_poses.h"
#include "backend/cuda/compiler.h"
#include "backend/cuda/driver.h"

#include <memory>
#include <vector>

namespace umov::backend {

/// What a driver says of a card.
struct CardFacts {
  int index = 0; ///< the driver's number
  std::string name;
  int capability = 0; ///< 75: 7.5
  std::size_t memory_bytes = 0;
  std::size_t processors = 1; ///< multiprocessors
};

/// What there is, without compiling anything.
struct CardFindings {
  CudaDriver driver;
  std::vector<CardCompiler> compilers; ///< one at least, in the order of CardCompiler::load
  std::vector<CardFacts> cards;        ///< one at least
};
/// Device with the first thing that lacks, and how to get it. `folders`: looked into before the
/// places where the system has its libraries.
Result<CardFindings> find_cards(std::span<const std::filesystem::path> folders);

/// Gives this thread back the context that it had: others of its process (PyTorch, CuPy) work with
/// theirs, on another card perhaps.
class CallersContext {
public:
  /// The driver outlives it.
  explicit CallersContext(const CudaDriver &driver)
      : driver_(driver), is_known_(driver.current_context(&context_) == cuda_success) {}
  CallersContext(const CallersContext &) = delete;
  CallersContext &operator=(const CallersContext &) = delete;
  ~CallersContext() {
    if (is_known_)
      driver_.use_context(context_);
  }

private:
  const CudaDriver &driver_;
  CudaHandle context_ = nullptr;
  bool is_known_;
};

/// Memory of a card; released with the object.
class CardMemory {
public:
  CardMemory() = default;
  CardMemory(const CudaDriver &driver, CudaHandle context, CudaPointer pointer)
      : driver_(&driver), context_(context), pointer_(pointer) {}
  CardMemory(CardMemory &&other) noexcept { *this = std::move(other); }
  CardMemory &operator=(CardMemory &&other) noexcept;
  ~CardMemory();
  /// Where it stands, as the card knows it: of no use to the host.
  template <class T> [[nodiscard]] T *as() const {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): addresses of a card are numbers to the host
    return reinterpret_cast<T *>(static_cast<std::uintptr_t>(pointer_));
  }
  [[nodiscard]] CudaPointer pointer() const { return pointer_; }

private:
  const CudaDriver *driver_ = nullptr;
  CudaHandle context_ = nullptr;
  CudaPointer pointer_ = 0;
};

/// A card with the program in it.
class Card {
public:
  /// Compiles nothing: `image` is for its capability. The driver outlives the card.
  static Result<std::unique_ptr<Card>> open(const CudaDriver &driver, const CardFacts &facts,
                                            const CardImage &image);
  Card(const Card &) = delete;
  Card &operator=(const Card &) = delete;
  ~Card();

  [[nodiscard]] const CardFacts &facts() const { return facts_; }
  [[nodiscard]] const CudaDriver &driver() const { return driver_; }
  [[nodiscard]] CudaHandle context() const { return context_; }
  /// From here on this thread's calls are for this card.
  [[nodiscard]] Result<void> use() const;
  /// Device with the number of bytes if they are not to be had; `is_full` is then true. For the
  /// card in use.
  [[nodiscard]] Result<CardMemory> allocate(std::size_t bytes, bool &is_full) const;
  /// Bytes that are free.
  [[nodiscard]] Result<std::size_t> free_bytes() const;
  /// Asks for the sums of a batch, and for light or abundances where it has room for them; what
  /// fails on the card may be said by a later call.
  [[nodiscard]] CudaCode launch(const CardScene &scene, const CardBatch &batch,
                                CudaHandle stream) const;
  /// Of a scene, in a batch: so many that who asks for a stop is not kept waiting.
  [[nodiscard]] std::size_t most_poses(const CardScene &scene) const;

private:
  [[nodiscard]] CudaCode launch_one(CudaHandle function, const CardScene &scene,
                                    const CardBatch &batch, CudaHandle stream) const;
  [[nodiscard]] CudaCode launch_sums(const CardScene &scene, const CardBatch &batch,
                                     CudaHandle stream) const;
  Card(const CudaDriver &driver, CardFacts facts) : driver_(driver), facts_(std::move(facts)) {}
  const CudaDriver &driver_;
  CardFacts facts_;
  CudaHandle context_ = nullptr, module_ = nullptr, prepare_ = nullptr, sum_ = nullptr,
             sum_curved_ = nullptr, colour_ = nullptr, weigh_ = nullptr;
};

/// All cards of one sort, that of the first: they share the poses of a batch.
class CardSet {
public:
  /// Finds, compiles (or takes what `cache` keeps) and loads, with the first compiler that knows
  /// the card and whose code the driver takes.
  static Result<std::shared_ptr<const CardSet>> open(std::span<const std::filesystem::path> folders,
                                                     const std::filesystem::path &cache);
  CardSet(const CardSet &) = delete;
  CardSet &operator=(const CardSet &) = delete;
  ~CardSet();
  [[nodiscard]] const std::vector<std::unique_ptr<Card>> &cards() const { return cards_; }
  /// "2 x NVIDIA ...", for headers of files.
  [[nodiscard]] std::string name() const;
  /// What bytes depend on: name, capability and compiler, not the number of cards.
  [[nodiscard]] const std::string &identity() const { return identity_; }
  /// Device in a process that was forked from the one that opened them: CUDA is of no use there.
  [[nodiscard]] Result<void> check_process() const;

private:
  explicit CardSet(CudaDriver driver) : driver_(std::move(driver)) {}
  Result<void> fill(const std::vector<CardFacts> &cards, const CardCompiler &compiler,
                    const std::filesystem::path &cache);
  CudaDriver driver_;
  int process_ = 0; ///< that opened them
  std::string identity_;
  std::vector<std::unique_ptr<Card>> cards_;
};

} // namespace umov::backend
