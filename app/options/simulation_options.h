// SPDX-License-Identifier: Apache-2.0
// The options of every command that simulates: device, environment, solver and their parameters.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/robot.h"

namespace mercury {

class SimulationOptions {
 public:
  // Adds the options to a command. The object must outlive it.
  void add_to(CLI::App& command);

  // What was chosen. Throws InputError naming the option that cannot be used or does not apply to the environment.
  Configuration configuration() const;
  // The same; without --environment, the one that the robots are made for, if they agree. What the user should know
  // about that is added to `notes`.
  Configuration configuration(std::span<const Robot> robots, std::vector<std::string>& notes) const;

  // What --environment was given; empty = it was not.
  std::string chosen_environment() const { return environment_.value_or(""); }

  // Time to simulate [s]. Throws InputError unless it is finite and >= 0 and has at most 1e15 steps of dt.
  double seconds(double otherwise = 10) const;
  std::int64_t steps() const;  // nearest to seconds() / dt

 private:
  Configuration configuration_in(std::string_view environment) const;
  void set_parameters(Environment& environment) const;

  std::string device_ = "auto", solver_ = "force";
  std::optional<std::string> environment_;
  int threads_ = 0;
  double dt_ = Configuration{}.dt, damping_ = Configuration{}.damping;
  std::optional<double> seconds_;
  std::optional<float> density_, drag_coefficient_, lift_coefficient_, point_drag_, friction_, contact_stiffness_,
      stiffness_scale_;
  std::optional<Vec3> flow_, gravity_;
  bool no_self_collision_ = false;
};

}  // namespace mercury
