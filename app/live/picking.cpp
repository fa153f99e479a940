// SPDX-License-Identifier: Apache-2.0
#include "app/live/picking.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/scene/group_layout.h"
#include "mercury/observables.h"

namespace mercury {
namespace {

using render::Vector3;

constexpr float far_away = std::numeric_limits<float>::infinity();

std::span<const float> floats(std::span<const Vec3> points) {
  return {points.empty() ? nullptr : &points.front().x, 3 * points.size()};
}

// Distance along the ray to a triangle, from either side; infinity if the ray misses it (Moeller and Trumbore 1997).
float distance_to_triangle(const render::Ray& ray, const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 ab = b - a, ac = c - a, across = ray.direction.cross(ac);
  const float determinant = ab.dot(across);
  if (determinant == 0 || !std::isfinite(determinant)) return far_away;
  const Vector3 from_a = ray.origin - a;
  const float u = from_a.dot(across) / determinant;
  if (!(u >= 0 && u <= 1)) return far_away;
  const Vector3 up = from_a.cross(ab);
  const float v = ray.direction.dot(up) / determinant;
  if (!(v >= 0 && u + v <= 1)) return far_away;
  const float t = ac.dot(up) / determinant;
  return t > 0 ? t : far_away;
}

struct Nearest {
  float along = far_away;  // distance along the ray [m]
  float apart = far_away;  // distance from the ray [m]
};

Nearest nearest_to_point(const render::Ray& ray, const Vector3& point) {
  const float along = (point - ray.origin).dot(ray.direction);
  if (!(along > 0)) return {};
  return {along, (ray.origin + along * ray.direction - point).norm()};
}

// The nearest points of the ray and the segment from a to b.
Nearest nearest_to_segment(const render::Ray& ray, const Vector3& a, const Vector3& b) {
  const Vector3 d = b - a, w = a - ray.origin;
  const float dd = d.squared_norm(), rd = ray.direction.dot(d), rw = ray.direction.dot(w), dw = d.dot(w);
  const float determinant = dd - rd * rd;
  // If the lines are parallel, any point is nearest.
  const float s = determinant > 1e-12f * dd ? std::clamp((rd * rw - dw) / determinant, 0.0f, 1.0f) : 0.0f;
  return nearest_to_point(ray, a + s * d);
}

// Where a ray enters a box; infinity if it misses it.
float distance_to_box(const render::Ray& ray, const render::Bounds& box) {
  if (box.empty()) return far_away;
  float enter = 0, leave = far_away;
  for (int axis = 0; axis < 3; ++axis) {
    const float inverse = 1 / ray.direction[axis];
    float a = (box.low[axis] - ray.origin[axis]) * inverse, b = (box.high[axis] - ray.origin[axis]) * inverse;
    if (std::isnan(a) || std::isnan(b)) continue;  // in the plane of a side
    if (a > b) std::swap(a, b);
    enter = std::max(enter, a);
    leave = std::min(leave, b);
  }
  // The tolerance lets a ray hit flat boxes despite rounding.
  return enter > leave + 1e-4f * (1 + std::abs(leave)) ? far_away : enter;
}

// How near the ray must pass a spring or mass.
float room_around(const Robot& robot, float wanted) {
  if (wanted > 0) return wanted;
  float longest = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(robot.springs.size(), 64); ++i)
    longest = std::max(longest, robot.springs[i].rest_length);
  return longest > 0 ? 0.12f * longest : 0.05f;
}

// Whether a ray misses a robot that is twice as large as a box, and turned.
bool misses(const render::Ray& ray, const render::Bounds& near) {
  const Vector3 reach = Vector3::all((near.high - near.low).norm());
  return distance_to_box(ray, {near.center() - reach, near.center() + reach}) == far_away;
}

// A robot whose box the ray meets.
struct Candidate {
  std::size_t index;
  float enter, room;  // [m]
};

// Nearest first.
std::vector<Candidate> candidates_on(const Snapshot& snapshot, std::span<const Vector3> offsets, const render::Ray& ray,
                                     const PickOptions& options) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < std::min(snapshot.robots->size(), offsets.size()); ++i) {
    if (!options.hidden.empty() && options.hidden[i]) continue;
    const float room = room_around(*snapshot.robots->robots[i].robot, options.radius);
    if (i < options.near.size() && !snapshot.telemetry[i].exploded && misses(ray, options.near[i])) continue;
    render::Bounds box = render::bounds_of(floats(snapshot.positions_of(i))).moved(offsets[i]);
    box.low -= render::Vector3::all(room);
    box.high += render::Vector3::all(room);
    const float enter = distance_to_box(ray, box);
    if (enter < far_away) candidates.push_back({i, enter, room});
  }
  std::ranges::stable_sort(candidates, {}, &Candidate::enter);
  return candidates;
}

// One robot that the ray may hit.
class Target {
 public:
  Target(const Robot& robot, std::span<const Vec3> positions, const Vector3& offset,
         const std::optional<render::Cut>& cut)
      : robot_(robot) {
    if (const auto frame = cut ? render::cut_frame(cut->axis, floats(robot.masses), floats(positions)) : std::nullopt) {
      cut_ = frame->plane_of(*cut);
      cut_.offset += cut_.normal.dot(offset);
    }
    points_.reserve(positions.size());
    for (const Vec3 p : positions) points_.push_back(Vector3(p) + offset);
  }

  void meet_skin(const render::Ray& ray, Hit& best) const {
    for (std::uint32_t i = 0; i < robot_.faces.size(); ++i) {
      const Face& face = robot_.faces[i];
      const float t = distance_to_triangle(ray, points_[face.a], points_[face.b], points_[face.c]);
      if (!(t < best.distance) || cut_.removes(ray.origin + t * ray.direction)) continue;
      best = {.face = i, .point = ray.origin + t * ray.direction, .distance = t};
      best.mass = nearest_of({face.a, face.b, face.c}, best.point);
    }
  }
  void meet_springs(const render::Ray& ray, float room, Hit& best) const {
    for (std::uint32_t i = 0; i < robot_.springs.size(); ++i) {
      const Spring& spring = robot_.springs[i];
      const Nearest near = nearest_to_segment(ray, points_[spring.a], points_[spring.b]);
      if (!(near.apart <= room && near.along < best.distance)) continue;
      const Vector3 point = ray.origin + near.along * ray.direction;
      if (cut_.removes(point)) continue;
      best = {.spring = i, .point = point, .distance = near.along};
      best.mass = nearest_of({spring.a, spring.b}, point);
    }
  }
  void meet_masses(const render::Ray& ray, float room, Hit& best) const {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Nearest near = nearest_to_point(ray, points_[i]);
      if (!(near.apart <= room && near.along < best.distance) || cut_.removes(points_[i])) continue;
      best = {.mass = static_cast<std::uint16_t>(i), .point = points_[i], .distance = near.along};
    }
  }

  // The spring along an edge of a face that is nearest to a point on the face.
  std::optional<std::uint32_t> spring_at(std::uint32_t face_index, const Vector3& point) const {
    const Face& face = robot_.faces[face_index];
    std::optional<std::uint32_t> found;
    float nearest = far_away;
    for (std::uint32_t i = 0; i < robot_.springs.size(); ++i) {
      const Spring& spring = robot_.springs[i];
      const auto on_face = [&](std::uint16_t mass) { return mass == face.a || mass == face.b || mass == face.c; };
      if (!on_face(spring.a) || !on_face(spring.b)) continue;
      const float apart = distance_to_segment(point, points_[spring.a], points_[spring.b]);
      if (apart >= nearest) continue;
      nearest = apart;
      found = i;
    }
    return found;
  }

 private:
  static float distance_to_segment(const Vector3& point, const Vector3& a, const Vector3& b) {
    const Vector3 d = b - a;
    const float s = d.squared_norm() > 0 ? std::clamp((point - a).dot(d) / d.squared_norm(), 0.0f, 1.0f) : 0.0f;
    return (a + s * d - point).norm();
  }
  std::uint16_t nearest_of(std::initializer_list<std::uint16_t> masses, const Vector3& point) const {
    return *std::ranges::min_element(masses, {},
                                     [&](std::uint16_t mass) { return (points_[mass] - point).squared_norm(); });
  }

  const Robot& robot_;
  render::CutPlane cut_;  // in the view's coordinates
  std::vector<Vector3> points_;
};

std::optional<CulpritSpring> culprit_spring_of(const Snapshot& snapshot, std::size_t index) {
  const Robot& robot = *snapshot.robots->robots[index].robot;
  const std::uint32_t spring_index = snapshot.telemetry[index].culprit_spring;
  if (spring_index >= robot.springs.size()) return std::nullopt;
  const Spring& spring = robot.springs[spring_index];
  return CulpritSpring{
      .index = spring_index, .a = spring.a, .b = spring.b, .figures = spring_details(snapshot, index, spring_index)};
}

}  // namespace

std::optional<Hit> pick(const Snapshot& snapshot, std::span<const Vector3> offsets, const render::Ray& ray,
                        const PickOptions& options) {
  std::optional<Hit> nearest;
  for (const auto& [i, enter, room] : candidates_on(snapshot, offsets, ray, options)) {
    if (nearest && enter > nearest->distance) break;
    const Robot& robot = *snapshot.robots->robots[i].robot;
    const Target target(robot, snapshot.positions_of(i), offsets[i], options.cut);
    Hit best{.distance = nearest ? nearest->distance : far_away};
    const bool skin = options.skin && !robot.faces.empty();
    if (skin) target.meet_skin(ray, best);
    if (options.springs || (!skin && !robot.springs.empty())) target.meet_springs(ray, room, best);
    if (options.masses || (!skin && robot.springs.empty())) target.meet_masses(ray, room, best);
    if (nearest ? best.distance >= nearest->distance : best.distance == far_away) continue;
    if (best.face) best.spring = target.spring_at(*best.face, best.point);
    best.robot = snapshot.robots->robots[i].id;
    best.index = i;
    nearest = best;
  }
  return nearest;
}

HitDetails describe(const Snapshot& snapshot, const Hit& hit) {
  HitDetails figures;
  const auto index = snapshot.robots->index_of(hit.robot);
  if (!index) return figures;
  const LiveRobot& live = snapshot.robots->robots[*index];
  const Robot& robot = *live.robot;
  figures.robot = live.name;
  if (hit.mass >= robot.masses.size()) return figures;
  const auto positions = snapshot.positions_of(*index);
  figures.mass.position = positions[hit.mass];
  if (const auto velocities = snapshot.velocities_of(*index); !velocities.empty())
    figures.mass.speed = length(velocities[hit.mass]);
  for (const Spring& spring : robot.springs) figures.mass.springs += spring.a == hit.mass || spring.b == hit.mass;
  if (hit.spring && *hit.spring < robot.springs.size()) figures.spring = spring_details(snapshot, *index, *hit.spring);
  return figures;
}

HitDetails::OfSpring spring_details(const Snapshot& snapshot, std::size_t index, std::uint32_t spring_index) {
  const LiveRobot& live = snapshot.robots->robots[index];
  const Robot& robot = *live.robot;
  const Spring& spring = robot.springs[spring_index];
  const Material material = snapshot.details.driven.of(index, materials_of(live))[spring.material];
  const auto positions = snapshot.positions_of(index);
  const double time = snapshot.telemetry[index].exploded ? snapshot.telemetry[index].exploded_at : snapshot.time;
  const MaterialNow now = materials_at({&material, 1}, snapshot.configuration.environment, time).front();
  HitDetails::OfSpring of{.material = spring.material, .rest_length = spring.rest_length};
  of.length = spring_length(spring, positions);
  of.strain = strain(of.length, spring.rest_length);
  of.activation = 1 - now.length_factor;
  of.force = spring_force(now.stiffness, stretch(spring, now, positions));
  of.material_name = name_of_material(robot, spring.material);
  return of;
}

std::vector<ExplodedRobot> exploded_robots(const Snapshot& snapshot, std::span<const render::Bounds> boxes) {
  std::vector<ExplodedRobot> exploded;
  for (std::size_t i = 0; i < std::min(snapshot.robots->size(), boxes.size()); ++i) {
    const Telemetry& telemetry = snapshot.telemetry[i];
    if (!telemetry.exploded) continue;
    const LiveRobot& robot = snapshot.robots->robots[i];
    exploded.push_back({.robot = robot.id,
                        .index = i,
                        .name = robot.name,
                        .time = telemetry.exploded_at,
                        .spring = culprit_spring_of(snapshot, i),
                        .body = robot.robot,
                        .offset = boxes[i].center() - rest_bounds(*robot.robot).center(),
                        .box = boxes[i]});
  }
  std::ranges::stable_sort(exploded, {}, &ExplodedRobot::time);
  return exploded;
}

}  // namespace mercury
