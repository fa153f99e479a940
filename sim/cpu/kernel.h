// SPDX-License-Identifier: Apache-2.0
// The steps of a robot, compiled once for every instruction set. All of them give the same bits.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "sim/cpu/lockstep.h"
#include "sim/cpu/muscles.h"
#include "sim/cpu/step.h"

namespace mercury::cpu {

struct Kernel {
  std::string_view name;  // "AVX2"
  std::size_t lanes;      // a body is made for so many

  // L(t) / L0 of every muscle at the next steps: factors[step][muscles.amplitude.size()]. Moves the muscles on.
  void (*fill_factors)(Muscles& muscles, float* factors, std::int64_t steps);

  // Advances a body that has not exploded. Returns how many steps were made; fewer than asked for if it exploded in the
  // step after them.
  std::int64_t (*advance)(Body& body, const StepSetting& setting, Factors factors, std::int64_t steps);

  // Advances a group. False if one of its robots may have exploded on the way: the group's state is worth nothing then.
  bool (*advance_together)(Lockstep& group, const StepSetting& setting, Factors factors, std::int64_t steps);
};

// What this machine can run, the best first; the last, portable one runs everywhere.
std::span<const Kernel> kernels();

}  // namespace mercury::cpu
