// SPDX-License-Identifier: Apache-2.0
// The step of robots, compiled once per instruction set. All kernels give the same bits.
//
//   kernel_avx2.cpp ...    one file per instruction set: sets HWY_TARGET and includes the rest
//     lanes.h              vectors that compute as floats do
//     gather.h             masses in any slots
//     factor_table.h       the factors of a row of springs
//     body_stepper.h       a robot alone       spring_rows.h, face_tiles.h, motion.h, near_search.h
//     lockstep_stepper.h   a lockstep group
//     muscle_factors.h     all muscles
//     spring_measures.h    springs, for telemetry
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "mercury/robot.h"
#include "sim/cpu/layout/lockstep_group.h"
#include "sim/cpu/layout/muscles.h"
#include "sim/cpu/layout/step_setting.h"

namespace mercury::cpu {

// Part of Telemetry.
struct SpringMeasures {
  double elastic_energy = 0, muscle_power = 0;  // [J], [W]
  float largest_strain = 0;                     // [1]
  std::uint32_t strained = 0;                   // springs
};

struct Kernel {
  std::string_view name;  // "AVX2"
  std::size_t lanes;      // bodies must have been made for this number

  // Computes L(t) / L0 of all muscles at the next steps, factors[step][muscles.amplitude.size()], and moves the
  // muscles' phases on by these steps.
  void (*fill_factors)(Muscles& muscles, float* factors, std::int64_t steps);
  // Measures the springs of a robot. `positions`: x, y, z and an unused number per mass; `materials`, by id: what
  // MaterialNow has and an unused number. Both are aligned to 16 bytes.
  SpringMeasures (*measure_springs)(std::span<const Spring> springs, const float* positions, const float* materials);
  // Whether this machine reads factors faster one by one than by gathering them (Factors::one_by_one).
  bool (*looks_up_one_by_one)();

  // Advances a body that has not exploded. Returns the number of complete steps; if it is less than `steps`, the body
  // exploded in the step after them.
  std::int64_t (*advance)(Body& body, const StepSetting& setting, Factors factors, StepRange steps);

  // Advances a group. Returns false if a member may have exploded on the way; the group's state is then undefined.
  bool (*advance_group)(LockstepGroup& group, const StepSetting& setting, Factors factors, StepRange steps);
};

// One per source file kernel_*.cpp.
extern const Kernel portable_kernel, ssse3_kernel, avx2_kernel, avx512_kernel, neon_kernel;

// The kernels that this machine can run, fastest first; none on an x86 processor without SSSE3.
std::span<const Kernel> kernels();

}  // namespace mercury::cpu
