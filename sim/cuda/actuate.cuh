// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/cuda/kernels.h"
#include "sim/physics/actuation.h"

namespace mercury::cuda {

// Sets a material as its actuator says, and its phase.
__device__ inline void set_driven(const DrivenMaterial& to, const ActuationSources& sources, const Clock& clock) {
  const Material now = actuated(*to.own, {sources.amplitude[to.setting], sources.frequency[to.setting],
                                          sources.phase[to.setting], sources.drive[to.setting]});
  *to.now = now;
  *to.phase = muscle_phase(now, clock);
  *to.swing = MuscleSwing::of(now);
}

}  // namespace mercury::cuda
