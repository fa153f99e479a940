// SPDX-License-Identifier: Apache-2.0
// The liveliest of random robots, so that the first robots that somebody sees move.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mercury/assessor.h"
#include "mercury/configuration.h"
#include "mercury/generator.h"

namespace mercury {

// As many robots are tried for each that is kept.
inline constexpr std::uint64_t tried_per_lively = 10;

// The configuration of the quick trials, on the CPU: the environment, or that of the generator if it is empty or no
// robot can move itself there.
Configuration lively_configuration(const RandomRobots& request, const std::string& environment = {});

// The indices of the `request.count` liveliest of ten times as many robots of the seed, from request.first on: those
// that get farthest in one trial of four seconds with jitter. The liveliest first; robots that are not sound, or cannot
// be made, come last. They depend on the arguments alone: trials are on the CPU. Returns none if
// `watch` said to stop. Throws ParameterError for a request that cannot be used.
std::vector<std::uint64_t> liveliest(const RandomRobots& request, const Configuration& configuration,
                                     const Watch& watch = {});

// The same robots as requests of one robot each.
std::vector<RandomRobots> lively_requests(const RandomRobots& request, const Configuration& configuration,
                                          const Watch& watch = {});

}  // namespace mercury
