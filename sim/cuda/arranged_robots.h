// SPDX-License-Identifier: Apache-2.0
// What is worked out of a robot before it is loaded, and where that waits (mercury/prepared_robots.h).
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "mercury/prepared_robots.h"
#include "sim/cuda/arrangement.h"
#include "sim/physics/measures.h"

namespace mercury::cuda {

struct RobotFindings {
  std::uint64_t topology = 0;  // its key
  RobotMeasures measures;
  std::uint32_t record_words = 1;
};
RobotFindings look_at(const Robot& robot);

class ArrangedRobots final : public PreparedRobots {
 public:
  struct Entry {
    std::shared_ptr<const Robot> robot;  // so that no other robot gets its address
    RobotFindings findings;
    // Null if a robot of its topology has one here, since such robots share it.
    std::unique_ptr<const Arrangement> arrangement;
  };

  void prepare(const std::shared_ptr<const Robot>& robot) override;
  // The entry of each robot, which is then no longer here; none if there is none.
  std::vector<std::optional<Entry>> take(std::span<const Robot* const> robots);

 private:
  std::mutex mutex_;
  std::unordered_set<std::uint64_t> topologies_;  // keys of those that have an arrangement, or will have one
  std::unordered_map<const Robot*, Entry> entries_;
};

}  // namespace mercury::cuda
