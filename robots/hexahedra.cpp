// SPDX-License-Identifier: Apache-2.0
#include "robots/hexahedra.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "mercury/random.h"
#include "mercury/voxels.h"

namespace mercury {
namespace {

using Vector = std::array<double, 3>;

double length_of(const Vector& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

double determinant(const std::array<Vector, 3>& rows) {
  const auto& [a, b, c] = rows;
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// Its mean edges along its three directions.
std::array<Vector, 3> edges_of(const Robot& robot, const Hexahedron& cell) {
  std::array<Vector, 3> edges{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const double sign = corner >> axis & 1 ? 0.25 : -0.25;
      const Vec3& at = robot.masses[cell[corner]];
      edges[axis][0] += sign * static_cast<double>(at.x);
      edges[axis][1] += sign * static_cast<double>(at.y);
      edges[axis][2] += sign * static_cast<double>(at.z);
    }
  return edges;
}

}  // namespace

std::array<double, 8> spring_shares(const Vector& sizes) {
  constexpr std::array<double, 8> cube{0, 0.15, 0.15, 0.2, 0.15, 0.2, 0.2, 0.45};
  // Seven shares and six moduli C_ijkl = sum of 4 share n_i n_j n_k n_l [E]: xxxx, yyyy, zzzz, xxyy, yyzz, zzxx. A weak
  // pull toward the cube's shares chooses among those that do.
  constexpr std::array<double, 6> wanted{1.2, 1.2, 1.2, 0.4, 0.4, 0.4};
  constexpr double pull = 0.05;
  std::array<std::array<double, 6>, 8> moduli{};
  for (std::size_t axes = 1; axes < 8; ++axes) {
    Vector n{};
    double squared = 0;
    for (std::size_t i = 0; i < 3; ++i)
      if (axes >> i & 1) squared += n[i] = sizes[i] * sizes[i];
    for (double& part : n) part /= squared;
    moduli[axes] = {4 * n[0] * n[0], 4 * n[1] * n[1], 4 * n[2] * n[2],
                    4 * n[0] * n[1], 4 * n[1] * n[2], 4 * n[2] * n[0]};
  }
  std::array<std::array<double, 8>, 8> normal{};
  std::array<double, 8> right{};
  for (std::size_t i = 1; i < 8; ++i) {
    for (std::size_t j = 1; j < 8; ++j)
      for (std::size_t m = 0; m < 6; ++m) normal[i][j] += moduli[i][m] * moduli[j][m];
    for (std::size_t m = 0; m < 6; ++m) right[i] += moduli[i][m] * wanted[m];
    normal[i][i] += pull * pull / (cube[i] * cube[i]);
    right[i] += pull * pull / cube[i];
  }
  // Gauss and Seidel's sweeps, each share kept above its least.
  std::array<double, 8> shares = cube;
  for (int sweep = 0; sweep < 2000; ++sweep) {
    double change = 0;
    for (std::size_t i = 1; i < 8; ++i) {
      double rest = right[i];
      for (std::size_t j = 1; j < 8; ++j)
        if (j != i) rest -= normal[i][j] * shares[j];
      const double next = std::max(0.15 * cube[i], rest / normal[i][i]);
      change = std::max(change, std::abs(next - shares[i]));
      shares[i] = next;
    }
    if (change < 1e-9) break;
  }
  return shares;
}

HexahedraSums sum_hexahedra(const Robot& robot, std::span<const Hexahedron> cells, std::span<const double> modulus,
                            std::span<const double> density) {
  HexahedraSums sums{std::vector<double>(robot.masses.size()), std::vector<double>(robot.springs.size())};
  std::unordered_map<std::uint32_t, std::size_t> spring_of;
  for (std::size_t s = 0; s < robot.springs.size(); ++s)
    spring_of.emplace(pair_of(robot.springs[s].a, robot.springs[s].b), s);
  std::map<std::array<int, 3>, std::array<double, 8>> known;  // cells of nearly one form have the same shares
  for (const Hexahedron& cell : cells) {
    const std::array<Vector, 3> edges = edges_of(robot, cell);
    const double volume = std::abs(determinant(edges));
    std::array<int, 3> form{};
    const double longest = std::max({length_of(edges[0]), length_of(edges[1]), length_of(edges[2])});
    constexpr double step = 0.04;
    for (std::size_t i = 0; i < 3; ++i)
      form[i] = static_cast<int>(std::lround(portable_log(length_of(edges[i]) / longest) / step));
    auto found = known.find(form);
    if (found == known.end()) {
      Vector sizes{};
      for (std::size_t i = 0; i < 3; ++i) sizes[i] = length_of(edges[i]) / longest;
      found = known.emplace(form, spring_shares(sizes)).first;
    }
    double mass = 0;
    for_each_pair_of_corners([&](std::size_t i, std::size_t j) {
      const auto spring = spring_of.find(pair_of(cell[i], cell[j]));
      if (spring == spring_of.end()) return;
      const auto& [a, b, material, rest_length] = robot.springs[spring->second];
      const double length = static_cast<double>(rest_length);
      sums.stiffness[spring->second] += found->second[i ^ j] * modulus[material] * volume / (length * length);
      mass += density[material] * volume / 28;
    });
    for (const std::uint16_t corner : cell) sums.mass[corner] += mass / 8;
  }
  return sums;
}

}  // namespace mercury
