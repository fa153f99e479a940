// SPDX-License-Identifier: Apache-2.0
#include "app/options/trial_options.h"

#include <fmt/format.h>

#include "app/options/option_values.h"

namespace mercury {

void add_trial_options(const Command& command, TrialSettings& trials) {
  add_number(command, "--settle", trials.settle, "Measure from this time on, after robots have fallen (default 0)", "S")
      .in_group(trial_options_group);
  add_number(command, "--strain-limit", trials.strain_limit,
             fmt::format("Robots with a spring strained more are overstretched: they rank behind all sound ones "
                         "(default {}; inf = no limit)",
                         trials.strain_limit),
             "X")
      .in_group(trial_options_group);
}

}  // namespace mercury
