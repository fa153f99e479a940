// SPDX-License-Identifier: Apache-2.0
#include "app/scene/arrows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "app/scene/color_scale.h"
#include "app/scene/group_layout.h"
#include "mercury/error.h"
#include "mercury/observables.h"

namespace mercury {
namespace {

// Of strong arrows. Muscles are terracotta, ochre, yellow, teal, blue and violet.
constexpr render::Color drag_color = render::rgb(0x3dff4e);
constexpr render::Color lift_color = render::rgb(0x3d8bff);
constexpr render::Color velocity_color = render::rgb(0xffffff);
constexpr render::Color gravity_color = render::rgb(0xce93d8);
constexpr render::Color contact_color = render::rgb(0xff3dc2);
constexpr render::Color force_color = render::rgb(0xffb23d);
constexpr render::Color weak_color = render::rgb(0xdfe6e4);

// Whether the arrow with this index is drawn: the same ones at any time, and more of them with a higher density.
bool is_drawn(std::size_t index, float density) {
  std::uint32_t x = static_cast<std::uint32_t>(index) * 0x9e3779b9u;  // spreads neighbors (Knuth's multiplicative hash)
  x ^= x >> 15;
  x *= 0x85ebca6bu;
  return static_cast<float>((x ^ (x >> 13)) >> 8) < density * static_cast<float>(1u << 24);
}

// The largest arrow of each robot, and of these the median, so that one strong robot does not make the arrows of all
// others invisible.
float largest_of(std::span<const render::Arrow> arrows, std::size_t robots) {
  std::vector<float> largest(robots);
  for (const render::Arrow& arrow : arrows)
    if (arrow.vector.is_finite()) largest[arrow.body] = std::max(largest[arrow.body], arrow.vector.norm());
  std::erase(largest, 0.0f);
  if (largest.empty()) return 0;
  const auto middle = largest.begin() + static_cast<std::ptrdiff_t>(largest.size() / 2);
  std::ranges::nth_element(largest, middle);
  return *middle;
}

// Makes an arrow of the value `full` as long as `longest`, none longer than twice that, and colors them by their
// values.
void scale(std::vector<render::Arrow>& arrows, float full, float longest, float threshold) {
  if (!(full > 0)) return arrows.clear();
  std::erase_if(arrows, [&](const render::Arrow& arrow) { return arrow.vector.norm() < threshold * full; });
  for (render::Arrow& arrow : arrows) {
    const float share = arrow.vector.norm() / full;
    arrow.vector *= longest / full * (share > 2 ? 2 / share : 1);
    arrow.color = render::mix(weak_color, arrow.color, std::min(std::sqrt(share), 1.0f));
  }
}

float mean_size(const Simulation& simulation) {
  float sum = 0;
  for (std::size_t i = 0; i < simulation.size(); ++i) sum += 2 * rest_bounds(simulation.robot(i)).radius();
  return simulation.size() > 0 ? sum / static_cast<float>(simulation.size()) : 1;
}

}  // namespace

Arrows::Arrows(const Simulation& simulation, ArrowKinds kinds)
    : simulation_(simulation), kinds_(kinds), longest_(0.5f * kinds.length * mean_size(simulation)) {
  const Environment& environment = simulation.configuration().environment;
  if (kinds.contact && !has_ground(environment))
    throw ParameterError("show", fmt::format("contact: {} has no ground; it applies to land", name_of(environment)));
  if ((kinds.drag || kinds.lift) && !has_face_forces(environment))
    throw ParameterError("show", fmt::format("{}: {} has no drag on faces; it applies to ocean",
                                             kinds.drag ? "drag" : "lift", name_of(environment)));
}

void Arrows::Gauge::fit(float largest) {
  if (largest > most) most = round_up(largest);
}

void Arrows::add_faces(std::size_t robot, const GroupState& state, std::vector<render::Arrow>& drag,
                       std::vector<render::Arrow>& lift) const {
  const Robot& body = simulation_.robot(robot);
  const auto positions = masses_of(simulation_, robot, state.positions);
  const auto velocities = masses_of(simulation_, robot, state.velocities);
  const Environment& environment = simulation_.configuration().environment;
  const std::vector<std::uint16_t> behind = masses_behind_faces(body, environment);
  for (std::size_t i = 0; i < body.faces.size(); ++i) {
    if (!is_drawn(i, kinds_.density)) continue;
    const FaceForce force = face_force(environment, body.faces[i], positions, velocities, behind[i]);
    const auto index = static_cast<std::uint32_t>(robot);
    if (kinds_.drag) drag.push_back({index, render::Vector3(force.center), render::Vector3(force.drag), drag_color});
    if (kinds_.lift) lift.push_back({index, render::Vector3(force.center), render::Vector3(force.lift), lift_color});
  }
}

void Arrows::add_contacts(std::size_t robot, const GroupState& state, std::vector<render::Arrow>& contacts) const {
  const std::size_t first = simulation_.mass_offsets()[robot];
  for (const FloorForce& contact : floor_forces(simulation_, robot, state))
    if (is_drawn(contact.mass, kinds_.density))
      contacts.push_back({static_cast<std::uint32_t>(robot), render::Vector3(state.positions[first + contact.mass]),
                          render::Vector3(contact.force), contact_color});
}

void Arrows::add_forces(std::size_t robot, const GroupState& state, std::vector<render::Arrow>& forces) const {
  const Robot& body = simulation_.robot(robot);
  const std::vector<Vec3> on_masses = net_forces(simulation_, robot, state);
  const std::size_t first = simulation_.mass_offsets()[robot];
  for (std::size_t i = 0; i < body.masses.size(); ++i)
    if (is_drawn(i, kinds_.density))
      forces.push_back({static_cast<std::uint32_t>(robot), render::Vector3(state.positions[first + i]),
                        render::Vector3(on_masses[i]), force_color});
}

std::vector<render::Arrow> Arrows::at(const GroupState& state, std::span<const Telemetry> telemetry) {
  std::vector<render::Arrow> forces, lifts, velocities;
  std::vector<render::Arrow> gravities, contacts, nets;
  const render::Vector3 gravity = render::Vector3(gravity_of(simulation_.configuration().environment));
  for (std::size_t i = 0; i < simulation_.size(); ++i) {
    if (telemetry[i].exploded) continue;
    if (kinds_.drag || kinds_.lift) add_faces(i, state, forces, lifts);
    if (kinds_.contact) add_contacts(i, state, contacts);
    if (kinds_.force) add_forces(i, state, nets);
    const render::Vector3 middle = render::Vector3(telemetry[i].center_of_mass);
    const auto index = static_cast<std::uint32_t>(i);
    if (kinds_.velocity) velocities.push_back({index, middle, render::Vector3(telemetry[i].velocity), velocity_color});
    if (kinds_.gravity && gravity.norm() > 0)
      gravities.push_back({index, middle, longest_ * gravity.normalized(), gravity_color});
  }
  forces.insert(forces.end(), lifts.begin(), lifts.end());
  const auto fit = [&](std::vector<render::Arrow>& arrows, Gauge& gauge) {
    gauge.fit(largest_of(arrows, simulation_.size()));
    scale(arrows, gauge.most, longest_, kinds_.threshold);
  };
  fit(forces, force_);
  fit(velocities, velocity_);
  fit(contacts, contact_);
  fit(nets, net_);
  for (const auto* more : {&velocities, &gravities, &contacts, &nets})
    forces.insert(forces.end(), more->begin(), more->end());
  std::erase_if(forces, [](const render::Arrow& arrow) { return !arrow.vector.is_finite(); });
  return forces;
}

std::string Arrows::key() const {
  std::string text;
  const auto add = [&](bool shown, const std::string& name, const Gauge& gauge) {
    if (!shown || gauge.most <= 0) return;
    text += fmt::format("{}{}: {:.2g} m = {:g} {}", text.empty() ? "" : "   ", name, longest_, gauge.most, gauge.unit);
  };
  add(kinds_.drag && kinds_.lift, "drag, lift", force_);
  add(kinds_.drag && !kinds_.lift, "drag", force_);
  add(kinds_.lift && !kinds_.drag, "lift", force_);
  add(kinds_.contact, contact_.name, contact_);
  add(kinds_.force, net_.name, net_);
  add(kinds_.velocity, velocity_.name, velocity_);
  return text;
}

}  // namespace mercury
