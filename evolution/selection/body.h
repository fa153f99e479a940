// SPDX-License-Identifier: Apache-2.0
// Measures of a body at rest.
#pragma once

#include "mercury/robot.h"

namespace mercury {

// Sides of the axis-parallel box around the masses [m]; 0 without masses.
Vec3 box_of(const Robot& robot);

// Volume that the skin encloses [m3], by the divergence theorem; 0 without faces.
double volume_of(const Robot& robot);

// How well the body equals its mirror image in y, 0..1. The mirror is the middle of the body's box. Each mass counts
// 1 - d/r, at least 0, where d is the distance from its mirror image to the nearest mass and r is half the mean rest
// length of the springs: 1 for a symmetric body, and for a lattice the share of its masses that have a partner.
double mirror_symmetry(const Robot& robot);

}  // namespace mercury
