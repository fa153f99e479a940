// SPDX-License-Identifier: Apache-2.0
// Robots made by the tests themselves, so that they depend on no builder.
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

// Voxels of `grid`: 8 masses each, shared; all 28 pairs of a voxel's masses joined once; two triangles a side of the
// outer skin, counter-clockwise seen from outside. All springs are of material 1 of a one-material table.
Robot voxels(const Grid& grid, const Material& material);
// The same with the default table and a material from 1..253 for each spring, drawn with `seed`.
Robot random_voxels(const Grid& grid, std::uint64_t seed);

// Turns the rest pose by the rotation whose rows are given.
void rotate(Robot& robot, const std::array<Vec3, 3>& rows);
// A rotation drawn uniformly (unit quaternion) with `seed`.
std::array<Vec3, 3> random_rotation(std::uint64_t seed);

// The robot at rest, all of it moving with one velocity.
State moving(const Robot& robot, Vec3 velocity);
// Shaken: every coordinate moved by at most `amount` [m], every velocity at most `speed` [m/s], drawn with `seed`.
State shaken(const Robot& robot, float amount, float speed, std::uint64_t seed);

}  // namespace mercury::bodies
