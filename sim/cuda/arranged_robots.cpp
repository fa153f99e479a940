// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/arranged_robots.h"

#include <utility>

#include "mercury/error.h"

namespace mercury {
namespace cuda {

void ArrangedRobots::prepare(const std::shared_ptr<const Robot>& robot) {
  try {
    validate(*robot);
  } catch (const InputError&) {
    return;
  }
  const std::uint64_t topology = topology_key(*robot);
  {
    const std::lock_guard lock(mutex_);
    if (!topologies_.insert(topology).second) return;
  }
  auto arrangement = std::make_unique<const Arrangement>(arrange(*robot));
  const std::lock_guard lock(mutex_);
  entries_.try_emplace(robot.get(), robot, std::move(arrangement));
}

std::unique_ptr<const Arrangement> ArrangedRobots::take(const Robot& robot) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(&robot);
  if (found == entries_.end()) return nullptr;
  std::unique_ptr<const Arrangement> arrangement = std::move(found->second.arrangement);
  entries_.erase(found);
  return arrangement;
}

}  // namespace cuda

std::shared_ptr<PreparedRobots> prepare_for_cuda() { return std::make_shared<cuda::ArrangedRobots>(); }

}  // namespace mercury
