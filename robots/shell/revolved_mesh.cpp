// SPDX-License-Identifier: Apache-2.0
#include "robots/shell/revolved_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace mercury {
namespace {

constexpr int samples = 512;  // of a profile
double fraction(int i) { return static_cast<double>(i) / samples; }

}  // namespace

RevolvedMesh::RevolvedMesh(const RevolvedSurface& surface, double spacing)
    : lobes_(static_cast<std::size_t>(surface.lobes)) {
  measure(surface);
  // Rows of equilateral triangles are 0.87 edges apart.
  auto steps = static_cast<std::size_t>(std::max(3.0, std::round(profile_length() / (0.87 * spacing))));
  if (surface.closed) steps += steps % 2;  // rings alternate
  for (std::size_t i = 0; i < steps + (surface.closed ? 0 : 1); ++i) {
    const bool pole = (i == 0 && surface.starts_on_axis) || (i == steps && surface.ends_on_axis);
    add_ring(surface, at_length(static_cast<double>(i) / static_cast<double>(steps)), pole, spacing, i % 2 == 1);
  }
  for (std::size_t i = 0; i + 1 < rings_.size(); ++i) {
    const Ring &a = rings_[i], &b = rings_[i + 1];
    if (a.count == 1)
      stitch_pole(a.first, b, false);
    else if (b.count == 1)
      stitch_pole(b.first, a, true);
    else
      stitch(a, b);
  }
  if (surface.closed) stitch(rings_.back(), rings_.front());
  find_edges();
  find_normals();
}

void RevolvedMesh::measure(const RevolvedSurface& surface) {
  lengths_.push_back(0);
  for (int i = 1; i <= samples; ++i) {
    const RevolvedSurface::Profile a = surface.profile(fraction(i - 1)), b = surface.profile(fraction(i));
    lengths_.push_back(lengths_.back() + std::sqrt((b.r - a.r) * (b.r - a.r) + (b.z - a.z) * (b.z - a.z)));
  }
}

// Where a share of the profile's length is reached, as s.
double RevolvedMesh::at_length(double share) const {
  const double wanted = share * profile_length();
  const auto above = std::lower_bound(lengths_.begin() + 1, lengths_.end() - 1, wanted);
  const double before = *(above - 1), step = *above - before;
  return fraction(static_cast<int>(above - lengths_.begin()) - 1) + (wanted - before) / step / samples;
}

void RevolvedMesh::add_ring(const RevolvedSurface& surface, double s, bool pole, double spacing, bool odd) {
  const double per_lobe = 2 * std::numbers::pi * surface.profile(s).r / (spacing * static_cast<double>(lobes_));
  const std::size_t count = pole ? 1 : lobes_ * static_cast<std::size_t>(std::max(1.0, std::round(per_lobe)));
  rings_.push_back({vertices_.size(), count, odd ? 0.5 : 0});
  for (std::size_t j = 0; j < count; ++j) {
    const double turns = (static_cast<double>(j) + rings_.back().offset) / static_cast<double>(count);
    vertices_.push_back({s, turns, surface.point(s, turns), {}});
  }
}

void RevolvedMesh::stitch_pole(std::size_t pole, const Ring& ring, bool below) {
  for (std::size_t j = 0; j < ring.count; ++j) {
    const std::size_t here = ring.first + j, next = ring.first + (j + 1) % ring.count;
    triangles_.push_back(below ? Triangle{here, pole, next} : Triangle{pole, here, next});
  }
}

// `a` is above `b`.
void RevolvedMesh::stitch(const Ring& a, const Ring& b) {
  const std::size_t per_a = a.count / lobes_, per_b = b.count / lobes_;
  const auto turns = [](const Ring& ring, std::size_t j) {
    return (static_cast<double>(j) + ring.offset) / static_cast<double>(ring.count);
  };
  for (std::size_t lobe = 0; lobe < lobes_; ++lobe) {
    std::size_t i = 0, j = 0;
    const auto in_a = [&](std::size_t k) { return a.first + (lobe * per_a + k) % a.count; };
    const auto in_b = [&](std::size_t k) { return b.first + (lobe * per_b + k) % b.count; };
    while (i < per_a || j < per_b) {
      const bool step_a = j == per_b || (i < per_a && std::abs(turns(a, i + 1) - turns(b, j)) <=
                                                          std::abs(turns(b, j + 1) - turns(a, i)));
      if (step_a)
        triangles_.push_back({in_a(i), in_b(j), in_a(i + 1)}), ++i;
      else
        triangles_.push_back({in_a(i), in_b(j), in_b(j + 1)}), ++j;
    }
  }
}

void RevolvedMesh::find_edges() {
  std::map<std::pair<std::size_t, std::size_t>, int> half_edges;
  for (const auto& [a, b, c] : triangles_) ++half_edges[{a, b}], ++half_edges[{b, c}], ++half_edges[{c, a}];
  for (const auto& [ends, count] : half_edges) {
    const bool has_twin = half_edges.contains({ends.second, ends.first});
    if (!has_twin) rim_.push_back({ends.first, ends.second});
    if (!has_twin || ends.first < ends.second) edges_.push_back({ends.first, ends.second});
  }
}

void RevolvedMesh::find_normals() {
  for (const auto& [a, b, c] : triangles_) {
    const Point twice_area = cross(vertices_[b].point - vertices_[a].point, vertices_[c].point - vertices_[a].point);
    for (const std::size_t corner : {a, b, c}) vertices_[corner].normal = vertices_[corner].normal + twice_area;
  }
  for (Vertex& vertex : vertices_) vertex.normal = 1 / std::sqrt(dot(vertex.normal, vertex.normal)) * vertex.normal;
}

}  // namespace mercury
