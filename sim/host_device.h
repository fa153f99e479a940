// The one place that knows whether nvcc is compiling: marks functions that run on host and device.
#pragma once

#ifdef __CUDACC__
#define MERCURY_HOST_DEVICE __host__ __device__ __forceinline__
#else
#define MERCURY_HOST_DEVICE inline
#endif
