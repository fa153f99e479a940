// SPDX-License-Identifier: Apache-2.0
// Robots in parts: large ones, which do not fit on one multiprocessor or would have few of them. Each block of a
// cluster steps a part.
//
//        part 0 of 2                   part 1 of 2
//   +-----------------------+     +-----------------------+
//   | o--o--o--o - - - - -g |     | g- - - - -o--o--o--o  |    o  own mass of a part
//   | |  |  |  |          . |     | .         |  |  |  |  |    g  ghost: a copy of an own mass of another part
//   | o--o--o--o - - - - -g |     | g- - - - -o--o--o--o  |    - - spring between two parts, which both compute
//   +-----------------------+     +-----------------------+
//        positions after each step  <------>  distributed shared memory
//
// 1. A part has every spring and face that acts on one of its own masses. So the sums of its own masses are complete
//    without any other part; what it adds to ghosts is not used. Springs between parts are computed twice, a few
//    percent of all.
// 2. After its own masses have moved, a part writes them to where other parts keep their ghosts (Export). Barriers of
//    the cluster take the place of those of the block.
// 3. The same forces are rounded to the same integers, whichever end of a spring is its owner, and their sums do not
//    depend on order. So the parts have the same bits as a robot that is stepped whole.
// 4. Parts have about the same number of masses: the robot is cut at the median across its longest side, and each half
//    again.
#pragma once

#include <cstdint>
#include <vector>

#include "mercury/robot.h"
#include "sim/cuda/arrangement.h"
#include "sim/cuda/layout.h"

namespace mercury::cuda {

// A cluster may have 8 blocks on all devices that have clusters, and 16 on many (robots_in_flight() says so).
inline constexpr std::uint32_t most_parts = 16;

struct Part {
  std::uint32_t own = 0;               // masses; ghosts come after them
  std::vector<std::uint16_t> masses;   // [mass of the part], its number in the robot
  std::vector<std::uint32_t> springs;  // [spring of the part], its number in the robot
  Arrangement arrangement;             // slots of own masses, then a tile where those of ghosts begin
  // [face pair of the arrangement], dither_of_pair() of the pair in the whole robot's arrangement, from which a and c
  // are; that of the second face, if the two have changed places.
  std::vector<std::uint32_t> face_dithers;
  std::vector<Export> exports;              // by the tile that they come from
  std::vector<std::uint32_t> export_start;  // [own tile + 1]

  std::uint32_t own_tiles() const { return tiles_for(own); }
  std::uint32_t tiles() const { return arrangement.schedule.tiles(); }
};

// `order` = that of the whole robot.
std::vector<Part> split(const Robot& robot, const SlotOrder& order, std::uint32_t parts);

}  // namespace mercury::cuda
