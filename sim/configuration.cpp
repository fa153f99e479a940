// SPDX-License-Identifier: Apache-2.0
#include "mercury/configuration.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <thread>
#include <type_traits>
#include <vector>

#include "mercury/error.h"
#include "mercury/threads.h"

namespace mercury {

std::string_view name_of(Solver solver) { return solver == Solver::force ? "force" : "xpbd"; }

std::string_view name_of(const Environment& environment) {
  return std::visit([](const auto& kind) { return std::decay_t<decltype(kind)>::name; }, environment);
}

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

std::vector<std::string_view> environment_names() {
  std::vector<std::string_view> names;
  for_each_environment([&](const auto& kind) { names.push_back(kind.name); });
  return names;
}

Solver solver_named(std::string_view name) {
  if (name == "force") return Solver::force;
  if (name == "xpbd") return Solver::xpbd;
  throw ParameterError("solver", "\"" + std::string(name) + "\" is not a solver; give force or xpbd");
}

Environment environment_named(std::string_view name) {
  std::optional<Environment> found;
  for_each_environment([&](const auto& kind) {
    if (kind.name == name) found = kind;
  });
  if (found) return *found;
  const std::vector<std::string_view> names = environment_names();
  std::string accepted;
  for (std::size_t i = 0; i < names.size(); ++i)
    accepted.append(i == 0 ? "" : i + 1 < names.size() ? ", " : " or ").append(names[i]);
  throw ParameterError("environment", "\"" + std::string(name) + "\" is not an environment; give " + accepted);
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

Vec3 gravity_of(const Environment& environment) {
  return std::visit([](const auto& kind) { return kind.gravity; }, environment);
}

float stiffness_scale_of(const Environment& environment) {
  return std::visit([](const auto& kind) { return kind.stiffness_scale; }, environment);
}

void validate(const Configuration& configuration) {
  check_parameters(configuration);
  check_parameters(configuration.device);
  std::visit([](const auto& kind) { check_parameters(kind); }, configuration.environment);
}

}  // namespace mercury
