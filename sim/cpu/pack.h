// SPDX-License-Identifier: Apache-2.0
// Robots that one core steps together, a few steps at a time: their muscles are computed once for all that move alike,
// and they are so few that what they touch stays in the core's own cache.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/cpu/kernel.h"

namespace mercury::cpu {

struct Pack {
  std::vector<std::size_t> bodies;  // stepped one by one
  std::vector<Lockstep> groups;     // one without bodies was broken up
  Muscles muscles;
  Aligned<float> factors;      // of the steps at hand
  bool laws_are_stale = true;  // the bodies' materials changed
};

// Every body in one pack; at least a few packs a thread where there are enough bodies. Good until one explodes or is
// made whole again; groups then want to be made anew.
std::vector<Pack> pack(std::span<const Body> bodies, std::size_t threads, const Configuration& configuration);

// Advances the pack's bodies, those that have not exploded. States may reside in the pack's groups from then on.
// Returns how many groups were broken up, because a robot of theirs may have exploded.
std::size_t advance(const Kernel& kernel, Pack& pack, std::span<Body> bodies, const StepSetting& setting,
                    const Clock& clock, std::int64_t steps);

// Brings all states back to the bodies.
void store(std::span<Pack> packs);

}  // namespace mercury::cpu
