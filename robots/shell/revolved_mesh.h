// SPDX-License-Identifier: Apache-2.0
// Triangle meshes of surfaces around the z axis, alike on every machine.
//
// Rings of vertices lie at equal distances along the profile, neighbors half a step apart. Each ring has as many
// vertices as its circumference needs, a multiple of the lobes; so triangles are nearly equilateral everywhere, and all
// lobes are meshed alike.
//
//       o---------o---------o       ring of 2 vertices per lobe
//      / \     / | \     / \       triangles step along the ring whose
//     /   \   /  |  \   /   \      next vertex is nearer around the axis
//    o-----o-----o-----o-----o      ring of 3 or more vertices per lobe
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace mercury {

struct Point {
  double x = 0, y = 0, z = 0;
};
inline Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point operator*(double s, Point a) { return {s * a.x, s * a.y, s * a.z}; }
inline Point cross(Point a, Point b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double dot(Point a, Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// A surface. `s` runs from 0, the top of the profile, to 1; `turns` around the axis, counter-clockwise from above.
struct RevolvedSurface {
  struct Profile {
    double r = 0, z = 0;
  };
  std::function<Profile(double s)> profile;            // without lobes; sets the distances of the vertices
  std::function<Point(double s, double turns)> point;  // with lobes
  int lobes = 1;
  bool closed = false;                                // the profile ends where it begins
  bool starts_on_axis = false, ends_on_axis = false;  // in one vertex; else a profile that is not closed ends in a rim
};

class RevolvedMesh {
 public:
  struct Vertex {
    double s, turns;
    Point point, normal;  // the normal has length 1
  };
  struct Edge {
    std::size_t a, b;  // vertices
  };
  using Triangle = std::array<std::size_t, 3>;  // vertices, counter-clockwise seen from outside

  // `spacing` is the wanted distance of neighboring vertices.
  RevolvedMesh(const RevolvedSurface& surface, double spacing);

  const std::vector<Vertex>& vertices() const { return vertices_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<Edge>& edges() const { return edges_; }  // each once
  const std::vector<Edge>& rim() const { return rim_; }      // edges of one triangle alone, in its direction
  double profile_length() const { return lengths_.back(); }

 private:
  struct Ring {
    std::size_t first, count;
    double offset;  // of its first vertex [vertices]
  };
  void measure(const RevolvedSurface& surface);
  double at_length(double share) const;
  void add_ring(const RevolvedSurface& surface, double s, bool pole, double spacing, bool odd);
  void stitch(const Ring& a, const Ring& b);
  void stitch_pole(std::size_t pole, const Ring& ring, bool below);
  void find_edges();
  void find_normals();

  std::size_t lobes_;
  std::vector<double> lengths_;  // of the profile up to each of its samples
  std::vector<Ring> rings_;
  std::vector<Vertex> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<Edge> edges_, rim_;
};

}  // namespace mercury
