#include "render/bodies.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "render/skin_topology.h"

namespace mercury::render {
namespace {

void require(bool holds, std::size_t body, const char* what) {
  if (!holds) throw std::invalid_argument("body " + std::to_string(body) + ": " + what);
}

void validate(const Body& body, std::size_t index) {
  require(body.rest_positions.size() % 3 == 0, index, "rest_positions must have 3 floats a mass");
  require(body.faces.size() % 3 == 0, index, "faces must have 3 masses a face");
  require(body.springs.size() % 2 == 0, index, "springs must have 2 masses a spring");
  require(body.face_looks.empty() || body.face_looks.size() == body.faces.size() / 3, index,
          "face_looks must be empty or have one element a face");
  require(body.spring_looks.empty() || body.spring_looks.size() == body.springs.size() / 2, index,
          "spring_looks must be empty or have one element a spring");
  const auto within = [&](std::uint32_t mass) { return mass < body.rest_positions.size() / 3; };
  require(std::all_of(body.faces.begin(), body.faces.end(), within), index, "a face's mass is out of range");
  require(std::all_of(body.springs.begin(), body.springs.end(), within), index, "a spring's mass is out of range");
}

float length_of(const Body& body, std::size_t spring) {
  const float* a = body.rest_positions.data() + 3 * std::size_t(body.springs[2 * spring]);
  const float* b = body.rest_positions.data() + 3 * std::size_t(body.springs[2 * spring + 1]);
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// At most some thousands, evenly picked: enough for a median.
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

template <typename T>
void append(std::vector<T>& to, std::span<const T> from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

Bodies::Bodies() { set({}); }

void Bodies::set(std::span<const Body> bodies) {
  for (std::size_t i = 0; i < bodies.size(); ++i) validate(bodies[i], i);
  std::vector<float> rest, lengths;
  std::vector<std::uint32_t> owners, face_masses, spring_masses, looks, offsets{0};
  std::vector<FaceRecord> records;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    const std::uint32_t first_mass = offsets.back(), first_face = std::uint32_t(records.size());
    append(rest, body.rest_positions);
    owners.resize(rest.size() / 3, std::uint32_t(i));
    for (const std::uint32_t mass : body.faces) face_masses.push_back(first_mass + mass);
    for (const std::uint32_t mass : body.springs) spring_masses.push_back(first_mass + mass);
    for (FaceRecord record : skin_topology(body.rest_positions, body.faces)) {
      for (std::uint32_t& neighbour : record.neighbours)
        if (neighbour != no_face) neighbour += first_face;
      if (!body.face_looks.empty()) record.look = body.face_looks[records.size() - first_face];
      records.push_back(record);
    }
    append(looks, body.spring_looks);
    looks.resize(spring_masses.size() / 2, 0);
    offsets.push_back(std::uint32_t(rest.size() / 3));
    sample_lengths(body, lengths);
  }
  const MassFaces adjacency = mass_faces_of(face_masses, rest.size() / 3);

  positions.write(rest);
  mass_bodies.write(owners);
  first_masses.write(offsets);
  faces.write(face_masses);
  face_records.write(records);
  springs.write(spring_masses);
  spring_looks.write(looks);
  mass_face_ends.write(adjacency.ends);
  mass_faces.write(adjacency.faces);
  mass_offsets_ = std::move(offsets);
  face_count_ = records.size();
  spring_count_ = looks.size();
  typical_spring_ = median(std::move(lengths), 0.1f);
}

}  // namespace mercury::render
