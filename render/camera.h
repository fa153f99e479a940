// SPDX-License-Identifier: Apache-2.0
// Cameras, and ways to move them.
#pragma once

#include <span>

#include "render/vector.h"

namespace mercury::render {

// An axis-aligned box; empty until extend() is called.
struct Bounds {
  Vector3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
  bool empty() const { return !(low.x <= high.x); }
  Vector3 center() const { return 0.5f * (low + high); }
  float radius() const { return empty() ? 0.0f : 0.5f * (high - low).norm(); }
  void extend(const Vector3& point);
  void extend(const Bounds& other);
  Bounds moved(const Vector3& offset) const;
};

// The box around points, 3 floats each; ignores points that are not finite.
Bounds bounds_of(std::span<const float> points);
// The box around boxes; ignores empty ones.
Bounds bounds_of(std::span<const Bounds> boxes);

// The i-th of `count` points spread over the unit disc (golden-angle spiral).
Vector2 disc_sample(int i, int count);
// The i-th of any number of points spread over the unit square (Roberts 2018, sequence R2).
Vector2 square_sample(int i);

// A half-line.
struct Ray {
  Vector3 origin, direction;  // direction has length 1
};

// What is not at this distance is blurred: a picture is the mean over eyes all over a disc, from `samples` of them.
struct Lens {
  float radius = 0;  // of the disc [m]
  float focus = 1;   // distance along the line of sight that stays sharp [m]
  int samples = 1;   // above 1: edges and shadows are smoother, too; costs as many pictures
};

struct Camera {
  Vector3 eye{3, -4, 3};           // [m]
  Vector3 target{0, 0, 0};         // [m]
  Vector3 up{0, 0, 1};             // any direction that is not the line of sight
  float field_of_view = 0.6f;      // of the picture's height [rad]
  float near = 0.05f, far = 1000;  // the range of depths that is drawn [m]
  Vector2 shift{0, 0};             // of the picture's middle, right and up from the line of sight [tangents]
  Lens lens;

  // World to eye, eye looking along -z.
  Matrix4 view() const;
  // Eye to clip coordinates, with depth 1 at `near` and 0 at `far`: reversed, so that float depth is precise
  // everywhere. `aspect` = width / height.
  Matrix4 projection(float aspect) const;
  // A point in a picture of width x height: pixels from the upper left corner, and depth along the line of sight [m]
  // (negative = behind the eye).
  Vector3 project(const Vector3& point, int width, int height) const;
  // Sample i of its lens, moved within a pixel of a picture that is that high, too. Without a lens.
  Camera seen_through_lens(int i, int height) const;
  // The line of sight through a point of the picture, in pixels from the upper left corner.
  Ray ray(float x, float y, int width, int height) const;
};

// Margins that stay free for legends and clocks, as shares of the picture's width and height.
struct Insets {
  float left = 0, right = 0, top = 0, bottom = 0;
};

// A camera that turns around a target.
struct Orbit {
  Vector3 target{0, 0, 0};     // [m]
  float azimuth = -1.0f;       // direction from target to eye, from +x toward +y [rad]
  float elevation = 0.45f;     // above the horizon [rad], -pi/2 to pi/2
  float distance = 6;          // [m]
  float field_of_view = 0.6f;  // [rad]

  Camera camera() const;
  // Turns by angles [rad]; elevation stops short of the poles.
  void turn(float azimuth_change, float elevation_change);
  // Moves target and eye along the picture's axes by fractions of the picture's height (drag).
  void pan(float right, float up);
  // Moves the eye closer by a factor < 1, or farther.
  void zoom(float factor);
  // Looks at the center of the box from `margin` times the smallest distance at which all of it is in the picture.
  // Keeps the angles.
  void frame(const Bounds& bounds, float aspect, float margin = 1.05f, const Insets& free = {});
  // The same for several boxes; fits their corners, which is tighter than one box around them.
  void frame(std::span<const Bounds> boxes, float aspect, float margin = 1.05f, const Insets& free = {});
};

// Looking straight down, +x to the right.
Orbit top_view(const Bounds& bounds, float aspect);
// An orbit that has turned once after `period` seconds.
Orbit turntable(Orbit start, double time, double period = 20);

// Follows a moving target smoothly: call once per frame with the time since the last one [s]. The distance between the
// orbit's target and `target` shrinks by the factor exp(-dt / lag).
void follow(Orbit& orbit, const Vector3& target, double dt, double lag = 0.5);

}  // namespace mercury::render
