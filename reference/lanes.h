/* lanes.h - the numbers that kernels compute with: on a card one lane a thread, on the CPU vectors of several rays.
 *
 * Kernels are written once over `real`, `whole` and `mask`; control flow asks any_lane(mask). REAL, the type of a lane,
 * is defined by the file that includes a kernel: float or double. Each lane computes the same, whatever its neighbours
 * do. TOGETHER lanes go together: a vector on the CPU, half a warp on a card, where all its threads must call what is
 * named together_.
 */
#ifndef REFERENCE_LANES_H
#define REFERENCE_LANES_H

#ifdef __CUDACC__
#define KERNEL static __device__ __forceinline__
#define HOST_AND_KERNEL static inline __host__ __device__
#else
#define KERNEL static inline __attribute__((always_inline))
#define HOST_AND_KERNEL static inline
#endif

/* Of a function with so much in it that the CPU calls it, vectors in memory. */
#ifdef __CUDACC__
#define APART KERNEL
#else
#define APART static __attribute__((noinline))
#endif

/* Before a loop that is not to be unrolled. */
#ifdef __clang__
#define ROLLED _Pragma("clang loop unroll(disable)")
#elif defined(__CUDACC__)
#define ROLLED _Pragma("unroll 1")
#else
#define ROLLED _Pragma("GCC unroll 1")
#endif

/* Before a loop of few turns that is to be unrolled. */
#ifdef __clang__
#define UNROLLED _Pragma("clang loop unroll(full)")
#elif defined(__CUDACC__)
#define UNROLLED _Pragma("unroll")
#else
#define UNROLLED _Pragma("GCC unroll 8")
#endif

#ifdef REAL
#ifdef __CUDACC__
#include "lanes_cuda.h"
#else
#include "lanes_cpu.h"
#endif
#endif

#endif
