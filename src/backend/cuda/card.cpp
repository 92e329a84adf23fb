#include "backend/cuda/card.h"

#include <algorithm>

namespace umov::backend {
namespace {

/// Of the driver's CUdevice_attribute.
constexpr int attribute_major = 75, attribute_minor = 76;
/// Threads of a block: a pose needs some 128 registers, of which four such blocks fill a
/// multiprocessor.
constexpr unsigned threads_per_block = 128;

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

CudaCode Card::launch(const CardScene &scene, const CardBatch &batch, CudaHandle stream) const {
  CardScene scene_copy = scene;
  CardBatch batch_copy = batch;
  void *parameters[] = {&scene_copy, &batch_copy};
  const auto blocks =
      static_cast<unsigned>((batch.poses.size() + threads_per_block - 1) / threads_per_block);
  const CudaHandle last = batch.light != nullptr  ? colour_
                          : batch.work != nullptr ? weigh_
                                                  : nullptr;
  for (const CudaHandle function : {prepare_, sum_, last}) {
    if (function == nullptr)
      continue;
    if (const CudaCode code = driver_.launch(function, blocks, 1, 1, threads_per_block, 1, 1, 0,
                                             stream, parameters, nullptr);
        code != cuda_success)
      return code;
  }
  return cuda_success;
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
  std::shared_ptr<CardSet> out(new CardSet(std::move(found.driver)));
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

std::string CardSet::name() const {
  const std::string &name = cards_.front()->facts().name;
  return cards_.size() == 1 ? name : std::to_string(cards_.size()) + " x " + name;
}

} // namespace umov::backend
