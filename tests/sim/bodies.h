// SPDX-License-Identifier: Apache-2.0
// Robots that the tests build themselves, so that they depend on no generator.
#pragma once

#include <array>
#include <cstdint>

#include "mercury/robot.h"
#include "mercury/simulation.h"

namespace mercury::bodies {

// A table of one passive material, id 1, besides air.
std::vector<Material> one_material(const Material& material);

// One mass, no spring.
Robot point(Vec3 position = {});

// Two masses on the x axis, `rest_length` apart, joined by one spring of material 1.
Robot pair(const Material& material, float rest_length = 1);

struct Grid {
  int x = 5, y = 5, z = 5;  // voxels
  float edge = 0.1f;        // [m]
  Vec3 corner;              // [m]
};

// A box of voxels. Each has 8 masses, shared with its neighbors; springs join all 28 pairs of them, each pair once.
// Each outer side of a voxel has two triangles, counter-clockwise seen from outside. All springs have material 1 of a
// table with one material.
Robot voxels(const Grid& grid, const Material& material);
// The same with the default table and a random material from 1..253 per spring.
Robot random_voxels(const Grid& grid, std::uint64_t seed);
// The robot with a table of its own, in which every second material moves by half waves.
Robot with_half_waves(Robot robot);

// Rotates the rest pose. `rows` are the rows of the rotation matrix.
void rotate(Robot& robot, const std::array<Vec3, 3>& rows);
// A uniformly random rotation (from a unit quaternion).
std::array<Vec3, 3> random_rotation(std::uint64_t seed);

// The rest pose, all masses with the same velocity.
State moving(const Robot& robot, Vec3 velocity);
// The rest pose with every coordinate moved by at most `amount` [m] and random velocities of at most `speed` [m/s].
State shaken(const Robot& robot, float amount, float speed, std::uint64_t seed);

}  // namespace mercury::bodies
