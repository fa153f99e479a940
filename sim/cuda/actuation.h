// SPDX-License-Identifier: Apache-2.0
// Actuators that a program drives through shared arrays (mercury/shared_array.h).
//
//   shared arrays [robot][actuator]  --+
//                                      +--> actuated() --> material as it is now --> step kernels
//   the robot's own material  ---------+                   and its phase
//
// One thread computes one driven material, before the steps of a call. Materials without an actuator are copied once,
// when the actuation begins. Step kernels read the materials as they are now in place of the own ones and do not know
// of actuators.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <cstdint>
#include <span>

#include "mercury/backend.h"
#include "sim/cuda/layout.h"
#include "sim/cuda/memory.h"

namespace mercury::cuda {

struct DrivenMaterial {
  const Material* own;
  Material* now;
  MusclePhase* phase;
  MuscleSwing* swing;
  std::uint32_t setting;  // index in the shared arrays
};

class Actuators {
 public:
  bool empty() const { return driven_.size() == 0; }
  // `sources` without actuator_of. Both arguments are valid until robots come or go.
  void set(std::span<const DrivenMaterial> driven, const ActuationSources& sources, cudaStream_t stream);
  void clear() { *this = {}; }

  // Computes all driven materials, and their phases for this clock. Asynchronous.
  void apply(const Clock& clock, cudaStream_t stream) const;

 private:
  DeviceArray<DrivenMaterial> driven_;
  const float *amplitude_ = nullptr, *frequency_ = nullptr, *phase_ = nullptr, *drive_ = nullptr;
};

}  // namespace mercury::cuda
