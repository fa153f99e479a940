// SPDX-License-Identifier: Apache-2.0
// The options of every command that simulates: device, solver, environment and their parameters. All options of
// parameters are derived from the tables in mercury/configuration.h.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/options/command.h"
#include "mercury/configuration.h"
#include "mercury/robot.h"

namespace mercury {

// What the bodies of these robots are. Throws InputError if some are real and others are not.
Physics physics_of(std::span<const Robot> robots);
Physics physics_of(std::span<const Robot* const> robots);
Physics physics_of(std::span<const std::shared_ptr<const Robot>> robots);

// Robots that live in one environment.
struct EnvironmentGroup {
  Configuration configuration;
  std::vector<std::size_t> members;  // their indices, rising
};

class SimulationOptions {
 public:
  // Adds the options to a command. The object must outlive it.
  void add_to(const Command& command);

  // The configuration that the options describe. Throws InputError for an option that cannot be used or does not apply
  // to the environment.
  Configuration configuration(Physics physics = Physics::paper) const;
  // Throws as configuration() for what can be checked before robots are read: without --environment, they choose which
  // parameters an environment has.
  void check(Physics physics) const;
  // The same, but without --environment the robots choose: the environment that they are made for, if they agree.
  // Appends to `notes` what the user should know about that.
  Configuration configuration(std::span<const Robot> robots, std::vector<std::string>& notes) const;
  // The same with the environments that the robots are made for; a name that is none, or empty, has no effect. What the
  // options leave out is as the physics of the robots has it.
  Configuration configuration(std::span<const std::string> environments, std::vector<std::string>& notes,
                              Physics physics = Physics::paper) const;

  // Each robot in the environment that it is made for, given its name per robot; a robot without one is put where those
  // with one agree, else into the default environment. With --environment, or if all agree, there is one group. Throws
  // InputError as above, also for a parameter that one of the environments does not have.
  std::vector<EnvironmentGroup> groups(std::span<const std::string> environments,
                                       Physics physics = Physics::paper) const;

  // Of robots that were loaded (robot_options.h): over the configuration of their run, if they are all of one.
  template <class Robots>
  Configuration configuration_of(const Robots& robots, std::vector<std::string>& notes) const {
    return robots.run ? configuration_over(robots.run->evolution.configuration)
                      : configuration(robots.environments, notes, robots.physics);
  }

  // The same over the configuration of a run: what the command line does not say is as there, except for the device.
  Configuration configuration_over(const Configuration& base) const;

  // The value of --environment; empty = not given.
  std::string chosen_environment() const { return environment_.value_or(""); }

  // Time to simulate [s]. Throws InputError unless it is finite and >= 0 and has at most 1e15 steps of dt.
  double seconds(double otherwise = 10) const;
  std::int64_t steps() const;  // nearest to seconds() / dt

 private:
  // The option of an environment's parameter.
  struct ParameterOption {
    std::string option;                                    // "--density"
    std::optional<std::variant<float, bool, Vec3>> value;  // if given
  };

  double dt() const;  // divided by --substeps [s]
  void add_environment_parameters(const Command& command);
  // The environment for robots that are made for this one; empty if the name is none. Robots with real bodies that were
  // made for the paper's water are put into the water of their physics.
  static std::string home_of(const std::string& environment, Physics physics);
  Configuration configuration_in(std::string_view environment, Physics physics) const;
  // Writes the options of its parameters into an environment. Throws InputError for options that do not apply to it.
  void set_parameters(Environment& environment) const;

  std::optional<Command> command_;
  Configuration given_;  // all but the environment
  std::optional<std::string> environment_;
  std::map<std::string, ParameterOption> parameter_options_;  // by the parameter's name
  std::optional<double> seconds_;
  int substeps_ = 1;
};

}  // namespace mercury
