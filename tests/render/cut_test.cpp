// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "render/cut.h"

#include "tests/render/triangle.h"

namespace mercury::render {
namespace {

using Eigen::Matrix3f;

const std::array materials{RenderMaterial{.color = {200, 40, 40}}, RenderMaterial{.color = {40, 200, 40}}};
bool is_green(const Rgb& color) { return 2 * color.y > 3 * color.x; }
bool is_red(const Rgb& color) { return 2 * color.x > 3 * color.y; }

class CutTest : public Offscreen {};

TEST_F(CutTest, ACutRemovesTheSideItsNormalPointsTo) {
  Renderer renderer = make_renderer();
  const Image empty = drawn(renderer, plain());
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  const Image whole = drawn(renderer, plain());
  Scene scene = plain();
  scene.cut = Cut{.axis = 2, .percent = 100 * 0.5f / 1.3f};  // the triangle reaches from z = -0.5 to 0.8
  const Image cut = drawn(renderer, scene);
  const Vector2 above = pinhole(front(), {0.1f, 0, 0.3f}, 160, 120), below = pinhole(front(), {0, 0, -0.3f}, 160, 120);
  EXPECT_LE(largest_difference(pixel(cut, int(above.x), int(above.y)), pixel(empty, int(above.x), int(above.y))), 1);
  EXPECT_LE(largest_difference(pixel(cut, int(below.x), int(below.y)), pixel(whole, int(below.x), int(below.y))), 6);
}

// A cube of side 1 about the origin: faces of material 0; springs of material 1 along its edges and through its middle.
struct Cube {
  std::vector<float> positions;
  std::vector<std::uint32_t> faces{0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                   2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  std::vector<std::uint32_t> springs, spring_materials;
  Cube() {
    for (std::uint32_t i = 0; i < 8; ++i)
      for (const std::uint32_t bit : {1u, 2u, 4u}) positions.push_back(i & bit ? 0.5f : -0.5f);
    for (std::uint32_t a = 0; a < 8; ++a)
      for (std::uint32_t b = a + 1; b < 8; ++b) springs.insert(springs.end(), {a, b});
    spring_materials.assign(springs.size() / 2, 1);
  }
  Body body() const { return {positions, faces, springs, {}, spring_materials}; }
};

TEST_F(CutTest, ACutShowsSolidBodiesInTheMaterialsOfTheirSprings) {
  Renderer renderer = make_renderer();
  const Cube cube;
  renderer.set_bodies(std::array{cube.body()});
  Scene scene = plain();
  scene.materials = materials;
  const Image whole = drawn(renderer, scene);
  scene.cut = Cut{.axis = 1, .below = true};  // its near half is gone
  const Image cut = drawn(renderer, scene);
  // The square where the plane cuts the cube, without its rim.
  for (const float x : {-0.44f, -0.2f, 0.0f, 0.2f, 0.44f})
    for (const float z : {-0.44f, -0.2f, 0.0f, 0.2f, 0.44f}) {
      const Vector2 at = pinhole(front(), {x, 0, z}, 160, 120);
      EXPECT_TRUE(is_red(pixel(whole, int(at.x), int(at.y)))) << x << " " << z;
      EXPECT_TRUE(is_green(pixel(cut, int(at.x), int(at.y)))) << x << " " << z;
    }
  // From behind, the cut is not visible.
  const Camera behind{.eye = {0.2f, 4, 0.1f}};
  const Vector2 middle = pinhole(behind, {0, 0.5f, 0}, 160, 120);
  EXPECT_TRUE(is_red(pixel(drawn(renderer, scene, behind), int(middle.x), int(middle.y))));
  // With springs shown, bodies are hollow: between the springs, the far wall is visible.
  scene.show.springs = true;
  scene.spring_radius = 0.005f;
  const Vector2 between = pinhole(front(), {0.13f, 0.5f, 0.33f}, 160, 120);
  EXPECT_TRUE(is_red(pixel(drawn(renderer, scene), int(between.x), int(between.y))));
}

Vector3 column(const Matrix3f& m, int i) { return {m(0, i), m(1, i), m(2, i)}; }

Vector3 times(const Matrix3f& m, const Vector3& v) {
  return v.x * column(m, 0) + v.y * column(m, 1) + v.z * column(m, 2);
}

std::vector<float> turned(const std::vector<float>& positions, const Matrix3f& rotation, const Vector3& offset) {
  std::vector<float> result;
  for (std::size_t i = 0; i < positions.size(); i += 3) {
    const Vector3 p = times(rotation, Vector3(positions.data() + i)) + offset;
    result.insert(result.end(), p.data(), p.data() + 3);
  }
  return result;
}

std::vector<Matrix3f> rotations() {
  std::vector<Matrix3f> all{Matrix3f::Identity()};
  for (int axis = 0; axis < 3; ++axis)  // half turns
    all.push_back(Eigen::AngleAxisf(std::numbers::pi_v<float>, Eigen::Vector3f::Unit(axis)).toRotationMatrix());
  for (int i = 1; i < 20; ++i)
    all.push_back(Eigen::AngleAxisf(0.55f * float(i),
                                    Eigen::Vector3f(std::sin(float(i)), std::cos(1.7f * float(i)), 0.3f).normalized())
                      .toRotationMatrix());
  return all;
}

TEST(CutFrame, TurnsAndMovesWithTheBody) {
  // A box of sides 1, 2, 3 and a few masses inside.
  std::vector<float> rest;
  for (std::uint32_t i = 0; i < 8; ++i)
    rest.insert(rest.end(), {i & 1 ? 1.0f : 0.0f, i & 2 ? 2.0f : 0.0f, i & 4 ? 3.0f : 0.0f});
  rest.insert(rest.end(), {0.2f, 0.3f, 1, 0.7f, 1.9f, 2.5f});
  const Vector3 offset(5, -7, 3);
  for (const Matrix3f& rotation : rotations()) {
    const std::vector<float> now = turned(rest, rotation, offset);
    for (int axis = 0; axis < 3; ++axis) {
      const CutFrame frame = cut_frame(axis, rest, now).value();
      EXPECT_LT((frame.axis - column(rotation, axis)).norm(), 1e-3f);
      const float start = column(rotation, axis).dot(offset);
      EXPECT_NEAR(frame.low, start, 5e-3f);
      EXPECT_NEAR(frame.high, start + float(axis + 1), 5e-3f);
      const CutPlane plane = frame.plane_of({.axis = axis, .percent = 25});
      const auto removed = [&](float share) {
        return plane.removes(share * float(axis + 1) * column(rotation, axis) + offset);
      };
      EXPECT_FALSE(removed(0.23f));
      EXPECT_TRUE(removed(0.27f));
    }
  }
}

TEST(CutFrame, FollowsABodyThatIsStretchedAndHasLostMasses) {
  const std::vector<float> rest{-1, 0, 0, 1, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 1};
  std::vector<float> now = rest;
  now[0] = -3;    // one mass is pulled along x
  now[14] = NAN;  // another is lost
  const CutFrame frame = cut_frame(0, rest, now).value();
  EXPECT_LT((frame.axis - Vector3::unit(0)).norm(), 1e-3f);
  EXPECT_NEAR(frame.low, -3, 1e-3f);
  EXPECT_NEAR(frame.high, 1, 1e-3f);
  EXPECT_FALSE(cut_frame(0, rest, std::vector<float>(15, NAN)));
  EXPECT_FALSE(cut_frame(0, {}, {}));
}

TEST(CutFrame, OfABodyThatMayTurnFreelyStaysUpright) {
  const std::vector<float> rest{-1, 0, 0, 0, 0, 0, 1, 0, 0};  // turns about x change nothing
  EXPECT_LT((cut_frame(2, rest, rest).value().axis - Vector3::unit(2)).norm(), 1e-3f);
}

TEST(CutFrame, ItsEndsKeepAllOrNothing) {
  const Cube cube;
  const CutFrame frame = cut_frame(0, cube.positions, cube.positions).value();
  for (std::size_t i = 0; i < cube.positions.size(); i += 3) {
    const Vector3 corner(cube.positions.data() + i);
    EXPECT_FALSE(frame.plane_of({.axis = 0, .percent = 100}).removes(corner));
    EXPECT_TRUE(frame.plane_of({.axis = 0, .percent = 0}).removes(corner));
    EXPECT_FALSE(frame.plane_of({.axis = 0, .below = true, .percent = 0}).removes(corner));
    EXPECT_TRUE(frame.plane_of({.axis = 0, .below = true, .percent = 100}).removes(corner));
  }
  EXPECT_NEAR(frame.place_of({.axis = 0, .shift = 0.2f}), 0.2f, 1e-6f) << "meters from the middle";
}

// The GPU's planes are those of theory: a section is where the turned body's own plane is, and nowhere else.
TEST_F(CutTest, EachBodyIsCutInItsOwnFrame) {
  Renderer renderer = make_renderer();
  const Cube cube;
  renderer.set_bodies(std::array{cube.body(), cube.body()});
  Scene scene = plain();
  scene.materials = materials;
  scene.cut = Cut{.axis = 0, .percent = 60};
  std::array<Placement, 2> placements;
  placements[0].offset = Vector3(-0.9f, 0, 0);
  placements[1].offset = Vector3(0.9f, 0.3f, 0.1f);
  scene.placements = placements;
  const Camera camera{.eye = {0.2f, -6, 0.4f}};
  const Vector3 drift(0.1f, 0.05f, -0.1f);
  int seen = 0, hidden = 0;
  const std::vector<Matrix3f> all = rotations();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::array<Matrix3f, 2> turns{all[i], all[(i + 5) % all.size()]};
    std::vector<float> positions;
    for (const Matrix3f& turn : turns)
      for (const float x : turned(cube.positions, turn, drift)) positions.push_back(x);
    scene.positions = positions;
    const Image image = drawn(renderer, scene, camera);
    for (std::size_t body = 0; body < 2; ++body) {
      const Vector3 normal = column(turns[body], 0), middle = placements[body].offset + drift + 0.1f * normal;
      const Vector2 at = pinhole(camera, middle, 160, 120);
      const float slant = normal.dot((camera.eye - middle).normalized());
      const Rgb color = pixel(image, int(at.x), int(at.y));
      if (slant > 0.3f) {
        ++seen;
        EXPECT_TRUE(is_green(color)) << i << " " << body;
      } else if (slant < -0.3f) {
        ++hidden;
        EXPECT_TRUE(is_red(color)) << i << " " << body;
      }
    }
  }
  EXPECT_GT(seen, 5);
  EXPECT_GT(hidden, 5);
}

// A body in front of another, both cut: each section has the color of its own springs.
TEST_F(CutTest, SectionsDoNotTakeTheColorsOfOtherBodies) {
  Renderer renderer = make_renderer();
  const Cube cube;
  std::vector<std::uint32_t> blue(cube.spring_materials.size(), 2);
  renderer.set_bodies(std::array{cube.body(), Body{cube.positions, cube.faces, cube.springs, {}, blue}});
  Scene scene = plain();
  const std::array three{materials[0], materials[1], RenderMaterial{.color = {40, 40, 200}}};
  scene.materials = three;
  scene.cut = Cut{.axis = 1, .below = true};
  std::array<Placement, 2> placements;
  placements[0].offset = Vector3(-0.2f, -1, 0);  // nearer; it covers part of the other
  placements[1].offset = Vector3(0.35f, 1, 0);
  scene.placements = placements;
  const Camera camera{.eye = {0, -6, 0}};
  const Image image = drawn(renderer, scene, camera);
  int near = 0, far = 0;
  for (float x = -0.6f; x < 0.8f; x += 0.02f)
    for (const float z : {-0.3f, 0.0f, 0.3f}) {
      const Vector2 in_front = pinhole(camera, {x, -1, z}, 160, 120), behind = pinhole(camera, {x, 1, z}, 160, 120);
      if (x > -0.66f && x < 0.26f) {
        ++near;
        EXPECT_TRUE(is_green(pixel(image, int(in_front.x), int(in_front.y)))) << x << " " << z;
      }
      // Beside the nearer cube, whose right edge is at x = 0.3, or 0.42 at the other's distance.
      if (x > 0.47f && x < 0.8f) {
        ++far;
        const Rgb color = pixel(image, int(behind.x), int(behind.y));
        EXPECT_GT(color.z, color.y + 30) << x << " " << z;
      }
    }
  EXPECT_GT(near, 50);
  EXPECT_GT(far, 20);
}

// Two arms on a base, from -y to y: a cut across the arms must not fill the gap between them.
struct Fork {
  std::vector<float> positions;
  std::vector<std::uint32_t> faces, springs, spring_materials;
  Fork() {
    constexpr float outline[8][2] = {{-1, -0.5f},   {1, -0.5f},     {1, 0.5f},     {0.5f, 0.5f},
                                     {0.5f, -0.2f}, {-0.5f, -0.2f}, {-0.5f, 0.5f}, {-1, 0.5f}};  // x, z
    for (const float y : {-0.3f, 0.3f})
      for (const auto& [x, z] : outline) positions.insert(positions.end(), {x, y, z});
    for (const auto& [a, b, c, d] : {std::array{0u, 1u, 4u, 5u}, {0u, 5u, 6u, 7u}, {1u, 2u, 3u, 4u}}) {
      faces.insert(faces.end(), {a, b, c, a, c, d});
      faces.insert(faces.end(), {a + 8, c + 8, b + 8, a + 8, d + 8, c + 8});
    }
    for (std::uint32_t i = 0; i < 8; ++i) {
      const std::uint32_t j = (i + 1) % 8;
      faces.insert(faces.end(), {i, i + 8, j + 8, i, j + 8, j});
    }
    for (std::uint32_t a = 0; a < 16; ++a)
      for (std::uint32_t b = a + 1; b < 16; ++b) springs.insert(springs.end(), {a, b});
    spring_materials.assign(springs.size() / 2, 1);
  }
};

TEST_F(CutTest, ACutOfAConcaveBodyLeavesItsGapsOpen) {
  Renderer renderer = make_renderer();
  const Fork fork;
  renderer.set_bodies(std::array{Body{fork.positions, fork.faces, fork.springs, {}, fork.spring_materials}});
  Scene scene = plain();
  scene.materials = materials;
  scene.cut = Cut{.axis = 2, .percent = 70};  // z = 0.2 of -0.5 to 0.5
  const Camera above{.eye = {0, -2.5f, 3}};
  const Image image = drawn(renderer, scene, above);
  for (const float x : {-0.3f, 0.0f, 0.3f}) {
    // The line of sight goes on to the base at y = 0.2, and leaves the body through its lower side.
    const Vector2 gap = pinhole(above, {x, -0.15f, 0.2f}, 160, 120);
    EXPECT_TRUE(is_red(pixel(image, int(gap.x), int(gap.y)))) << x;
  }
  for (const float x : {-0.75f, 0.75f}) {
    const Vector2 arm = pinhole(above, {x, -0.1f, 0.2f}, 160, 120);
    EXPECT_TRUE(is_green(pixel(image, int(arm.x), int(arm.y)))) << x;
  }
}

}  // namespace
}  // namespace mercury::render
