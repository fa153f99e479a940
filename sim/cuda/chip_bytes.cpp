// SPDX-License-Identifier: Apache-2.0
#include "mercury/cuda_devices.h"

#include <algorithm>

#include "sim/cuda/block_layout.h"

namespace mercury {

namespace cuda {

std::vector<float> lengths_of(const Robot& robot) {
  std::vector<float> lengths{0};
  for (const Spring& spring : robot.springs) {
    const auto at = std::ranges::lower_bound(lengths, spring.rest_length);
    if (at != lengths.end() && *at == spring.rest_length) continue;
    lengths.insert(at, spring.rest_length);
    if (lengths.size() > max_lengths) break;
  }
  return lengths;
}

}  // namespace cuda

std::size_t chip_bytes(const Robot& robot, const Configuration& configuration) {
  using namespace cuda;
  const std::uint32_t tiles = tiles_for(robot.masses.size());
  LaunchConfiguration launch;
  launch.record_words = lengths_of(robot).size() <= max_lengths ? 1 : 2;
  launch.contact_buckets = contact_buckets(configuration.environment, tiles);
  return block_layout(launch, tiles, working_fields(configuration.solver, false)).total;
}

}  // namespace mercury
