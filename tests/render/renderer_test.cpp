#include "render/renderer.h"

#include <epoxy/gl.h>

#include <array>
#include <cmath>
#include <limits>

#include "tests/render/offscreen.h"
#include "tests/render/wobbling_bodies.h"

namespace mercury::render {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;
using Eigen::Vector3i;

struct Mesh {
  std::vector<float> positions;
  std::vector<std::uint32_t> faces, springs;
  Body body() const { return {positions, faces, springs, {}, {}}; }
};

// Faces the eye of `front()`.
Mesh triangle(float y = 0) { return {{-0.8f, y, -0.5f, 0.9f, y, -0.4f, 0.1f, y, 0.8f}, {0, 1, 2}, {0, 1, 1, 2, 2, 0}}; }

Camera front() { return {.eye = {0.4f, -4, 0.3f}, .target = {0, 0, 0.1f}}; }

// Nothing but the bodies.
Scene plain() {
  Scene scene;
  scene.surroundings = Surroundings::none;
  return scene;
}

Image drawn(Renderer& renderer, const Scene& scene, const Camera& camera = front()) {
  renderer.draw(scene, camera);
  return read(renderer);
}

// Similar triangles, in the test's own words.
Vector2f pinhole(const Camera& camera, const Vector3f& point, int width, int height) {
  const Vector3f forward = (camera.target - camera.eye).normalized();
  const Vector3f right = Vector3f(forward.y(), -forward.x(), 0).normalized();
  const Vector3f up(right.y() * forward.z() - right.z() * forward.y(),
                    right.z() * forward.x() - right.x() * forward.z(),
                    right.x() * forward.y() - right.y() * forward.x());
  const Vector3f p = point - camera.eye;
  const float scale = float(height) / 2 / std::tan(camera.field_of_view / 2) / p.dot(forward);
  return {float(width) / 2 + scale * p.dot(right), float(height) / 2 - scale * p.dot(up)};
}

// Distance of a point from a triangle's edges in pixels, positive inside, for corners in either order.
float depth_inside(const Vector2f& point, const std::array<Vector2f, 3>& corners) {
  const auto cross = [](const Vector2f& a, const Vector2f& b) { return a.x() * b.y() - a.y() * b.x(); };
  const float sign = cross(corners[1] - corners[0], corners[2] - corners[0]) > 0 ? 1.0f : -1.0f;
  float inside = 1e9f;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector2f edge = corners[(i + 1) % 3] - corners[i];
    inside = std::min(inside, sign * cross(edge, point - corners[i]) / edge.norm());
  }
  return inside;
}

class RendererTest : public Offscreen {};

TEST_F(RendererTest, ATriangleLandsWhereTheCameraSays) {
  Renderer renderer = make_renderer(200, 150);
  const Image empty = drawn(renderer, plain());
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  const Image image = drawn(renderer, plain());
  std::array<Vector2f, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) corners[i] = pinhole(front(), Vector3f(mesh.positions.data() + 3 * i), 200, 150);
  for (int y = 0; y < 150; ++y)
    for (int x = 0; x < 200; ++x) {
      const float inside = depth_inside({float(x) + 0.5f, float(y) + 0.5f}, corners);
      const int change = largest_difference(pixel(image, x, y), pixel(empty, x, y));
      if (inside > 1) {
        ASSERT_GT(change, 20) << x << ", " << y;
      } else if (inside < -1) {
        ASSERT_LE(change, 1) << x << ", " << y;
      }
    }
}

TEST_F(RendererTest, EdgesAreSmooth) {
  Renderer renderer = make_renderer();
  const Image empty = drawn(renderer, plain());
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  const Image image = drawn(renderer, plain());
  const int full = largest_difference(pixel(image, 80, 60), pixel(empty, 80, 60));
  int between = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      const int change = largest_difference(pixel(image, x, y), pixel(empty, x, y));
      between += change > full / 5 && change < full * 4 / 5;
    }
  EXPECT_GT(between, 40);
}

TEST_F(RendererTest, APlacementMovesABody) {
  Renderer renderer = make_renderer();
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  Scene scene = plain();
  const std::array placements{Placement{.offset = {0.5f, 0.2f, -0.3f}}};
  scene.placements = placements;
  const Image placed = drawn(renderer, scene);
  std::vector<float> moved = mesh.positions;
  for (std::size_t i = 0; i < moved.size(); i += 3) moved[i] += 0.5f, moved[i + 1] += 0.2f, moved[i + 2] -= 0.3f;
  Scene other = plain();
  other.positions = moved;
  EXPECT_EQ(count_differing(placed, drawn(renderer, other), 2), 0);
}

TEST_F(RendererTest, APlacementChoosesAmongLooksWithoutNewBodies) {
  Renderer renderer = make_renderer();
  const Mesh mesh = triangle();
  const std::array<std::uint32_t, 1> face_look{1};
  const std::array<std::uint32_t, 3> spring_looks{1, 1, 1};
  Body body = mesh.body();
  body.face_looks = face_look;
  body.spring_looks = spring_looks;
  // Prepared beforehand, as on another thread.
  const std::array prepared{prepare_body(body)};
  renderer.set_bodies(assemble(prepared));
  EXPECT_EQ(renderer.spring_count(), 3u);
  const std::array looks{Look{rgb(0x101010)}, Look{rgb(0xd01010)}, Look{rgb(0x101010)}, Look{rgb(0x1010d0)}};
  for (const bool springs : {false, true}) {
    Scene scene = plain();
    scene.show = {.skin = !springs, .springs = springs};
    scene.spring_radius = 0.1f;
    scene.looks = looks;
    const Vector2f middle = pinhole(front(), {0.05f, 0, -0.45f}, 160, 120);  // of the first spring
    const auto color = [&](std::uint32_t first_look) {
      const std::array placements{Placement{.selected = false, .first_look = first_look}};
      scene.placements = placements;
      return springs ? pixel(drawn(renderer, scene), int(middle.x()), int(middle.y())) : pixel(drawn(renderer, scene), 80, 60);
    };
    const Eigen::Vector3i red = color(0), blue = color(2);
    EXPECT_GT(red.x(), red.z() + 80) << springs;
    EXPECT_GT(blue.z(), blue.x() + 80) << springs;
  }
}

TEST_F(RendererTest, TheNearerBodyHidesTheFartherInEitherOrder) {
  Renderer renderer = make_renderer();
  const Mesh near = triangle(-0.5f), far = triangle(0.5f);
  const std::array<std::uint32_t, 1> first{0}, second{1};
  const std::array looks{Look{rgb(0xd01010)}, Look{rgb(0x1010d0)}};
  Scene scene = plain();
  scene.looks = looks;
  Body a = near.body(), b = far.body();
  a.face_looks = first;
  b.face_looks = second;
  renderer.set_bodies(std::array{a, b});
  const Eigen::Vector3i near_color = pixel(drawn(renderer, scene), 80, 60);
  renderer.set_bodies(std::array{b, a});
  EXPECT_LE(largest_difference(pixel(drawn(renderer, scene), 80, 60), near_color), 1);
  EXPECT_GT(near_color.x(), near_color.z() + 80);
}

TEST_F(RendererTest, AHiddenBodyLeavesNoTrace) {
  Renderer renderer = make_renderer();
  Scene scene = plain();
  scene.surroundings = Surroundings::land;
  scene.floor = -1;
  const Image empty = drawn(renderer, scene);
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  const std::array placements{Placement{.hidden = true}};
  scene.placements = placements;
  scene.show = {true, true, true};
  EXPECT_EQ(count_differing(drawn(renderer, scene), empty, 1), 0);
}

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

TEST_F(RendererTest, AContractedMuscleIsBrighterThanAStretchedOne) {
  Renderer renderer = make_renderer();
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  int last = -1;
  for (const float activation : {-1.0f, 0.0f, 0.6f, 1.0f}) {
    const std::array looks{Look{muscle_color(0, 0.5f), activation}};
    Scene scene = plain();
    scene.looks = looks;
    const int brightness = pixel(drawn(renderer, scene), 80, 60).sum();
    EXPECT_GT(brightness, last + 10) << activation;
    last = brightness;
  }
}

TEST_F(RendererTest, ValuesColorSkinsSpringsAndMassesByTheScale) {
  Renderer renderer = make_renderer();
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  const std::array<float, 1> low_face{0}, high_face{1};
  const std::array<float, 3> low{0, 0, 0}, high{1, 1, 1};
  const auto check = [&](Scene scene, auto set) {
    scene.scale = {0, 1, Colormap::diverging};
    set(scene, false);
    const Image cold = drawn(renderer, scene);
    set(scene, true);
    const Image warm = drawn(renderer, scene);
    int redder = 0, bluer = 0;
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 160; ++x) {
        if (largest_difference(pixel(cold, x, y), pixel(warm, x, y)) < 10) continue;
        redder += pixel(warm, x, y).x() > pixel(warm, x, y).z();
        bluer += pixel(cold, x, y).z() > pixel(cold, x, y).x();
      }
    EXPECT_GT(redder, 50);
    EXPECT_GT(bluer, 50);
  };
  check(plain(), [&](Scene& s, bool warm) { s.face_values = warm ? high_face : low_face; });
  check(plain(), [&](Scene& s, bool warm) { s.mass_values = warm ? high : low; });
  Scene springs = plain();
  springs.show = {false, true, false};
  springs.spring_radius = 0.05f;
  check(springs, [&](Scene& s, bool warm) { s.spring_values = warm ? high : low; });
  Scene masses = plain();
  masses.show = {false, false, true};
  masses.mass_radius = 0.1f;
  check(masses, [&](Scene& s, bool warm) { s.mass_values = warm ? high : low; });
}

TEST_F(RendererTest, LegendsColorsAreThoseOfItsValues) {
  Renderer renderer = make_renderer(320, 240);
  for (int map = 0; map < colormap_count; ++map) {
    Scene scene = plain();
    const Image without = drawn(renderer, scene);
    scene.legend = Legend{"speed", "m/s", Scale{0, 1, Colormap(map)}, {}};
    const Image image = drawn(renderer, scene);
    // The bar is found by its colours: a column in which the high end's and the low end's both stand.
    const auto close = [&](int x, int y, float t) {
      const Color c = color_at(Colormap(map), t);
      return largest_difference(pixel(image, x, y), {c.r, c.g, c.b}) <= 6;
    };
    int column = -1, top = 0, bottom = 0;
    for (int x = 319; x > 160 && column < 0; --x)
      for (int high = 0; high < 240 && column < 0; ++high)
        if (close(x, high, 0.994f))
          for (int low = 239; low > high + 60; --low)
            if (close(x, low, 0.006f)) {
              column = x - 3, top = high, bottom = low;
              break;
            }
    ASSERT_GE(column, 0) << name_of(Colormap(map));
    for (int y = top; y <= bottom; ++y) {
      const float t = 1 - (float(y - top) + 0.5f) / float(bottom - top + 1);
      const Color expected = color_at(Colormap(map), t);
      EXPECT_LE(largest_difference(pixel(image, column, y), {expected.r, expected.g, expected.b}), 12) << y;
    }
    EXPECT_EQ(largest_difference(pixel(image, 20, 20), pixel(without, 20, 20)), 0);
  }
}

TEST_F(RendererTest, ACutTakesAwayTheSideItsNormalPointsTo) {
  Renderer renderer = make_renderer();
  const Image empty = drawn(renderer, plain());
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  const Image whole = drawn(renderer, plain());
  Scene scene = plain();
  scene.cut = CutPlane{{0, 0, 1}, 0};
  const Image cut = drawn(renderer, scene);
  const Vector2f above = pinhole(front(), {0.1f, 0, 0.3f}, 160, 120), below = pinhole(front(), {0, 0, -0.3f}, 160, 120);
  EXPECT_LE(
      largest_difference(pixel(cut, int(above.x()), int(above.y())), pixel(empty, int(above.x()), int(above.y()))), 1);
  EXPECT_LE(
      largest_difference(pixel(cut, int(below.x()), int(below.y())), pixel(whole, int(below.x()), int(below.y()))), 6);
}

// A cube of side 1 about the origin: faces of look 0, springs along its edges and through its middle of look 1.
struct Cube {
  std::vector<float> positions;
  std::vector<std::uint32_t> faces{0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                   2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  std::vector<std::uint32_t> springs, spring_looks;
  Cube() {
    for (std::uint32_t i = 0; i < 8; ++i)
      for (const std::uint32_t bit : {1u, 2u, 4u}) positions.push_back(i & bit ? 0.5f : -0.5f);
    for (std::uint32_t a = 0; a < 8; ++a)
      for (std::uint32_t b = a + 1; b < 8; ++b) springs.insert(springs.end(), {a, b});
    spring_looks.assign(springs.size() / 2, 1);
  }
  Body body() const { return {positions, faces, springs, {}, spring_looks}; }
};

TEST_F(RendererTest, ACutShowsBodiesAsSolidInTheLooksOfTheirSprings) {
  Renderer renderer = make_renderer();
  const Cube cube;
  renderer.set_bodies(std::array{cube.body()});
  Scene scene = plain();
  const std::array looks{Look{.color = {200, 40, 40}}, Look{.color = {40, 200, 40}}};
  scene.looks = looks;
  const auto is_green = [](const Vector3i& color) { return 2 * color.y() > 3 * color.x(); };
  const auto is_red = [](const Vector3i& color) { return 2 * color.x() > 3 * color.y(); };
  const Image whole = drawn(renderer, scene);
  scene.cut = CutPlane{{0, -1, 0}, 0};  // its near half is gone
  const Image cut = drawn(renderer, scene);
  // The square that the plane cuts out of the cube, but for its rim.
  for (const float x : {-0.44f, -0.2f, 0.0f, 0.2f, 0.44f})
    for (const float z : {-0.44f, -0.2f, 0.0f, 0.2f, 0.44f}) {
      const Vector2f at = pinhole(front(), {x, 0, z}, 160, 120);
      EXPECT_TRUE(is_red(pixel(whole, int(at.x()), int(at.y())))) << x << " " << z;
      EXPECT_TRUE(is_green(pixel(cut, int(at.x()), int(at.y())))) << x << " " << z;
    }
  // From behind, the cut is not seen.
  const Camera behind{.eye = {0.2f, 4, 0.1f}};
  const Vector2f middle = pinhole(behind, {0, 0.5f, 0}, 160, 120);
  EXPECT_TRUE(is_red(pixel(drawn(renderer, scene, behind), int(middle.x()), int(middle.y()))));
  // With springs shown, it is a window: between them, the far wall.
  scene.show.springs = true;
  scene.spring_radius = 0.005f;
  const Vector2f between = pinhole(front(), {0.13f, 0.5f, 0.33f}, 160, 120);
  EXPECT_TRUE(is_red(pixel(drawn(renderer, scene), int(between.x()), int(between.y()))));
}

TEST_F(RendererTest, AShadowFallsBesideABodyOnTheGround) {
  Renderer renderer = make_renderer();
  const WobblingGroup group = make_wobbling_group(1, 6, 3, 1);
  Scene scene;
  scene.surroundings = Surroundings::land;
  scene.floor = -0.5f;
  Orbit orbit{.elevation = 1.2f, .distance = 4};
  const Image empty = drawn(renderer, scene, orbit.camera());
  renderer.set_bodies(group.views());
  const Image image = drawn(renderer, scene, orbit.camera());
  int darker = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) darker += pixel(image, x, y).sum() < pixel(empty, x, y).sum() - 40;
  EXPECT_GT(darker, 150);
  EXPECT_LE(largest_difference(pixel(image, 2, 2), pixel(empty, 2, 2)), 1);
}

TEST_F(RendererTest, ArrowsAndPathsAreDrawnWhereTheyPoint) {
  Renderer renderer = make_renderer();
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  Scene scene = plain();
  scene.show.skin = false;
  const Image empty = drawn(renderer, scene);
  const std::array arrows{Arrow{0, {-1, 0, 0}, {1.5f, 0, 0}, rgb(0xff8000)}};
  scene.arrows = arrows;
  const Image arrow = drawn(renderer, scene);
  const Vector2f on = pinhole(front(), {-0.3f, 0, 0}, 160, 120), off = pinhole(front(), {0.7f, 0, 0}, 160, 120);
  EXPECT_GT(largest_difference(pixel(arrow, int(on.x()), int(on.y())), pixel(empty, int(on.x()), int(on.y()))), 60);
  EXPECT_LE(largest_difference(pixel(arrow, int(off.x()), int(off.y())), pixel(empty, int(off.x()), int(off.y()))), 1);
  const std::array<float, 6> points{-1, 0, 0.5f, 1, 0, 0.5f};
  const std::array paths{Path{0, points, rgb(0x40ff40)}};
  scene.arrows = {};
  scene.paths = paths;
  const Image path = drawn(renderer, scene);
  int changed = 0;
  const Vector2f end = pinhole(front(), {0.95f, 0, 0.5f}, 160, 120);
  for (int dy = -2; dy <= 2; ++dy)
    changed += largest_difference(pixel(path, int(end.x()), int(end.y()) + dy),
                                  pixel(empty, int(end.x()), int(end.y()) + dy)) > 20;
  EXPECT_GT(changed, 0);
}

TEST_F(RendererTest, SpecksDriftWithTheFlow) {
  Renderer renderer = make_renderer();
  Scene scene;
  scene.floor = -100;
  const Image still = drawn(renderer, scene);
  scene.flow = {2, 0, 0};
  EXPECT_GT(count_differing(still, drawn(renderer, scene), 3), 10);
}

TEST_F(RendererTest, EveryModeIsDrawnWithoutAWordFromTheDriver) {
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
          if (shown & 4) scene.cut = CutPlane{};
          scene.labels = labels;
          scene.clock = "1.0 s";
          scene.scale_bar = true;
          renderer.draw(scene, front());
          ASSERT_TRUE(context_->take_messages().empty()) << name_of(quality) << " " << shown;
        }
  }
}

TEST_F(RendererTest, SizeAndQualityChangeWithoutLosingTheScene) {
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

TEST_F(RendererTest, PositionsThatAreNotFiniteHarmNoOtherBody) {
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
  const Orbit orbit = top_view({Vector3f(0, 0, 0), Vector3f(20, 12.5f, 0.3f)}, 160.0f / 120);
  const Image many = drawn(renderer, scene, orbit.camera());
  for (Placement& place : placements) place.hidden = &place != &placements[0];
  const Image one = drawn(renderer, scene, orbit.camera());
  EXPECT_GT(count_differing(many, one, 20), 1000);
}

TEST_F(RendererTest, TellsHowLongThePartsOfAPictureTook) {
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

TEST_F(RendererTest, LeavesDepthAsOthersExpectIt) {
  Renderer renderer = make_renderer();
  renderer.draw(plain(), front());
  GLint value = 0;
  glGetIntegerv(GL_CLIP_DEPTH_MODE, &value);
  EXPECT_EQ(value, GL_NEGATIVE_ONE_TO_ONE);
  glGetIntegerv(GL_DEPTH_FUNC, &value);
  EXPECT_EQ(value, GL_LESS);
  EXPECT_FALSE(glIsEnabled(GL_BLEND));
}

TEST_F(RendererTest, WrongLengthsAndIndicesAreRefused) {
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
