// SPDX-License-Identifier: Apache-2.0
#include "sim/physics/face_pairs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace mercury {
namespace {

// Edge k of a face joins its corners k and k + 1.
std::array<std::uint16_t, 3> corners(const Face& face) { return {face.a, face.b, face.c}; }

std::uint32_t edge_key(std::uint32_t a, std::uint32_t b) { return std::min(a, b) << 16 | std::max(a, b); }

std::array<std::uint32_t, 3> edge_keys(const Face& face) {
  return {edge_key(face.a, face.b), edge_key(face.b, face.c), edge_key(face.c, face.a)};
}

// The half-edges of a robot's faces, with number 4 f + k for edge k of face f.
class HalfEdges {
 public:
  explicit HalfEdges(const Robot& robot)
      : faces_(robot.faces), bits_(static_cast<int>(std::bit_width(6 * faces_.size()))),
        table_(std::size_t{1} << bits_), apart_(4 * faces_.size() + 1) {
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      const auto keys = edge_keys(faces_[f]);
      for (std::uint32_t k = 0; k < 3; ++k) add(keys[k], 4 * f + k);
    }
  }

  // Half-edges that share their edge with a later face, sorted by how much later the next such face is in the file,
  // then by their own face, then by edge key. Faces that are close in the file are often the two triangles of a square.
  std::vector<std::uint32_t> shared_edges() const {
    std::vector<std::uint32_t> start(faces_.size() + 1);
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
      for (std::uint32_t k = 0; k < 3; ++k) ++start[apart(4 * f + k)];
    const std::size_t unshared = start[0];
    std::uint32_t count = 0;
    for (std::uint32_t& s : start) s = std::exchange(count, count + s);
    std::vector<std::uint32_t> sorted(3 * faces_.size());
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
      for (const std::uint32_t k : edge_order(f)) sorted[start[apart(4 * f + k)]++] = 4 * f + k;
    sorted.erase(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(unshared));
    return sorted;
  }

  // Number of the next face with this edge minus the number of the half-edge's face; 0 = there is none.
  std::uint32_t apart(std::uint32_t half_edge) const { return apart_[half_edge]; }

 private:
  struct Entry {
    std::uint32_t key = 0xffffffffu;  // no edge joins a mass to itself
    std::uint32_t last = 0;           // the last half-edge of this key so far
  };

  void add(std::uint32_t key, std::uint32_t half_edge) {
    const std::size_t mask = table_.size() - 1;
    std::size_t at = key * 0x9e3779b1u >> (32 - bits_);
    while (table_[at].key != key && table_[at].key != Entry().key) at = (at + 1) & mask;
    // New keys write to the unused last element, because a branch would often be mispredicted.
    const std::size_t previous = table_[at].key == key ? table_[at].last : apart_.size() - 1;
    apart_[previous] = half_edge / 4 - table_[at].last / 4;
    table_[at] = {key, half_edge};
  }

  // By key only where two edges of the face lead to the same face; otherwise `apart` decides.
  std::array<std::uint32_t, 3> edge_order(std::uint32_t face) const {
    std::array<std::uint32_t, 3> order{0, 1, 2};
    const std::uint32_t* const a = &apart_[4 * std::size_t{face}];
    if (((a[0] == a[1]) & (a[0] > 0)) | ((a[1] == a[2]) & (a[1] > 0)) | ((a[2] == a[0]) & (a[2] > 0))) {
      const auto keys = edge_keys(faces_[face]);
      std::ranges::sort(order, {}, [&](std::uint32_t k) { return keys[k]; });
    }
    return order;
  }

  const std::vector<Face>& faces_;
  int bits_;                  // of the table's size
  std::vector<Entry> table_;  // open addressing
  std::vector<std::uint32_t> apart_;
};

// The pair of two faces that share edge k of the first one, each with its own orientation.
FacePair pair_of(const Face& first, std::uint32_t k, const Face& second) {
  const auto [a, b, c] = k == 0   ? std::array{first.b, first.c, first.a}
                         : k == 1 ? std::array{first.c, first.a, first.b}
                                  : corners(first);
  // The first face is (a, b, c) with the edge c -> a; a consistent neighbor runs a -> c -> d.
  for (const std::uint16_t d : corners(second))
    if (d != a && d != c) return {a, b, c, d};
  return {a, b, c, a};
}

// Chooses the vertex order by rest positions (face_pairs.h).
FacePair ordered_by_position(FacePair pair, const Robot& robot) {
  // Without branches, which would often be mispredicted.
  const auto before = [&](std::uint16_t p, std::uint16_t q) {
    const Vec3 x = robot.masses[p], y = robot.masses[q];
    const bool by_x = (x.x < y.x) | ((x.x == y.x) & (p < q));
    const bool by_y = (x.y < y.y) | ((x.y == y.y) & by_x);
    return (x.z < y.z) | ((x.z == y.z) & by_y);
  };
  if (pair.d == pair.a) return pair;
  if (before(pair.c, pair.a)) std::swap(pair.a, pair.c);
  if (before(pair.d, pair.b)) std::swap(pair.b, pair.d);
  return pair;
}

}  // namespace

std::vector<FacePair> pair_faces(const Robot& robot) {
  std::vector<FacePair> pairs;
  pairs.reserve(robot.faces.size());
  std::vector<std::uint8_t> matched(robot.faces.size());
  const HalfEdges edges(robot);
  for (const std::uint32_t h : edges.shared_edges()) {
    const std::uint32_t first = h / 4, second = first + edges.apart(h);
    if (matched[first] || matched[second]) continue;
    matched[first] = matched[second] = 1;
    pairs.push_back(ordered_by_position(pair_of(robot.faces[first], h % 4, robot.faces[second]), robot));
  }
  for (std::size_t f = 0; f < robot.faces.size(); ++f)
    if (!matched[f]) pairs.push_back({robot.faces[f].a, robot.faces[f].b, robot.faces[f].c, robot.faces[f].a});
  return pairs;
}

}  // namespace mercury
