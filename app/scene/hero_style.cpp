// SPDX-License-Identifier: Apache-2.0
#include "app/scene/hero_style.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "app/scene/camera_controller.h"

namespace mercury {
namespace {

using render::Vector3;

constexpr float pi = std::numbers::pi_v<float>;

// Where a robot is, in sizes of the first one and from its middle, and how it is turned.
struct Place {
  float right, up, back;
  float turn, tilt;  // about the vertical, then about the line across [rad]
};

// In water they hang in all heights, and tilt.
constexpr std::array<Place, 10> in_water{{{0, 0, 0, 0, 0},
                                          {-1.9f, 0.15f, 2.3f, 0.6f, 0.30f},
                                          {2.0f, -0.75f, 3.1f, 1.9f, -0.35f},
                                          {1.3f, 1.15f, 4.4f, 2.6f, 0.2f},
                                          {-3.1f, -1.2f, 4.6f, 0.2f, -0.2f},
                                          {-1.5f, 1.7f, 5.9f, 1.2f, 0.4f},
                                          {3.9f, 0.9f, 5.6f, 0.9f, 0.25f},
                                          {0.1f, -1.9f, 6.8f, 2.2f, -0.3f},
                                          {-5.0f, 1.1f, 7.4f, 1.5f, 0.1f},
                                          {3.3f, 2.6f, 8.6f, 0.4f, -0.25f}}};
// On land they go nearly the same way.
constexpr std::array<Place, 7> on_land{{{0, 0, 0, 0, 0},
                                        {-1.15f, 0, 1.35f, 0.15f, 0},
                                        {1.05f, 0, 2.2f, -0.2f, 0},
                                        {-0.55f, 0, 3.6f, 0.3f, 0},
                                        {2.3f, 0, 4.4f, 0.1f, 0},
                                        {-2.6f, 0, 4.6f, -0.1f, 0},
                                        {0.9f, 0, 6.4f, 0.2f, 0}}};

std::span<const Place> places_of(const Environment& environment) {
  if (has_ground(environment)) return on_land;
  return in_water;
}

Vec3 turned(Vec3 p, const Place& place) {
  const float ct = std::cos(place.tilt), st = std::sin(place.tilt), c = std::cos(place.turn), s = std::sin(place.turn);
  const Vec3 tilted{p.x, ct * p.y - st * p.z, st * p.y + ct * p.z};
  return {c * tilted.x - s * tilted.y, s * tilted.x + c * tilted.y, tilted.z};
}

}  // namespace

void set_hero_style(ViewSettings& view, const Environment& environment) {
  const bool land = has_ground(environment);
  const CameraPlan usual;
  view.hero = true;
  view.smooth = true;
  if (view.aperture == 0) view.aperture = land ? 0.022f : 0.05f;
  if (view.camera.mode == usual.mode) {
    view.camera.mode = CameraMode::follow;
    view.camera.robot = "0";
  }
  if (!view.camera.azimuth) view.camera.azimuth = land ? -0.75f : -1.9f;
  if (!view.camera.elevation) view.camera.elevation = land ? 0.09f : -0.12f;
  if (view.camera.zoom == usual.zoom) view.camera.zoom = land ? 1.6f : 2.0f;
}

void add_siblings(std::vector<std::shared_ptr<const Robot>>& robots, const Environment& environment) {
  const std::span<const Place> places = places_of(environment);
  const std::size_t given = robots.size();
  for (std::size_t i = given; i < places.size() && given > 0; ++i) {
    Robot sibling = *robots[i % given];
    for (Vec3& mass : sibling.masses) mass = turned(mass, places[i]);
    for (Vec3& velocity : sibling.velocity) velocity = turned(velocity, places[i]);
    robots.push_back(std::make_shared<const Robot>(std::move(sibling)));
  }
}

std::vector<Vector3> hero_layout(std::span<const Room> rooms, const ViewSettings& view,
                                 const Environment& environment) {
  const bool land = has_ground(environment);
  const std::span<const Place> places = places_of(environment);
  const render::Orbit orbit = direction_of(view.camera, land);
  const Vector3 right = picture_axes(orbit).right;
  const Vector3 back(-std::cos(orbit.azimuth), -std::sin(orbit.azimuth), 0);
  std::vector<Vector3> offsets;
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    const Place& place = places[i % places.size()];
    const float size = 2 * std::max(rooms.front().radius, rooms.front().half_height);
    const auto round = static_cast<float>(i / places.size());  // more robots than places stand farther away
    Vector3 middle = size * (place.right * right + (place.back + 9 * round) * back);
    middle.z += size * place.up;
    Vector3 own = rooms[i].center;
    if (land) own.z = 0;
    offsets.push_back(middle - own);
  }
  return offsets;
}

render::KeyLight hero_light(const ViewSettings& view, const Environment& environment) {
  const bool land = has_ground(environment);
  const float away = direction_of(view.camera, land).azimuth + pi + (land ? 0.42f : 0.25f);
  const float height = land ? 0.15f : 0.95f;
  return {.to_key = {std::cos(height) * std::cos(away), std::cos(height) * std::sin(away), std::sin(height)}};
}

}  // namespace mercury
