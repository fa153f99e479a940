#include "render/frame_block.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace mercury::render {
namespace {

using Eigen::Vector3f;

TEST(FitShadow, HoldsEveryCornerWithinTheMap) {
  const Bounds casters{Vector3f(-3, 1, 0), Vector3f(2, 9, 0.4f)};
  for (const Vector3f& to_key : {Vector3f(0.3f, -0.4f, 0.8f), Vector3f(0, 0, 1), Vector3f(1, 0.2f, 0.3f)}) {
    const ShadowFit fit = fit_shadow(casters, to_key, 1024);
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3f point(corner & 1 ? 2 : -3, corner & 2 ? 9 : 1, corner & 4 ? 0.4f : 0);
      const Vector3f place = (fit.matrix * point.homogeneous()).hnormalized();
      EXPECT_GE(place.minCoeff(), 0);
      EXPECT_LE(place.maxCoeff(), 1);
    }
    EXPECT_LT(fit.width, 3 * (casters.high - casters.low).norm());
  }
}

TEST(FitShadow, DepthGrowsAwayFromTheLight) {
  const Vector3f to_key = Vector3f(0.3f, -0.4f, 0.8f).normalized();
  const ShadowFit fit = fit_shadow({Vector3f(-1, -1, -1), Vector3f(1, 1, 1)}, to_key, 1024);
  const auto depth = [&](float along) { return (fit.matrix * Vector3f(along * to_key).homogeneous()).z(); };
  EXPECT_NEAR(depth(-0.5f) - depth(0.5f), 1 / fit.depth, 1e-5);
}

TEST(FitShadow, MovesByWholeTexels) {
  const Vector3f to_key(0, 0, 1);
  const auto shift = [&](float x) {
    const ShadowFit fit = fit_shadow({Vector3f(x - 1, -1, 0), Vector3f(x + 1, 1, 0.5f)}, to_key, 256);
    return (fit.matrix * Vector3f(0, 0, 0).homogeneous()).x() * 256;
  };
  const float texels = shift(0.123f) - shift(0.456f);
  EXPECT_NEAR(texels, std::round(texels), 1e-3);
  EXPECT_GT(std::abs(texels), 1);
}

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
