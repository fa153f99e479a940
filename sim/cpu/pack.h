// Robots that one core steps together, a few steps at a time: they share their materials, whose muscles are then computed
// once for all of them, and are so few that what they touch stays in the core's own cache.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/cpu/kernel.h"

namespace mercury::cpu {

struct Pack {
  std::vector<std::size_t> bodies;  // all of the same materials, as are those of the groups
  std::vector<Lockstep> groups;
  bool broken = false;              // a group had to be stepped one by one; pack anew
};

// Whether a body is small enough to be one of a group, if enough others are built alike.
bool fits_in_lockstep(const Body& body, const Configuration& configuration);

// Every body in one pack; at least a few packs a thread where there are enough bodies. With `configuration` as the bodies'
// laws stand.
std::vector<Pack> pack(std::span<const Body> bodies, std::size_t threads, const Configuration& configuration);

// Advances the pack's bodies, those that have not exploded.
void advance(const Kernel& kernel, Pack& pack, std::span<Body> bodies, const StepSetting& setting, const Clock& clock,
             std::int64_t steps);

}  // namespace mercury::cpu
