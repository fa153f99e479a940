// SPDX-License-Identifier: Apache-2.0
// The parts of a robot from NumPy arrays, or from what NumPy makes an array of. Errors name the array or its row:
// "masses: must have the shape (n, 3), not (3, 8)", "/springs/7: mass 70000 is out of range, the robot has 300". What
// is not a number throws TypeError, all else InputError.
#pragma once

#include <nanobind/nanobind.h>

#include <cstdint>
#include <vector>

#include "mercury/robot.h"
#include "mercury/voxel.h"

namespace mercury::python {

std::vector<Vec3> masses_from(nanobind::handle array);  // (n, 3)
// (m, 3) or (m, 4): a, b, material, rest length; or fields of these names. A rest length that is not given is the
// distance of the masses. Needs the robot's masses and materials.
std::vector<Spring> springs_from(nanobind::handle array, const Robot& robot);
std::vector<Face> faces_from(nanobind::handle array, const Robot& robot);  // (k, 3)
// (l, 4) to (l, 6): stiffness, amplitude, frequency, phase, half_wave (0 or 1), relaxation_time; or fields of these
// names.
std::vector<Material> materials_from(nanobind::handle array);

std::vector<float> mass_from(nanobind::handle given, const Robot& robot);     // (n,), or one number for all
std::vector<Vec3> velocity_from(nanobind::handle given, const Robot& robot);  // (n, 3), or (3,) for all
// (k,): indices of masses, or a mask with one bool per mass.
std::vector<std::uint16_t> fixed_from(nanobind::handle given, const Robot& robot);

VoxelGrid grid_from(nanobind::handle array);  // (x, y, z): materials 0 to 22

// Adds actuators of a mapping {name: springs}. Springs are indices, or a mask with one bool per spring.
void add_actuators(Robot& robot, nanobind::handle actuators);

// Read-only arrays that share memory with the robot of `owner` and keep it.
nanobind::object masses_view(nanobind::handle owner, const Robot& robot);           // (n, 3) float32
nanobind::object springs_view(nanobind::handle owner, const Robot& robot);          // (m,) a, b, material, rest_length
nanobind::object faces_view(nanobind::handle owner, const Robot& robot);            // (k, 3) uint16
nanobind::object materials_view(nanobind::handle owner, const Robot& robot);        // (l, 4) float32
nanobind::object half_wave_view(nanobind::handle owner, const Robot& robot);        // (l,) bool
nanobind::object relaxation_time_view(nanobind::handle owner, const Robot& robot);  // (l,) float32
// Of a robot that says nothing of them, new arrays of its defaults.
nanobind::object mass_view(nanobind::handle owner, const Robot& robot);      // (n,) float32
nanobind::object velocity_view(nanobind::handle owner, const Robot& robot);  // (n, 3) float32
nanobind::object fixed_view(nanobind::handle owner, const Robot& robot);     // (k,) uint16

}  // namespace mercury::python
