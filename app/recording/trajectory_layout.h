// SPDX-License-Identifier: Apache-2.0
// What the writer and the reader of trajectories agree on: names in the file, and the parameters of a configuration.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "mercury/configuration.h"

namespace mercury {

inline constexpr int trajectory_format = 1;  // attribute "format" of /parameters
inline constexpr std::array<int, 2> h5md_version{1, 1};

// Whether a name's extension is that of a trajectory: .h5, .hdf5 or .h5md.
bool is_trajectory_name(const std::filesystem::path& path);

// A group's name for each robot: its own name where HDF5 allows that, all different. Slashes and control characters
// become "_", "" and "." become "robot", a name that another has gets "-2", "-3", ..., and long ones are cut.
std::vector<std::string> group_names(std::span<const std::string> robot_names);

// Calls visit(name, member) for every parameter of an environment: a float, bool or Vec3. Names as in the program's
// options.
template <class Visit>
void visit_parameters(Ocean& ocean, const Visit& visit) {
  visit("density", ocean.density);
  visit("drag_coefficient", ocean.drag_coefficient);
  visit("lift_coefficient", ocean.lift_coefficient);
  visit("flow", ocean.flow);
  visit("gravity", ocean.gravity);
  visit("stiffness_scale", ocean.stiffness_scale);
}
template <class Visit>
void visit_parameters(OceanSimple& ocean, const Visit& visit) {
  visit("point_drag", ocean.point_drag);
  visit("flow", ocean.flow);
  visit("gravity", ocean.gravity);
  visit("stiffness_scale", ocean.stiffness_scale);
}
template <class Visit>
void visit_parameters(Land& land, const Visit& visit) {
  visit("gravity", land.gravity);
  visit("friction", land.friction);
  visit("self_collision", land.self_collision);
  visit("contact_stiffness", land.contact_stiffness);
  visit("stiffness_scale", land.stiffness_scale);
}

}  // namespace mercury
