// SPDX-License-Identifier: Apache-2.0
#include "render/body_data.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
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

void require(bool holds, std::size_t body, const char* what) {
  if (!holds) throw std::invalid_argument("body " + std::to_string(body) + ": " + what);
}

void validate(const Body& body, std::size_t index) {
  require(body.rest_positions.size() % 3 == 0, index, "rest_positions must have 3 floats per mass");
  require(body.faces.size() % 3 == 0, index, "faces must have 3 masses per face");
  require(body.springs.size() % 2 == 0, index, "springs must have 2 masses per spring");
  require(body.face_materials.empty() || body.face_materials.size() == body.faces.size() / 3, index,
          "face_materials must be empty or have one element per face");
  require(body.spring_materials.empty() || body.spring_materials.size() == body.springs.size() / 2, index,
          "spring_materials must be empty or have one element per spring");
  const auto within = [&](std::uint32_t mass) { return mass < body.rest_positions.size() / 3; };
  require(std::all_of(body.faces.begin(), body.faces.end(), within), index, "a face's mass is out of range");
  require(std::all_of(body.springs.begin(), body.springs.end(), within), index, "a spring's mass is out of range");
}

float length_of(const Body& body, std::size_t spring) {
  const float* a = body.rest_positions.data() + 3 * std::size_t(body.springs[2 * spring]);
  const float* b = body.rest_positions.data() + 3 * std::size_t(body.springs[2 * spring + 1]);
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// A sample spread evenly over the springs; over all bodies it is enough for a median.
void sample_lengths(const Body& body, std::vector<float>& lengths) {
  const std::size_t count = body.springs.size() / 2;
  for (std::size_t i = 0; i < count; i += std::max<std::size_t>(1, count / 64)) lengths.push_back(length_of(body, i));
}

float median(std::vector<float> values, float otherwise) {
  if (values.empty()) return otherwise;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// For each mass the faces that touch it, as offsets into one list.
struct MassFaces {
  std::vector<std::uint32_t> ends, faces;
};

MassFaces mass_faces_of(std::span<const std::uint32_t> faces, std::size_t masses) {
  MassFaces result{std::vector<std::uint32_t>(masses, 0), std::vector<std::uint32_t>(faces.size())};
  for (const std::uint32_t mass : faces) ++result.ends[mass];
  std::uint32_t sum = 0;
  for (std::uint32_t& end : result.ends) end = std::exchange(sum, sum + end);
  for (std::size_t i = 0; i < faces.size(); ++i) result.faces[result.ends[faces[i]]++] = std::uint32_t(i / 3);
  return result;
}

std::vector<std::uint32_t> copy_of(std::span<const std::uint32_t> values) { return {values.begin(), values.end()}; }

// Faces that are drawn: of equal ones, the first. The others become points, which cover no pixel; thousands of faces on
// the same pixels would take minutes.
std::vector<std::uint32_t> drawn_faces(std::span<const std::uint32_t> faces) {
  struct Corners {
    std::array<std::uint32_t, 3> masses;  // the lowest first, in the order of the face
    std::size_t face;
    bool operator<(const Corners& other) const { return std::tie(masses, face) < std::tie(other.masses, other.face); }
  };
  std::vector<Corners> sorted;
  sorted.reserve(faces.size() / 3);
  for (std::size_t face = 0; face < faces.size() / 3; ++face) {
    std::array masses{faces[3 * face], faces[3 * face + 1], faces[3 * face + 2]};
    std::rotate(masses.begin(), std::min_element(masses.begin(), masses.end()), masses.end());
    sorted.push_back({masses, face});
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::uint32_t> drawn = copy_of(faces);
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i].masses == sorted[i - 1].masses) std::fill_n(&drawn[3 * sorted[i].face], 3, sorted[i].masses[0]);
  return drawn;
}

template <typename T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

// Adds `first` to each index.
void append(std::vector<std::uint32_t>& to, const std::vector<std::uint32_t>& from, std::uint32_t first) {
  const std::size_t begin = to.size();
  to.resize(begin + from.size());
  std::transform(from.begin(), from.end(), to.begin() + std::ptrdiff_t(begin),
                 [first](std::uint32_t i) { return first + i; });
}

void append(std::vector<FaceRecord>& to, const std::vector<FaceRecord>& from, std::uint32_t first) {
  for (FaceRecord record : from) {
    for (std::uint32_t& neighbor : record.neighbors)
      if (neighbor != no_face) neighbor += first;
    to.push_back(record);
  }
}

void reserve(BodyData& data, std::span<const std::shared_ptr<const PreparedBody>> bodies) {
  std::size_t masses = 0, faces = 0, springs = 0;
  for (const auto& body : bodies) {
    masses += body->rest_positions.size() / 3;
    faces += body->records.size();
    springs += body->spring_materials.size();
  }
  data.rest_positions.reserve(3 * masses);
  data.owners.reserve(masses);
  data.mass_face_ends.reserve(masses);
  data.faces.reserve(3 * faces);
  data.mass_faces.reserve(3 * faces);
  data.records.reserve(faces);
  data.springs.reserve(2 * springs);
  data.spring_materials.reserve(springs);
}

}  // namespace

std::vector<FaceRecord> skin_topology(std::span<const float> positions, std::span<const std::uint32_t> faces) {
  const Skin skin{positions, faces, half_edges(faces)};
  std::vector<FaceRecord> records;
  records.reserve(faces.size() / 3);
  for (std::uint32_t face = 0; face < faces.size() / 3; ++face) records.push_back(record_of(skin, face));
  return records;
}

std::shared_ptr<const PreparedBody> prepare_body(const Body& body, std::size_t index) {
  validate(body, index);
  auto prepared = std::make_shared<PreparedBody>();
  prepared->rest_positions.assign(body.rest_positions.begin(), body.rest_positions.end());
  prepared->faces = drawn_faces(body.faces);
  prepared->springs = copy_of(body.springs);
  prepared->spring_materials = copy_of(body.spring_materials);
  prepared->spring_materials.resize(body.springs.size() / 2, 0);
  prepared->records = skin_topology(body.rest_positions, body.faces);
  for (std::size_t i = 0; i < body.face_materials.size(); ++i) prepared->records[i].material = body.face_materials[i];
  MassFaces adjacency = mass_faces_of(body.faces, body.rest_positions.size() / 3);
  prepared->mass_face_ends = std::move(adjacency.ends);
  prepared->mass_faces = std::move(adjacency.faces);
  sample_lengths(body, prepared->lengths);
  return prepared;
}

std::shared_ptr<const BodyData> assemble(std::span<const std::shared_ptr<const PreparedBody>> bodies) {
  auto data = std::make_shared<BodyData>();
  reserve(*data, bodies);
  std::vector<float> lengths;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const PreparedBody& body = *bodies[i];
    const std::uint32_t first_mass = data->mass_offsets.back(), first_face = std::uint32_t(data->records.size());
    append(data->rest_positions, body.rest_positions);
    data->owners.resize(data->rest_positions.size() / 3, std::uint32_t(i));
    append(data->faces, body.faces, first_mass);
    append(data->springs, body.springs, first_mass);
    append(data->spring_materials, body.spring_materials);
    append(data->records, body.records, first_face);
    append(data->mass_face_ends, body.mass_face_ends, std::uint32_t(data->mass_faces.size()));
    append(data->mass_faces, body.mass_faces, first_face);
    append(lengths, body.lengths);
    data->mass_offsets.push_back(std::uint32_t(data->rest_positions.size() / 3));
    data->face_offsets.push_back(std::uint32_t(data->records.size()));
    data->spring_offsets.push_back(std::uint32_t(data->spring_materials.size()));
  }
  data->typical_spring = median(std::move(lengths), 0.1f);
  return data;
}

}  // namespace mercury::render
