// Every kernel of light and the loops over facets on a graphics processor, in float alone:
// tools/check_cuda finds no operation of double in what becomes of this.

#include "backend/facet_loops.inl.h"
#include "kernel/tests/probes.inl.h"

namespace umov {
namespace {

/// One facet after the other.
struct DeviceMachine {
  using R = float;
  using T = float;
  using S = float;
  using Mask = bool;
  static constexpr std::size_t width = 1;
  __device__ static float load(const float *p) { return *p; }
  __device__ static float load_any(const float *p) { return *p; }
  __device__ static void store_any(float x, float *p) { *p = x; }
  __device__ static float total(float x) { return x; }
  __device__ static bool any(bool x) { return x; }
  __device__ static bool all_three(const std::uint32_t *a, const std::uint32_t *b,
                        const std::uint32_t *c, std::uint32_t value) {
    return *a == value && *b == value && *c == value;
  }
  __device__ static void prefetch(const backend::MaskBlock *) {}
  __device__ static std::uint32_t bits(bool x) { return x ? 1 : 0; }
  __device__ static std::uint32_t first_bit(std::uint32_t) { return 0; }
  class Packer {
  public:
    __device__ explicit Packer(bool keep) : keep_(keep) {}
    __device__ std::size_t count() const { return keep_ ? 1 : 0; }
    __device__ static void put(float x, float *to) { *to = x; }
    __device__ static void put_indices(std::uint32_t first, std::uint32_t *to) { *to = first; }

  private:
    bool keep_;
  };
  __device__ static int joint(const kernel::EntryLook &sun, const kernel::EntryLook &seen,
                              std::size_t a, std::size_t b, std::size_t block, std::size_t word) {
    return __popc(sun.block[a][block].word[word] & seen.block[b][block].word[word]);
  }

  template <std::size_t A, std::size_t B>
  __device__ static void count_lanes(const kernel::EntryLook &sun, const kernel::EntryLook &seen,
                                     std::size_t words, std::size_t s, const float *weight,
                                     float &mean, float &square) {
    mean = square = 0;
    for (std::size_t k = 0; k < A * B; ++k) {
      int count = 0;
      for (std::size_t w = 0; w < words; ++w)
        count += joint(sun, seen, k / B, k % B, w, s);
      const float c = static_cast<float>(count);
      mean += weight[k] * c;
      square += weight[k] * c * c;
    }
  }
  __device__ static void count_long(const kernel::EntryLook &sun, const kernel::EntryLook &seen,
                                    std::size_t words, float *count) {
    for (std::size_t k = 0; k < 9; ++k) {
      int sum = 0;
      for (std::size_t w = 0; w < words; ++w)
        sum += joint(sun, seen, k / 3, k % 3, w / backend::lanes, w % backend::lanes);
      count[k] = static_cast<float>(sum);
    }
  }
};

struct Add {
  float *to;
  __device__ void operator()(float value) const { *to += value; }
};

} // namespace

__global__ void sum_poses(backend::SceneData<float> scene, backend::Masks masks,
                          backend::MaskErrorModel model, const backend::PoseData<float> *pose,
                          backend::PoseSumsOf<float> *out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  kernel::FacetLoops<DeviceMachine>(scene, &masks, model, pose[i], out[i]).run();
}

__global__ void list_facets(backend::SceneData<float> scene, backend::Masks masks,
                            backend::MaskErrorModel model, const backend::PoseData<float> *pose,
                            backend::PoseSumsOf<float> *sums, backend::WeighedListOf<float> *weighed,
                            backend::SeenListOf<float> *seen) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  kernel::FacetLoops<DeviceMachine> loops(scene, &masks, model, pose[i], sums[i]);
  loops.list_weighed(weighed[i]);
  loops.list_seen(scene.chunks, seen[i]);
}

__global__ void probe_all(const float *x, float *sum) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  for (std::size_t family = 0; family < kernel::probe_families; ++family)
    kernel::probe<float, float>(family, x[i], Add{sum + i});
}

} // namespace umov
