#pragma once
// What stands before every function that a graphics processor may call too.

#if defined(__CUDACC__)
#define UMOV_KERNEL __host__ __device__ inline
#else
#define UMOV_KERNEL inline
#endif

// Before UMOV_KERNEL: a loop whose constants would find no registers within its caller. A graphics
// processor has them.
#if !defined(__CUDACC__) && (defined(__GNUC__) || defined(__clang__))
#define UMOV_KERNEL_LOOP [[gnu::noinline]]
#else
#define UMOV_KERNEL_LOOP
#endif
