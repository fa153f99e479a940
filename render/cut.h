// SPDX-License-Identifier: Apache-2.0
// A cut that opens bodies, and the plane that it means for one of them.
#pragma once

#include <optional>
#include <span>

#include "render/vector.h"

namespace mercury::render {

// Each body is cut across an axis of its own frame, which moves and turns with the body and whose axes are x, y and z
// when the body is at rest.
struct Cut {
  int axis = 1;        // 0 = x, 1 = y, 2 = z
  bool below = false;  // removes what lies below the plane on the axis, rather than what lies above it
  float percent = 50;  // where the plane is: 0 = the body's lowest point on the axis, 100 = its highest
  float shift = 0;     // added to that [m]
  friend bool operator==(const Cut&, const Cut&) = default;
};

// The side normal . x > offset is removed, in the body's coordinates.
struct CutPlane {
  Vector3 normal{0, 0, 0};
  float offset = 1;  // [m]
  bool removes(const Vector3& point) const { return normal.dot(point) > offset; }
};

// A body along one axis of its frame.
struct CutFrame {
  Vector3 center{0, 0, 0};  // mean of its masses [m]
  Vector3 axis{0, 1, 0};    // unit, in the body's coordinates
  float low = 0, high = 0;  // of its masses: dot(axis, x) [m]

  // A plane perpendicular to the axis: dot(axis, x) = place_of(cut).
  float place_of(const Cut& cut) const;
  CutPlane plane_of(const Cut& cut) const;
};

// `rest` and `now`: 3 floats per mass, of the same masses; others than finite ones do not count. Nothing without any.
// The frame is the rotation that fits the body best (Horn 1987). shaders/cut_planes.comp computes the same.
std::optional<CutFrame> cut_frame(int axis, std::span<const float> rest, std::span<const float> now);

}  // namespace mercury::render
