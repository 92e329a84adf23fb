// Every kernel of light and the loops over facets on a graphics processor, in float alone:
// tools/check_cuda finds no operation of double in what becomes of this.

#include "backend/cuda/thread_machine.h"
#include "kernel/tests/probes.inl.h"

namespace umov {
namespace {

using backend::RunningSum;
using backend::ThreadMachine;

struct Add {
  float *to;
  __device__ void operator()(float value) const { *to += value; }
};

} // namespace

__global__ void sum_poses(backend::SceneData<float> scene, backend::Masks masks,
                          backend::MaskErrorModel model, const backend::PoseData<float> *pose,
                          backend::PoseSumsOf<RunningSum> *out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  kernel::FacetLoops<ThreadMachine>(scene, &masks, model, pose[i], out[i]).run();
}

__global__ void list_facets(backend::SceneData<float> scene, backend::Masks masks,
                            backend::MaskErrorModel model, const backend::PoseData<float> *pose,
                            backend::PoseSumsOf<RunningSum> *sums, backend::WeighedListOf<RunningSum> *weighed,
                            backend::SeenListOf<RunningSum> *seen) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  kernel::FacetLoops<ThreadMachine> loops(scene, &masks, model, pose[i], sums[i]);
  loops.list_weighed(weighed[i]);
  loops.list_seen(scene.chunks, seen[i]);
}

__global__ void probe_all(const float *x, float *sum) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  for (std::size_t family = 0; family < kernel::probe_families; ++family)
    kernel::probe<float, float>(family, x[i], Add{sum + i});
}

} // namespace umov
