// SPDX-License-Identifier: Apache-2.0
#include "render/passes/scene_buffers.h"

#include <gtest/gtest.h>

namespace mercury::render {
namespace {

TEST(Octave, FadesFromOnePowerOfTwoToTheNextWithoutAJump) {
  EXPECT_FLOAT_EQ(octave_of(8).size, 8);
  EXPECT_FLOAT_EQ(octave_of(8).share_of_double, 0);
  EXPECT_FLOAT_EQ(octave_of(15.99f).size, 16);
  EXPECT_FLOAT_EQ(octave_of(15.99f).share_of_double, 0);
  const auto mean_size = [](float distance) {
    const Octave octave = octave_of(distance);
    return octave.size * (1 + octave.share_of_double);
  };
  for (float distance = 1; distance < 40; distance *= 1.005f)
    EXPECT_LT(mean_size(distance * 1.005f), 1.05f * mean_size(distance)) << distance;
}

}  // namespace
}  // namespace mercury::render
