// SPDX-License-Identifier: Apache-2.0
// What every robot's origin may say, whatever its kind. The origin (Robot::origin) is a JSON object that records how
// the robot was made.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mercury/robot.h"

namespace mercury {

// The key "kind": "voxel", "nn", ..., usually a generator (generator.h). Empty if the origin has no such text.
std::string kind_of(const Robot& robot);

// The key "environment", where the robot belongs: "ocean", "ocean-simple", "land". Empty if the origin has no such
// text. It is not checked here; environment_named() checks it.
std::string environment_of(const Robot& robot);

// The key "ancestry": from whom a robot descends, and how. Mutants and crosses have it (generator.h).
struct Ancestry {
  std::vector<std::string> parents;             // their names, at most 16
  std::optional<std::uint64_t> crossover_seed;  // of a child of two
  std::optional<std::uint64_t> mutation_seed;   // of a mutation (after the crossover, if there are both)
  std::optional<double> strength, muscles;      // of that mutation, as in MutationRequest
  std::optional<std::uint64_t> generation;      // of the run of an evolution, the first is 0
  friend bool operator==(const Ancestry&, const Ancestry&) = default;
};

// The ancestry in a robot's origin; none if it has none. Throws InputError("/origin/ancestry/parents/0", ...), with the
// place as a JSON pointer, for one that cannot be used. Members with other names are ignored.
std::optional<Ancestry> ancestry_of(const Robot& robot);

// The origin with this ancestry in place of its own. All its other members stay as they are, number by number. An empty
// origin becomes one with an ancestry alone. Throws InputError("/origin", ...) if the origin is not a JSON object, and
// for a name that is not UTF-8.
std::string with_ancestry(const std::string& origin, const Ancestry& ancestry);

}  // namespace mercury
