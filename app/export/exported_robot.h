// SPDX-License-Identifier: Apache-2.0
// What every format is written from: a robot, and where its masses are.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/robot.h"
#include "render/colormap.h"

namespace mercury {

// A robot and where it is simulated. Refers to the robot.
struct ExportedRobot {
  const Robot& robot;
  std::span<const Material> materials;  // by id, as they are simulated
  Environment environment;              // its stiffness scale is part of the springs' forces
};
// A robot as its file has it, in the environment that it is made for, or else in water.
ExportedRobot exported_robot(const Robot& robot);

// The masses at one moment. Refers to the lists.
struct Pose {
  double time = 0;                   // [s]
  std::span<const Vec3> positions;   // per mass [m]
  std::span<const Vec3> velocities;  // per mass [m/s]; empty = unknown
};
// At rest, at time 0, without velocities.
Pose rest_pose(const Robot& robot);

bool is_finite(std::span<const Vec3> positions);

// A material of the robot that something has which is exported.
struct ExportedMaterial {
  MaterialId id = 0;
  std::string name;     // of the robot's table, else of the default material, else "material 7"
  render::Color color;  // as pictures draw it, at rest
};
// Those of the springs, by id; and air, without a name of its own, where a face has no spring.
std::vector<ExportedMaterial> exported_materials(const Robot& robot);
// The colors of all ids of the robot's table.
std::vector<render::Color> colors_of(const Robot& robot);

// Per spring, at one moment.
struct SpringValues {
  std::vector<float> strain;  // (|d| - L0) / L0 [1]
  std::vector<float> force;   // k (|d| - L(t)), positive = it pulls its ends together [N]
};
SpringValues spring_values(const ExportedRobot& robot, const Pose& pose);

// The springs along the edges of each face; no_spring where an edge has none. In a voxel robot every edge has one.
std::vector<std::array<std::uint32_t, 3>> springs_of_faces(const Robot& robot);

// A name as formats with bare words take it: letters, digits and "_", not beginning with a digit.
std::string identifier_of(const std::string& name);

}  // namespace mercury
