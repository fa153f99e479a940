// SPDX-License-Identifier: Apache-2.0
// A vector of three floats with the usual operators, for host and device.
#pragma once

#include <cmath>

#include "mercury/host_device.h"

namespace mercury {

struct Vec3 {
  float x = 0, y = 0, z = 0;
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

MERCURY_HOST_DEVICE constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
MERCURY_HOST_DEVICE constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
MERCURY_HOST_DEVICE constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
MERCURY_HOST_DEVICE constexpr Vec3 operator*(float s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
MERCURY_HOST_DEVICE constexpr Vec3 operator*(Vec3 a, float s) { return s * a; }
MERCURY_HOST_DEVICE constexpr Vec3& operator+=(Vec3& a, Vec3 b) { return a = a + b; }
MERCURY_HOST_DEVICE constexpr Vec3& operator-=(Vec3& a, Vec3 b) { return a = a - b; }
MERCURY_HOST_DEVICE constexpr float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
MERCURY_HOST_DEVICE constexpr Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
MERCURY_HOST_DEVICE constexpr Vec3 select(bool condition, Vec3 yes, Vec3 no) { return condition ? yes : no; }
inline float length(Vec3 a) { return std::sqrt(dot(a, a)); }

}  // namespace mercury
