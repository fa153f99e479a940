// SPDX-License-Identifier: Apache-2.0
// The buffers of a size class (size_class.h) in device memory. Each robot has a chunk of each buffer, sized by the
// largest robot of the class (paper, II.D):
//
//   state        | robot 0: tile 0, tile 1, ...        | robot 1: tile 0, ...   | ...
//   springs      | robot 0: group 0, group 1, ...      | robot 1: group 0, ...  | ...
//   face_pairs   | robot 0: face tile 0, face tile 1.. | robot 1: ...           | ...
//
// A group is four rows of one tile, as a warp computes them. A lane has its records of a group side by side, and loads
// them at once. The last group of a tile may have unused rows, whose records are 0: springs of air.
//
// Spring records stream through every step, so their size decides whether those of all robots in flight fit into the L2
// cache. A record begins with a key:
//
//    31              16 15  14 13           8 7            0
//   +------------------+------+--------------+--------------+
//   |     partner      |  0   | length index |   material   |
//   +------------------+------+--------------+--------------+
//
// 1. The partner is a slot, or the offset of a slot in working memory (offset_of_slot), which saves the conversion. So
//    are the corners of a face pair. The two bits of 0 make an offset in bytes of one in words.
// 2. If each robot of the class has at most 64 different rest lengths, the robots keep them in tables, the key has
//    the index, and a record is one word, the key. In other classes a record is two words, the key (with length index
//    0) and the rest length.
#pragma once

#include <cstdint>

#include "mercury/configuration.h"
#include "mercury/host_device.h"
#include "mercury/material.h"
#include "mercury/vec3.h"
#include "sim/cuda/tile.h"
#include "sim/physics/face_pairs.h"
#include "sim/physics/muscle.h"
#include "sim/physics/points.h"

namespace mercury::cuda {

// Rest lengths in a robot's table.
inline constexpr std::uint32_t max_lengths = 64;

struct RobotHeader {
  std::uint32_t masses, tiles, face_pairs, springs;
  float force_scale, correction_scale;  // FixedPointScale
  float squared_stretch_limit;          // [m2]
  float environment_scale;              // the same, of the forces of the environment
  float contact_distance;               // [m]; 0 = no contacts
  float contact_units;                  // k_c [units/m]
  float list_radius;                    // within which pairs are listed that may touch [m]
  float highest_length_rate;            // [m/s]; 0 = no spring has a relaxation time
  float relaxation_time;                // tau of all springs [s]; negative = of each material
  double mass;                          // of all masses together [kg]
};

// How many rows a slot's tile has, and what the sum of the slot's own springs starts with (springs.cuh).
struct alignas(8) SlotRows {
  std::uint32_t count = 0;
  std::int32_t bias = 0;
};

// Whether and when a robot exploded.
struct DeviceStatus {
  long long exploded_step;  // from the start of the simulation; -1 = has not exploded
  std::uint32_t bad_mass;   // its number, not its slot
};

struct DevicePerturbation {
  std::uint32_t robot, slot;
  Vec3 target;
  float stiffness;
};

// What a step needs of a material beside its phase.
struct alignas(8) MuscleSwing {
  float amplitude, highest_sine;
  MERCURY_HOST_DEVICE static MuscleSwing of(const Material& material) {
    return {material.amplitude, mercury::highest_sine(material)};
  }
};

// A robot that a cluster steps in parts (parts.h).
struct PartHeader {
  std::uint32_t masses, tiles, ghost_tiles, face_pairs;  // without ghosts, but for their tiles
};
// An own mass that is a ghost of another part.
struct alignas(8) Export {
  std::uint16_t from, to;  // its slot, the slot of the ghost
  std::uint32_t part;      // that of the ghost
};
// The parts of a size class; part p of robot r is number r * per_robot + p.
struct PartsView {
  std::uint32_t per_robot = 1;
  std::uint32_t robot_tile_stride = 0, export_stride = 0;
  const PartHeader* headers = nullptr;
  const std::uint16_t* slots = nullptr;         // [part][slot], where the whole robot has the mass
  const std::uint32_t* face_dithers = nullptr;  // [part][pair]
  const Export* exports = nullptr;              // [part][export_stride]
  const std::uint32_t* export_start = nullptr;  // [part][tile + 1]
  const std::uint32_t* places = nullptr;        // [robot][slot of the whole robot], part << 16 | slot of its own mass
};

// Pointers and strides of a size class in device memory. A stride is the length of one robot's chunk, in units of what
// it counts.
struct BatchView {
  const RobotHeader* robots;
  DeviceStatus* statuses;
  float* state;                  // [robot][tile][state_fields][32]
  const std::uint32_t* springs;  // [robot][group][32][rows_at_once][record_words]
  const float* lengths;          // [robot][max_lengths], if record_words is 1 [m]
  const std::uint32_t* groups;   // [robot][tile], the first one of each
  const SlotRows* rows;          // [robot][slot]
  const FacePair* face_pairs;    // [robot][pair], with addresses of masses for their numbers
  const float* valences;         // [robot][slot]
  const std::uint16_t* masses;   // [robot][slot], the mass that stands there, by its number
  // [robot][pair]: slots of the masses behind the two faces, the second << 16; null = no water is one-sided
  const std::uint32_t* face_backs;
  const PointProperties* points;  // [robot][slot]; null = masses of 1 kg, none fixed
  const float* point_masses;      // [robot][slot] [kg]; null = 1 kg
  const Material* materials;      // [robot][max_materials]
  MusclePhase* phases;            // [robot][max_materials], for the current clock base
  MuscleSwing* swings;            // [robot][max_materials]
  const DevicePerturbation* perturbations;
  char* workspace;  // [robot], what does not fit on the chip: contact lists, working memory
  std::uint32_t robot_count, tile_stride, group_stride, face_stride, perturbation_count;
  std::uint32_t workspace_stride;  // [bytes]
  std::uint32_t record_words;      // 1 or 2
  // If robots are stepped in parts, springs, groups, rows, face_pairs, face_backs and points have a chunk for each
  // part, and the strides are those of a part. All else is of whole robots.
  PartsView parts;
};

}  // namespace mercury::cuda
