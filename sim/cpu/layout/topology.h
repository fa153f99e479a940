// SPDX-License-Identifier: Apache-2.0
// The topology that the members of a lockstep group share (see lockstep_group.h).
//
// A topology has slots, each for one mass of every member, and entries, each for one spring of every member between the
// same two slots. Members with the same topology use all of them. Others have no mass in some slots and no spring at
// some entries: there, their lane is padding.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/physics/face_pairs.h"

namespace mercury::cpu {

struct Topology {
  struct Slot {
    std::uint32_t owned = 0;    // entries that the slot owns, as the lower of two
    std::uint32_t valence = 0;  // entries at the slot
  };
  std::vector<Slot> slots;
  std::vector<std::uint32_t> partners;  // slot, by entry; entries are sorted by owner
  std::vector<FacePair> face_pairs;     // between slots
};

// Where a member stands in the topology of its group.
struct IndexMap {
  std::vector<std::uint32_t> slots;       // by mass
  std::vector<std::uint32_t> entries;     // by spring
  std::vector<std::uint32_t> face_pairs;  // by face pair
};

// Face pairs that only members in the lower half of the lanes have, and those that only the others have. One of either
// fits into one face tile (see lockstep_group.h).
struct HalfFacePairs {
  std::vector<std::uint32_t> lower, upper;
};
HalfFacePairs half_face_pairs(std::size_t face_pairs, std::span<const std::shared_ptr<const IndexMap>> index_maps);

// Vectors with fewer lanes are not split into halves.
inline constexpr std::size_t min_lanes_to_split = 8;

// A topology with room for several members.
struct MergedTopology {
  std::shared_ptr<const Topology> topology;
  std::vector<std::shared_ptr<const IndexMap>> index_maps;  // by member
};

}  // namespace mercury::cpu
