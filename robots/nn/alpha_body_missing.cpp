// SPDX-License-Identifier: Apache-2.0
// Replaces alpha_body.cpp in a build without CGAL (-DMERCURY_NN=OFF).
#include "robots/nn/tetrahedra.h"

#include "mercury/error.h"

namespace mercury {

AlphaBody alpha_body(std::span<const Vec3>, double) {
  throw InputError("network robots", "this program was built without them (MERCURY_NN=OFF)");
}

}  // namespace mercury
