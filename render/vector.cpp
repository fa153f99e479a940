// SPDX-License-Identifier: Apache-2.0
#include "render/vector.h"

#include <Eigen/LU>

namespace mercury::render {

Matrix4 inverse(const Matrix4& m) {
  Matrix4 result;
  Eigen::Map<Eigen::Matrix4f>(result.values) = Eigen::Map<const Eigen::Matrix4f>(m.values).inverse();
  return result;
}

}  // namespace mercury::render
