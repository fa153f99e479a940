#include "sim/cpu/muscles.h"

namespace mercury::cpu {

Muscles muscles_of(std::span<const Material> materials, const Clock& clock) {
  Muscles muscles;
  for (const Material& material : materials) {
    const MusclePhase phase = muscle_phase(material, clock);
    muscles.amplitude.push_back(material.amplitude);
    muscles.phase.push_back(phase_at(phase, clock.step - clock.base_step));
    muscles.per_step.push_back(phase.per_step);
  }
  return muscles;
}

}  // namespace mercury::cpu
