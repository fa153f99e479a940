// SPDX-License-Identifier: Apache-2.0
// The CPU backend, and what it does with its work batches and bodies.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "mercury/backend.h"
#include "sim/cpu/grouping/work_batch.h"
#include "sim/cpu/kernels/kernel.h"
#include "sim/cpu/layout/body.h"

namespace mercury::cpu {

// With a kernel of choice; make_cpu_backend() takes the best.
std::unique_ptr<Backend> make_backend(const Device& device, const Kernel& kernel);

// Advances those of the batch's bodies that have not exploded. The batch's groups may hold states from then on. Returns
// the number of groups that were broken up because a member may have exploded.
std::size_t advance(const Kernel& kernel, WorkBatch& batch, const StepSetting& setting, const Clock& clock,
                    std::int64_t steps);

// Brings all states back to the bodies.
void store(std::span<WorkBatch> batches);

Telemetry measure_state(const Kernel& kernel, const Body& body, const Configuration& configuration, const Clock& clock);

}  // namespace mercury::cpu
