// SPDX-License-Identifier: Apache-2.0
#include "render/skin_topology.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "render/vector.h"

namespace mercury::render {
namespace {

constexpr float flat_cosine = 0.9994f;  // 2 degrees
constexpr float most_skewed = 0.35f;    // cosine at the corner of a quadrilateral; a right angle has 0
constexpr std::uint32_t own_triangle = 3;

struct HalfEdge {
  std::uint64_t key;  // both masses, the lower first
  std::uint32_t face;
  std::uint32_t from;
};

struct Skin {
  std::span<const float> positions;
  std::span<const std::uint32_t> faces;
  std::vector<HalfEdge> edges;  // sorted by key, from and face

  std::uint32_t mass(std::uint32_t face, std::uint32_t corner) const {
    return faces[3 * std::size_t(face) + corner % 3];
  }
  Vector3 position(std::uint32_t mass) const { return Vector3(positions.data() + 3 * std::size_t(mass)); }
  Vector3 normal(std::uint32_t face) const {
    const Vector3 a = position(mass(face, 0));
    return (position(mass(face, 1)) - a).cross(position(mass(face, 2)) - a).normalized();
  }
};

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
  return (std::uint64_t(std::min(a, b)) << 32) | std::max(a, b);
}

std::vector<HalfEdge> half_edges(std::span<const std::uint32_t> faces) {
  std::vector<HalfEdge> edges;
  edges.reserve(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
    edges.push_back({key_of(faces[i], faces[next]), std::uint32_t(i / 3), faces[i]});
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.key, a.from, a.face) < std::tie(b.key, b.from, b.face);
  });
  return edges;
}

// The neighbor of `face` across its edge from a to b: it has the edge from b to a. Of several, the first; many equal
// faces cost no search through all of them.
std::uint32_t across(const Skin& skin, std::uint32_t face, std::uint32_t a, std::uint32_t b) {
  const std::pair wanted{key_of(a, b), b};
  auto edge = std::lower_bound(skin.edges.begin(), skin.edges.end(), wanted,
                               [](const HalfEdge& e, const auto& w) { return std::pair(e.key, e.from) < w; });
  for (; edge != skin.edges.end() && std::pair(edge->key, edge->from) == wanted; ++edge)
    if (edge->face != face) return edge->face;
  return no_face;
}

float corner_cosine(const Skin& skin, std::uint32_t face, std::uint32_t corner) {
  const Vector3 at = skin.position(skin.mass(face, corner));
  const Vector3 u = skin.position(skin.mass(face, corner + 1)) - at;
  const Vector3 v = skin.position(skin.mass(face, corner + 2)) - at;
  return u.dot(v) / std::max(u.norm() * v.norm(), 1e-20f);
}

// The corner nearest to a right angle: its opposite edge may be the diagonal of a quadrilateral.
std::uint32_t squarest_corner(const Skin& skin, std::uint32_t face) {
  std::uint32_t best = 0;
  for (std::uint32_t corner = 1; corner < 3; ++corner)
    if (std::abs(corner_cosine(skin, face, corner)) < std::abs(corner_cosine(skin, face, best))) best = corner;
  return best;
}

struct Partner {
  std::uint32_t face = no_face, corner = 0;
};

// The other half of the quadrilateral, if `face` is half of one.
Partner partner_of(const Skin& skin, std::uint32_t face, std::uint32_t corner) {
  const std::uint32_t b = skin.mass(face, corner + 1), c = skin.mass(face, corner + 2);
  const std::uint32_t other = across(skin, face, b, c);
  if (other == no_face || skin.normal(face).dot(skin.normal(other)) < flat_cosine) return {};
  const std::uint32_t other_corner = squarest_corner(skin, other);
  const std::uint32_t d = skin.mass(other, other_corner);
  if (d == b || d == c) return {};
  if (std::abs(corner_cosine(skin, face, corner)) > most_skewed) return {};
  if (std::abs(corner_cosine(skin, other, other_corner)) > most_skewed) return {};
  return {other, other_corner};
}

FaceRecord record_of(const Skin& skin, std::uint32_t face) {
  const std::uint32_t corner = squarest_corner(skin, face);
  const Partner partner = partner_of(skin, face, corner);
  if (partner.face == no_face) {
    FaceRecord record{{no_face, no_face, no_face, no_face}, 0, own_triangle};
    for (std::uint32_t i = 0; i < 3; ++i)
      record.neighbors[i] = across(skin, face, skin.mass(face, i + 1), skin.mass(face, i + 2));
    return record;
  }
  const std::uint32_t a = skin.mass(face, corner), b = skin.mass(face, corner + 1), c = skin.mass(face, corner + 2);
  const std::uint32_t d = skin.mass(partner.face, partner.corner);
  return {{across(skin, face, c, a), across(skin, partner.face, b, d), across(skin, face, a, b),
           across(skin, partner.face, d, c)},
          0,
          corner};
}

}  // namespace

std::vector<FaceRecord> skin_topology(std::span<const float> positions, std::span<const std::uint32_t> faces) {
  const Skin skin{positions, faces, half_edges(faces)};
  std::vector<FaceRecord> records;
  records.reserve(faces.size() / 3);
  for (std::uint32_t face = 0; face < faces.size() / 3; ++face) records.push_back(record_of(skin, face));
  return records;
}

}  // namespace mercury::render
