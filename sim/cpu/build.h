// SPDX-License-Identifier: Apache-2.0
// What robots that are stepped together, one a lane, share: seats, each for one mass of every robot, and slots, each
// for one spring of every robot between the same two seats. Robots of one build fill every lane of it. Others leave
// lanes empty: a seat without a mass holds a stand-in, a slot without a spring gives no force.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mercury/robot.h"
#include "sim/physics/face_pairs.h"

namespace mercury::cpu {

struct Build {
  struct Joint {
    std::uint32_t owned = 0;  // slots that the seat owns, as the lower one of two
    std::uint32_t slots = 0;  // slots at the seat
  };
  std::vector<Joint> joints;            // one a seat
  std::vector<std::uint32_t> partners;  // seats, one a slot; slots stand by owner
  std::vector<FacePair> faces;          // of seats
};

// Where one robot is in a build: by mass, by spring, by pair of faces.
struct Seating {
  std::vector<std::uint32_t> seats, slots, faces;
};

// One robot of a build to be.
struct Sitter {
  const Robot* robot;
  std::span<const FacePair> faces;   // pair_faces(*robot)
  std::vector<std::uint32_t> seats;  // of its masses, no two the same
};

struct Assembly {
  std::shared_ptr<const Build> build;
  std::vector<std::shared_ptr<const Seating>> seatings;  // one a sitter
};

// Pairs of faces that only robots in the first half of these have, and those that only others have.
struct FaceHalves {
  std::vector<std::uint32_t> lower, upper;
};
FaceHalves halves_of(std::size_t pairs, std::span<const std::shared_ptr<const Seating>> seatings);

// Vectors shorter than this are not split in two.
inline constexpr std::size_t least_lanes_to_split = 8;

// The smallest build that has room for all of these, of so many seats (at most max_masses).
Assembly assemble(std::span<const Sitter> sitters, std::size_t seats);

}  // namespace mercury::cpu
