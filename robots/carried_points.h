// SPDX-License-Identifier: Apache-2.0
// What a robot says of its masses, and its brain, handed on to a body that is made from it.
#pragma once

#include <array>

#include "mercury/robot.h"

namespace mercury {

// Where a mass is at rest. Masses nearer to each other than a step of it are one: no spring is that short.
using MassPlace = std::array<long long, 3>;
MassPlace mass_place_of(Vec3 rest);

// Gives `to` the masses, velocities and fixed points of `from`, by place: a point where `from` has one gets what that
// one has. Other points have the mean mass, and are at rest. A list that `to` has already stays.
void carry_points(const Robot& from, Robot& to);

// Gives `to` the sensors and the brain of `from`, if they fit it: a brain that drives its actuators, and sensors that
// name springs or masses by index only where the topology is the same.
void carry_brain(const Robot& from, Robot& to);

// Gives `to`, which grew from `from` or its like, the actuators of `from`, and sensors and brain as carry_brain().
// Actuators name materials by id, so they stay if these ids have not changed their meaning: the table has as many
// materials as before, with the same names. Their values may differ.
void carry_control(const Robot& from, Robot& to);

}  // namespace mercury
