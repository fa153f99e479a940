// The muscles of a table of materials on their way through time.
#pragma once

#include <cstdint>
#include <span>

#include "sim/cpu/aligned.h"
#include "sim/muscle.h"

namespace mercury::cpu {

struct Muscles {
  Aligned<float> amplitude;                // by material
  Aligned<std::uint64_t> phase, per_step;  // MusclePhase, the phase at the present step
};

// At the clock's step. `materials` has max_materials elements.
Muscles muscles_of(std::span<const Material> materials, const Clock& clock);

}  // namespace mercury::cpu
