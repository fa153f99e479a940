// SPDX-License-Identifier: Apache-2.0
#include "mercury/configuration.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <thread>

#include "mercury/error.h"
#include "mercury/threads.h"

namespace mercury {
namespace {

template <class Number>
std::string shown(Number value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value);
  return {text, end.ptr};
}

bool is_accepted(double value, Accepts accepts) {
  return std::isfinite(value) &&
         (accepts == Accepts::any || value > 0 || (accepts == Accepts::at_least_zero && value == 0));
}

std::string bounds(Accepts accepts) {
  return accepts == Accepts::above_zero ? " > 0" : accepts == Accepts::at_least_zero ? " >= 0" : "";
}

// Throws ParameterError if the value is not accepted.
struct Check {
  template <class Parameter, class Number>
  void operator()(const Parameter& parameter, Number value) const {
    const auto number = static_cast<double>(value);
    if (is_accepted(number, parameter.accepts)) return;
    refuse(parameter, shown(value), "a finite number" + bounds(parameter.accepts), " ");
  }
  template <class Parameter>
  void operator()(const Parameter& parameter, int value) const {
    if (!is_accepted(value, parameter.accepts)) refuse(parameter, std::to_string(value), "0 or more", " ");
  }
  template <class Parameter>
  void operator()(const Parameter& parameter, Vec3 value) const {
    for (const float component : {value.x, value.y, value.z})
      if (!is_accepted(static_cast<double>(component), parameter.accepts))
        refuse(parameter, shown(value.x) + "," + shown(value.y) + "," + shown(value.z),
               "three finite numbers" + bounds(parameter.accepts), " of ");
  }
  template <class Parameter>
  void operator()(const Parameter&, bool) const {}

  template <class Parameter>
  [[noreturn]] static void refuse(const Parameter& parameter, const std::string& value, const std::string& accepted,
                                  const char* before_unit) {
    const std::string unit(parameter.unit);
    throw ParameterError(std::string(parameter.name),
                         value + " is not accepted; give " + accepted + (unit.empty() ? unit : before_unit + unit));
  }
};

}  // namespace

std::string_view name_of(Solver solver) { return solver == Solver::force ? "force" : "xpbd"; }

std::string name_of(const Device& device) {
  switch (device.kind) {
    case DeviceKind::automatic:
      return "auto";
    case DeviceKind::cpu:
      return "cpu";
    case DeviceKind::cuda:
      break;
  }
  if (device.index == Device::all_devices) return "cuda:all";
  return device.index == 0 ? "cuda" : "cuda:" + std::to_string(device.index);
}

Solver solver_named(std::string_view name) {
  if (name == "force") return Solver::force;
  if (name == "xpbd") return Solver::xpbd;
  throw ParameterError("solver", "\"" + std::string(name) + "\" is not a solver; give force or xpbd");
}

Device device_named(std::string_view name) {
  if (name == "auto") return {};
  if (name == "cpu") return {.kind = DeviceKind::cpu};
  if (name == "cuda") return {.kind = DeviceKind::cuda};
  if (name == "cuda:all") return {.kind = DeviceKind::cuda, .index = Device::all_devices};
  if (name.starts_with("cuda:")) {
    const std::string_view digits = name.substr(5);
    Device device{.kind = DeviceKind::cuda};
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), device.index);
    if (error == std::errc{} && end == digits.data() + digits.size() && device.index >= 0) return device;
  }
  throw ParameterError("device",
                       "\"" + std::string(name) + "\" is not a device; give auto, cpu, cuda, cuda:N or cuda:all");
}

int max_threads() {
  constexpr unsigned always = 256, most = 65536;
  return static_cast<int>(std::clamp(4 * std::thread::hardware_concurrency(), always, most));
}

void require_possible_threads(const Device& device) {
  if (device.threads >= 0 && device.threads <= max_threads()) return;
  throw ParameterError("threads", std::to_string(device.threads) + " is not accepted; give 0 (all cores) to " +
                                      std::to_string(max_threads()));
}

void validate(const Configuration& configuration) {
  for_each_parameter(configuration, Check{});
  for_each_parameter(configuration.device, Check{});
  for_each_parameter(configuration.environment, Check{});
}

}  // namespace mercury
