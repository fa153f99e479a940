// SPDX-License-Identifier: Apache-2.0
#include "bench/cpu_lattice.h"

#include <array>
#include <numeric>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace mercury::bench {
namespace {

using Engine = std::mt19937_64;

class Voxels {
 public:
  Voxels(int n, double holes, std::uint64_t seed) : n_(n), solid_(static_cast<std::size_t>(n * n * n)) {
    Engine random(seed);
    for (std::size_t i = 0; i < solid_.size(); ++i) solid_[i] = static_cast<double>(random() >> 11) * 0x1p-53 >= holes;
  }

  Robot robot() const {
    Robot robot;
    robot.name = "lattice";
    const std::vector<int> numbers = number_masses(robot);
    add_springs(robot, numbers);
    add_faces(robot, numbers);
    return robot;
  }

 private:
  bool solid(int x, int y, int z) const {
    if (x < 0 || y < 0 || z < 0 || x >= n_ || y >= n_ || z >= n_) return false;
    return solid_[static_cast<std::size_t>(x + n_ * (y + n_ * z))];
  }
  std::size_t corner(int x, int y, int z) const { return static_cast<std::size_t>(x + (n_ + 1) * (y + (n_ + 1) * z)); }
  template <class Visit>
  void for_each_solid(const Visit& visit) const {
    for (int z = 0; z < n_; ++z)
      for (int y = 0; y < n_; ++y)
        for (int x = 0; x < n_; ++x)
          if (solid(x, y, z)) visit(x, y, z);
  }

  std::vector<int> number_masses(Robot& robot) const {
    std::vector<int> numbers(corner(n_, n_, n_) + 1, -1);
    for_each_solid([&](int x, int y, int z) {
      for (int c = 0; c < 8; ++c) numbers[corner(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2))] = 0;
    });
    int next = 0;
    for (int z = 0; z <= n_; ++z)
      for (int y = 0; y <= n_; ++y)
        for (int x = 0; x <= n_; ++x)
          if (int& number = numbers[corner(x, y, z)]; number == 0) {
            number = next++;
            robot.masses.push_back(0.1f * Vec3{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
          }
    return numbers;
  }

  void add_springs(Robot& robot, const std::vector<int>& numbers) const {
    std::set<std::pair<int, int>> joined;
    for_each_solid([&](int x, int y, int z) {
      std::array<int, 8> masses{};
      for (int c = 0; c < 8; ++c)
        masses[static_cast<std::size_t>(c)] = numbers[corner(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2))];
      for (const int a : masses)
        for (const int b : masses)
          if (a < b) joined.emplace(a, b);
    });
    Engine random(2);
    for (const auto& [a, b] : joined) {
      const auto i = static_cast<std::uint16_t>(a), j = static_cast<std::uint16_t>(b);
      const auto material = static_cast<MaterialId>(1 + random() % (default_material_count - 1));
      robot.springs.push_back({i, j, material, rest_distance(robot, i, j)});
    }
  }

  void add_faces(Robot& robot, const std::vector<int>& numbers) const {
    for_each_solid([&](int x, int y, int z) {
      const std::array<int, 3> at{x, y, z};
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (int side = 0; side <= 1; ++side) {
          std::array<int, 3> beyond = at;
          beyond[axis] += 2 * side - 1;
          if (solid(beyond[0], beyond[1], beyond[2])) continue;
          const auto mass = [&](int u, int v) {
            std::array<int, 3> c = at;
            c[axis] += side;
            c[(axis + 1) % 3] += side == 1 ? u : v;
            c[(axis + 2) % 3] += side == 1 ? v : u;
            return static_cast<std::uint16_t>(numbers[corner(c[0], c[1], c[2])]);
          };
          robot.faces.push_back({mass(0, 0), mass(1, 0), mass(1, 1)});
          robot.faces.push_back({mass(0, 0), mass(1, 1), mass(0, 1)});
        }
    });
  }

  int n_;
  std::vector<bool> solid_;
};

}  // namespace

Robot lattice(int n) { return Voxels(n, 0, 1).robot(); }
Robot lattice_with_holes(int n, double share, std::uint64_t seed) { return Voxels(n, share, seed).robot(); }

Robot scrambled(const Robot& robot, std::uint64_t seed) {
  std::vector<std::uint16_t> number(robot.masses.size());
  std::iota(number.begin(), number.end(), std::uint16_t{0});
  Engine random(seed);
  for (std::size_t i = number.size(); i > 1; --i) std::swap(number[i - 1], number[random() % i]);
  Robot result = robot;
  for (std::size_t i = 0; i < number.size(); ++i) result.masses[number[i]] = robot.masses[i];
  for (Spring& spring : result.springs) {
    spring.a = number[spring.a];
    spring.b = number[spring.b];
  }
  for (Face& face : result.faces) face = {number[face.a], number[face.b], number[face.c]};
  return result;
}

}  // namespace mercury::bench
