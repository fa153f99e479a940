// SPDX-License-Identifier: Apache-2.0
// Cameras: where the eye is, and the ways to move it.
#pragma once

#include <Eigen/Core>
#include <span>

namespace mercury::render {

// An axis-aligned box; empty until something is put into it.
struct Bounds {
  Eigen::Vector3f low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
  bool empty() const { return !(low.x() <= high.x()); }
  Eigen::Vector3f center() const { return 0.5f * (low + high); }
  float radius() const { return empty() ? 0.0f : 0.5f * (high - low).norm(); }
  void extend(const Eigen::Vector3f& point);
  void extend(const Bounds& other);
  Bounds moved(const Eigen::Vector3f& offset) const;
};

// The box around points, 3 floats each; what is not finite is left out.
Bounds bounds_of(std::span<const float> points);

// A line of sight.
struct Ray {
  Eigen::Vector3f origin, direction;  // direction has length 1
};

struct Camera {
  Eigen::Vector3f eye{3, -4, 3};    // [m]
  Eigen::Vector3f target{0, 0, 0};  // [m]
  Eigen::Vector3f up{0, 0, 1};      // any direction that is not the line of sight
  float field_of_view = 0.6f;       // of the picture's height [rad]
  float near = 0.05f, far = 1000;   // nearest and farthest that is drawn [m]

  // World to eye, eye looking along -z.
  Eigen::Matrix4f view() const;
  // Eye to clip coordinates with depth 1 at `near` and 0 at `far` (reversed: float depth is then precise everywhere).
  // `aspect` = width / height.
  Eigen::Matrix4f projection(float aspect) const;
  // Where a point lands in a picture of width x height, in pixels from the upper left corner, and its depth along the
  // line of sight [m] (negative = behind the eye).
  Eigen::Vector3f project(const Eigen::Vector3f& point, int width, int height) const;
  // The line of sight through a place in the picture, in pixels from the upper left corner.
  Ray ray(float x, float y, int width, int height) const;
};

// Parts of the picture's width and height to be left free at its edges, for legends and clocks.
struct Insets {
  float left = 0, right = 0, top = 0, bottom = 0;
};

// A camera that turns around a target, as every mode of moving it needs.
struct Orbit {
  Eigen::Vector3f target{0, 0, 0};  // [m]
  float azimuth = -1.0f;            // direction from target to eye, from +x towards +y [rad]
  float elevation = 0.45f;          // above the horizon [rad], -pi/2 to pi/2
  float distance = 6;               // [m]
  float field_of_view = 0.6f;       // [rad]

  Camera camera() const;
  // Turns by angles [rad]; elevation stops short of the poles.
  void turn(float azimuth_change, float elevation_change);
  // Moves target and eye along the picture's axes by fractions of the picture's height (drag).
  void pan(float right, float up);
  // Moves the eye closer by a factor < 1, or farther.
  void zoom(float factor);
  // Looks at the centre of the box from so far that all of it is in a picture of that aspect, `margin` times as far as
  // just needed. Angles stay.
  void frame(const Bounds& bounds, float aspect, float margin = 1.05f, const Insets& free = {});
  // The same for several boxes, as tightly as their corners allow: what a group of bodies needs.
  void frame(std::span<const Bounds> boxes, float aspect, float margin = 1.05f, const Insets& free = {});
};

// Looking straight down, +x to the right.
Orbit top_view(const Bounds& bounds, float aspect);
// An orbit that has turned once after `period` seconds.
Orbit turntable(Orbit start, double time, double period = 20);

// Follows a moving target without jerks: call once a frame with the time since the last one.
// The orbit's target nears `target` by the factor exp(-dt / lag).
void follow(Orbit& orbit, const Eigen::Vector3f& target, double dt, double lag = 0.5);

}  // namespace mercury::render
