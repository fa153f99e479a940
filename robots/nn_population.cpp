// SPDX-License-Identifier: Apache-2.0
#include "mercury/nn_robot.h"
#include "robots/make_all.h"

namespace mercury {

Robot random_nn_robot(const NnOptions& options, std::uint64_t seed, std::uint64_t index) {
  return grow(random_nn_genome(options, seed, index), "nn-" + std::to_string(seed) + "-" + std::to_string(index));
}

std::vector<Robot> random_nn_robots(const NnOptions& options, std::uint64_t seed, std::size_t count,
                                    std::uint64_t first, std::vector<FailedRobot>* failed) {
  validate(options);
  return make_all(
      "nn", seed, count, first, [&](std::uint64_t index) { return random_nn_robot(options, seed, index); }, failed);
}

}  // namespace mercury
