// SPDX-License-Identifier: Apache-2.0
#include "render/passes/visibility_passes.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <optional>
#include <vector>

#include "render/passes/bindings.h"
#include "render/passes/scene_buffers.h"
#include "tests/render/offscreen.h"

namespace mercury::render {
namespace {

struct FittedBody {
  Bounds box;
  Vector3 offset{0, 0, 0};
  bool hidden = false;
};

class FitPassTest : public Offscreen {
 protected:
  // The frame block after the pass.
  FrameBlock fitted(const std::vector<FittedBody>& bodies, const Vector3& to_key, int side, float floor = 0) {
    FrameBlock block{};
    const Vector3 direction = to_key.normalized();
    block.to_key = {direction.x, direction.y, direction.z, 0.1f};
    block.ground = {0, 0, 1, floor};
    Buffer frame, boxes, placements;
    frame.write(&block, sizeof block);
    std::vector<Vector4> corners, places;
    for (const FittedBody& body : bodies) {
      for (const Vector3& corner : {body.box.low, body.box.high}) corners.emplace_back(corner, 1.0f);
      const float flags = std::bit_cast<float>(body.hidden ? 1u : 0u);
      places.push_back({body.offset.x, body.offset.y, body.offset.z, flags});
      places.push_back({0, 0, 0, 1});  // it is not cut
    }
    boxes.write(corners);
    placements.write(places);
    placements.bind_storage(binding::placements);
    pass_.emplace();
    pass_->fit(frame, boxes, bodies.size(), side, side);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(frame.get(), 0, sizeof block, &block);
    return block;
  }
  static Vector3 place(const FrameBlock& block, const Vector3& point) {
    const Vector4 p = block.shadow * Vector4(point, 1);
    return p.xyz() / p.w;
  }
  void TearDown() override {
    pass_.reset();
    Offscreen::TearDown();
  }

 private:
  std::optional<FitPass> pass_;
};

TEST_F(FitPassTest, ShadowMapCoversEveryCornerOfEveryBody) {
  // More bodies than lanes, so that each lane handles several.
  std::vector<FittedBody> bodies;
  for (int i = 0; i < 700; ++i)
    bodies.push_back({{Vector3(-1, -1, 0), Vector3(1, 1, 0.4f)}, {float(i % 30), -float(i % 7), 0.01f * float(i)}});
  for (const Vector3& to_key : {Vector3(0.3f, -0.4f, 0.8f), Vector3(0, 0, 1), Vector3(1, 0.2f, 0.3f)}) {
    const FrameBlock block = fitted(bodies, to_key, 1024);
    for (const FittedBody& body : bodies)
      for (int corner = 0; corner < 8; ++corner) {
        const Vector3 point(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 0.4f : 0);
        const Vector3 at = place(block, point + body.offset);
        ASSERT_GE(std::min({at.x, at.y, at.z}), 0);
        ASSERT_LE(std::max({at.x, at.y, at.z}), 1);
      }
    EXPECT_LT(block.shadow_size.x, 3 * Vector3(31, 8, 7.4f).norm());
    EXPECT_FLOAT_EQ(block.water.z, 0.4f + 6.99f);
  }
}

TEST_F(FitPassTest, DepthGrowsAwayFromTheLight) {
  const Vector3 to_key = Vector3(0.3f, -0.4f, 0.8f).normalized();
  const FrameBlock block = fitted({{{Vector3(-1, -1, -1), Vector3(1, 1, 1)}}}, to_key, 1024);
  EXPECT_NEAR(place(block, -0.5f * to_key).z - place(block, 0.5f * to_key).z, 1 / block.shadow_size.y, 1e-5);
}

TEST_F(FitPassTest, ShadowMapMovesByWholeTexels) {
  const auto fit = [&](float x) {
    return fitted({{{Vector3(x - 1, -1, 0), Vector3(x + 1, 1, 0.5f)}}}, Vector3(0, 0, 1), 256);
  };
  const FrameBlock a = fit(0.123f), b = fit(0.456f);
  const float texels = 256 * (place(a, {0, 0, 0}).x - place(b, {0, 0, 0}).x);
  EXPECT_NEAR(texels, std::round(texels), 1e-3);
  EXPECT_GT(std::abs(texels), 1);
  ASSERT_EQ(a.ground.z, b.ground.z);
  const float ground_texels = 256 * (b.ground.x - a.ground.x) / a.ground.z;
  EXPECT_NEAR(ground_texels, std::round(ground_texels), 1e-3);
  EXPECT_GT(std::abs(ground_texels), 1);
}

TEST_F(FitPassTest, HiddenAndEmptyBodiesAreIgnored) {
  const FittedBody seen{{Vector3(-1, -1, 0), Vector3(1, 1, 1)}};
  const FittedBody hidden{{Vector3(50, 50, 50), Vector3(60, 60, 60)}, {0, 0, 0}, true};
  const FittedBody broken{Bounds{}};
  const FrameBlock alone = fitted({seen}, Vector3(0.3f, 0, 0.8f), 512);
  const FrameBlock among = fitted({hidden, seen, broken}, Vector3(0.3f, 0, 0.8f), 512);
  EXPECT_EQ(alone.shadow, among.shadow);
  EXPECT_EQ(alone.ground, among.ground);
}

TEST_F(FitPassTest, FloorsMapCoversTheShadowsOfHighBodies) {
  const Vector3 to_key = Vector3(-0.5f, -0.3f, 0.8f).normalized();
  const Bounds box{Vector3(-1, -1, 4), Vector3(1, 1, 5)};
  const FrameBlock block = fitted({{box}}, to_key, 512, -2);
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3 point(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 5 : 4);
    const Vector3 shade = point - (point.z + 2) / to_key.z * to_key;
    EXPECT_GT(shade.x, block.ground.x);
    EXPECT_GT(shade.y, block.ground.y);
    EXPECT_LT(shade.x, block.ground.x + block.ground.z);
    EXPECT_LT(shade.y, block.ground.y + block.ground.z);
  }
  EXPECT_EQ(block.ground.w, -2);
}

TEST_F(FitPassTest, WithoutBodiesTheMapsAreStillValid) {
  const FrameBlock block = fitted({}, Vector3(0, 0, 1), 512);
  for (const float value : block.shadow.values) EXPECT_TRUE(std::isfinite(value));
  EXPECT_GT(block.ground.z, 1);
  EXPECT_EQ(block.water.z, 0);
}

}  // namespace
}  // namespace mercury::render
