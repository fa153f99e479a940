// SPDX-License-Identifier: Apache-2.0
// Drive signals of robots that are evaluated, from Python.
#pragma once

#include <nanobind/nanobind.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <unordered_map>
#include <vector>

#include "mercury/robot.h"
#include "python/src/called_object.h"

namespace mercury::python {

namespace nb = nanobind;

// A signal per robot: rows of drives, one per period, which begin again after the last one. Several threads use it.
class Drives {
 public:
  // `given` = an array (periods, actuators) for all robots, a list of them, one per robot, or a function of index and
  // robot that gives one. Throws TypeError, InputError.
  explicit Drives(nb::handle given);

  // The drives of a period, into one element per actuator. Throws InputError, and what the function raises.
  void write(std::size_t index, const Robot& robot, std::int64_t period, std::span<float> drives) const;
  // The robot is done.
  void forget(std::size_t index) const;

 private:
  struct Signal {
    std::vector<float> rows;
    std::size_t actuators = 0;
  };
  using SharedSignal = std::shared_ptr<const Signal>;

  static SharedSignal signal_from(nb::handle array, const std::string& place);
  SharedSignal signal(std::size_t index, const Robot& robot) const;

  SharedSignal of_all_;
  std::vector<SharedSignal> of_each_;
  CalledObject function_;
  mutable std::mutex mutex_;
  mutable std::unordered_map<std::size_t, SharedSignal> of_function_;  // by robot
};

}  // namespace mercury::python
