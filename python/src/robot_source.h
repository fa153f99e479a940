// SPDX-License-Identifier: Apache-2.0
// Robots that Python makes, for an Evaluator.
#pragma once

#include <nanobind/nanobind.h>

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>

#include "mercury/evaluator.h"
#include "python/src/bindings.h"

namespace mercury::python {

// A source ends where it raises. The exception is kept until the results before it are there.
class SourceError {
 public:
  // To be called while the exception is caught, with the GIL. The exception of the lowest index stays.
  void keep(std::size_t index, std::exception_ptr exception);
  // Throws it, once.
  void rethrow();
  // The same for what is no Exception, such as KeyboardInterrupt: that does not wait.
  void rethrow_if_urgent();

 private:
  std::exception_ptr exception_;
  std::size_t index_ = 0;
};

// An iterator. The evaluator's thread that needs a robot waits until the thread of Python that waits for a result takes
// one from the iterator. So Python runs in no other thread, and only as many robots are made as are needed.
//
//     evaluator's thread      take() ......................... robot
//     thread of Python        next() -> is_wanted() -> serve()
class PulledSource {
 public:
  // Without the GIL. nullptr after the end, and once it is closed.
  std::shared_ptr<const Robot> take();
  void close();

  bool is_wanted();
  // Waits until is_wanted(), or until the time is over. Without the GIL.
  void wait(std::chrono::milliseconds time);
  // nullptr = there are no more.
  void serve(std::shared_ptr<const Robot> robot);

 private:
  std::mutex mutex_;
  std::condition_variable wanted_changed_, served_changed_;
  bool wanted_ = false, ended_ = false;
  std::shared_ptr<const Robot> served_;
};

// Throws TypeError unless it is a Robot. `index` = in the source.
std::shared_ptr<const Robot> robot_from(nb::handle robot, std::size_t index);

// A function of Python that gives the robot of an index, or None. The evaluator's threads call it, with the GIL. Its
// InputErrors are the failure of their robots; other exceptions end the source.
RobotSource source_of_function(nb::handle function, std::shared_ptr<SourceError> error);

}  // namespace mercury::python
