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

#include <span>

#include "sim/cuda/kernels.h"
#include "sim/cuda/memory.h"

namespace mercury::cuda {

class Actuators {
 public:
  bool empty() const { return driven_.size() == 0; }
  // `sources` without actuator_of. Both arguments are valid until robots come or go.
  void set(std::span<const DrivenMaterial> driven, const ActuationSources& sources, cudaStream_t stream) {
    driven_ = DeviceArray<DrivenMaterial>(driven.size());
    driven_.write(0, driven, stream);
    sources_ = sources;
    sources_.actuator_of = {};
  }
  void clear() { *this = {}; }
  const DrivenMaterial* driven() const { return driven_.data(); }
  const ActuationSources& sources() const { return sources_; }

  // Computes all driven materials, and their phases for this clock. Asynchronous.
  void apply(const Clock& clock, bool before_step, cudaStream_t stream) const {
    if (!empty()) actuate(driven_.data(), driven_.size(), sources_, clock, before_step, stream);
  }

 private:
  DeviceArray<DrivenMaterial> driven_;
  ActuationSources sources_;
};

}  // namespace mercury::cuda
