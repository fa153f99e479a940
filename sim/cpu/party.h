// SPDX-License-Identifier: Apache-2.0
// Which robots step together, one a lane.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "sim/cpu/body.h"
#include "sim/cpu/build.h"

namespace mercury::cpu {

struct Party {
  std::vector<std::size_t> bodies;  // 1 to as many as there are lanes
  Assembly assembly;                // a seating each
};

// Whether a body is small enough to be one of a party.
bool fits_in_party(const Body& body);

// Parties of robots of one build, then of robots that are built in much the same way, wherever that is quicker than one
// robot after the other and leaves no thread without work. Each body is in one party at most.
std::vector<Party> find_parties(std::span<const Body> bodies, std::size_t threads, const Configuration& configuration);

// Bytes that a step of a party touches.
std::size_t footprint(const Build& build, std::size_t lanes);
// And about what that of a body alone does.
std::size_t footprint(const Body& body);

// Enough packs of work a thread to share it out evenly.
inline constexpr std::size_t packs_a_thread = 4;
inline constexpr std::size_t cache_share = 512 * 1024;  // [bytes] of a core's own cache

}  // namespace mercury::cpu
