// A driver without a card, for tests: memory of the card is the host's, and the kernels run on the
// host, grid, block and thread one after the other, through the very functions that a card calls.
// What it lacks and when it fails is asked of the environment:
//   UMOV_FAKE_CARDS     how many cards (1)
//   UMOV_FAKE_MEMORY    bytes of each (1e9)
//   UMOV_FAKE_INIT      code of cuInit
//   UMOV_FAKE_LOAD      code of cuModuleLoadData
//   UMOV_FAKE_DRIVER    CUDA of the driver, 1000 major + 10 minor (13020): newer images are refused
//   UMOV_FAKE_REFUSES   version of images that it does not load
//   UMOV_FAKE_FULL      launches after which there is no memory for any
//   UMOV_FAKE_POSES     most poses of a launch, beyond which there is no memory
//   UMOV_FAKE_LAUNCHES  launches after which the card is lost
//   UMOV_FAKE_PROCESSORS how many multiprocessors (132)
//   UMOV_FAKE_WATCHDOG  most poses times facets of a launch of sums, beyond which it is ended
// umov_fake_launches tells how many there were since cuInit; umov_fake_under_way how many were not
// waited for.

#include "backend/cuda/card_poses.h"

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <string>

using namespace umov::backend;

namespace {

using Code = int;
constexpr Code fine = 0, invalid = 1, out_of_memory = 2, not_there = 101,
               newer_than_the_driver = 222, not_ready = 600, timed_out = 702, lost = 719;

std::size_t asked(const char *name, std::size_t otherwise) {
  const char *value = std::getenv(name);
  return value == nullptr || *value == '\0' ? otherwise : std::strtoull(value, nullptr, 10);
}

std::mutex lock;
std::map<void *, std::size_t> allocated;
std::size_t used = 0;
char used_by_none = 0; ///< an address
std::atomic<std::size_t> launches{0};
std::map<void *, std::size_t> under_way; ///< launches of each stream
thread_local void *current = nullptr;    ///< context
/// From memory that is not pinned, until the default stream is waited for: others do not wait.
std::atomic<bool> is_copy_under_way{false};

bool is_lost() { return launches > asked("UMOV_FAKE_LAUNCHES", ~std::size_t{0}); }

std::size_t memory() { return asked("UMOV_FAKE_MEMORY", 1'000'000'000); }

void *const prepare = &used, *const sum = &launches, *const colour = &allocated,
            *const weighing = &lock, *const sum_curved = &used_by_none;

} // namespace

extern "C" {

std::size_t umov_fake_launches() { return launches; }
std::size_t umov_fake_under_way() {
  const std::lock_guard guard(lock);
  std::size_t out = 0;
  for (const auto &[stream, count] : under_way)
    out += count;
  return out;
}

Code cuInit(unsigned) {
  launches = 0;
  return static_cast<Code>(asked("UMOV_FAKE_INIT", 0));
}
Code cuDriverGetVersion(int *version) {
  *version = static_cast<int>(asked("UMOV_FAKE_DRIVER", 13020));
  return fine;
}
Code cuGetErrorName(Code code, const char **name) {
  *name = code == out_of_memory           ? "CUDA_ERROR_OUT_OF_MEMORY"
          : code == timed_out             ? "CUDA_ERROR_LAUNCH_TIMEOUT"
          : code == lost                  ? "CUDA_ERROR_LAUNCH_FAILED"
          : code == 100                   ? "CUDA_ERROR_NO_DEVICE"
          : code == newer_than_the_driver ? "CUDA_ERROR_UNSUPPORTED_PTX_VERSION"
                                          : "CUDA_ERROR_UNKNOWN";
  return fine;
}
Code cuGetErrorString(Code code, const char **text) {
  *text = code == 100 ? "no CUDA-capable device is detected" : nullptr;
  return *text == nullptr ? invalid : fine;
}
Code cuDeviceGetCount(int *count) {
  *count = static_cast<int>(asked("UMOV_FAKE_CARDS", 1));
  return fine;
}
Code cuDeviceGet(int *device, int index) {
  *device = index;
  return index < static_cast<int>(asked("UMOV_FAKE_CARDS", 1)) ? fine : not_there;
}
Code cuDeviceGetName(char *name, int size, int) {
  std::strncpy(name, "Card of paper", static_cast<std::size_t>(size));
  return fine;
}
Code cuDeviceGetAttribute(int *value, int attribute, int) {
  *value = attribute == 75   ? 8 // compute capability 8.0
           : attribute == 16 ? static_cast<int>(asked("UMOV_FAKE_PROCESSORS", 132))
                             : 0;
  return fine;
}
Code cuDeviceTotalMem_v2(std::size_t *bytes, int) {
  *bytes = memory();
  return fine;
}
Code cuDevicePrimaryCtxRetain(void **context, int device) {
  static int contexts[16];
  *context = contexts + device;
  return fine;
}
Code cuDevicePrimaryCtxRelease_v2(int) { return fine; }
Code cuCtxSetCurrent(void *context) {
  current = context;
  return is_lost() ? lost : fine;
}
Code cuCtxGetCurrent(void **context) {
  *context = current;
  return is_lost() ? lost : fine;
}
Code cuModuleLoadData(void **module, const void *image) {
  constexpr const char *words = "kernels on paper ";
  *module = &used;
  const char *const text = static_cast<const char *>(image);
  if (std::strncmp(text, words, std::strlen(words)) != 0)
    return invalid;
  const std::size_t version = std::strtoull(text + std::strlen(words), nullptr, 10);
  if (version > asked("UMOV_FAKE_DRIVER", 13020) || version == asked("UMOV_FAKE_REFUSES", 0))
    return newer_than_the_driver;
  return static_cast<Code>(asked("UMOV_FAKE_LOAD", 0));
}
Code cuModuleUnload(void *) { return fine; }
Code cuModuleGetFunction(void **function, void *, const char *name) {
  const std::map<std::string, void *> all{{"umov_prepare_poses", prepare},
                                          {"umov_sum_poses", sum},
                                          {"umov_sum_curved_poses", sum_curved},
                                          {"umov_colour_poses", colour},
                                          {"umov_weigh_poses", weighing}};
  const auto found = all.find(name);
  *function = found == all.end() ? nullptr : found->second;
  return *function == nullptr ? invalid : fine;
}
Code cuMemGetInfo_v2(std::size_t *free, std::size_t *total) {
  const std::lock_guard guard(lock);
  *total = memory();
  *free = used < *total ? *total - used : 0;
  return fine;
}
Code cuMemAlloc_v2(unsigned long long *pointer, std::size_t bytes) {
  const std::lock_guard guard(lock);
  if (is_lost())
    return lost;
  if (used + bytes > memory())
    return out_of_memory;
  void *block = std::aligned_alloc(256, (bytes + 255) / 256 * 256); // as the driver aligns
  std::memset(block, 0xA5, bytes);                                  // nothing of it is known
  allocated[block] = bytes;
  used += bytes;
  *pointer = reinterpret_cast<unsigned long long>(block);
  return fine;
}
Code cuMemFree_v2(unsigned long long pointer) {
  const std::lock_guard guard(lock);
  void *block = reinterpret_cast<void *>(pointer);
  const auto found = allocated.find(block);
  if (found == allocated.end())
    return invalid;
  used -= found->second;
  allocated.erase(found);
  std::free(block);
  return fine;
}
Code cuMemAllocHost_v2(void **pointer, std::size_t bytes) {
  *pointer = std::malloc(bytes);
  return fine;
}
Code cuMemFreeHost(void *pointer) {
  std::free(pointer);
  return fine;
}
Code cuMemcpyHtoDAsync_v2(unsigned long long to, const void *from, std::size_t bytes, void *) {
  std::memcpy(reinterpret_cast<void *>(to), from, bytes);
  return is_lost() ? lost : fine;
}
Code cuMemcpyHtoD_v2(unsigned long long to, const void *from, std::size_t bytes) {
  is_copy_under_way = true;
  return cuMemcpyHtoDAsync_v2(to, from, bytes, nullptr);
}
Code cuMemcpyDtoHAsync_v2(void *to, unsigned long long from, std::size_t bytes, void *) {
  std::memcpy(to, reinterpret_cast<const void *>(from), bytes);
  return is_lost() ? lost : fine;
}
Code cuStreamCreate(void **stream, unsigned) {
  *stream = new int;
  return is_lost() ? lost : fine;
}
Code cuStreamDestroy_v2(void *stream) {
  const std::lock_guard guard(lock);
  under_way.erase(stream);
  delete static_cast<int *>(stream);
  return fine;
}
Code cuStreamSynchronize(void *stream) {
  if (stream == nullptr)
    is_copy_under_way = false;
  const std::lock_guard guard(lock);
  under_way.erase(stream);
  return is_lost() ? lost : fine;
}

Code cuLaunchKernel(void *function, unsigned blocks, unsigned, unsigned, unsigned threads, unsigned,
                    unsigned, unsigned, void *stream, void **parameters, void **) {
  const CardScene scene = *static_cast<const CardScene *>(parameters[0]);
  const CardBatch batch = *static_cast<const CardBatch *>(parameters[1]);
  if (batch.poses.size() > asked("UMOV_FAKE_POSES", ~std::size_t{0}) ||
      launches >= asked("UMOV_FAKE_FULL", ~std::size_t{0}))
    return out_of_memory;
  if (is_copy_under_way)
    return not_ready; // the kernel would read what has not come
  const std::size_t facets = scene.scene.chunks.size() * groups_per_thread * lanes;
  const bool is_sum = function == sum || function == sum_curved;
  if (is_sum && facets * batch.poses.size() > asked("UMOV_FAKE_WATCHDOG", ~std::size_t{0}))
    return timed_out;
  ++launches;
  if (is_lost())
    return lost;
  {
    const std::lock_guard guard(lock);
    ++under_way[stream];
  }
  for (unsigned block = 0; block < blocks; ++block)
    for (unsigned thread = 0; thread < threads; ++thread) {
      const std::size_t i = std::size_t{block} * threads + thread;
      if (i >= batch.poses.size())
        continue;
      if (function == prepare)
        prepare_on_card(scene, batch, i);
      else if (function == sum)
        sum_on_card<false>(scene, batch, i);
      else if (function == sum_curved)
        sum_on_card<true>(scene, batch, i);
      else if (function == colour)
        colour_on_card(scene, batch, i);
      else
        weigh_on_card(scene, batch, i);
    }
  return fine;
}

} // extern "C"
