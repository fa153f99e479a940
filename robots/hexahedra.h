// SPDX-License-Identifier: Apache-2.0
// Real bodies of hexahedra, which need not be cubes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mercury/robot.h"

namespace mercury {

// Eight corners, joined by all 28 springs: x fastest, then y, then z, in directions of its own.
using Hexahedron = std::array<std::uint16_t, 8>;

// For springs of length L in a box of these sizes, volume V and modulus E: k L^2 / (E V), by the axes along which a
// spring extends (bit 0 for x, and so on). For a cube it is 0.15 for an edge, 0.2 for a diagonal across a side, 0.45
// through the middle, as for voxels (real_body.h). For a box they are those that make it isotropic, as nearly as
// springs can that only pull and push: least squares, no share below 0.15 of the cube's. Bit for bit the same on every
// machine.
std::array<double, 8> spring_shares(const std::array<double, 3>& sizes);

// What cells add up to, with the modulus and the density of the material of each spring by its id.
struct HexahedraSums {
  std::vector<double> mass;       // per point [kg]
  std::vector<double> stiffness;  // per spring of the robot [N/m]
};
HexahedraSums sum_hexahedra(const Robot& robot, std::span<const Hexahedron> cells, std::span<const double> modulus,
                            std::span<const double> density);

}  // namespace mercury
