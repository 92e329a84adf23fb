// Opens the namespace of the kernels; included again for every instruction set where the
// translation unit is compiled for several (it then includes <hwy/highway.h> first). Each such set
// has its own namespace, so that no function of one is taken for the same function of another.
#include "kernel/qualifier.h"
#ifdef HWY_NAMESPACE
HWY_BEFORE_NAMESPACE();
namespace umov::kernel::HWY_NAMESPACE {
#else
namespace umov::kernel {
#endif
