// SPDX-License-Identifier: Apache-2.0
#include "app/export/vxa_world.h"

#include <fmt/format.h>

#include <variant>

namespace mercury {
namespace {

// The shortest decimal number that is the same float: 0.6f is not to become 0.60000002.
double as_written(float value) { return std::stod(fmt::format("{}", value)); }

std::vector<std::string> lost_of(const Environment& environment) {
  std::vector<std::string> lost;
  const auto lose = [&](bool is_lost, const char* what) {
    if (is_lost) lost.emplace_back(what);
  };
  const bool fluid = has_face_forces(environment);
  lose(environment.gravity.x != 0 || environment.gravity.y != 0, "gravity has no parts along x and y there");
  lose(fluid && environment.gravity.z != 0, "there is no gravity in water there");
  lose(fluid && has_ground(environment), "there is no floor under water there");
  lose(std::holds_alternative<FaceDrag>(environment.water),
       "water there has a normal drag alone, as resistive water has; it gets the drag coefficient");
  if (const auto* water = std::get_if<ResistiveDrag>(&environment.water))
    lose(water->tangential_coefficient != 0 || water->added_mass_coefficient != 0,
         "water there has no tangential drag, added mass and buoyancy");
  if (const auto* water = std::get_if<PointDrag>(&environment.water))
    lose(water->point_drag != 0, "water there acts on faces alone; the drag of masses is left out");
  const Vec3 flow = flow_of(environment);
  lose(flow.x != 0 || flow.y != 0 || flow.z != 0, "water there does not flow");
  return lost;
}

}  // namespace

VxaWorld vxa_world(const Environment& environment, double damping, std::optional<double> seconds) {
  VxaWorld world{.settings = {.environment = has_face_forces(environment) ? "resistive"
                                             : has_ground(environment)    ? "land"
                                                                          : "ocean-simple",
                              .gravity = as_written(environment.gravity.z),
                              .stiffness_scale = as_written(environment.stiffness_scale),
                              .self_collision = has_contacts(environment),
                              .damping = damping,
                              .seconds = seconds},
                 .lost = lost_of(environment)};
  if (const auto* plane = std::get_if<Plane>(&environment.ground)) {
    world.settings.friction = as_written(plane->friction);
    world.settings.static_friction = as_written(plane->static_friction);
  }
  const auto coefficient = [](float own, float density) { return as_written(own) * as_written(density) / 1000; };
  if (const auto* water = std::get_if<ResistiveDrag>(&environment.water))
    world.settings.drag_coefficient = coefficient(water->normal_coefficient, water->density);
  if (const auto* water = std::get_if<FaceDrag>(&environment.water))
    world.settings.drag_coefficient = coefficient(water->drag_coefficient, water->density);
  return world;
}

}  // namespace mercury
