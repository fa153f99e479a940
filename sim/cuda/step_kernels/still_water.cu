// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/step_kernel.cuh"

namespace mercury::cuda {

template StepKernel<StillWaterOceanModel> step_kernel_for(Solver solver, const LaunchConfiguration& launch);

}  // namespace mercury::cuda
