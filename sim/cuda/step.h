// SPDX-License-Identifier: Apache-2.0
// Launching the step kernels.
#pragma once

#include <cuda_runtime_api.h>

#include "sim/cuda/brain_tables.h"
#include "sim/cuda/launch_configuration.h"
#include "sim/cuda/layout.h"
#include "sim/cuda/telemetry.h"
#include "sim/physics/environments.h"
#include "sim/physics/integration.h"

namespace mercury::cuda {

struct StepArguments {
  BatchView batch;
  Clock clock;  // of the first step
  StepConstants constants;
  float stiffness_scale = 1;
  std::uint32_t steps = 0;
  LaunchConfiguration launch;
  DeviceTelemetry* report = nullptr;  // [robot], filled after the last step, unless null
  Thoughts thoughts;
};

// The model whose kernel a launch uses. Robots in device memory wait for it most of the time, and few are too large by
// their valences alone, so both have one kernel for all environments.
inline AnyEnvironmentModel step_model_of(const Configuration& configuration, bool real_bodies,
                                         const LaunchConfiguration& launch) {
  const Environment& environment = configuration.environment;
  if (launch.on_chip && launch.valence_on_chip) return solver_model_of(environment, real_bodies);
  return GeneralModel(environment);
}

// Robots that the current device steps at the same time.
std::uint32_t robots_in_flight(Solver solver, const AnyEnvironmentModel& model, const LaunchConfiguration& launch);

// Makes the kernel for this launch ready, once per device.
void prepare_steps(Solver solver, const AnyEnvironmentModel& model, const LaunchConfiguration& launch);

// Asynchronous. prepare_steps() comes first.
void launch_steps(Solver solver, const AnyEnvironmentModel& model, const StepArguments& arguments, cudaStream_t stream);

}  // namespace mercury::cuda
