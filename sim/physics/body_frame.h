// SPDX-License-Identifier: Apache-2.0
// The frame that turns with a body: the rotation R that brings its rest shape closest to the current one.
//
//   min over R of  sum m |(x - c) - R (X - C)|^2       x, c: current masses and their center;  X, C: at rest
//
// R is a unit quaternion, the eigenvector of the largest eigenvalue of a symmetric 4x4 matrix that the sums
// S = sum m (X - C) (x - c)^T make (Horn 1987, "Closed-form solution of absolute orientation using unit quaternions").
// It exists for flat bodies, too, never reflects, and needs no guess from the last step, so nothing has to be saved.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "sim/physics/double3.h"

namespace mercury {

struct Rotation {
  std::array<double, 9> r{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row after row
  // Of a vector of the world, in the body's frame: R^T v.
  Double3 to_body(Double3 v) const {
    return {r[0] * v.x + r[3] * v.y + r[6] * v.z, r[1] * v.x + r[4] * v.y + r[7] * v.z,
            r[2] * v.x + r[5] * v.y + r[8] * v.z};
  }
};

// The eigenvector of the largest eigenvalue of a symmetric matrix, by cyclic Jacobi rotations.
inline std::array<double, 4> largest_eigenvector(std::array<std::array<double, 4>, 4> m) {
  std::array<std::array<double, 4>, 4> v{};
  for (std::size_t i = 0; i < 4; ++i) v[i][i] = 1;
  constexpr int sweeps = 12;  // each squares what is left beside the diagonal; six are enough for doubles
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (std::size_t p = 0; p < 3; ++p)
      for (std::size_t q = p + 1; q < 4; ++q) {
        if (m[p][q] == 0) continue;
        const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
        const double t = (theta < 0 ? -1 : 1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (std::size_t k = 0; k < 4; ++k) {
          const double kp = m[k][p], kq = m[k][q];
          m[k][p] = c * kp - s * kq;
          m[k][q] = s * kp + c * kq;
        }
        for (std::size_t k = 0; k < 4; ++k) {
          const double pk = m[p][k], qk = m[q][k], vp = v[k][p], vq = v[k][q];
          m[p][k] = c * pk - s * qk;
          m[q][k] = s * pk + c * qk;
          v[k][p] = c * vp - s * vq;
          v[k][q] = s * vp + c * vq;
        }
        m[p][q] = m[q][p] = 0;
      }
  std::size_t largest = 0;
  for (std::size_t i = 1; i < 4; ++i)
    if (m[i][i] > m[largest][largest]) largest = i;
  return {v[0][largest], v[1][largest], v[2][largest], v[3][largest]};
}

// `s` = S, row after row.
inline Rotation rotation_of(const std::array<double, 9>& s) {
  const auto [xx, xy, xz, yx, yy, yz, zx, zy, zz] = s;
  const auto [w, x, y, z] = largest_eigenvector({{{xx + yy + zz, yz - zy, zx - xz, xy - yx},
                                                  {yz - zy, xx - yy - zz, xy + yx, zx + xz},
                                                  {zx - xz, xy + yx, -xx + yy - zz, yz + zy},
                                                  {xy - yx, zx + xz, yz + zy, -xx - yy + zz}}});
  return {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z),
           1 - 2 * (x * x + z * z), 2 * (y * z - w * x), 2 * (x * z - w * y), 2 * (y * z + w * x),
           1 - 2 * (x * x + y * y)}};
}

// The angular velocity of a body with this angular momentum L and inertia J = sum m (|d|^2 1 - d d^T) about its center,
// from J omega = L. 0 for a body that is a line or a point, which may turn about itself.
inline Double3 angular_velocity(Double3 momentum, double jxx, double jyy, double jzz, double jxy, double jxz,
                                double jyz) {
  const double cxx = jyy * jzz - jyz * jyz, cxy = jxz * jyz - jxy * jzz, cxz = jxy * jyz - jxz * jyy;
  const double determinant = jxx * cxx + jxy * cxy + jxz * cxz, trace = jxx + jyy + jzz;
  if (!(determinant > 1e-12 * trace * trace * trace)) return {};
  const double cyy = jxx * jzz - jxz * jxz, cyz = jxy * jxz - jxx * jyz, czz = jxx * jyy - jxy * jxy;
  return {(cxx * momentum.x + cxy * momentum.y + cxz * momentum.z) / determinant,
          (cxy * momentum.x + cyy * momentum.y + cyz * momentum.z) / determinant,
          (cxz * momentum.x + cyz * momentum.y + czz * momentum.z) / determinant};
}

}  // namespace mercury
