// SPDX-License-Identifier: Apache-2.0
#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace mercury::render {
namespace {

constexpr float steepest = 1.5533f;  // [rad], 89 degrees

struct Axes {
  Vector3 right, up, back;
};

Axes axes_of(const Camera& camera) {
  const Vector3 back = (camera.eye - camera.target).normalized();
  Vector3 right = camera.up.cross(back);
  if (right.norm() < 1e-4f) right = Vector3::unit(1).cross(back);
  right = right.normalized();
  return {right, back.cross(right), back};
}

// The free part of the picture along one axis, as tangents from the line of sight.
struct Span {
  float low, high;
};

struct Interval {
  float low = -1e30f, high = 1e30f;
};

// The shifts of the target along an axis for which all points lie in the free part. Seen from the distance d, they are
// the interval from low - free.high d to high - free.low d.
class Shifts {
 public:
  Shifts(std::span<const Vector3> points, int axis, Span free) : free_(free) {
    for (const Vector3& p : points) {
      at_zero_.low = std::max(at_zero_.low, p[axis] + free.high * p.z);
      at_zero_.high = std::min(at_zero_.high, p[axis] + free.low * p.z);
    }
  }
  // From which there is one.
  float least_distance() const { return (at_zero_.low - at_zero_.high) / (free_.high - free_.low); }
  float middle(float distance) const {
    return 0.5f * (at_zero_.low + at_zero_.high - (free_.high + free_.low) * distance);
  }

 private:
  Span free_;
  Interval at_zero_;
};

std::vector<Vector3> corners_of(std::span<const Bounds> boxes) {
  std::vector<Vector3> corners;
  for (const Bounds& box : boxes)
    for (int corner = 0; corner < 8 && !box.empty(); ++corner)
      corners.emplace_back((corner & 1) ? box.high.x : box.low.x, (corner & 2) ? box.high.y : box.low.y,
                           (corner & 4) ? box.high.z : box.low.z);
  return corners;
}

}  // namespace

Vector2 disc_sample(int i, int count) {
  const float radius = std::sqrt((float(i) + 0.5f) / float(count)), angle = 2.39996323f * float(i);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

Vector2 square_sample(int i) {
  const double n = i + 0.5;
  return {float(std::fmod(0.7548776662466927 * n, 1.0)), float(std::fmod(0.5698402909980532 * n, 1.0))};
}

void Bounds::extend(const Vector3& point) {
  low = smallest(low, point);
  high = largest(high, point);
}

void Bounds::extend(const Bounds& other) {
  low = smallest(low, other.low);
  high = largest(high, other.high);
}

Bounds Bounds::moved(const Vector3& offset) const { return empty() ? *this : Bounds{low + offset, high + offset}; }

Bounds bounds_of(std::span<const float> points) {
  Bounds bounds;
  for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
    const Vector3 point(points[i], points[i + 1], points[i + 2]);
    if (point.is_finite()) bounds.extend(point);
  }
  return bounds;
}

Bounds bounds_of(std::span<const Bounds> boxes) {
  Bounds all;
  for (const Bounds& box : boxes)
    if (!box.empty()) all.extend(box);
  return all;
}

Matrix4 Camera::view() const {
  const Axes axes = axes_of(*this);
  Matrix4 m = Matrix4::identity();
  const Vector3 rows[] = {axes.right, axes.up, axes.back};
  for (int row = 0; row < 3; ++row) {
    m.set_row(row, rows[row]);
    m(row, 3) = -rows[row].dot(eye);
  }
  return m;
}

Matrix4 Camera::projection(float aspect) const {
  const float scale = 1 / std::tan(0.5f * field_of_view);
  Matrix4 m = Matrix4{};
  m(0, 0) = scale / aspect;
  m(1, 1) = scale;
  m(0, 2) = scale / aspect * shift.x;
  m(1, 2) = scale * shift.y;
  m(2, 2) = near / (far - near);
  m(2, 3) = near * far / (far - near);
  m(3, 2) = -1;
  return m;
}

Vector3 Camera::project(const Vector3& point, int width, int height) const {
  const Vector4 seen = view() * Vector4(point, 1);
  const Vector4 clip = projection(float(width) / float(height)) * seen;
  return {float(width) * 0.5f * (1 + clip.x / clip.w), float(height) * 0.5f * (1 - clip.y / clip.w), -seen.z};
}

Ray Camera::ray(float x, float y, int width, int height) const {
  const Axes axes = axes_of(*this);
  const float half = std::tan(0.5f * field_of_view);
  const float across = (2 * x / float(width) - 1) * half * float(width) / float(height);
  const float upward = (1 - 2 * y / float(height)) * half;
  return {eye, ((across + shift.x) * axes.right + (upward + shift.y) * axes.up - axes.back).normalized()};
}

Camera Camera::seen_through_lens(int i, int height) const {
  const Axes axes = axes_of(*this);
  const Vector2 on_lens = lens.radius * disc_sample(i, lens.samples);
  const Vector3 moved = on_lens.x * axes.right + on_lens.y * axes.up;
  const float pixel = 2 * std::tan(0.5f * field_of_view) / float(height);
  Camera seen = *this;
  seen.lens = {};
  seen.eye += moved;
  seen.target += moved;
  // What is in focus stays where it is in the picture.
  seen.shift = shift - (1 / lens.focus) * on_lens + pixel * (square_sample(i) - Vector2(0.5f, 0.5f));
  return seen;
}

Camera Orbit::camera() const {
  const Vector3 direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                          std::sin(elevation));
  Camera camera;
  camera.target = target;
  camera.eye = target + distance * direction;
  // Derivative of `direction` by the elevation: points up in the picture even when the camera looks straight down.
  camera.up =
      Vector3(-std::sin(elevation) * std::cos(azimuth), -std::sin(elevation) * std::sin(azimuth), std::cos(elevation));
  camera.field_of_view = field_of_view;
  camera.near = std::max(1e-3f, 0.01f * distance);
  camera.far = 200 * distance;
  return camera;
}

void Orbit::turn(float azimuth_change, float elevation_change) {
  azimuth = std::remainder(azimuth + azimuth_change, 2 * std::numbers::pi_v<float>);
  elevation = std::clamp(elevation + elevation_change, -steepest, steepest);
}

void Orbit::pan(float right, float up) {
  const Axes axes = axes_of(camera());
  const float height = 2 * distance * std::tan(0.5f * field_of_view);
  target += height * (right * axes.right + up * axes.up);
}

void Orbit::zoom(float factor) { distance = std::clamp(distance * factor, 1e-3f, 1e5f); }

void Orbit::frame(const Bounds& bounds, float aspect, float margin, const Insets& free) {
  frame(std::span(&bounds, 1), aspect, margin, free);
}

void Orbit::frame(std::span<const Bounds> boxes, float aspect, float margin, const Insets& free) {
  const std::vector<Vector3> corners = corners_of(boxes);
  if (corners.empty()) return;
  target = bounds_of({corners[0].data(), 3 * corners.size()}).center();
  distance = 1;
  const Axes axes = axes_of(camera());
  const float half = std::tan(0.5f * field_of_view);
  std::vector<Vector3> seen;  // corners along the picture's axes, from the target
  float nearest = -1e30f;
  for (const Vector3& corner : corners) {
    const Vector3 p = corner - target;
    seen.push_back({p.dot(axes.right), p.dot(axes.up), p.dot(axes.back)});
    nearest = std::max(nearest, seen.back().z);
  }
  const Shifts across(seen, 0, {half * aspect * (2 * free.left - 1), half * aspect * (1 - 2 * free.right)});
  const Shifts upward(seen, 1, {half * (2 * free.bottom - 1), half * (1 - 2 * free.top)});
  distance = std::max(1e-3f, margin * std::max({nearest, across.least_distance(), upward.least_distance()}));
  target += across.middle(distance) * axes.right + upward.middle(distance) * axes.up;
}

Orbit top_view(const Bounds& bounds, float aspect) {
  Orbit orbit;
  orbit.azimuth = -0.5f * std::numbers::pi_v<float>;
  orbit.elevation = 0.5f * std::numbers::pi_v<float>;
  orbit.frame(bounds, aspect);
  return orbit;
}

Orbit turntable(Orbit start, double time, double period) {
  start.azimuth += float(2 * std::numbers::pi * std::remainder(time / period, 1.0));
  return start;
}

void follow(Orbit& orbit, const Vector3& target, double dt, double lag) {
  orbit.target += float(1 - std::exp(-dt / lag)) * (target - orbit.target);
}

}  // namespace mercury::render
