// SPDX-License-Identifier: Apache-2.0
// The frame that turns with a body: the rotation R that brings its rest shape closest to the current one.
//
//   min over R of  sum m |(x - c) - R (X - C)|^2       x, c: current masses and their center;  X, C: at rest
//
// R is a unit quaternion, the eigenvector of the largest eigenvalue of a symmetric 4x4 matrix N that the sums
// S = sum m (X - C) (x - c)^T make (Horn 1987, "Closed-form solution of absolute orientation using unit quaternions").
// It exists for flat bodies, too, never reflects, and needs no guess from the last step, so nothing has to be saved.
#pragma once

#include <cmath>
#include <cstdint>

#include "sim/physics/double3.h"

namespace mercury {

struct Rotation {
  double r[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // row after row
  // Of a vector of the world, in the body's frame: R^T v.
  MERCURY_HOST_DEVICE Double3 to_body(Double3 v) const {
    return {r[0] * v.x + r[3] * v.y + r[6] * v.z, r[1] * v.x + r[4] * v.y + r[7] * v.z,
            r[2] * v.x + r[5] * v.y + r[8] * v.z};
  }
  // One component of it.
  MERCURY_HOST_DEVICE double to_body(Double3 v, std::uint32_t component) const {
    return r[component] * v.x + r[3 + component] * v.y + r[6 + component] * v.z;
  }
  // The cosine of the angle between the body's z axis and the world's.
  MERCURY_HOST_DEVICE double up() const { return r[8]; }
};

struct Quaternion {
  double q[4];
};
struct Symmetric4 {
  double m[4][4];
};

// The eigenvector of the largest eigenvalue, by cyclic Jacobi rotations.
MERCURY_HOST_DEVICE Quaternion largest_eigenvector_by_rotations(Symmetric4 matrix) {
  auto& m = matrix.m;
  double v[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  constexpr int sweeps = 12;  // each squares what is left beside the diagonal; six are enough for doubles
  MERCURY_NO_UNROLL
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    MERCURY_NO_UNROLL
    for (int pair = 0; pair < 6; ++pair) {
      const int p = pair < 3 ? 0 : pair < 5 ? 1 : 2, q = pair < 3 ? pair + 1 : pair < 5 ? pair - 1 : 3;
      if (m[p][q] == 0) continue;
      const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
      const double t = (theta < 0 ? -1 : 1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
      const double c = 1 / std::sqrt(t * t + 1), s = t * c;
      MERCURY_NO_UNROLL
      for (int k = 0; k < 4; ++k) {
        const double kp = m[k][p], kq = m[k][q];
        m[k][p] = c * kp - s * kq;
        m[k][q] = s * kp + c * kq;
      }
      MERCURY_NO_UNROLL
      for (int k = 0; k < 4; ++k) {
        const double pk = m[p][k], qk = m[q][k], vp = v[k][p], vq = v[k][q];
        m[p][k] = c * pk - s * qk;
        m[q][k] = s * pk + c * qk;
        v[k][p] = c * vp - s * vq;
        v[k][q] = s * vp + c * vq;
      }
      m[p][q] = m[q][p] = 0;
    }
  }
  int largest = 0;
  for (int i = 1; i < 4; ++i)
    if (m[i][i] > m[largest][largest]) largest = i;
  return {{v[0][largest], v[1][largest], v[2][largest], v[3][largest]}};
}

// The adjugate of a symmetric matrix, and its determinant.
struct Adjugate {
  double b[4][4], determinant;
};
MERCURY_HOST_DEVICE Adjugate adjugate(const Symmetric4& matrix) {
  const auto& a = matrix.m;
  const auto minor = [&](int row, int i, int j) { return a[row][i] * a[row + 1][j] - a[row + 1][i] * a[row][j]; };
  const double s0 = minor(0, 0, 1), s1 = minor(0, 0, 2), s2 = minor(0, 0, 3), s3 = minor(0, 1, 2), s4 = minor(0, 1, 3),
               s5 = minor(0, 2, 3);
  const double c0 = minor(2, 0, 1), c1 = minor(2, 0, 2), c2 = minor(2, 0, 3), c3 = minor(2, 1, 2), c4 = minor(2, 1, 3),
               c5 = minor(2, 2, 3);
  Adjugate of{};
  auto& b = of.b;
  b[0][0] = a[1][1] * c5 - a[1][2] * c4 + a[1][3] * c3;
  b[0][1] = b[1][0] = -a[0][1] * c5 + a[0][2] * c4 - a[0][3] * c3;
  b[0][2] = b[2][0] = a[3][1] * s5 - a[3][2] * s4 + a[3][3] * s3;
  b[0][3] = b[3][0] = -a[2][1] * s5 + a[2][2] * s4 - a[2][3] * s3;
  b[1][1] = a[0][0] * c5 - a[0][2] * c2 + a[0][3] * c1;
  b[1][2] = b[2][1] = -a[3][0] * s5 + a[3][2] * s2 - a[3][3] * s1;
  b[1][3] = b[3][1] = a[2][0] * s5 - a[2][2] * s2 + a[2][3] * s1;
  b[2][2] = a[3][0] * s4 - a[3][1] * s2 + a[3][3] * s0;
  b[2][3] = b[3][2] = -a[2][0] * s4 + a[2][1] * s2 - a[2][3] * s0;
  b[3][3] = a[2][0] * s3 - a[2][1] * s1 + a[2][2] * s0;
  of.determinant = s0 * c5 - s1 * c4 + s2 * c3 + s3 * c2 - s4 * c1 + s5 * c0;
  return of;
}

// Not below the largest root of l^4 + c2 l^2 + c1 l + c0, as rotation_of() says. A GPU comes near it in single
// precision, whose divisions take a tenth of the time; the start is then above the root by more than single precision
// can err.
MERCURY_HOST_DEVICE double start_of_newton(double c2, double c1, double c0) {
  const double highest = std::sqrt(-1.5 * c2);
#ifdef __CUDA_ARCH__
  if (!(highest > 1e-30 && highest < 1e30)) return highest;
  // In units of `highest`.
  const auto scaled = [&](double coefficient, double power) { return static_cast<float>(coefficient / power); };
  const double square = highest * highest;
  const float a2 = scaled(c2, square), a1 = scaled(c1, square * highest), a0 = scaled(c0, square * square);
  float x = 1;
  MERCURY_NO_UNROLL
  for (int i = 0; i < 12; ++i) {
    const float slope = (4 * x * x + 2 * a2) * x + a1, value = ((x * x + a2) * x + a1) * x + a0;
    if (!(slope > 1e-2f && value > 1e-4f * slope)) break;
    x -= __fdividef(value, slope);
  }
  return highest * static_cast<double>(fminf(x + 1e-4f, 1));
#else
  (void)c1, (void)c0;
  return highest;
#endif
}

// `s` = S, row after row.
//
// N has no trace, so its characteristic polynomial is l^4 + c2 l^2 + c1 l + c0, and its largest root is at most
// sqrt(-3/2 c2). From there Newton's steps fall toward it, and never below. All columns of adj(N - l 1) are multiples
// of the eigenvector (Theobald 2005, "Rapid calculation of RMSDs using a quaternion-based characteristic polynomial").
// They vanish where the second largest root comes near, as for a line; rotations then take their place.
MERCURY_HOST_DEVICE Rotation rotation_of(const double (&s)[9]) {
  const double xx = s[0], xy = s[1], xz = s[2], yx = s[3], yy = s[4], yz = s[5], zx = s[6], zy = s[7], zz = s[8];
  Symmetric4 n{{{xx + yy + zz, yz - zy, zx - xz, xy - yx},
                {yz - zy, xx - yy - zz, xy + yx, zx + xz},
                {zx - xz, xy + yx, -xx + yy - zz, yz + zy},
                {xy - yx, zx + xz, yz + zy, -xx - yy + zz}}};
  double squares = 0;
  for (const double each : s) squares += each * each;
  const double c2 = -2 * squares, c0 = adjugate(n).determinant,
               c1 = -8 * (xx * (yy * zz - yz * zy) - xy * (yx * zz - yz * zx) + xz * (yx * zy - yy * zx));
  double l = start_of_newton(c2, c1, c0);
  MERCURY_NO_UNROLL
  for (int i = 0; i < 60; ++i) {
    const double slope = (4 * l * l + 2 * c2) * l + c1;
    if (!(slope > 0)) break;
    const double step = ((l * l + c2) * l * l + c1 * l + c0) / slope;
    l -= step;
    if (!(step > 1e-15 * l)) break;
  }
  Symmetric4 shifted = n;
  for (int i = 0; i < 4; ++i) shifted.m[i][i] -= l;
  const Adjugate columns = adjugate(shifted);
  // The column with the largest element on the diagonal, without an index, which would put the matrix into memory.
  Quaternion found{};
  double largest = 0;
  for (int i = 0; i < 4; ++i) {
    const double size = std::fabs(columns.b[i][i]);
    const bool larger = size > largest;
    for (int k = 0; k < 4; ++k) found.q[k] = larger ? columns.b[k][i] : found.q[k];
    largest = larger ? size : largest;
  }
  if (!(largest > 1e-6 * l * l * l)) found = largest_eigenvector_by_rotations(n);
  double length = 0;
  for (const double each : found.q) length += each * each;
  length = 1 / std::sqrt(length);
  const double w = length * found.q[0], x = length * found.q[1], y = length * found.q[2], z = length * found.q[3];
  return {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z),
           1 - 2 * (x * x + z * z), 2 * (y * z - w * x), 2 * (x * z - w * y), 2 * (y * z + w * x),
           1 - 2 * (x * x + y * y)}};
}

// The inertia sum m (|d|^2 1 - d d^T) of a body about its center [kg m2].
struct Inertia {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};

// The angular velocity of a body with this angular momentum L, from J omega = L. 0 for a body that is a line or a
// point, which may turn about itself.
MERCURY_HOST_DEVICE Double3 angular_velocity(Double3 momentum, const Inertia& j) {
  const double cxx = j.yy * j.zz - j.yz * j.yz, cxy = j.xz * j.yz - j.xy * j.zz, cxz = j.xy * j.yz - j.xz * j.yy;
  const double determinant = j.xx * cxx + j.xy * cxy + j.xz * cxz, trace = j.xx + j.yy + j.zz;
  if (!(determinant > 1e-12 * trace * trace * trace)) return {};
  const double cyy = j.xx * j.zz - j.xz * j.xz, cyz = j.xy * j.xz - j.xx * j.yz, czz = j.xx * j.yy - j.xy * j.xy;
  return {(cxx * momentum.x + cxy * momentum.y + cxz * momentum.z) / determinant,
          (cxy * momentum.x + cyy * momentum.y + cyz * momentum.z) / determinant,
          (cxz * momentum.x + cyz * momentum.y + czz * momentum.z) / determinant};
}

}  // namespace mercury
