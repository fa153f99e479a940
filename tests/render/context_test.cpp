// SPDX-License-Identifier: Apache-2.0
#include "render/context/context.h"

#include <epoxy/gl.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/render/offscreen.h"
#include "tests/render/wobbling_bodies.h"

namespace mercury::render {
namespace {

using testing::HasSubstr;

TEST(ContextKind, NamesRoundTripAndUnknownOnesThrowAList) {
  for (const ContextKind kind : {ContextKind::automatic, ContextKind::egl, ContextKind::mesa, ContextKind::osmesa})
    EXPECT_EQ(context_kind_named(name_of(kind)), kind);
  EXPECT_THAT([] { context_kind_named("glx"); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("auto, egl, mesa or osmesa")));
}

class ContextTest : public testing::TestWithParam<ContextKind> {
 protected:
  void SetUp() override {
    // The shared context of the other tests must not be current while OSMesa is.
    if (Context* shared = shared_context()) shared->release();
    try {
      context_ = make_context({.kind = GetParam()});
    } catch (const ContextError& error) {
      GTEST_SKIP() << error.what();
    }
  }
  std::unique_ptr<Context> context_;
};

TEST_P(ContextTest, DescribesItself) {
  EXPECT_THAT(context_->describe(), HasSubstr("OpenGL 4."));
  EXPECT_EQ(context_->describe().find('\n'), std::string::npos);
  if (GetParam() != ContextKind::automatic) {
    EXPECT_EQ(context_->is_software(), GetParam() != ContextKind::egl);
  }
}

TEST_P(ContextTest, ReportsMisuseOnce) {
  glEnable(0xdead);
  const std::vector<std::string> messages = context_->take_messages();
  ASSERT_FALSE(messages.empty());
  EXPECT_THAT(messages[0], HasSubstr("GL_INVALID_ENUM"));
  EXPECT_TRUE(context_->take_messages().empty());
}

TEST_P(ContextTest, CanBeMadeCurrentAgainAfterRelease) {
  context_->release();
  context_->make_current();
  EXPECT_NE(glGetString(GL_VERSION), nullptr);
}

TEST_P(ContextTest, DrawsTheSamePictureAsTheOtherKinds) {
  const WobblingGroup group = make_wobbling_group(2, 4, 3, 0.8f);
  const auto picture = [&](Context& context) {
    Renderer renderer(context, {.width = 120, .height = 80, .quality = Quality::low});
    renderer.set_bodies(group.views());
    Scene scene;
    scene.placements = group.placements;
    renderer.draw(scene, Orbit{.distance = 3}.camera());
    return read(renderer);
  };
  const Image here = picture(*context_);
  context_.reset();
  if (Context* shared = shared_context()) {
    shared->make_current();
    EXPECT_LT(count_differing(here, picture(*shared), 8), 120 * 80 / 100);
    shared->release();
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, ContextTest,
                         testing::Values(ContextKind::automatic, ContextKind::egl, ContextKind::mesa,
                                         ContextKind::osmesa),
                         [](const auto& test) { return std::string(name_of(test.param)); });

}  // namespace
}  // namespace mercury::render
