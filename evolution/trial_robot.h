// SPDX-License-Identifier: Apache-2.0
// The robot of one of several trials: the same body, started at another moment, of slightly other materials, or with
// voxels missing.
#pragma once

#include <cstdint>

#include "mercury/robot.h"
#include "mercury/trials.h"

namespace mercury {

// Whether all trials show the robot as it is, except for where its masses begin.
inline bool trials_are_alike(const TrialSettings& settings) {
  return (settings.trials == 1 || settings.delay == 0) && settings.noise == 0 && settings.damage == 0;
}

// Trial 0 starts at time 0, the others at a random moment of the muscles' movement up to settings.delay. Depends on the
// arguments alone; all robots of a run get the same conditions. Throws InputError if voxels should be missing and the
// robot has none.
Robot trial_robot(const Robot& robot, const TrialSettings& settings, std::uint64_t seed, int trial);

}  // namespace mercury
