// SPDX-License-Identifier: Apache-2.0
#include "bodies.h"

#include <cmath>
#include <random>
#include <set>
#include <utility>

namespace mercury::bodies {
namespace {

using Random = std::mt19937_64;

// In [0, 1), the same on every standard library.
float uniform(Random& random) { return static_cast<float>(random() >> 40) * 0x1p-24f; }

Vec3 uniform_in_cube(Random& random, float half_edge) {
  const float x = uniform(random), y = uniform(random), z = uniform(random);
  return half_edge * Vec3{2 * x - 1, 2 * y - 1, 2 * z - 1};
}

// Two triangles on the voxel's side that looks along +axis or -axis.
void add_side(Robot& robot, const std::array<std::uint16_t, 8>& corner, int axis, int side) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const auto at = [&](int along_u, int along_v) {
    return corner[static_cast<std::size_t>(side << axis | along_u << u | along_v << v)];
  };
  const std::uint16_t p = at(0, 0), q = at(1, 0), r = at(1, 1), s = at(0, 1);  // counter-clockwise about +axis
  if (side == 1) {
    robot.faces.push_back({p, q, r});
    robot.faces.push_back({p, r, s});
  } else {
    robot.faces.push_back({p, r, q});
    robot.faces.push_back({p, s, r});
  }
}

}  // namespace

std::vector<Material> one_material(const Material& material) { return {Material{}, material}; }

Robot point(Vec3 position) {
  Robot robot;
  robot.name = "point";
  robot.masses = {position};
  return robot;
}

Robot pair(const Material& material, float rest_length) {
  Robot robot;
  robot.name = "pair";
  robot.materials = one_material(material);
  robot.masses = {{0, 0, 0}, {rest_length, 0, 0}};
  robot.springs = {{0, 1, 1, rest_length}};
  return robot;
}

Robot voxels(const Grid& grid, const Material& material) {
  Robot robot;
  robot.name = "voxels";
  robot.materials = one_material(material);
  const auto mass_at = [&](int x, int y, int z) {
    return static_cast<std::uint16_t>((z * (grid.y + 1) + y) * (grid.x + 1) + x);
  };
  for (int z = 0; z <= grid.z; ++z)
    for (int y = 0; y <= grid.y; ++y)
      for (int x = 0; x <= grid.x; ++x)
        robot.masses.push_back(grid.corner +
                               grid.edge * Vec3{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});

  std::set<std::pair<std::uint16_t, std::uint16_t>> joined;
  const std::array<int, 3> last = {grid.x - 1, grid.y - 1, grid.z - 1};
  for (int z = 0; z < grid.z; ++z)
    for (int y = 0; y < grid.y; ++y)
      for (int x = 0; x < grid.x; ++x) {
        std::array<std::uint16_t, 8> corner{};
        for (int c = 0; c < 8; ++c)
          corner[static_cast<std::size_t>(c)] = mass_at(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
        for (std::size_t i = 0; i < 8; ++i)
          for (std::size_t j = i + 1; j < 8; ++j) joined.insert({corner[i], corner[j]});
        const std::array<int, 3> here = {x, y, z};
        for (int axis = 0; axis < 3; ++axis) {
          const auto a = static_cast<std::size_t>(axis);
          if (here[a] == 0) add_side(robot, corner, axis, 0);
          if (here[a] == last[a]) add_side(robot, corner, axis, 1);
        }
      }
  for (const auto& [a, b] : joined) robot.springs.push_back({a, b, 1, rest_distance(robot, a, b)});
  return robot;
}

Robot random_voxels(const Grid& grid, std::uint64_t seed) {
  Robot robot = voxels(grid, {});
  robot.name = "random voxels";
  robot.materials.clear();
  Random random(seed);
  for (Spring& spring : robot.springs)
    spring.material = static_cast<MaterialId>(1 + random() % (default_material_count - 1));
  return robot;
}

Robot with_half_waves(Robot robot) {
  const std::vector<Material> table(materials_of(robot).begin(), materials_of(robot).end());
  robot.materials = table;
  for (std::size_t id = 1; id < robot.materials.size(); id += 2) robot.materials[id].half_wave = true;
  return robot;
}

void rotate(Robot& robot, const std::array<Vec3, 3>& rows) {
  for (Vec3& x : robot.masses) x = {dot(rows[0], x), dot(rows[1], x), dot(rows[2], x)};
}

std::array<Vec3, 3> random_rotation(std::uint64_t seed) {
  Random random(seed);
  std::normal_distribution<double> normal;
  double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  const double norm = std::sqrt(w * w + x * x + y * y + z * z);
  w /= norm, x /= norm, y /= norm, z /= norm;
  const auto row = [](double a, double b, double c) {
    return Vec3{static_cast<float>(a), static_cast<float>(b), static_cast<float>(c)};
  };
  return {row(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
          row(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
          row(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))};
}

State moving(const Robot& robot, Vec3 velocity) {
  return {robot.masses, std::vector<Vec3>(robot.masses.size(), velocity)};
}

State shaken(const Robot& robot, float amount, float speed, std::uint64_t seed) {
  State state = moving(robot, {});
  Random random(seed);
  for (Vec3& x : state.positions) x += uniform_in_cube(random, amount);
  for (Vec3& v : state.velocities) v += uniform_in_cube(random, speed);
  return state;
}

}  // namespace mercury::bodies
