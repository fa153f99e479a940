// SPDX-License-Identifier: Apache-2.0
// The order in which the CPU meets a robot's springs.
//
// Each spring is owned by one of its masses; the other is its partner. A block of masses, one a lane, meets its springs
// slot by slot: in one slot every lane has at most one spring. The owners' forces are summed in registers. In a run the
// partners stand next to each other as the owners do, so that they are loaded and added to like any vector: in a
// lattice most springs of one direction do. All other springs stand in rows, whose partners are collected one by one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mercury/robot.h"
#include "sim/cpu/aligned.h"
#include "sim/cpu/muscles.h"
#include "sim/cpu/places.h"
#include "sim/physics/face_pairs.h"

namespace mercury::cpu {

// Forces on partners of runs are added to one of several arrays in turn: a load that overlaps a store of other
// alignment made shortly before would have to wait for it.
inline constexpr std::uint32_t reaction_arrays = 2;

struct Run {
  std::uint32_t partner;   // place of the first lane's partner
  std::uint32_t reaction;  // the same in the reaction array that takes the forces
};

struct SpringPlan {
  struct Block {
    std::uint32_t runs = 0, rows = 0;  // slots, runs first
  };
  std::vector<Block> blocks;
  std::vector<Run> runs;
  std::vector<std::uint32_t> partners;  // of the rows: four times the place, a lane

  // Of each slot, a lane; no_spring and rest length 0 where there is none.
  Aligned<float> rest_length;
  std::vector<std::uint32_t> spring;
  // Body::hardness; 0 where there is no spring.
  Aligned<float> hardness;
  // The place of its factor among those of the muscles that it is stepped with.
  Aligned<FactorId> factor;

  // The integers of the sums carry rounding_magic_bits (sim/physics/fixed_point.h) once for every lane that was added;
  // these, one a place, take them out again.
  Aligned<std::uint32_t> bias;

  bool has_rows() const { return !partners.empty(); }
};

SpringPlan plan_springs(const Robot& robot, const Places& places);

// For every pair of faces its corners a, b, c, d: all lanes' a, then b and so on, each four times the place. The last
// block is filled up with pairs that have no area.
std::vector<std::uint32_t> plan_faces(std::span<const FacePair> pairs, const Places& places);

}  // namespace mercury::cpu
