// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/cuda/kernels.h"
#include "sim/physics/actuation.h"

namespace mercury::cuda {

// Sets a material as its actuator says, and its phase. Returns false if the drive has failed.
__device__ inline bool set_driven(const DrivenMaterial& to, const ActuationSources& sources, const Clock& clock) {
  const float drive = sources.drive[to.setting];
  const ActuatorSetting setting{sources.amplitude[to.setting], sources.frequency[to.setting], sources.phase[to.setting],
                                drive, is_driven(sources.driven[to.setting], drive)};
  const Material now = actuated(*to.own, setting);
  *to.now = now;
  *to.phase = muscle_phase(now, clock);
  *to.swing = MuscleSwing::of(now);
  return !has_failed(setting);
}

}  // namespace mercury::cuda
