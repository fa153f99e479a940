// SPDX-License-Identifier: Apache-2.0
// Vectors for geometry that floats are too coarse for.
#pragma once

#include "mercury/host_device.h"
#include "mercury/vec3.h"

namespace mercury {

struct Double3 {
  double x = 0, y = 0, z = 0;

  Double3() = default;
  MERCURY_HOST_DEVICE Double3(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
  MERCURY_HOST_DEVICE explicit Double3(Vec3 v)
      : x(static_cast<double>(v.x)), y(static_cast<double>(v.y)), z(static_cast<double>(v.z)) {}

  MERCURY_HOST_DEVICE friend Double3 operator+(Double3 a, Double3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  MERCURY_HOST_DEVICE friend Double3 operator-(Double3 a, Double3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  MERCURY_HOST_DEVICE friend Double3 operator*(double factor, Double3 v) {
    return {factor * v.x, factor * v.y, factor * v.z};
  }
};

MERCURY_HOST_DEVICE double dot(Double3 a, Double3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

MERCURY_HOST_DEVICE Double3 cross(Double3 a, Double3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace mercury
