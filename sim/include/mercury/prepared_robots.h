// SPDX-License-Identifier: Apache-2.0
// What a device needs of robots, worked out on the host before it loads them: while CUDA starts, which takes a quarter
// of a second, or while others are stepped. Arranging thousands of robots keeps all cores busy for tens of
// milliseconds.
#pragma once

#include <memory>

#include "mercury/backend.h"
#include "mercury/robot.h"

namespace mercury {

class PreparedRobots {
 public:
  virtual ~PreparedRobots() = default;
  // Several threads may call it. A robot that breaks a rule is passed over. The others are kept until a backend has
  // loaded them.
  virtual void prepare(const std::shared_ptr<const Robot>& robot) = 0;
};

// For CUDA backends that share them; null in a build without CUDA.
std::shared_ptr<PreparedRobots> prepare_for_cuda();
// Takes those robots that it loads from `prepared`, which prepare_for_cuda() returned.
std::unique_ptr<Backend> make_cuda_backend(const Device& device, std::shared_ptr<PreparedRobots> prepared);

}  // namespace mercury
