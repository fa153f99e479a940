// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/arranged_robots.h"

#include <utility>

#include "mercury/error.h"
#include "sim/cuda/rest_lengths.h"

namespace mercury {
namespace cuda {

RobotFindings look_at(const Robot& robot) { return {topology_key(robot), measure(robot), record_words_for(robot)}; }

void ArrangedRobots::prepare(const std::shared_ptr<const Robot>& robot) {
  try {
    validate(*robot);
  } catch (const InputError&) {
    return;
  }
  Entry entry{robot, look_at(*robot), nullptr};
  bool is_first;
  {
    const std::lock_guard lock(mutex_);
    is_first = topologies_.insert(entry.findings.topology).second;
  }
  if (is_first) entry.arrangement = std::make_unique<const Arrangement>(arrange(*robot));
  const std::lock_guard lock(mutex_);
  entries_.try_emplace(robot.get(), std::move(entry));
}

// In one go: thousands of robots from all threads would wait for the mutex longer than this takes.
std::vector<std::optional<ArrangedRobots::Entry>> ArrangedRobots::take(std::span<const Robot* const> robots) {
  std::vector<std::optional<Entry>> taken(robots.size());
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < robots.size() && !entries_.empty(); ++i)
    if (auto found = entries_.extract(robots[i])) {
      taken[i] = std::move(found.mapped());
      if (taken[i]->arrangement) topologies_.erase(taken[i]->findings.topology);
    }
  return taken;
}

}  // namespace cuda

std::shared_ptr<PreparedRobots> prepare_for_cuda() { return std::make_shared<cuda::ArrangedRobots>(); }

}  // namespace mercury
