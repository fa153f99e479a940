// The options of every command that simulates: device, environment, solver and their parameters.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <optional>
#include <string>

#include "sim/configuration.h"

namespace mercury {

class SimulationOptions {
 public:
  // Adds the options to a command. The object must outlive it.
  void add_to(CLI::App& command);

  // What was chosen. Throws InputError naming the option that cannot be used or does not apply to the environment.
  Configuration configuration() const;

  // Time to simulate [s]. Throws InputError unless it is finite and >= 0 and has at most 1e15 steps of dt.
  double seconds() const;
  std::int64_t steps() const;  // nearest to seconds() / dt

 private:
  void set_environment(Configuration& configuration) const;

  std::string device_ = "auto", environment_ = "ocean", solver_ = "force";
  int threads_ = 0;
  double dt_ = Configuration{}.dt, damping_ = Configuration{}.damping, seconds_ = 10;
  std::optional<float> density_, drag_coefficient_, lift_coefficient_, point_drag_, friction_, contact_stiffness_,
      stiffness_scale_;
  std::optional<Vec3> flow_, gravity_;
  bool no_self_collision_ = false;
};

}  // namespace mercury
