// SPDX-License-Identifier: Apache-2.0
// Launching the step kernels.
#pragma once

#include <variant>

#include "sim/cuda/block_layout.h"
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
  float contact_stiffness = 0;  // [N/m], times the stiffness scale
  std::uint32_t steps = 0;
  Shape shape;
  DeviceTelemetry* report = nullptr;  // [robot], filled after the last step, unless null
};

using AnyEnvironmentModel = std::variant<OceanModel, OceanSimpleModel, LandModel>;

// The shape that keeps most robots in flight on the present device. `groups` = of the largest robot.
Shape choose_shape(Solver solver, const Environment& environment, const BatchView& batch, bool same_materials);

// Shared memory that a block may have on the present device [bytes].
std::size_t most_shared_bytes();

// Robots that the present device steps at the same time.
std::uint32_t robots_in_flight(Solver solver, const AnyEnvironmentModel& model, const Shape& shape);

// Springs a second if only the shared memory pipe counted: a row of 32 springs takes ten passes through it (four of the
// record, the position and the rest length, two of the material, three additions, and one more where XPBD reads
// splits).
double spring_limit(Solver solver);

// Asynchronous; errors through cudaGetLastError.
void launch_steps(Solver solver, const AnyEnvironmentModel& model, const StepArguments& arguments, cudaStream_t stream);

}  // namespace mercury::cuda
