// SPDX-License-Identifier: Apache-2.0
// How robots lie in device memory. Every robot has a chunk of each buffer, sized by the largest robot (paper, II.D).
//
// Masses stand in slots, 32 slots a group. A group is a stack of rows of 32 floats, one row a quantity, so that a slot
// is one offset, every quantity of it lies a constant further, and a mass's bank is its slot mod 32 in every row. On
// the device masses are named by their slots.
#pragma once

#include <cstdint>

#include "mercury/configuration.h"
#include "mercury/host_device.h"
#include "mercury/material.h"
#include "mercury/vec3.h"
#include "sim/cuda/schedule.h"
#include "sim/physics/muscle.h"

namespace mercury::cuda {

inline constexpr std::uint32_t row_bytes = lanes * 4;

// Rows of a group in global memory: positions and velocities.
inline constexpr std::uint32_t state_rows = 6;

// Rows of a group while it is stepped: positions, velocities, sums, and for XPBD the number of springs at a mass.
enum Row : std::uint32_t { row_x = 0, row_v = 3, row_sum = 6, row_splits = 9 };
MERCURY_HOST_DEVICE constexpr std::uint32_t working_rows(Solver solver, bool keeps_splits) {
  return solver == Solver::xpbd && keeps_splits ? 10 : 9;
}

// The slot whose working memory begins so many words behind the first one's; with 0 rows, places are slots.
MERCURY_HOST_DEVICE constexpr std::uint32_t slot_at(std::uint32_t place, std::uint32_t rows) {
  return rows == 0 ? place : place / (rows * lanes) * lanes + place % lanes;
}

// Which slot each mass stands in: slot 32 g + lane is the lane of group g. Within a group masses stand in their order,
// turned on by so many lanes a group: where masses are numbered row by row, lattice neighbours in other rows would else
// be likely to share a bank, or all corners of one kind would have even banks.
struct SlotOrder {
  std::uint32_t masses, turn;

  MERCURY_HOST_DEVICE std::uint32_t slot_of(std::uint32_t mass) const {
    const std::uint32_t group = mass / lanes;
    return group * lanes + (mass % lanes + group * turn) % in_group(group);
  }
  MERCURY_HOST_DEVICE std::uint32_t mass_of(std::uint32_t slot) const {
    const std::uint32_t group = slot / lanes, size = in_group(group);
    return group * lanes + (slot % lanes + size - group * turn % size) % size;
  }

 private:
  MERCURY_HOST_DEVICE std::uint32_t in_group(std::uint32_t group) const {
    const std::uint32_t rest = masses - group * lanes;
    return rest < lanes ? rest : lanes;
  }
};

// A scheduled spring. `key` = partner << 16 | length << 8 | material. The partner is a slot or, on the chip, the
// slot's offset in the working memory, in words. Robots that have at most 256 different rest lengths name theirs by
// number, which makes a record 4 bytes; others have it behind the key in 8 bytes, and no number. Records stream through
// every step, so their size decides whether those of all robots in flight fit into the L2 cache.
inline constexpr std::uint32_t max_lengths = 256;

struct RobotRecord {
  std::uint32_t masses, groups, face_pairs, springs;
  std::uint32_t turn;                   // SlotOrder
  float force_scale, correction_scale;  // FixedPointScale
  float squared_stretch_limit;          // [m2]
  float contact_distance;               // [m]
};

MERCURY_HOST_DEVICE SlotOrder slot_order(const RobotRecord& record) { return {record.masses, record.turn}; }

// Rows of springs that a warp has in hand at once; behind the last robot's rows stand as many that are read but unused.
inline constexpr int rows_at_once = 4;

// What became of a robot: the step is counted from the start of the simulation, -1 = has not exploded.
struct DeviceStatus {
  long long exploded_step;
  std::uint32_t bad_mass;  // its number, not its slot
};

struct DevicePerturbation {
  std::uint32_t robot, slot;
  Vec3 target;
  float stiffness;
};

// Pointers and strides of a batch in device memory; strides in elements, one chunk a robot.
struct BatchView {
  const RobotRecord* robots;
  DeviceStatus* statuses;
  float* state;                    // [robot][group][state_rows][32]
  const std::uint32_t* springs;    // [robot][row][32][record_words], keys, and rest lengths in wide records
  const float* lengths;            // [robot][max_lengths], for narrow records
  const std::uint32_t* row_start;  // [robot][group + 1]
  const FacePair* face_pairs;      // [robot][pair]
  const float* splits;             // [robot][slot], springs at a mass
  const std::uint32_t* arrivals;   // [robot][slot], places of the schedule whose partner a slot is
  const Material* materials;       // [robot][max_materials]
  MusclePhase* phases;             // [robot][max_materials], for the present clock base
  const DevicePerturbation* perturbations;
  char* workspace;  // [robot], what does not fit on the chip: contact lists, working memory
  std::uint32_t robot_count, group_stride, row_stride, face_stride, perturbation_count, workspace_stride;
  std::uint32_t record_words;  // 1 or 2
};

}  // namespace mercury::cuda
