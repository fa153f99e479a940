// SPDX-License-Identifier: Apache-2.0
#include "mercury/configuration.h"

#include <charconv>
#include <cmath>
#include <type_traits>

#include "mercury/error.h"

namespace mercury {
namespace {

std::string shown(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value);
  return {text, end.ptr};
}

template <class Value>
void require_at_least_zero(const char* name, Value value, const char* unit) {
  if (!(std::isfinite(value) && value >= 0))
    throw ParameterError(name, shown(value) + " is not accepted; give a finite number >= 0" + unit);
}

void require_finite(const char* name, Vec3 value, const char* unit) {
  if (!(std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z)))
    throw ParameterError(name, shown(value.x) + "," + shown(value.y) + "," + shown(value.z) +
                                   " is not accepted; give three finite numbers" + unit);
}

void validate_environment(const Ocean& ocean) {
  require_at_least_zero("density", ocean.density, " kg/m3");
  require_at_least_zero("drag_coefficient", ocean.drag_coefficient, "");
  require_at_least_zero("lift_coefficient", ocean.lift_coefficient, "");
  require_finite("flow", ocean.flow, " of m/s");
}

void validate_environment(const OceanSimple& ocean) {
  require_at_least_zero("point_drag", ocean.point_drag, " N s/m");
  require_finite("flow", ocean.flow, " of m/s");
}

void validate_environment(const Land& land) {
  require_at_least_zero("friction", land.friction, "");
  require_at_least_zero("contact_stiffness", land.contact_stiffness, " N/m");
}

}  // namespace

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

Solver solver_named(std::string_view name) {
  if (name == "force") return Solver::force;
  if (name == "xpbd") return Solver::xpbd;
  throw ParameterError("solver", "\"" + std::string(name) + "\" is not a solver; give force or xpbd");
}

Environment environment_named(std::string_view name) {
  if (name == Ocean::name) return Ocean{};
  if (name == OceanSimple::name) return OceanSimple{};
  if (name == Land::name) return Land{};
  throw ParameterError("environment",
                       "\"" + std::string(name) + "\" is not an environment; give ocean, ocean-simple or land");
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

Vec3 gravity_of(const Environment& environment) {
  return std::visit([](const auto& kind) { return kind.gravity; }, environment);
}

float stiffness_scale_of(const Environment& environment) {
  return std::visit([](const auto& kind) { return kind.stiffness_scale; }, environment);
}

void validate(const Configuration& configuration) {
  if (!(std::isfinite(configuration.dt) && configuration.dt > 0))
    throw ParameterError("dt", shown(configuration.dt) + " is not accepted; give a finite number > 0 s");
  require_at_least_zero("damping", configuration.damping, " 1/s");
  require_finite("gravity", gravity_of(configuration.environment), " of m/s2");
  require_at_least_zero("stiffness_scale", stiffness_scale_of(configuration.environment), "");
  if (configuration.device.threads < 0)
    throw ParameterError("threads", std::to_string(configuration.device.threads) + " is not accepted; give 0 or more");
  std::visit([](const auto& kind) { validate_environment(kind); }, configuration.environment);
}

}  // namespace mercury
