// SPDX-License-Identifier: Apache-2.0
// The options of every command that measures robots: what counts, and from when on. They mean the same everywhere.
#pragma once

#include "app/options/command.h"
#include "mercury/assessor.h"

namespace mercury {

// Adds --settle and --strain-limit, which write into `trials`. It must outlive the command; validate() checks it.
void add_trial_options(const Command& command, TrialSettings& trials);

inline constexpr const char* trial_options_group = "Trials";  // in the help

}  // namespace mercury
