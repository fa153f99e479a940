// SPDX-License-Identifier: Apache-2.0
#include <oneapi/tbb/parallel_for.h>

#include <optional>

#include "mercury/error.h"
#include "mercury/nn_robot.h"

namespace mercury {

Robot random_nn_robot(const NnOptions& options, std::uint64_t seed, std::uint64_t index) {
  return grow(random_nn_genome(options, seed, index), "nn-" + std::to_string(seed) + "-" + std::to_string(index));
}

std::vector<Robot> random_nn_robots(const NnOptions& options, std::uint64_t seed, std::size_t count,
                                    std::uint64_t first, std::vector<FailedRobot>* failed) {
  validate(options);
  std::vector<std::optional<Robot>> grown(count);
  std::vector<std::string> reasons(count);
  oneapi::tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    try {
      grown[i] = random_nn_robot(options, seed, first + i);
    } catch (const InputError& error) {
      reasons[i] = error.what();
    }
  });
  std::vector<Robot> robots;
  robots.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (grown[i])
      robots.push_back(std::move(*grown[i]));
    else if (failed)
      failed->push_back({first + i, std::move(reasons[i])});
    else
      throw InputError("random network robot " + std::to_string(first + i), reasons[i]);
  }
  return robots;
}

}  // namespace mercury
