// SPDX-License-Identifier: Apache-2.0
#include "render/renderer.h"

#include <epoxy/gl.h>

#include <array>
#include <limits>

#include "render/context/gl_objects.h"
#include "tests/render/triangle.h"
#include "tests/render/wobbling_bodies.h"

namespace mercury::render {
namespace {

class RendererTest : public Offscreen {};

TEST_F(RendererTest, TheSameSceneGivesTheSamePicture) {
  Renderer renderer = make_renderer();
  const WobblingGroup group = make_wobbling_group(4, 5, 3, 0.8f);
  renderer.set_bodies(group.views());
  Scene scene;
  scene.placements = group.placements;
  scene.floor = -0.6f;
  scene.time = 1.5;
  const Image once = drawn(renderer, scene), twice = drawn(renderer, scene);
  EXPECT_EQ(count_differing(once, twice, 0), 0);
}

TEST_F(RendererTest, PositionsComeThroughTheSceneOrTheBuffer) {
  Renderer renderer = make_renderer();
  const WobblingGroup group = make_wobbling_group(2, 5, 3, 0.8f);
  renderer.set_bodies(group.views());
  const std::vector<float> positions = group.positions(2.5);
  Scene scene = plain();
  scene.placements = group.placements;
  scene.positions = positions;
  const Image through_scene = drawn(renderer, scene);
  renderer.set_bodies(group.views());
  scene.positions = {};
  const Image at_rest = drawn(renderer, scene);
  glNamedBufferSubData(renderer.position_buffer(), 0, GLsizeiptr(4 * positions.size()), positions.data());
  EXPECT_EQ(drawn(renderer, scene).bytes, through_scene.bytes);
  EXPECT_GT(count_differing(at_rest, through_scene, 10), 100);
}

TEST_F(RendererTest, MixedPositionsAreThoseOfFloatArithmetic) {
  Renderer renderer = make_renderer();
  const WobblingGroup group = make_wobbling_group(2, 5, 3, 0.8f);
  renderer.set_bodies(group.views());
  const std::vector<float> a = group.positions(2.5), b = group.positions(3.7);
  constexpr std::size_t offset = 512;  // [bytes]
  const auto source = [](const std::vector<float>& positions) {
    std::vector<float> padded(offset / 4, 1e9f);
    padded.insert(padded.end(), positions.begin(), positions.end());
    Buffer buffer;
    buffer.write(padded);
    return buffer;
  };
  const Buffer from = source(a), to = source(b);
  const float share = 1.0f / 3;
  renderer.mix_positions({from.get(), offset}, {to.get(), offset}, share);
  std::vector<float> mixed(a.size()), expected(a.size());
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(renderer.position_buffer(), 0, GLsizeiptr(4 * mixed.size()), mixed.data());
  for (std::size_t i = 0; i < a.size(); ++i) expected[i] = a[i] + share * (b[i] - a[i]);
  EXPECT_EQ(mixed, expected);
}

TEST_F(RendererTest, BoundsAreThoseOfThePositions) {
  Renderer renderer = make_renderer();
  const WobblingGroup group = make_wobbling_group(3, 6, 3, 0.8f);
  renderer.set_bodies(group.views());
  const std::vector<float> positions = group.positions(1);
  Scene scene = plain();
  scene.positions = positions;
  renderer.draw(scene, front());
  const std::vector<Bounds> bounds = renderer.body_bounds();
  ASSERT_EQ(bounds.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t first = renderer.mass_offsets()[i], end = renderer.mass_offsets()[i + 1];
    const Bounds expected = bounds_of(std::span(positions).subspan(3 * first, 3 * (end - first)));
    EXPECT_EQ(bounds[i].low, expected.low);
    EXPECT_EQ(bounds[i].high, expected.high);
  }
}

TEST_F(RendererTest, EveryModeIsDrawnWithoutMessagesFromTheDriver) {
  const WobblingGroup group = make_wobbling_group(2, 4, 3, 0.8f);
  const std::array labels{Label{0, "one"}, Label{1, "two\n1.2 m"}};
  for (const Quality quality : {Quality::low, Quality::medium, Quality::high}) {
    Renderer renderer(*context_, {.width = 97, .height = 61, .quality = quality});
    renderer.set_bodies(group.views());
    for (const Surroundings around : {Surroundings::none, Surroundings::water, Surroundings::land})
      for (const Theme theme : {Theme::dark, Theme::light})
        for (int shown = 0; shown < (quality == Quality::low ? 8 : 1); ++shown) {
          Scene scene;
          std::vector<Placement> placements = group.placements;
          placements[0].smooth = placements[0].selected = shown & 1;
          placements[1].faulty = shown & 2;
          scene.placements = placements;
          scene.surroundings = around;
          scene.theme = theme;
          scene.floor = -0.5f;
          scene.show = {(shown & 1) != 0, (shown & 2) != 0, (shown & 4) != 0};
          if (shown & 4) scene.cut = Cut{};
          scene.labels = labels;
          scene.clock = "1.0 s";
          scene.scale_bar = true;
          renderer.draw(scene, front());
          ASSERT_TRUE(context_->take_messages().empty()) << name_of(quality) << " " << shown;
        }
  }
}

TEST_F(RendererTest, ChangesOfSizeAndQualityKeepTheBodies) {
  Renderer renderer = make_renderer();
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  const Image before = drawn(renderer, plain());
  renderer.set_quality(Quality::high);
  renderer.resize(320, 240);
  drawn(renderer, plain());
  EXPECT_EQ(renderer.width(), 320);
  EXPECT_EQ(renderer.quality(), Quality::high);
  renderer.set_quality(Quality::low);
  renderer.resize(160, 120);
  EXPECT_EQ(drawn(renderer, plain()).bytes, before.bytes);
}

TEST_F(RendererTest, PositionsThatAreNotFiniteAffectNoOtherBody) {
  Renderer renderer = make_renderer();
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  const Image alone = drawn(renderer, plain());
  renderer.set_bodies(std::array{mesh.body(), mesh.body()});
  std::vector<float> positions = mesh.positions;
  positions.resize(18, std::numeric_limits<float>::quiet_NaN());
  Scene scene = plain();
  scene.positions = positions;
  EXPECT_LT(count_differing(drawn(renderer, scene), alone, 2), 8);
}

TEST_F(RendererTest, AThousandBodiesAreDrawnAsOneGroup) {
  Renderer renderer = make_renderer();
  const WobblingBody body = make_wobbling_body(4, 9);
  std::vector<Body> bodies(1000, body.body());
  std::vector<Placement> placements(1000);
  for (std::size_t i = 0; i < 1000; ++i) placements[i].offset = {0.5f * float(i % 40), 0.5f * float(i / 40), 0};
  renderer.set_bodies(bodies);
  Scene scene = plain();
  scene.placements = placements;
  const Orbit orbit = top_view({Vector3(0, 0, 0), Vector3(20, 12.5f, 0.3f)}, 160.0f / 120);
  const Image many = drawn(renderer, scene, orbit.camera());
  for (Placement& place : placements) place.hidden = &place != &placements[0];
  const Image one = drawn(renderer, scene, orbit.camera());
  EXPECT_GT(count_differing(many, one, 20), 1000);
}

TEST_F(RendererTest, ReportsTheTimesOfThePartsOfAPicture) {
  Renderer renderer = make_renderer();
  EXPECT_TRUE(renderer.times().empty());
  for (int i = 0; i < 6; ++i) {
    renderer.draw(plain(), front());
    glFinish();
  }
  ASSERT_FALSE(renderer.times().empty());
  EXPECT_EQ(renderer.times().front().name, "positions");
  for (const PassTime& part : renderer.times()) EXPECT_GE(part.milliseconds, 0) << part.name;
}

TEST_F(RendererTest, RestoresDepthStateForOthers) {
  Renderer renderer = make_renderer();
  renderer.draw(plain(), front());
  GLint value = 0;
  glGetIntegerv(GL_CLIP_DEPTH_MODE, &value);
  EXPECT_EQ(value, GL_NEGATIVE_ONE_TO_ONE);
  glGetIntegerv(GL_DEPTH_FUNC, &value);
  EXPECT_EQ(value, GL_LESS);
  EXPECT_FALSE(glIsEnabled(GL_BLEND));
}

TEST_F(RendererTest, WrongLengthsAndIndicesThrow) {
  Renderer renderer = make_renderer();
  Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  const std::array<float, 2> two{};
  Scene scene = plain();
  scene.positions = two;
  EXPECT_THROW(renderer.draw(scene, front()), std::invalid_argument);
  scene.positions = {};
  scene.face_values = two;
  EXPECT_THROW(renderer.draw(scene, front()), std::invalid_argument);
  mesh.faces = {0, 1, 3};
  EXPECT_THROW(renderer.set_bodies(std::array{mesh.body()}), std::invalid_argument);
  EXPECT_THROW(renderer.resize(0, 5), ContextError);
  EXPECT_THROW(renderer.resize(1 << 20, 5), ContextError);
}

}  // namespace
}  // namespace mercury::render
