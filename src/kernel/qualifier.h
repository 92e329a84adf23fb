#pragma once
// What stands before every function that a graphics processor may call too.

#if defined(__CUDACC__)
#define UMOV_KERNEL __host__ __device__ inline
#else
#define UMOV_KERNEL inline
#endif
