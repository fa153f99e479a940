// SPDX-License-Identifier: Apache-2.0
#include "app/options/simulation_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <set>
#include <type_traits>
#include <variant>

#include "app/options/option_values.h"
#include "mercury/error.h"
#include "mercury/origin.h"

namespace mercury {
namespace {

// One member of an environment, told by a function that exists only for the environments that have it.
constexpr auto density = [](auto& e) -> decltype((e.density)) { return e.density; };
constexpr auto drag_coefficient = [](auto& e) -> decltype((e.drag_coefficient)) { return e.drag_coefficient; };
constexpr auto lift_coefficient = [](auto& e) -> decltype((e.lift_coefficient)) { return e.lift_coefficient; };
constexpr auto flow = [](auto& e) -> decltype((e.flow)) { return e.flow; };
constexpr auto point_drag = [](auto& e) -> decltype((e.point_drag)) { return e.point_drag; };
constexpr auto gravity = [](auto& e) -> decltype((e.gravity)) { return e.gravity; };
constexpr auto friction = [](auto& e) -> decltype((e.friction)) { return e.friction; };
constexpr auto contact_stiffness = [](auto& e) -> decltype((e.contact_stiffness)) { return e.contact_stiffness; };
constexpr auto stiffness_scale = [](auto& e) -> decltype((e.stiffness_scale)) { return e.stiffness_scale; };
constexpr auto self_collision = [](auto& e) -> decltype((e.self_collision)) { return e.self_collision; };

// The environments that have the member, as "ocean and ocean-simple".
template <class Member, std::size_t... i>
std::string environments_with(Member, std::index_sequence<i...>) {
  std::string names;
  const auto add = [&names]<class Kind>(std::type_identity<Kind>) {
    if constexpr (std::is_invocable_v<Member, Kind&>) names += (names.empty() ? "" : " and ") + std::string(Kind::name);
  };
  (add(std::type_identity<std::variant_alternative_t<i, Environment>>{}), ...);
  return names;
}

template <class Value, class Member>
void set(Environment& environment, const char* option, const std::optional<Value>& value, Member member) {
  if (!value) return;
  std::visit(
      [&]<class Kind>(Kind& kind) {
        if constexpr (std::is_invocable_v<Member, Kind&>)
          member(kind) = *value;
        else
          throw InputError(
              option,
              fmt::format("{} has no such parameter; it applies to {}", Kind::name,
                          environments_with(member, std::make_index_sequence<std::variant_size_v<Environment>>{})));
      },
      environment);
}

bool is_environment(std::string_view name) {
  return [&]<std::size_t... i>(std::index_sequence<i...>) {
    return ((name == std::variant_alternative_t<i, Environment>::name) || ...);
  }
  (std::make_index_sequence<std::variant_size_v<Environment>>{});
}

// One number is a pull downwards.
Vec3 gravity_from(const std::string& option, const std::string& text) {
  if (text.find(',') != std::string::npos) return vector_from(option, text);
  return {0, 0, -number_from<float>(option, text)};
}

}  // namespace

void SimulationOptions::add_to(CLI::App& command) {
  const auto group = [](CLI::Option* option, const char* name) { option->group(name); };
  group(add_value(command, "--device", device_,
                  "What computes; cuda:all spreads robots over all GPUs (default auto: a GPU if there is one)",
                  "auto|cpu|cuda[:N]",
                  [](const std::string&, const std::string& text) { return name_of(device_named(text)); }),
        "Simulation");
  group(add_number(command, "--threads", threads_, "CPU threads (default 0 = all cores)", "N"), "Simulation");
  group(add_value(
            command, "--environment", environment_,
            "Where the robots live (default: what they are made for, else ocean)", "ocean|ocean-simple|land",
            [](const std::string&, const std::string& text) { return std::string(name_of(environment_named(text))); }),
        "Simulation");
  group(add_value(command, "--solver", solver_, "Solver (default force)", "force|xpbd",
                  [](const std::string&, const std::string& text) { return std::string(name_of(solver_named(text))); }),
        "Simulation");
  group(add_number(command, "--dt", dt_, "Time step (default 0.001)", "S"), "Simulation");
  group(add_number(command, "--seconds", seconds_, "Simulated time (default 10)", "S"), "Simulation");
  group(add_number(command, "--damping", damping_, "Damping of all velocities (default 0.1)", "1/S"), "Simulation");
  group(add_number(command, "--stiffness-scale", stiffness_scale_,
                   "Multiplies every stiffness (default 1 in water, 200 on land)", "X"),
        "Environment");
  group(add_value(command, "--gravity", gravity_,
                  "Gravity, downwards or as a vector (default 0 in water, 9.81 on land)", "G|X,Y,Z", gravity_from),
        "Environment");
  group(add_number(command, "--density", density_, "Density of the water (ocean; default 1000)", "KG/M3"),
        "Environment");
  group(add_number(command, "--drag-coefficient", drag_coefficient_, "Drag coefficient (ocean; default 1)", "C"),
        "Environment");
  group(add_number(command, "--lift-coefficient", lift_coefficient_, "Lift coefficient (ocean; default 0.2)", "C"),
        "Environment");
  group(add_value(command, "--flow", flow_, "Velocity of the water (ocean, ocean-simple; default 0,0,0)", "X,Y,Z",
                  vector_from),
        "Environment");
  group(add_number(command, "--point-drag", point_drag_, "Drag of a mass (ocean-simple; default 1)", "N S/M"),
        "Environment");
  group(add_number(command, "--friction", friction_, "Friction of the ground (land; default 0.8)", "MU"),
        "Environment");
  group(add_number(command, "--contact-stiffness", contact_stiffness_,
                   "Stiffness of a robot's contact with itself (land; default 100)", "N/M"),
        "Environment");
  group(command.add_flag("--no-self-collision", no_self_collision_, "Robots pass through themselves (land)"),
        "Environment");
}

void SimulationOptions::set_parameters(Environment& environment) const {
  set(environment, "--density", density_, density);
  set(environment, "--drag-coefficient", drag_coefficient_, drag_coefficient);
  set(environment, "--lift-coefficient", lift_coefficient_, lift_coefficient);
  set(environment, "--flow", flow_, flow);
  set(environment, "--point-drag", point_drag_, point_drag);
  set(environment, "--gravity", gravity_, gravity);
  set(environment, "--friction", friction_, friction);
  set(environment, "--contact-stiffness", contact_stiffness_, contact_stiffness);
  set(environment, "--stiffness-scale", stiffness_scale_, stiffness_scale);
  if (no_self_collision_) set(environment, "--no-self-collision", std::optional<bool>(false), self_collision);
}

Configuration SimulationOptions::configuration_in(std::string_view environment) const {
  Configuration configuration;
  configuration.dt = dt_;
  configuration.damping = damping_;
  configuration.solver = solver_named(solver_);
  configuration.device = device_named(device_);
  configuration.device.threads = threads_;
  configuration.environment = environment_named(environment);
  set_parameters(configuration.environment);
  validate(configuration);
  return configuration;
}

Configuration SimulationOptions::configuration() const { return configuration_in(environment_.value_or("ocean")); }

Configuration SimulationOptions::configuration(std::span<const Robot> robots, std::vector<std::string>& notes) const {
  if (environment_) return configuration();
  std::set<std::string> wanted;
  for (const Robot& robot : robots) {
    const std::string environment = environment_of(robot);
    if (is_environment(environment)) wanted.insert(environment);
  }
  if (wanted.size() == 1) return configuration_in(*wanted.begin());
  if (wanted.size() > 1)
    notes.push_back(fmt::format("the robots are made for {}; all are put into ocean, --environment chooses",
                                fmt::join(wanted, " and ")));
  return configuration();
}

double SimulationOptions::seconds(double otherwise) const {
  const double seconds = seconds_.value_or(otherwise);
  if (!(std::isfinite(seconds) && seconds >= 0))
    throw InputError("--seconds", fmt::format("{} is not accepted; give a finite number >= 0 s", seconds));
  if (seconds / dt_ > 1e15) throw InputError("--seconds", fmt::format("{} s are too many steps of {} s", seconds, dt_));
  return seconds;
}

std::int64_t SimulationOptions::steps() const { return std::llround(seconds() / dt_); }

}  // namespace mercury
