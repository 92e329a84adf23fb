// SGP4 on a graphics processor, in double as everywhere.

#include "kernel/sgp4.inl.h"

namespace umov {

__global__ void states(kernel::Sgp4Kind kind, const kernel::Sgp4Numbers<double> *numbers,
                       const kernel::ResonanceNode<double> *node, const double *minutes,
                       kernel::Sgp4State<double> *out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  out[i] = kernel::sgp4_state(kind, numbers[i], node[i], minutes[i]);
}

} // namespace umov
