// SPDX-License-Identifier: Apache-2.0
// Work batches: robots that one thread steps together, several steps at a time.
//
// 1. Their muscles are computed once for all materials with the same movement, several steps ahead.
// 2. They are so few that all that a step touches stays in the core's own cache while their steps repeat.
// 3. There are several batches per thread, so that the threads finish at about the same time.
#pragma once

#include <span>
#include <unordered_set>
#include <vector>

#include "mercury/work_watch.h"
#include "sim/cpu/layout/lockstep_group.h"
#include "sim/cpu/layout/muscles.h"

namespace mercury::cpu {

struct WorkBatch {
  std::vector<Body*> bodies;          // stepped alone
  std::vector<LockstepGroup> groups;  // a group without bodies was broken up
  Muscles muscles;
  Aligned<float> factors;                   // of the next steps
  bool spring_parameters_are_stale = true;  // the bodies' materials have changed
};

// Distributes all bodies. The batches are valid until the bodies are configured again; after an explosion, or the end
// of one, other groups may be faster. Uses all cores.
std::vector<WorkBatch> make_work_batches(std::span<Body* const> bodies, std::size_t threads,
                                         const Configuration& configuration, const WorkWatch& watch = {});

// Takes these bodies out of their batches. The rest of their groups break up: their bodies are in no batch, either.
// Returns those, without the ones that are taken.
std::vector<Body*> take_out(const std::unordered_set<const Body*>& bodies, std::vector<WorkBatch>& batches);

}  // namespace mercury::cpu
