// SPDX-License-Identifier: Apache-2.0
// The schedule of springs: the order in which the CPU evaluates a robot's springs.
//
// Each spring belongs to one of its two masses, its owner; the other mass is its partner. A tile evaluates its springs
// row by row. A row has one entry per lane: the spring that the mass in this lane owns, or padding. There are two kinds
// of rows, runs first:
//
//   owners         slot    8   9  10  11  12  13  14  15      one tile
//   run            to     24  25  26  27  28  29  30  31      partners stand as the owners do
//   run            to      9  10  11  12   -  14  15  16      lane 4 has no such spring
//   gathered row   to      3  40  17  55   -   8  61   -      partners stand anywhere
//
// 1. The owners' forces of all rows add up in registers: one store per tile, not one per spring.
// 2. A run's partners are one vector in memory, though rarely an aligned one. Loading them and adding to their sums
//    costs two instructions per axis. In a lattice, most springs of one direction form runs.
// 3. Gathered rows hold all other springs. Their partners are loaded one by one (kernels/gather.h), which costs more
//    than twice as much, so that even a run with several unused lanes is cheaper. Owners are chosen so that the lanes
//    of a tile have about equally many springs in gathered rows: the busiest lane sets the number of rows.
// 4. Forces on the partners of runs are added to one of several reaction arrays. A load that overlaps a recent store
//    which is aligned otherwise waits until that is in the cache. So runs of a tile take turns in an order, and in
//    arrays, such that what they add to overlaps with none of the latest runs.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mercury/robot.h"
#include "sim/cpu/layout/aligned.h"
#include "sim/cpu/layout/muscles.h"
#include "sim/cpu/layout/slots.h"
#include "sim/physics/face_backs.h"

namespace mercury::cpu {

inline constexpr std::uint32_t reaction_arrays = 3;

struct Run {
  std::uint32_t partner;   // slot of the first lane's partner
  std::uint32_t reaction;  // index in the consecutive reaction arrays, for the same lane
};

struct SpringSchedule {
  struct Tile {
    std::uint32_t runs = 0, gathered_rows = 0;
  };
  std::vector<Tile> tiles;
  std::vector<Run> runs;
  std::vector<std::uint32_t> partners;  // [gathered row][lane]: four times the partner's slot

  // [row][lane]: one element per entry. Rows stand in the order of evaluation: tile by tile, runs first.
  Aligned<float> rest_length;         // [m]; 0 in padding
  std::vector<std::uint32_t> spring;  // index in Robot::springs; no_spring in padding
  Aligned<float> stiffness;           // Body::stiffness; 0 in padding
  Aligned<float> relaxation_time;     // [s]; 0 in padding
  Aligned<FactorId> factor;           // of the spring's material

  // [slot] Removes rounding_magic_bits from the sums, which carry it once per contribution (see body.h).
  Aligned<std::uint32_t> bias;

  bool has_gathered_rows() const { return !partners.empty(); }
};

SpringSchedule schedule_springs(const Robot& robot, const Slots& slots);

// The order in which the CPU evaluates a robot's pairs of faces. As with springs there are runs, of pairs whose corners
// stand side by side, as along most sides of a lattice, and tiles of all other pairs, whose corners are gathered.
struct FaceSchedule {
  struct Run {
    std::array<std::uint32_t, 4> corners{};  // slots of corners a, b, c, d of the first lane's pair
    std::uint32_t lanes = 0;                 // those that have a pair, one bit each
  };
  std::vector<Run> runs;
  // As many face pairs as there are lanes. [face tile][corner a, b, c, d][lane]: four times the corner's slot. The last
  // tile is filled up with pairs that have no area.
  std::vector<std::uint32_t> tiles;
  Aligned<std::uint32_t> dither;  // dither_of_pair(), [run, then face tile][lane]
  // [run, then face tile][first, second][lane]: four times the slot of the mass behind the face; empty = not known
  std::vector<std::uint32_t> backs;

  std::size_t gathered_tiles(std::size_t lanes) const { return tiles.size() / (4 * lanes); }
};
// `backs` = masses_behind(), or empty.
FaceSchedule schedule_faces(std::span<const FacePair> pairs, std::span<const PairBacks> backs, const Slots& slots);

}  // namespace mercury::cpu
