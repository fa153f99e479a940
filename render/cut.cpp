// SPDX-License-Identifier: Apache-2.0
#include "render/cut.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace mercury::render {
namespace {

using Eigen::Matrix3f;
using Eigen::Matrix4f;

constexpr int squarings = 16;
constexpr float upright = 1e-4f;  // a body that may turn freely, such as a straight line of masses, stays as at rest

Eigen::Vector3f eigen(const Vector3& v) { return {v.x, v.y, v.z}; }

Vector3 mass_of(std::span<const float> positions, std::size_t i) { return Vector3(positions.data() + 3 * i); }

bool counts(const Vector3& p) {
  return std::fabs(p.x) < 1e9f && std::fabs(p.y) < 1e9f && std::fabs(p.z) < 1e9f;
}  // also false for NaN

// The rotation R that minimizes the sum of |now - R rest|^2, as a unit quaternion: the dominant eigenvector of Horn's
// matrix. `s` = sum of rest now^T. Squaring a matrix again and again leaves its dominant eigenvector.
Eigen::Quaternionf rotation_of(const Matrix3f& s) {
  Matrix4f n;
  n << s.trace(), s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0),                    //
      s(1, 2) - s(2, 1), s(0, 0) - s(1, 1) - s(2, 2), s(0, 1) + s(1, 0), s(2, 0) + s(0, 2),   //
      s(2, 0) - s(0, 2), s(0, 1) + s(1, 0), -s(0, 0) + s(1, 1) - s(2, 2), s(1, 2) + s(2, 1),  //
      s(0, 1) - s(1, 0), s(2, 0) + s(0, 2), s(1, 2) + s(2, 1), -s(0, 0) - s(1, 1) + s(2, 2);
  const float size = n.norm();
  if (!(size > 1e-20f)) return Eigen::Quaternionf::Identity();
  Matrix4f power = n / size + Matrix4f::Identity();  // no eigenvalue is negative
  power(0, 0) += upright;
  for (int i = 0; i < squarings; ++i) {
    power = (power * power).eval();
    power /= power.norm();
  }
  int best = 0;
  power.colwise().squaredNorm().maxCoeff(&best);
  const Eigen::Vector4f q = power.col(best).normalized();
  return Eigen::Quaternionf(q[0], q[1], q[2], q[3]);
}

}  // namespace

float CutFrame::place_of(const Cut& cut) const {
  // A little beyond the ends, so that 0 and 100 leave nothing of the side that they remove or keep.
  const float room = 1e-3f * (high - low), share = cut.percent / 100;
  return (1 - share) * (low - room) + share * (high + room) + cut.shift;
}

CutPlane CutFrame::plane_of(const Cut& cut) const {
  const float place = place_of(cut);
  return cut.below ? CutPlane{-axis, -place} : CutPlane{axis, place};
}

std::optional<CutFrame> cut_frame(int axis, std::span<const float> rest, std::span<const float> now) {
  const std::size_t masses = std::min(rest.size(), now.size()) / 3;
  Vector3 rest_sum = Vector3(), sum = Vector3();
  float count = 0;
  for (std::size_t i = 0; i < masses; ++i) {
    if (!counts(mass_of(now, i))) continue;
    rest_sum += mass_of(rest, i);
    sum += mass_of(now, i);
    ++count;
  }
  if (count == 0) return std::nullopt;
  const Vector3 rest_center = rest_sum / count;
  CutFrame frame{.center = sum / count};
  Matrix3f covariance = Matrix3f::Zero();
  for (std::size_t i = 0; i < masses; ++i)
    if (counts(mass_of(now, i)))
      covariance += eigen(mass_of(rest, i) - rest_center) * eigen(mass_of(now, i) - frame.center).transpose();
  const Eigen::Vector3f turned = rotation_of(covariance) * Eigen::Vector3f::Unit(axis);
  frame.axis = {turned[0], turned[1], turned[2]};
  frame.low = INFINITY;
  frame.high = -INFINITY;
  for (std::size_t i = 0; i < masses; ++i) {
    if (!counts(mass_of(now, i))) continue;
    frame.low = std::min(frame.low, frame.axis.dot(mass_of(now, i)));
    frame.high = std::max(frame.high, frame.axis.dot(mass_of(now, i)));
  }
  return frame;
}

}  // namespace mercury::render
