// SPDX-License-Identifier: Apache-2.0
#include "app/scene/coloring.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/scene/appearance.h"
#include "app/scene/face_forces.h"
#include "app/scene/materials_now.h"
#include "mercury/error.h"

namespace mercury {
namespace {

struct Quantity {
  ColorBy by;
  std::string_view name, unit;
  render::Colormap map;
  bool is_signed;
  float least;  // the scale's smallest end
};

constexpr std::array<Quantity, 8> quantities{{
    {ColorBy::material, "material", "", render::Colormap::viridis, false, 1},
    {ColorBy::activation, "activation", "%", render::Colormap::diverging, true, 1},
    {ColorBy::strain, "strain", "%", render::Colormap::diverging, true, 1},
    {ColorBy::force, "force", "N", render::Colormap::diverging, true, 0.01f},
    {ColorBy::speed, "speed", "m/s", render::Colormap::viridis, false, 0.001f},
    {ColorBy::pressure, "pressure", "Pa", render::Colormap::turbo, false, 0.001f},
    {ColorBy::energy, "energy", "mJ", render::Colormap::viridis, false, 0.01f},
    {ColorBy::stiffness, "stiffness", "N/m", render::Colormap::viridis, false, 1},
}};

const Quantity& quantity(ColorBy by) { return quantities[static_cast<std::size_t>(by)]; }

float contraction(const MaterialNow& material) { return 100 * (1 - material.length_factor); }

float spring_value(ColorBy by, const Spring& spring, const MaterialNow& material, std::span<const Vec3> positions) {
  if (by == ColorBy::activation) return contraction(material);
  if (by == ColorBy::stiffness) return material.stiffness;
  const float length_now = length(positions[spring.b] - positions[spring.a]);
  if (by == ColorBy::strain) return 100 * (length_now / spring.rest_length - 1);
  const float stretch = length_now - spring.rest_length * material.length_factor;
  if (by == ColorBy::energy) return 1000 * material.stiffness * stretch * stretch / 2;
  return material.stiffness * stretch;
}

// Each mass gets the mean of its springs.
void average_to_masses(const Robot& robot, std::span<const float> spring, std::span<float> mass) {
  std::vector<int> counts(robot.masses.size(), 0);
  for (std::size_t i = 0; i < robot.springs.size(); ++i)
    for (const std::uint16_t end : {robot.springs[i].a, robot.springs[i].b}) {
      mass[end] += spring[i];
      ++counts[end];
    }
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] > 0) mass[i] /= static_cast<float>(counts[i]);
}

}  // namespace

std::string_view name_of(ColorBy by) { return quantity(by).name; }

ColorBy color_named(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Quantity& q : quantities) {
    if (q.name == name) return q.by;
    names.push_back(q.name);
  }
  throw InputError("--color", fmt::format("\"{}\" is not accepted; give {}", name, fmt::join(names, ", ")));
}

GroupState read_state(const Simulation& simulation) {
  GroupState state{.time = simulation.time(),
                   .positions = std::vector<Vec3>(simulation.mass_count()),
                   .velocities = std::vector<Vec3>(simulation.mass_count())};
  simulation.read_positions(state.positions);
  simulation.read_velocities(state.velocities);
  return state;
}

Coloring::Coloring(const Simulation& simulation, ColorBy by) : simulation_(simulation), by_(by) {
  const Environment& environment = simulation.configuration().environment;
  if (by == ColorBy::pressure && !has_face_forces(environment))
    throw InputError("--color",
                     fmt::format("pressure: {} has no drag on faces; it applies to ocean", name_of(environment)));
  face_offsets_.push_back(0);
  spring_offsets_.push_back(0);
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    const Robot& robot = simulation.robot(i);
    face_offsets_.push_back(face_offsets_.back() + robot.faces.size());
    spring_offsets_.push_back(spring_offsets_.back() + robot.springs.size());
    if (by == ColorBy::activation) face_materials_.push_back(face_materials(robot));
  }
}

ColorValues Coloring::values(const GroupState& state) const {
  ColorValues values;
  const auto is = [&](std::initializer_list<ColorBy> any) {
    return std::find(any.begin(), any.end(), by_) != any.end();
  };
  if (is({ColorBy::activation, ColorBy::pressure})) values.face.resize(face_offsets_.back());
  const bool of_springs = is({ColorBy::strain, ColorBy::force, ColorBy::energy, ColorBy::stiffness});
  if (of_springs || by_ == ColorBy::activation) values.spring.resize(spring_offsets_.back());
  if (of_springs || by_ == ColorBy::speed) values.mass.resize(state.positions.size());
  tbb::parallel_for(std::size_t{0}, simulation_.size(), [&](std::size_t i) { fill(values, i, state); });
  return values;
}

void Coloring::fill(ColorValues& values, std::size_t robot, const GroupState& state) const {
  const Robot& body = simulation_.robot(robot);
  const std::size_t first_mass = simulation_.mass_offsets()[robot];
  const auto positions = std::span(state.positions).subspan(first_mass, body.masses.size());
  const auto velocities = std::span(state.velocities).subspan(first_mass, body.masses.size());
  const auto part = [](std::vector<float>& all, std::size_t first, std::size_t count) {
    return all.empty() ? std::span<float>() : std::span(all).subspan(first, count);
  };
  const auto face = part(values.face, face_offsets_[robot], body.faces.size());
  const auto mass = part(values.mass, first_mass, body.masses.size());
  const auto spring = part(values.spring, spring_offsets_[robot], body.springs.size());
  const Environment& environment = simulation_.configuration().environment;

  const std::vector<MaterialNow> materials = materials_at(simulation_, robot, state.time);
  for (std::size_t i = 0; i < spring.size(); ++i)
    spring[i] = spring_value(by_, body.springs[i], materials[body.springs[i].material], positions);
  if (by_ == ColorBy::speed)
    for (std::size_t i = 0; i < mass.size(); ++i) mass[i] = length(velocities[i]);
  else if (!mass.empty())
    average_to_masses(body, spring, mass);
  for (std::size_t i = 0; i < face.size(); ++i) {
    if (by_ == ColorBy::activation) {
      face[i] = contraction(materials[face_materials_[robot][i]]);
    } else {
      const FaceForce force = face_force(environment, body.faces[i], positions, velocities);
      face[i] = force.area > 0 ? length(force.drag + force.lift) / force.area : 0;
    }
  }
}

float round_up(float value) {
  const float power = std::pow(10.0f, std::floor(std::log10(value)));
  for (const float step : {1.0f, 2.0f, 5.0f, 10.0f})
    if (step * power >= value * (1 - 1e-6f)) return step * power;
  return 10 * power;
}

GrowingScale::GrowingScale(ColorBy by, std::optional<std::pair<float, float>> fixed)
    : by_(by), fixed_(fixed.has_value()) {
  const Quantity& q = quantity(by);
  scale_ = {.low = q.is_signed ? -q.least : 0, .high = q.least, .map = q.map};
  if (fixed) std::tie(scale_.low, scale_.high) = *fixed;
}

void GrowingScale::fit(const ColorValues& values) {
  if (fixed_ || by_ == ColorBy::material) return;
  // Faces and masses are what the skin shows; a few springs go far beyond them.
  const std::vector<float>& shown = !values.face.empty()   ? values.face
                                    : !values.mass.empty() ? values.mass
                                                           : values.spring;
  float largest = 0;
  for (const float value : shown)
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  if (largest <= scale_.high) return;
  scale_.high = round_up(largest);
  if (quantity(by_).is_signed) scale_.low = -scale_.high;
}

render::Legend GrowingScale::legend() const {
  return {.title = std::string(quantity(by_).name), .unit = std::string(quantity(by_).unit), .scale = scale_};
}

}  // namespace mercury
