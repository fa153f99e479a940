// SPDX-License-Identifier: Apache-2.0
#include "render/body_data.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace mercury::render {
namespace {

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

std::shared_ptr<const PreparedBody> prepare_body(const Body& body, std::size_t index) {
  validate(body, index);
  auto prepared = std::make_shared<PreparedBody>();
  prepared->rest_positions.assign(body.rest_positions.begin(), body.rest_positions.end());
  prepared->faces = copy_of(body.faces);
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
