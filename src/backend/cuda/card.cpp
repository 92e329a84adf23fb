#include "backend/cuda/card.h"

#include <algorithm>
#include <unistd.h>

namespace umov::backend {
namespace {

/// Of the driver's CUdevice_attribute.
constexpr int attribute_processors = 16, attribute_major = 75, attribute_minor = 76;
/// Threads of a block: a pose needs some 128 registers, of which four such blocks fill a
/// multiprocessor; one with curved classes 148, three blocks.
constexpr unsigned threads_per_block = 128;
/// Poses times facets of a launch, for each multiprocessor: well below the seconds after which a
/// card that drives a screen too ends what runs (CUDA_ERROR_LAUNCH_TIMEOUT).
constexpr std::size_t work_of_a_launch = std::size_t{1} << 24;
/// Of a batch, of which there are two under way when somebody asks for a stop.
constexpr std::size_t launches_of_a_batch = 16;
/// Facets of a chunk at most.
constexpr std::size_t facets_of_a_chunk = groups_per_thread * lanes;

Result<CardFacts> facts_of(const CudaDriver &driver, int index) {
  CardFacts out;
  out.index = index;
  CudaDevice device = 0;
  UMOV_TRY(driver.check(driver.device_at(&device, index), "asking for a card"));
  char name[256] = "";
  UMOV_TRY(driver.check(driver.device_name(name, sizeof name - 1, device), "asking for its name"));
  out.name = name;
  int major = 0, minor = 0;
  UMOV_TRY(driver.check(driver.device_attribute(&major, attribute_major, device),
                        "asking for its compute capability"));
  UMOV_TRY(driver.check(driver.device_attribute(&minor, attribute_minor, device),
                        "asking for its compute capability"));
  out.capability = 10 * major + minor;
  UMOV_TRY(driver.check(driver.device_memory(&out.memory_bytes, device), "asking for its memory"));
  int processors = 0;
  UMOV_TRY(driver.check(driver.device_attribute(&processors, attribute_processors, device),
                        "asking for its multiprocessors"));
  out.processors = static_cast<std::size_t>(std::max(processors, 1));
  return out;
}

} // namespace

Result<CardFindings> find_cards(std::span<const std::filesystem::path> folders) {
  UMOV_ASSIGN(driver, CudaDriver::load(folders));
  int count = 0;
  UMOV_TRY(driver.check(driver.device_count(&count), "counting the cards"));
  if (count < 1)
    return fail(ErrorCode::Device,
                driver.file + " (CUDA " + cuda_version_text(driver.version) + ") finds no card");
  std::vector<CardFacts> cards;
  for (int k = 0; k < count; ++k) {
    UMOV_ASSIGN(facts, facts_of(driver, k));
    cards.push_back(std::move(facts));
  }
  UMOV_ASSIGN(compilers, CardCompiler::load(folders, driver.version));
  return CardFindings{std::move(driver), std::move(compilers), std::move(cards)};
}

CardMemory &CardMemory::operator=(CardMemory &&other) noexcept {
  std::swap(driver_, other.driver_);
  std::swap(context_, other.context_);
  std::swap(pointer_, other.pointer_);
  return *this;
}

CardMemory::~CardMemory() {
  if (pointer_ == 0)
    return;
  driver_->use_context(context_); // what fails here is lost with the card
  driver_->release(pointer_);
}

Result<std::unique_ptr<Card>> Card::open(const CudaDriver &driver, const CardFacts &facts,
                                         const CardImage &image) {
  std::unique_ptr<Card> out(new Card(driver, facts));
  CudaDevice device = 0;
  UMOV_TRY(driver.check(driver.device_at(&device, facts.index), "opening " + facts.name));
  UMOV_TRY(driver.check(driver.retain_context(&out->context_, device), "opening " + facts.name));
  UMOV_TRY(out->use());
  const auto loaded = driver.check(driver.load_module(&out->module_, image.bytes.c_str()),
                                   "loading the kernels into " + facts.name);
  if (!loaded)
    return fail(ErrorCode::Device, loaded.error().message + ": the driver is of CUDA " +
                                       cuda_version_text(driver.version) +
                                       "; a compiler (nvidia-cuda-nvrtc) no newer than that makes "
                                       "code that it loads");
  for (const auto &[function, name] : {std::pair{&out->prepare_, "umov_prepare_poses"},
                                       {&out->sum_, "umov_sum_poses"},
                                       {&out->sum_curved_, "umov_sum_curved_poses"},
                                       {&out->colour_, "umov_colour_poses"},
                                       {&out->weigh_, "umov_weigh_poses"}})
    UMOV_TRY(driver.check(driver.function_of(function, out->module_, name),
                          std::string("looking for ") + name));
  return out;
}

Card::~Card() {
  if (context_ == nullptr)
    return;
  driver_.use_context(context_);
  if (module_ != nullptr)
    driver_.unload_module(module_);
  CudaDevice device = 0;
  if (driver_.device_at(&device, facts_.index) == cuda_success)
    driver_.release_context(device);
}

Result<void> Card::use() const {
  return driver_.check(driver_.use_context(context_), "using " + facts_.name);
}

Result<CardMemory> Card::allocate(std::size_t bytes, bool &is_full) const {
  if (bytes == 0)
    return CardMemory();
  CudaPointer pointer = 0;
  const CudaCode code = driver_.allocate(&pointer, bytes);
  is_full = code == cuda_out_of_memory;
  UMOV_TRY(driver_.check(code, "asking " + facts_.name + " for " + std::to_string(bytes) +
                                   " bytes of memory"));
  return CardMemory(driver_, context_, pointer);
}

Result<std::size_t> Card::free_bytes() const {
  std::size_t free = 0, total = 0;
  UMOV_TRY(driver_.check(driver_.memory_info(&free, &total), "asking for free memory"));
  return free;
}

CudaCode Card::launch_one(CudaHandle function, const CardScene &scene, const CardBatch &batch,
                          CudaHandle stream) const {
  CardScene scene_copy = scene;
  CardBatch batch_copy = batch;
  void *parameters[] = {&scene_copy, &batch_copy};
  const auto blocks =
      static_cast<unsigned>((batch.poses.size() + threads_per_block - 1) / threads_per_block);
  return driver_.launch(function, blocks, 1, 1, threads_per_block, 1, 1, 0, stream, parameters,
                        nullptr);
}

/// Some chunks after the others: sums go on where they were, so that no byte depends on it.
CudaCode Card::launch_sums(const CardScene &scene, const CardBatch &batch,
                           CudaHandle stream) const {
  const View<const Chunk> all = scene.scene.chunks;
  const std::size_t most =
      std::max<std::size_t>(facts_.processors * work_of_a_launch /
                                (std::max<std::size_t>(batch.poses.size(), 1) * facets_of_a_chunk),
                            1);
  const CudaHandle sum = scene.scene.patches_of.empty() ? sum_ : sum_curved_;
  CardScene part = scene;
  CardBatch at = batch;
  std::size_t first = 0;
  do {
    part.scene.chunks = {all.data() + first, std::min(most, all.size() - first)};
    if (const CudaCode code = launch_one(sum, part, at, stream); code != cuda_success)
      return code;
    at.goes_on = true;
    first += most;
  } while (first < all.size());
  return cuda_success;
}

CudaCode Card::launch(const CardScene &scene, const CardBatch &batch, CudaHandle stream) const {
  CudaCode code = launch_one(prepare_, scene, batch, stream);
  if (code == cuda_success)
    code = launch_sums(scene, batch, stream);
  if (code == cuda_success && batch.light != nullptr)
    return launch_one(colour_, scene, batch, stream);
  if (code == cuda_success && batch.work != nullptr)
    return launch_one(weigh_, scene, batch, stream);
  return code;
}

std::size_t Card::most_poses(const CardScene &scene) const {
  const std::size_t facets =
      std::max<std::size_t>(scene.scene.chunks.size(), 1) * facets_of_a_chunk;
  return facts_.processors * work_of_a_launch / facets * launches_of_a_batch;
}

Result<void> CardSet::fill(const std::vector<CardFacts> &cards, const CardCompiler &compiler,
                           const std::filesystem::path &cache) {
  cards_.clear();
  const CardFacts &first = cards.front();
  UMOV_ASSIGN(image, compiler.image_for(first.capability, cache));
  for (const CardFacts &facts : cards) {
    if (facts.name != first.name || facts.capability != first.capability)
      continue; // other code, other bytes
    UMOV_ASSIGN(card, Card::open(driver_, facts, image));
    cards_.push_back(std::move(card));
  }
  identity_ = first.name + ", compute " + std::to_string(first.capability / 10) + "." +
              std::to_string(first.capability % 10) + ", compiler " + compiler.version();
  if (compiler.makes_assembly_for(first.capability))
    identity_ += ", driver of CUDA " + cuda_version_text(driver_.version);
  return {};
}

Result<std::shared_ptr<const CardSet>> CardSet::open(std::span<const std::filesystem::path> folders,
                                                     const std::filesystem::path &cache) {
  UMOV_ASSIGN(found, find_cards(folders));
  const CudaDriver driver = found.driver;
  const CallersContext kept(driver);
  std::shared_ptr<CardSet> out(new CardSet(std::move(found.driver)));
  out->process_ = ::getpid();
  std::vector<std::string> said; // once, where it is no compiler's fault
  for (const CardCompiler &compiler : found.compilers) {
    const auto filled = out->fill(found.cards, compiler, cache);
    if (filled)
      return out;
    if (std::ranges::find(said, filled.error().message) == said.end())
      said.push_back(filled.error().message);
  }
  std::string all;
  for (const std::string &one : said)
    all += (all.empty() ? "" : "; ") + one;
  return fail(ErrorCode::Device, all);
}

CardSet::~CardSet() {
  const CallersContext kept(driver_);
  cards_.clear();
}

Result<void> CardSet::check_process() const {
  if (process_ == ::getpid())
    return {};
  return fail(
      ErrorCode::Device,
      "this process was forked from one that had opened the graphics card, and CUDA does not "
      "work in it: start processes anew (Python: multiprocessing's \"spawn\" or "
      "\"forkserver\"), or use the card in them alone");
}

std::string CardSet::name() const {
  const std::string &name = cards_.front()->facts().name;
  return cards_.size() == 1 ? name : std::to_string(cards_.size()) + " x " + name;
}

} // namespace umov::backend
