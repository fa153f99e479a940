#include "app/group_camera.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace mercury {
namespace {

// The eye's axes in the world, as rows: right, up and forward.
Eigen::Matrix3f axes_of(const render::Orbit& direction) {
  const render::Camera camera = direction.camera();
  const Eigen::Vector3f forward = (camera.target - camera.eye).normalized();
  const Eigen::Vector3f right = forward.cross(camera.up).normalized();
  Eigen::Matrix3f axes;
  axes << right.transpose(), right.cross(forward).transpose(), forward.transpose();
  return axes;
}

// The four sides of the field of view pushed against the boxes, in the eye's axes (x right, y up, z forward): the
// largest x - tan_x z, and so on.
struct Sides {
  float left = -INFINITY, right = -INFINITY, bottom = -INFINITY, top = -INFINITY;
  float tan_x = 1, tan_y = 1;

  bool empty() const { return !std::isfinite(left); }

  // A point is inside when |x - eye x| <= tan_x (z - eye z), and likewise y: the two sides' sum bounds the eye's z, their
  // difference centres it.
  Eigen::Vector3f best_eye() const {
    return {(right - left) / 2, (top - bottom) / 2,
            std::min(-(left + right) / (2 * tan_x), -(bottom + top) / (2 * tan_y))};
  }
  // The largest z of an eye at this x and y that sees all.
  float nearest(float x, float y) const {
    return std::min({(x - right) / tan_x, (-x - left) / tan_x, (y - top) / tan_y, (-y - bottom) / tan_y});
  }
};

template <class Visit>
void for_each_corner(const render::Bounds& box, Visit visit) {
  for (int i = 0; i < 8; ++i)
    visit(Eigen::Vector3f(i & 1 ? box.high.x() : box.low.x(), i & 2 ? box.high.y() : box.low.y(),
                          i & 4 ? box.high.z() : box.low.z()));
}

Sides sides_of(std::span<const render::Bounds> boxes, const Eigen::Matrix3f& axes, float tan_y, float aspect) {
  Sides sides{.tan_x = tan_y * aspect, .tan_y = tan_y};
  for (const render::Bounds& box : boxes) {
    if (box.empty()) continue;
    for_each_corner(box, [&](const Eigen::Vector3f& corner) {
      const Eigen::Vector3f p = axes * corner;
      sides.right = std::max(sides.right, p.x() - sides.tan_x * p.z());
      sides.left = std::max(sides.left, -p.x() - sides.tan_x * p.z());
      sides.top = std::max(sides.top, p.y() - sides.tan_y * p.z());
      sides.bottom = std::max(sides.bottom, -p.y() - sides.tan_y * p.z());
    });
  }
  return sides;
}

// The eye moved right and up until the picture's margins left over on opposite sides are alike.
Eigen::Vector3f balanced(std::span<const render::Bounds> boxes, const Eigen::Matrix3f& axes, Eigen::Vector3f eye) {
  for (int pass = 0; pass < 12; ++pass) {
    Eigen::Array2f most = Eigen::Array2f::Constant(-INFINITY), least = Eigen::Array2f::Constant(INFINITY);
    float depth = INFINITY;
    for (const render::Bounds& box : boxes) {
      if (box.empty()) continue;
      for_each_corner(box, [&](const Eigen::Vector3f& corner) {
        const Eigen::Vector3f p = axes * corner - eye;
        most = most.max(p.head<2>().array() / p.z());
        least = least.min(p.head<2>().array() / p.z());
        depth = std::min(depth, p.z());
      });
    }
    // By the depth of the nearest, so that no pass goes too far.
    eye.head<2>() += (0.5f * depth * (most + least)).matrix();
  }
  return eye;
}

// Mean depth of the boxes' middles before the eye, all in the eye's axes.
float mean_depth(std::span<const render::Bounds> boxes, const Eigen::Matrix3f& axes, float eye_z) {
  float sum = 0;
  int count = 0;
  for (const render::Bounds& box : boxes) {
    if (box.empty()) continue;
    sum += axes.row(2).dot(box.center()) - eye_z;
    ++count;
  }
  return sum / static_cast<float>(count);
}

}  // namespace

GroupCamera::GroupCamera(const render::Orbit& direction, float aspect, float margin)
    : orbit_(direction), aspect_(aspect), margin_(margin) {}

render::Camera GroupCamera::follow(std::span<const render::Bounds> robots, double dt) {
  constexpr double lag = 0.8;              // [s]
  constexpr float least_margin = 1.02f;    // what the lag leaves of the margin
  const Eigen::Matrix3f axes = axes_of(orbit_);
  const float tan_y = std::tan(orbit_.field_of_view / 2);
  const Sides sides = sides_of(robots, axes, tan_y / margin_, aspect_);
  if (sides.empty()) return orbit_.camera();
  const Eigen::Vector3f wanted = balanced(robots, axes, sides.best_eye());
  if (!eye_) eye_ = wanted;
  *eye_ += static_cast<float>(1 - std::exp(-dt / lag)) * (wanted - *eye_);
  eye_->z() = std::min(eye_->z(), sides_of(robots, axes, tan_y / least_margin, aspect_).nearest(eye_->x(), eye_->y()));
  orbit_.distance = std::max(1e-3f, mean_depth(robots, axes, eye_->z()));
  orbit_.target = axes.transpose() * (*eye_ + Eigen::Vector3f(0, 0, orbit_.distance));
  return orbit_.camera();
}

}  // namespace mercury
