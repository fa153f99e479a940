// SPDX-License-Identifier: Apache-2.0
#include "mercury/cuda_devices.h"

#include <algorithm>

#include "sim/cuda/block_layout.h"

namespace mercury {

namespace cuda {

// The different rest lengths of a robot in ascending order, 0 of empty places first; cut off behind max_lengths + 1.
std::vector<float> lengths_of(const Robot& robot) {
  std::vector<float> lengths{0};
  for (const Spring& spring : robot.springs) {
    const auto place = std::ranges::lower_bound(lengths, spring.rest_length);
    if (place != lengths.end() && *place == spring.rest_length) continue;
    lengths.insert(place, spring.rest_length);
    if (lengths.size() > max_lengths) break;
  }
  return lengths;
}

}  // namespace cuda

std::size_t chip_bytes(const Robot& robot, const Configuration& configuration) {
  using namespace cuda;
  Shape shape;
  shape.record_words = lengths_of(robot).size() <= max_lengths ? 1 : 2;
  shape.contact_buckets = contact_buckets(configuration.environment, groups_of(robot));
  return block_layout(shape, groups_of(robot), working_rows(configuration.solver, false)).total;
}

}  // namespace mercury
