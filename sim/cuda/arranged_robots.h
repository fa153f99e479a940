// SPDX-License-Identifier: Apache-2.0
// Arrangements made before a device has started (mercury/prepared_robots.h).
#pragma once

#include <memory>
#include <mutex>
#include <unordered_map>
#include <unordered_set>

#include "mercury/prepared_robots.h"
#include "sim/cuda/arrangement.h"

namespace mercury::cuda {

class ArrangedRobots final : public PreparedRobots {
 public:
  // Does nothing for a robot of a topology that was there before, since such robots share an arrangement.
  void prepare(const std::shared_ptr<const Robot>& robot) override;
  // The arrangement of this robot, which is then no longer here; null if there is none.
  std::unique_ptr<const Arrangement> take(const Robot& robot);

 private:
  struct Entry {
    std::shared_ptr<const Robot> robot;  // so that no other robot gets its address
    std::unique_ptr<const Arrangement> arrangement;
  };

  std::mutex mutex_;
  std::unordered_set<std::uint64_t> topologies_;  // keys of all that were ever here
  std::unordered_map<const Robot*, Entry> entries_;
};

}  // namespace mercury::cuda
