// SPDX-License-Identifier: Apache-2.0
// Which kernel steps robots in an environment.
#pragma once

#include "sim/cuda/launch_configuration.h"
#include "sim/cuda/step.h"

namespace mercury::cuda {

template <class EnvironmentModel>
using StepKernel = void (*)(const StepArguments, const EnvironmentModel);

// For each kind of StepModel, in step_kernels/.
template <class EnvironmentModel>
StepKernel<EnvironmentModel> step_kernel_for(Solver solver, const LaunchConfiguration& launch);

}  // namespace mercury::cuda
