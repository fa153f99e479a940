// SPDX-License-Identifier: Apache-2.0
#include "mercury/cuda_devices.h"

#include "sim/cuda/block_layout.h"
#include "sim/cuda/rest_lengths.h"

namespace mercury {

std::size_t chip_bytes(const Robot& robot, const Configuration& configuration) {
  using namespace cuda;
  const std::uint32_t tiles = tiles_for(robot.masses.size());
  LaunchConfiguration launch;
  launch.record_words = record_words_for(robot);
  launch.contact_buckets = contact_buckets(configuration.environment, tiles);
  return block_layout(launch, tiles, working_fields(configuration.solver, false)).total;
}

}  // namespace mercury
