// SPDX-License-Identifier: Apache-2.0
#include "app/options/simulation_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <type_traits>
#include <utility>

#include "app/options/option_values.h"
#include "app/options/parameter_options.h"
#include "mercury/error.h"
#include "mercury/names.h"
#include "mercury/origin.h"
#include "mercury/real_body.h"
#include "mercury/threads.h"

namespace mercury {
namespace {

constexpr const char* simulation_group = "Simulation";
constexpr const char* environment_group = "Environment";

// The environments that have a parameter, by its default there.
std::vector<std::pair<std::string, std::vector<std::string>>> environments_by_default(std::string_view name) {
  std::vector<std::pair<std::string, std::vector<std::string>>> groups;
  for (const EnvironmentPreset& preset : environment_presets)
    for_each_parameter(preset.environment, [&](const auto& parameter, const auto& value) {
      if (parameter.name != name) return;
      auto group = std::ranges::find(groups, text_of(value), &decltype(groups)::value_type::first);
      if (group == groups.end()) group = groups.insert(groups.end(), {text_of(value), {}});
      group->second.emplace_back(preset.name);
    });
  return groups;
}

// The environments that have a parameter, as "ocean and ocean-simple".
std::string environments_with(std::string_view name) {
  std::vector<std::string> names;
  for (const auto& [value, environments] : environments_by_default(name))
    names.insert(names.end(), environments.begin(), environments.end());
  return list_of(names, " and ");
}

// "(ocean, ocean-simple; default 0,0,0)", or "(default 1 in ocean and ocean-simple, 200 in land)".
std::string where_and_default(std::string_view name) {
  const auto groups = environments_by_default(name);
  if (groups.size() == 1)
    return fmt::format("({}; default {})", fmt::join(groups.front().second, ", "), groups.front().first);
  std::vector<std::string> defaults;
  for (const auto& [value, environments] : groups)
    defaults.push_back(fmt::format("{} in {}", value, list_of(environments, " and ")));
  return fmt::format("(default {})", fmt::join(defaults, ", "));
}

// One number is a magnitude, downward.
Vec3 gravity_from(const std::string& option, const std::string& text) {
  if (text.find(',') != std::string::npos) return vector_from(option, text);
  return {0, 0, -number_from<float>(option, text)};
}

}  // namespace

namespace {

class PhysicsOfAll {
 public:
  void add(const Robot& robot) {
    (mercury::physics_of(robot) == Physics::real ? real_ : paper_) = &robot;
    if (real_ && paper_)
      throw InputError(real_->name + " and " + paper_->name,
                       "one has a real body, the other that of the paper; --physics real gives all a real one");
  }
  Physics physics() const { return real_ ? Physics::real : Physics::paper; }

 private:
  const Robot *real_ = nullptr, *paper_ = nullptr;
};

}  // namespace

Physics physics_of(std::span<const Robot> robots) {
  PhysicsOfAll all;
  for (const Robot& robot : robots) all.add(robot);
  return all.physics();
}
Physics physics_of(std::span<const Robot* const> robots) {
  PhysicsOfAll all;
  for (const Robot* robot : robots) all.add(*robot);
  return all.physics();
}
Physics physics_of(std::span<const std::shared_ptr<const Robot>> robots) {
  PhysicsOfAll all;
  for (const auto& robot : robots) all.add(*robot);
  return all.physics();
}

void SimulationOptions::add_to(const Command& command) {
  command_ = command;
  const auto add = [](const Option& option) { option.in_group(simulation_group); };
  add(command.add_option(
      "--device",
      [this](const std::string& text) {
        const Device device = device_named(text);
        given_.device.kind = device.kind;
        given_.device.index = device.index;
      },
      "What computes; cuda:all spreads robots over all GPUs (default auto: a GPU if there is one)",
      "auto|cpu|cuda[:N]"));
  add_parameters(command, given_.device, simulation_group);
  add(add_value(
          command, "--environment", environment_,
          "Where the robots live; + adds parts, as in ocean+ground+contacts (default: what they are made for, else "
          "ocean)",
          fmt::format("{}", fmt::join(environment_names(), "|")),
          [](const std::string&, const std::string& text) { return std::string(name_of(environment_named(text))); })
          .on_first_screen());
  add(add_value(command, "--solver", given_.solver, "Solver (default force)", "force|xpbd",
                [](const std::string&, const std::string& text) { return solver_named(text); }));
  add(add_number(command, "--seconds", seconds_, "Simulated time (default 10)", "S").on_first_screen());
  add_parameters(command, given_, simulation_group);
  add(add_number(command, "--substeps", substeps_, "Divide the time step by N (default 1)", "N"));
  add_environment_parameters(command);
}

// One option for all environments that have a parameter of that name.
void SimulationOptions::add_environment_parameters(const Command& command) {
  const auto add = [&]<class Value>(const auto& parameter, const Value& usual) {
    const std::string name(parameter.name);
    if (parameter_options_.contains(name)) return;  // of an earlier environment
    ParameterOption& target = parameter_options_[name];
    std::optional<Option> option;
    if constexpr (std::is_same_v<Value, bool>) {
      target.option = switch_of(name, usual);
      option = command.add_flag(
          target.option, [&target, usual] { target.value = !usual; },
          fmt::format("{}{} ({})", usual ? "Switch off: " : "", parameter.help, environments_with(name)));
    } else {
      target.option = option_of(name);
      const std::string help =
          fmt::format("{}{} {}", parameter.help, parameter.takes_downward_magnitude ? ", downward or as a vector" : "",
                      where_and_default(name));
      if constexpr (!std::is_same_v<Value, Vec3>)
        option = add_value(command, target.option, target.value, help, form_of(parameter.unit), number_from<Value>)
                     .as_number(false);
      else if (parameter.takes_downward_magnitude)
        option = add_value(command, target.option, target.value, help, "G|X,Y,Z", gravity_from);
      else
        option = add_value(command, target.option, target.value, help, "X,Y,Z", vector_from);
    }
    option->in_group(environment_group);
  };
  for (const EnvironmentPreset& preset : environment_presets) for_each_parameter(preset.environment, add);
}

void SimulationOptions::set_parameters(Environment& environment) const {
  std::set<std::string> applicable;
  for_each_parameter(environment, [&]<class Value>(const auto& parameter, Value& value) {
    const std::string name(parameter.name);
    applicable.insert(name);
    const auto option = parameter_options_.find(name);
    if (option != parameter_options_.end() && option->second.value) value = std::get<Value>(*option->second.value);
  });
  for (const auto& [name, option] : parameter_options_)
    if (option.value && !applicable.contains(name))
      throw InputError(option.option, fmt::format("{} has no such parameter; it applies to {}", name_of(environment),
                                                  environments_with(name)));
}

Configuration SimulationOptions::configuration_in(std::string_view environment, Physics physics) const {
  const Configuration usual = default_configuration(physics, environment);
  Configuration configuration = given_;
  configuration.environment = usual.environment;
  configuration.dt = dt();
  if (!command_->is_given(option_of("damping"))) configuration.damping = usual.damping;
  set_parameters(configuration.environment);
  validate(configuration);
  require_possible_threads(configuration.device);
  return configuration;
}

Configuration SimulationOptions::configuration_over(const Configuration& base) const {
  Configuration configuration = base;
  configuration.device = given_.device;
  if (command_->is_given("--solver")) configuration.solver = given_.solver;
  const auto take_given = [&](const auto& parameter, auto& value) {
    if (command_->is_given(option_of(parameter.name))) value = given_.*parameter.member;
  };
  for_each_parameter(configuration, take_given);
  dt();  // throws for a number of substeps that is none
  configuration.dt /= substeps_;
  if (environment_ && *environment_ != name_of(base.environment))
    configuration.environment = environment_named(*environment_);
  set_parameters(configuration.environment);
  validate(configuration);
  require_possible_threads(configuration.device);
  return configuration;
}

std::string SimulationOptions::home_of(const std::string& environment, Physics physics) {
  if (!is_environment(environment)) return {};
  return has_water(environment_named(environment)) && physics == Physics::real
             ? std::string(name_of(default_configuration(physics).environment))
             : environment;
}

void SimulationOptions::check(Physics physics) const {
  if (environment_) return (void)configuration(physics);
  validate(given_);
  dt();
  require_possible_threads(given_.device);
}

Configuration SimulationOptions::configuration(Physics physics) const {
  return configuration_in(environment_.value_or(""), physics);
}

Configuration SimulationOptions::configuration(std::span<const Robot> robots, std::vector<std::string>& notes) const {
  std::vector<std::string> environments;
  for (const Robot& robot : robots) environments.push_back(environment_of(robot));
  return configuration(environments, notes, physics_of(robots));
}

Configuration SimulationOptions::configuration(std::span<const std::string> environments,
                                               std::vector<std::string>& notes, Physics physics) const {
  if (environment_) return configuration(physics);
  std::set<std::string> wanted;
  for (const std::string& environment : environments) wanted.insert(home_of(environment, physics));
  wanted.erase("");
  if (wanted.size() == 1) return configuration_in(*wanted.begin(), physics);
  if (wanted.size() > 1)
    notes.push_back(fmt::format("the robots are made for {}; all are put into {}, --environment chooses",
                                fmt::join(wanted, " and "), name_of(default_configuration(physics).environment)));
  return configuration(physics);
}

std::vector<EnvironmentGroup> SimulationOptions::groups(std::span<const std::string> environments,
                                                        Physics physics) const {
  std::map<std::string, std::vector<std::size_t>> members;  // by the name of their environment
  for (std::size_t i = 0; i < environments.size(); ++i)
    members[environment_ ? *environment_ : home_of(environments[i], physics)].push_back(i);
  if (const auto homeless = members.find(""); homeless != members.end() && members.size() > 1) {
    const std::string home(members.size() == 2 ? std::prev(members.end())->first
                                               : name_of(default_configuration(physics).environment));
    auto& others = members[home];
    others.insert(others.end(), homeless->second.begin(), homeless->second.end());
    std::ranges::sort(others);
    members.erase(homeless);
  }
  std::vector<EnvironmentGroup> groups;
  for (auto& [environment, robots] : members)
    groups.push_back({configuration_in(environment, physics), std::move(robots)});
  return groups;
}

double SimulationOptions::seconds(double otherwise) const {
  const double seconds = seconds_.value_or(otherwise);
  if (!(std::isfinite(seconds) && seconds >= 0))
    throw InputError("--seconds", fmt::format("{} is not accepted; give a finite number >= 0 s", seconds));
  if (seconds / dt() > 1e15)
    throw InputError("--seconds", fmt::format("{} s are too many steps of {} s", seconds, dt()));
  return seconds;
}

double SimulationOptions::dt() const {
  if (substeps_ < 1) throw InputError("--substeps", fmt::format("{} is not accepted; give 1 or more", substeps_));
  return given_.dt / substeps_;
}

std::int64_t SimulationOptions::steps() const { return std::llround(seconds() / dt()); }

}  // namespace mercury
