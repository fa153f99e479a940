// Robots that one core steps together, a few steps at a time: they share their materials, whose muscles are then computed
// once for all of them, and are so few that what they touch stays in the core's own cache.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/cpu/kernel.h"

namespace mercury::cpu {

struct Pack {
  std::vector<std::size_t> bodies;  // all of the same materials
};

// Every body in one pack; at least a few packs a thread where there are enough bodies.
std::vector<Pack> pack(std::span<const Body> bodies, std::size_t threads);

// Advances the pack's bodies, those that have not exploded.
void advance(const Kernel& kernel, const Pack& pack, std::span<Body> bodies, const StepSetting& setting, const Clock& clock,
             std::int64_t steps);

}  // namespace mercury::cpu
