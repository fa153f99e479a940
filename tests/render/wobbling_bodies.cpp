// SPDX-License-Identifier: Apache-2.0
#include "tests/render/wobbling_bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace mercury::render {
namespace {

constexpr float voxel = 0.1f;  // [m]
constexpr float quarter = 0.5f * std::numbers::pi_v<float>;

struct Grid {
  int side;
  std::vector<int> kinds;  // 0 = air, 1..22
  int at(int x, int y, int z) const {
    if (std::min({x, y, z}) < 0 || std::max({x, y, z}) >= side) return 0;
    return kinds[std::size_t((z * side + y) * side + x)];
  }
};

// Lobes around a spine, in patches of one material each, mirrored left and right.
Grid random_grid(int side, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  Grid grid{side, std::vector<int>(std::size_t(side * side * side), 0)};
  struct Lobe {
    float x, y, z, radius;
    int kind;
  };
  std::vector<Lobe> lobes;
  const int count = 5 + int(unit(random) * 5);
  for (int i = 0; i < count; ++i) {
    const float along = float(i) / float(count - 1);
    lobes.push_back({0.12f + 0.76f * along, 0.5f - 0.38f * unit(random), 0.35f + 0.3f * unit(random),
                     0.12f + 0.13f * unit(random), 1 + int(unit(random) * 22) % 22});
  }
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const float px = (float(x) + 0.5f) / float(side), pz = (float(z) + 0.5f) / float(side);
        const float py = 0.5f - std::abs((float(y) + 0.5f) / float(side) - 0.5f);
        float best = 1;
        int kind = 0;
        for (const Lobe& lobe : lobes) {
          const float d = std::hypot(px - lobe.x, py - lobe.y, pz - lobe.z) / lobe.radius;
          if (d < best) best = d, kind = lobe.kind;
        }
        if (std::abs(py - 0.5f) < 0.17f && std::abs(pz - 0.5f) < 0.12f && px > 0.1f && px < 0.9f && kind == 0)
          kind = 21;
        grid.kinds[std::size_t((z * side + y) * side + x)] = kind;
      }
  return grid;
}

constexpr std::array<std::array<int, 3>, 6> sides{
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
// Corners of each side as bits x = 1, y = 2, z = 4, counter-clockwise from outside.
constexpr std::array<std::array<int, 4>, 6> side_corners{
    {{1, 3, 7, 5}, {0, 4, 6, 2}, {2, 6, 7, 3}, {0, 1, 5, 4}, {4, 5, 7, 6}, {0, 2, 3, 1}}};

class Builder {
 public:
  explicit Builder(const Grid& grid) : grid_(grid) {}
  WobblingBody build() {
    for (int z = 0; z < grid_.side; ++z)
      for (int y = 0; y < grid_.side; ++y)
        for (int x = 0; x < grid_.side; ++x)
          if (grid_.at(x, y, z)) add_voxel(x, y, z);
    for (const auto& [ends, kind] : springs_) {
      body_.springs.insert(body_.springs.end(), {ends.first, ends.second});
      body_.spring_materials.push_back(std::uint32_t(kind - 1));
    }
    return std::move(body_);
  }

 private:
  std::uint32_t mass(int x, int y, int z) {
    const auto [entry, fresh] = masses_.try_emplace({x, y, z}, std::uint32_t(body_.rest.size() / 3));
    if (fresh)
      for (const int i : {x, y, z}) body_.rest.push_back(voxel * (float(i) - 0.5f * float(grid_.side)));
    return entry->second;
  }
  void add_voxel(int x, int y, int z) {
    const int kind = grid_.at(x, y, z);
    std::array<std::uint32_t, 8> corner{};
    for (int i = 0; i < 8; ++i) corner[std::size_t(i)] = mass(x + (i & 1), y + ((i >> 1) & 1), z + (i >> 2));
    for (std::size_t i = 0; i < 8; ++i)
      for (std::size_t j = i + 1; j < 8; ++j)
        springs_[{std::min(corner[i], corner[j]), std::max(corner[i], corner[j])}] = kind;
    for (std::size_t s = 0; s < 6; ++s) {
      if (grid_.at(x + sides[s][0], y + sides[s][1], z + sides[s][2])) continue;
      const auto& c = side_corners[s];
      const auto at = [&](std::size_t i) { return corner[std::size_t(c[i])]; };
      body_.faces.insert(body_.faces.end(), {at(0), at(1), at(2), at(0), at(2), at(3)});
      body_.face_materials.insert(body_.face_materials.end(), 2, std::uint32_t(kind - 1));
    }
  }

  const Grid& grid_;
  WobblingBody body_;
  std::map<std::array<int, 3>, std::uint32_t> masses_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> springs_;
};

}  // namespace

std::vector<float> WobblingBody::positions(double time, float phase) const {
  std::vector<float> moved(rest.size());
  const float t = 2.2f * float(time) + phase;
  for (std::size_t i = 0; i < rest.size(); i += 3) {
    const float x = rest[i], y = rest[i + 1], z = rest[i + 2];
    const float wave = std::sin(t - 4 * x);
    const float swell = 1 + 0.12f * std::sin(t + 3 * x);
    moved[i] = x * (1 + 0.06f * std::cos(t));
    moved[i + 1] = y * swell + 0.10f * wave;
    moved[i + 2] = z * swell + 0.06f * std::cos(t - 5 * x) + 0.15f * y * y * std::sin(t);
  }
  return moved;
}

WobblingBody make_wobbling_body(int side, std::uint32_t seed) {
  const Grid grid = random_grid(side, seed);
  return Builder(grid).build();
}

WobblingBody make_blob(int splits, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  constexpr float g = 1.618034f;
  std::vector<Vector3> points{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                              {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  std::vector<std::uint32_t> faces{0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                                   4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                                   6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
  for (int split = 0; split < splits; ++split) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, fresh] = middles.try_emplace({std::min(a, b), std::max(a, b)}, std::uint32_t(points.size()));
      if (fresh) points.push_back(0.5f * (points[a] + points[b]));
      return entry->second;
    };
    std::vector<std::uint32_t> finer;
    for (std::size_t i = 0; i < faces.size(); i += 3) {
      const std::uint32_t a = faces[i], b = faces[i + 1], c = faces[i + 2];
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
    }
    faces = finer;
  }
  std::array<Vector3, 5> bumps;
  for (Vector3& bump : bumps) bump = 2.5f * Vector3(normal(random), normal(random), normal(random));
  WobblingBody body;
  for (Vector3& point : points) {
    point = point.normalized();
    float radius = 0.35f;
    for (const Vector3& bump : bumps) radius += 0.045f * std::sin(bump.dot(point) + bump.x);
    for (int axis = 0; axis < 3; ++axis) body.rest.push_back(radius * point[axis] + 0.008f * normal(random));
  }
  body.faces = faces;
  for (std::size_t i = 0; i < faces.size(); i += 3) {
    const Vector3 at = points[faces[i]];
    body.face_materials.push_back(std::uint32_t(7 * std::floor(3 + 2 * at.x) + std::floor(3 + 2 * at.z)) % 22);
    for (std::size_t corner = 0; corner < 3; ++corner)
      if (faces[i + corner] < faces[i + (corner + 1) % 3]) {
        body.springs.insert(body.springs.end(), {faces[i + corner], faces[i + (corner + 1) % 3]});
        body.spring_materials.push_back(body.face_materials.back());
      }
  }
  return body;
}

std::vector<RenderMaterial> wobbling_materials(double time) {
  std::vector<RenderMaterial> materials;
  for (int m = 0; m < 20; ++m) {
    const float speed = float(m / 4), phase = float(m % 4) * quarter;
    materials.push_back({muscle_color(phase, speed / 4), -std::sin((speed + 1) * float(time) + phase)});
  }
  materials.push_back({tissue_color, 0});
  materials.push_back({bone_color, 0});
  return materials;
}

std::vector<Body> WobblingGroup::views() const {
  std::vector<Body> result;
  for (const WobblingBody& body : bodies) result.push_back(body.body());
  return result;
}

std::vector<float> WobblingGroup::positions(double time) const {
  std::vector<float> all;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::vector<float> one = bodies[i].positions(time, 1.7f * float(i));
    all.insert(all.end(), one.begin(), one.end());
  }
  return all;
}

WobblingGroup make_wobbling_group(int count, int side, std::uint32_t seed, float spacing) {
  WobblingGroup group;
  const int columns = std::max(1, int(std::lround(std::sqrt(1.4 * count))));
  const int rows = (count + columns - 1) / columns;
  for (int i = 0; i < count; ++i) {
    const std::uint32_t own = seed + std::uint32_t(i);
    group.bodies.push_back(side == 0 ? make_blob(2, own) : make_wobbling_body(side, own));
    const float column = float(i % columns) - 0.5f * float(columns - 1);
    const float row = float(i / columns) - 0.5f * float(rows - 1);
    Placement placement;
    placement.offset = {spacing * column, -spacing * row, 0};
    group.placements.push_back(placement);
  }
  return group;
}

}  // namespace mercury::render
