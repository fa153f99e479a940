// SPDX-License-Identifier: Apache-2.0
#include "python/src/drives.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include <cmath>
#include <string>
#include <utility>

#include "mercury/error.h"
#include "python/src/bindings.h"
#include "python/src/values.h"

namespace mercury::python {

Drives::Drives(nb::handle given) {
  if (nb::isinstance<nb::list>(given) || nb::isinstance<nb::tuple>(given)) {
    for (const nb::handle one : given)
      of_each_.push_back(signal_from(one, "drives: " + std::to_string(of_each_.size())));
    if (of_each_.empty()) throw InputError("drives", "an empty list; give an array per robot");
  } else if (PyCallable_Check(given.ptr())) {
    function_ = CalledObject(given);
  } else {
    of_all_ = signal_from(given, "drives");
  }
}

Drives::SharedSignal Drives::signal_from(nb::handle array, const std::string& place) {
  const nb::module_ numpy = nb::module_::import_("numpy");
  const nb::object converted = numpy.attr("ascontiguousarray")(array, nb::arg("dtype") = "float32");
  nb::ndarray<const float, nb::c_contig, nb::device::cpu> values;
  if (!nb::try_cast(converted, values) || values.ndim() != 2 || values.shape(0) == 0)
    throw InputError(place, "the shape " + std::string(nb::str(nb::object(converted.attr("shape"))).c_str()) +
                                " is not accepted; give (periods, actuators)");
  auto signal = std::make_shared<Signal>();
  signal->rows.assign(values.data(), values.data() + values.size());
  signal->actuators = values.shape(1);
  for (std::size_t i = 0; i < signal->rows.size(); ++i) {
    const float value = signal->rows[i];
    const bool goes_on_by_itself = std::isnan(value) && std::isnan(signal->rows[i % signal->actuators]);
    if (!(std::abs(value) <= 1) && !goes_on_by_itself)
      throw InputError(place, "the drive of actuator " + std::to_string(i % signal->actuators) + " in period " +
                                  std::to_string(i / signal->actuators) + " is not from -1 to 1");
  }
  return signal;
}

Drives::SharedSignal Drives::signal(std::size_t index, const Robot& robot) const {
  if (of_all_) return of_all_;
  if (!function_) {
    if (index >= of_each_.size())
      throw InputError("drives", std::to_string(of_each_.size()) + " are not accepted; robot " + std::to_string(index) +
                                     " has none");
    return of_each_[index];
  }
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = of_function_.find(index); found != of_function_.end()) return found->second;
  }
  // Without the lock: Python may let another thread work meanwhile.
  SharedSignal made = function_.call([&](nb::handle function) {
    const nb::object array = function(index, SharedRobot{std::make_shared<const Robot>(robot)});
    return signal_from(array, "drives: robot " + std::to_string(index));
  });
  const std::lock_guard lock(mutex_);
  return of_function_.emplace(index, std::move(made)).first->second;
}

void Drives::write(std::size_t index, const Robot& robot, std::int64_t period, std::span<float> drives) const {
  const SharedSignal own = signal(index, robot);
  if (own->actuators != drives.size())
    throw InputError("drives", "robot " + std::to_string(index) + " has " + std::to_string(drives.size()) +
                                   " actuators, and " + std::to_string(own->actuators) + " signals");
  if (drives.empty()) return;
  const std::size_t row = static_cast<std::size_t>(period) % (own->rows.size() / own->actuators);
  for (std::size_t a = 0; a < drives.size(); ++a) drives[a] = own->rows[row * own->actuators + a];
}

void Drives::forget(std::size_t index) const {
  const std::lock_guard lock(mutex_);
  of_function_.erase(index);
}

}  // namespace mercury::python
