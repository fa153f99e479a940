// SPDX-License-Identifier: Apache-2.0
#include "python/src/robot_source.h"

#include <string>
#include <utility>

#include "mercury/error.h"

namespace mercury::python {

void SourceError::keep(std::size_t index, std::exception_ptr exception) {
  if (exception_ && index_ < index) return;
  exception_ = std::move(exception);
  index_ = index;
}

void SourceError::rethrow() {
  if (exception_) std::rethrow_exception(std::exchange(exception_, nullptr));
}

void SourceError::rethrow_if_urgent() {
  if (!exception_) return;
  try {
    std::rethrow_exception(exception_);
  } catch (nb::python_error& raised) {
    if (!raised.matches(PyExc_Exception)) rethrow();
  } catch (...) {
  }
}

std::shared_ptr<const Robot> PulledSource::take() {
  std::unique_lock lock(mutex_);
  wanted_ = true;
  wanted_changed_.notify_all();
  served_changed_.wait(lock, [&] { return ended_ || served_; });
  wanted_ = false;
  return std::exchange(served_, nullptr);
}

void PulledSource::close() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  served_changed_.notify_all();
}

bool PulledSource::is_wanted() {
  const std::lock_guard lock(mutex_);
  return wanted_ && !ended_ && !served_;
}

void PulledSource::wait(std::chrono::milliseconds time) {
  std::unique_lock lock(mutex_);
  wanted_changed_.wait_for(lock, time, [&] { return wanted_ && !ended_ && !served_; });
}

void PulledSource::serve(std::shared_ptr<const Robot> robot) {
  const std::lock_guard lock(mutex_);
  ended_ = ended_ || !robot;
  served_ = std::move(robot);
  served_changed_.notify_all();
}

std::shared_ptr<const Robot> robot_from(nb::handle robot, std::size_t index) {
  if (SharedRobot shared; nb::try_cast(robot, shared)) return shared.robot;
  const std::string type = nb::type_name(robot.type()).c_str();
  throw nb::type_error(("robot " + std::to_string(index) + " of the source is a " + type + "; give Robots").c_str());
}

RobotSource source_of_function(nb::handle function, std::shared_ptr<SourceError> error) {
  return [function, error](std::size_t index) -> std::shared_ptr<const Robot> {
    const nb::gil_scoped_acquire gil;
    try {
      const nb::object robot = function(index);
      return robot.is_none() ? nullptr : robot_from(robot, index);
    } catch (nb::python_error& raised) {
      if (raised.matches(nb::module_::import_("mercurysim").attr("InputError")))
        throw InputError(nb::str(raised.value()).c_str());
      error->keep(index, std::current_exception());
    } catch (...) {
      error->keep(index, std::current_exception());
    }
    return nullptr;
  };
}

}  // namespace mercury::python
