// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/cuda/kernels.h"
#include "sim/physics/actuation.h"

namespace mercury::cuda {

// A driven material with what it needs beside its drive, so that it can be read before the drive is there.
struct ActuatedMaterial {
  DrivenMaterial to;
  Material own;
  float amplitude, frequency, phase;

  ActuatedMaterial() = default;
  __device__ ActuatedMaterial(const DrivenMaterial& driven, const ActuationSources& sources)
      : to(driven), own(*driven.own), amplitude(sources.amplitude[driven.setting]),
        frequency(sources.frequency[driven.setting]), phase(sources.phase[driven.setting]) {}

  // Sets it as its actuator says, and its phase. Returns false if the drive has failed.
  __device__ bool set(const ActuationSources& sources, const Clock& clock) const {
    const float drive = sources.drive[to.setting];
    const ActuatorSetting setting{amplitude, frequency, phase, drive, is_driven(sources.driven[to.setting], drive)};
    const Material now = actuated(own, setting);
    *to.now = now;
    *to.phase = muscle_phase(now, clock);
    *to.swing = MuscleSwing::of(now);
    return !has_failed(setting);
  }
};

}  // namespace mercury::cuda
