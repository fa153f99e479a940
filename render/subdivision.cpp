// SPDX-License-Identifier: Apache-2.0
#include "render/subdivision.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <unordered_map>
#include <utility>

namespace mercury::render {
namespace {

constexpr float kept_size = 0.6f;  // of what a skin would lose; 1 = nearly all, but flat sides would bulge

using Mean = std::map<std::uint32_t, float>;  // weights by mass

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::uint64_t{std::max(a, b)};
}

// An edge of a skin: the faces' corners opposite to it.
struct SkinEdge {
  std::uint32_t a = 0, b = 0, point = 0;
  std::vector<std::uint32_t> opposite;
};

struct SkinEdges {
  std::unordered_map<std::uint64_t, std::size_t> by_ends;
  std::vector<SkinEdge> list;
};

bool is_copy(std::span<const std::uint32_t> face) { return face[0] == face[1] || face[1] == face[2]; }

SkinEdges skin_edges(std::span<const std::uint32_t> faces) {
  SkinEdges edges;
  for (std::size_t f = 0; f + 2 < faces.size(); f += 3) {
    if (is_copy(faces.subspan(f, 3))) continue;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t a = faces[f + corner], b = faces[f + (corner + 1) % 3], across = faces[f + (corner + 2) % 3];
      const auto [found, added] = edges.by_ends.try_emplace(edge_key(a, b), edges.list.size());
      if (added) edges.list.push_back({.a = a, .b = b, .point = 0, .opposite = {}});
      edges.list[found->second].opposite.push_back(across);
    }
  }
  return edges;
}

// Loop's weight of each of n neighbors of a point.
float neighbor_weight(std::size_t n) {
  const double center = 0.375 + 0.25 * std::cos(2 * std::numbers::pi / double(n));
  return float((0.625 - center * center) / double(n));
}

// Where the old points go. At edges of other than two faces they stay.
std::vector<Mean> moved_points(std::size_t points, const SkinEdges& edges) {
  std::vector<std::vector<std::uint32_t>> neighbors(points);
  std::vector<bool> stays(points, false);
  for (const SkinEdge& edge : edges.list) {
    neighbors[edge.a].push_back(edge.b);
    neighbors[edge.b].push_back(edge.a);
    if (edge.opposite.size() != 2) stays[edge.a] = stays[edge.b] = true;
  }
  std::vector<Mean> moved(points);
  for (std::uint32_t i = 0; i < points; ++i) {
    const std::size_t n = neighbors[i].size();
    if (n < 3 || stays[i]) {
      moved[i] = {{i, 1.0f}};
      continue;
    }
    const float weight = neighbor_weight(n);
    moved[i][i] = 1 - float(n) * weight;
    for (const std::uint32_t neighbor : neighbors[i]) moved[i][neighbor] += weight;
  }
  return moved;
}

Mean middle_of(const SkinEdge& edge) {
  if (edge.opposite.size() != 2) return {{edge.a, 0.5f}, {edge.b, 0.5f}};
  Mean mean{{edge.a, 0.375f}, {edge.b, 0.375f}};
  for (const std::uint32_t across : edge.opposite) mean[across] += 0.125f;
  return mean;
}

Mean combined(const Mean& outer, std::span<const Mean> inner) {
  Mean mean;
  for (const auto& [point, weight] : outer)
    for (const auto& [mass, share] : inner[point]) mean[mass] += weight * share;
  return mean;
}

// Where a skin starts from: its masses, moved against the way that they will go, so that it keeps its size.
std::vector<Mean> widened(std::size_t masses, std::span<const std::uint32_t> faces) {
  std::vector<Mean> points = moved_points(masses, skin_edges(faces));
  for (std::uint32_t i = 0; i < masses; ++i) {
    for (auto& [mass, weight] : points[i]) weight *= -kept_size;
    points[i][i] += 1 + kept_size;
  }
  return points;
}

// A skin of points that are means of masses.
struct MeansSkin {
  std::vector<Mean> points;
  std::vector<std::uint32_t> owners, faces;
  std::vector<FaceRecord> records;
};

void refine(MeansSkin& skin) {
  SkinEdges edges = skin_edges(skin.faces);
  MeansSkin fine;
  for (const Mean& point : moved_points(skin.points.size(), edges)) fine.points.push_back(combined(point, skin.points));
  fine.owners = skin.owners;
  for (SkinEdge& edge : edges.list) {
    edge.point = std::uint32_t(fine.points.size());
    fine.points.push_back(combined(middle_of(edge), skin.points));
    fine.owners.push_back(skin.owners[edge.a]);
  }
  for (std::size_t f = 0; f < skin.records.size(); ++f) {
    const auto face = std::span(skin.faces).subspan(3 * f, 3);
    if (is_copy(face)) {
      fine.faces.insert(fine.faces.end(), 12, face[0]);
      fine.records.insert(fine.records.end(), 4, skin.records[f]);
      continue;
    }
    const auto point = [&](std::size_t i, std::size_t j) {
      return edges.list[edges.by_ends.at(edge_key(face[i], face[j]))].point;
    };
    const std::uint32_t ab = point(0, 1), bc = point(1, 2), ca = point(2, 0);
    for (const std::uint32_t corner : {face[0], ab, ca, ab, face[1], bc, ca, bc, face[2], ab, bc, ca})
      fine.faces.push_back(corner);
    const FaceRecord record{{no_face, no_face, no_face, no_face}, skin.records[f].material, 3};
    fine.records.insert(fine.records.end(), 4, record);
  }
  skin = std::move(fine);
}

}  // namespace

FineSkin subdivided(const BodyData& bodies, int times) {
  MeansSkin skin{.points = {}, .owners = bodies.owners, .faces = bodies.faces, .records = bodies.records};
  skin.points = widened(bodies.owners.size(), bodies.faces);
  for (int i = 0; i < times; ++i) refine(skin);
  FineSkin fine;
  for (const Mean& point : skin.points) {
    for (const auto& [mass, weight] : point) {
      fine.means.masses.push_back(mass);
      fine.means.weights.push_back(weight);
    }
    fine.means.ends.push_back(std::uint32_t(fine.means.masses.size()));
  }
  BodyData& data = fine.bodies;
  data.typical_spring = bodies.typical_spring;
  data.owners = std::move(skin.owners);
  data.faces = std::move(skin.faces);
  data.records = std::move(skin.records);
  data.rest_positions.resize(3 * data.owners.size());  // filled in by each frame
  // All points count as one body's: nothing asks for the points of a single one.
  data.mass_offsets = {0, std::uint32_t(data.owners.size())};
  for (std::uint32_t& end : data.face_offsets = bodies.face_offsets) end <<= 2 * times;
  data.spring_offsets = {0, 0};
  std::vector<std::vector<std::uint32_t>> faces_at(data.owners.size());
  for (std::uint32_t i = 0; i < data.faces.size(); ++i)
    if (!is_copy(std::span(data.faces).subspan(i / 3 * 3, 3))) faces_at[data.faces[i]].push_back(i / 3);
  for (const auto& faces : faces_at) {
    data.mass_faces.insert(data.mass_faces.end(), faces.begin(), faces.end());
    data.mass_face_ends.push_back(std::uint32_t(data.mass_faces.size()));
  }
  return fine;
}

}  // namespace mercury::render
