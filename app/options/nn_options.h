// SPDX-License-Identifier: Apache-2.0
// The options that shape random network robots.
#pragma once

#include <CLI/CLI.hpp>

#include "mercury/nn_robot.h"

namespace mercury {

class NnRobotOptions {
 public:
  // Adds the options to a command. The object must outlive it.
  void add_to(CLI::App& command);

  // What was chosen. Throws InputError naming the option that cannot be used.
  NnOptions chosen() const;

 private:
  NnOptions options_;
};

}  // namespace mercury
