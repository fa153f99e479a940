// SPDX-License-Identifier: Apache-2.0
#include "mercury/configuration.h"

#include <algorithm>
#include <thread>

#include "mercury/error.h"
#include "mercury/number_text.h"
#include "mercury/threads.h"

namespace mercury {

Configuration default_configuration(Physics physics, std::string_view environment) {
  Configuration configuration;
  const std::string_view own = physics == Physics::real ? Water::name : Ocean::name;
  configuration.environment = environment_named(environment.empty() ? own : environment);
  if (physics == Physics::paper) return configuration;
  configuration.damping = 0;
  configuration.environment.stiffness_scale = 1;
  if (configuration.environment.contacts) configuration.environment.contacts = Water{}.contacts;
  return configuration;
}

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
    const auto index = parse_number<int>(name.substr(5));
    if (index >= 0) return {.kind = DeviceKind::cuda, .index = *index};
  }
  throw ParameterError("device", "\"" + std::string(name) +
                                     "\" is not a device; give auto, cpu, cuda, cuda:N or cuda:all" +
                                     (name == "gpu" ? "; did you mean cuda?" : ""));  // cpu would be nearest
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
  check_parameters(configuration);
  check_parameters(configuration.device);
  check_parameters(configuration.environment);
}

}  // namespace mercury
