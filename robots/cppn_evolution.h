// SPDX-License-Identifier: Apache-2.0
// Mutation and crossover of painted voxel robots, as the registry of generators has them.
#pragma once

#include <cstdint>
#include <string>

#include "mercury/cppn.h"
#include "mercury/generator.h"

namespace mercury {

// cppn_genome_of, which must be there. Throws InputError.
CppnGenome cppn_genome_in(const Robot& robot);

Robot mutate_cppn_robot(const Robot& parent, const MutationRequest& request, const std::string& name);
Robot cross_cppn_robots(const Robot& a, const Robot& b, std::uint64_t seed, const std::string& name);

}  // namespace mercury
