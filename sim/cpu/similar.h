// SPDX-License-Identifier: Apache-2.0
// Which robots are built in much the same way, so that few lanes stay empty where they are stepped together.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mercury/robot.h"
#include "sim/cpu/cells.h"
#include "sim/physics/face_pairs.h"

namespace mercury::cpu {

// What a robot asks seats and slots for: its masses, by cell, its springs and its pairs of faces between masses.
struct Outline {
  std::span<const Cell> masses;
  std::span<const Spring> springs;
  std::span<const FacePair> faces;  // none where they give no force
};

// Shares robots, by number, out to groups of so many, so that those of a group have most in common. The last group of
// about a thousand may be smaller.
std::vector<std::vector<std::size_t>> similar_groups(std::span<const Outline> robots, std::size_t group_size);

}  // namespace mercury::cpu
