// SPDX-License-Identifier: Apache-2.0
// Tiles and lanes: where a robot's masses stand in the CPU's arrays.
//
// A slot holds one mass. As many consecutive slots as a vector register has lanes form a tile, so that one aligned load
// reads the same quantity of all masses of a tile. Slots without a mass are padding.
//
//   A robot of 13 masses, 8 lanes:
//
//   lane    0  1  2  3  4  5  6  7   0  1  2  3  4  5  6  7   0 ... 7
//   slot    0  1  2  3  4  5  6  7   8  9 10 11 12 13 14 15  16 ... 23
//   mass    0  1  2  3  4  5  6  7   8  9 10 11 12  -  -  -
//          |------- tile 0 -------| |------- tile 1 -------| |- spare -|
//
// 1. Padding keeps the loops over tiles free of special cases. It moves like a mass that nothing acts on, and is put
//    back to mass 0 after each step, so that it never widens the box around the robot.
// 2. The spare tile is room for loads that do not start at a tile: a run reads the slots of its partners (see
//    spring_schedule.h), and the last of them may reach beyond the last tile.
#pragma once

#include <cstdint>
#include <vector>

#include "mercury/robot.h"

namespace mercury::cpu {

struct Slots {
  std::size_t lanes = 1;
  std::vector<std::uint32_t> of_mass;
  std::vector<std::uint32_t> mass_at;  // by slot, without the spare tile; no_mass at padding
  std::vector<std::uint32_t> padding;  // slots without a mass

  std::size_t tiles() const { return mass_at.size() / lanes; }
  std::size_t size_with_spare() const { return mass_at.size() + lanes; }
};

// Masses in the order of the robot's file.
Slots assign_slots(const Robot& robot, std::size_t lanes);

}  // namespace mercury::cpu
