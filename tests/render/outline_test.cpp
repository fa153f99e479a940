// SPDX-License-Identifier: Apache-2.0
// Selected bodies have a line around their silhouettes, and nothing else changes.
#include <algorithm>
#include <array>

#include "tests/render/triangle.h"

namespace mercury::render {
namespace {

constexpr int outline_width = 200, outline_height = 150;
constexpr float line = 3.6f;  // at most so far outside [pixels]

class OutlineTest : public Offscreen {
 protected:
  // The picture with the first body selected, or not.
  static Image with(Renderer& renderer, Scene scene, bool selected, std::size_t bodies = 1,
                    const Camera& camera = front()) {
    std::vector<Placement> placements(bodies);
    placements[0].selected = selected;
    scene.placements = placements;
    return drawn(renderer, scene, camera);
  }
};

// Whether a pixel within `reach` of (x, y) is one of those that differ.
bool any_near(const Image& a, const Image& b, int x, int y, int reach) {
  for (int v = std::max(0, y - reach); v <= std::min(outline_height - 1, y + reach); ++v)
    for (int u = std::max(0, x - reach); u <= std::min(outline_width - 1, x + reach); ++u)
      if (largest_difference(pixel(a, u, v), pixel(b, u, v)) > 2) return true;
  return false;
}

// Pixels of the body that the edge of its silhouette does not touch keep their colors exactly, and the line is beside
// it.
void expect_line_around(const Image& empty, const Image& plain, const Image& marked) {
  int changed = 0;
  for (int y = 1; y + 1 < outline_height; ++y)
    for (int x = 1; x + 1 < outline_width; ++x) {
      bool inside = true;
      for (int v = -1; v <= 1; ++v)
        for (int u = -1; u <= 1; ++u)
          inside = inside && largest_difference(pixel(empty, x + u, y + v), pixel(plain, x + u, y + v)) > 4;
      const int change = largest_difference(pixel(plain, x, y), pixel(marked, x, y));
      ASSERT_FALSE(inside && change > 0) << x << ", " << y;
      if (change == 0) continue;
      ++changed;
      ASSERT_TRUE(any_near(empty, plain, x, y, 5)) << "far from the body: " << x << ", " << y;
    }
  EXPECT_GT(changed, 200);
}

TEST_F(OutlineTest, IsOutsideTheSilhouetteOfEverythingThatIsShown) {
  Renderer renderer = make_renderer(outline_width, outline_height);
  const Image empty = drawn(renderer, plain());
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  for (int shown = 1; shown < 8; ++shown) {
    SCOPED_TRACE(shown);
    Scene scene = plain();
    scene.show = {.skin = (shown & 1) != 0, .springs = (shown & 2) != 0, .masses = (shown & 4) != 0};
    scene.spring_radius = 0.05f;
    scene.mass_radius = shown == 4 ? 0.3f : 0.1f;
    expect_line_around(empty, with(renderer, scene, false), with(renderer, scene, true));
  }
}

TEST_F(OutlineTest, IsAsWideAsItShouldBeOnEverySide) {
  Renderer renderer = make_renderer(outline_width, outline_height);
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  const Image plain_image = with(renderer, plain(), false), marked = with(renderer, plain(), true);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto corner = [&](std::size_t j) {
      return pinhole(front(), Vector3(mesh.positions.data() + 3 * (j % 3)), outline_width, outline_height);
    };
    const Vector2 middle = 0.5f * (corner(i) + corner(i + 1));
    Vector2 out(corner(i + 1).y - corner(i).y, corner(i).x - corner(i + 1).x);
    out = (1 / out.norm()) * out;
    if (out.dot(corner(i + 2) - middle) > 0) out = -out;
    const auto change = [&](float off) {
      const Vector2 at = middle + off * out;
      return largest_difference(pixel(plain_image, int(at.x), int(at.y)), pixel(marked, int(at.x), int(at.y)));
    };
    EXPECT_GT(std::max({change(0.5f), change(1), change(1.5f)}), 60) << i;
    EXPECT_EQ(change(line + 1), 0) << i;
    EXPECT_EQ(change(-2), 0) << i;
  }
}

TEST_F(OutlineTest, FollowsACut) {
  Renderer renderer = make_renderer(outline_width, outline_height);
  const Mesh mesh = triangle();
  Scene scene = plain();
  scene.cut = Cut{.axis = 2, .percent = 100 * 0.5f / 1.3f};  // at z = 0
  const Image empty = drawn(renderer, scene);
  renderer.set_bodies(std::array{mesh.body()});
  const Image plain_image = with(renderer, scene, false), marked = with(renderer, scene, true);
  expect_line_around(empty, plain_image, marked);
  const Vector2 tip = pinhole(front(), {0.1f, 0, 0.8f}, outline_width, outline_height),
                edge = pinhole(front(), {0.1f, 0, 0}, outline_width, outline_height);
  EXPECT_FALSE(any_near(plain_image, marked, int(tip.x), int(tip.y), 5)) << "what is cut away has no line";
  EXPECT_TRUE(any_near(plain_image, marked, int(edge.x), int(edge.y) - 1, 1));
}

TEST_F(OutlineTest, IsHiddenBehindNearerBodies) {
  Renderer renderer = make_renderer(outline_width, outline_height);
  const Mesh far = triangle(0), near = triangle(-1.5f);
  renderer.set_bodies(std::array{far.body(), near.body()});
  // The nearer triangle covers the farther one, which is smaller in the picture.
  const Camera camera{.eye = {0.1f, -4, 0}, .target = {0.1f, 0, 0}};
  const auto changed = [&] {
    return count_differing(with(renderer, plain(), false, 2, camera), with(renderer, plain(), true, 2, camera), 0);
  };
  EXPECT_EQ(changed(), 0);
  renderer.set_bodies(std::array{near.body(), far.body()});
  EXPECT_GT(changed(), 200);
}

TEST_F(OutlineTest, HiddenBodiesHaveNone) {
  Renderer renderer = make_renderer(outline_width, outline_height);
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  Scene scene = plain();
  std::array placements{Placement{.hidden = true}};
  scene.placements = placements;
  const Image without = drawn(renderer, scene);
  placements[0].selected = true;
  EXPECT_EQ(count_differing(without, drawn(renderer, scene), 0), 0);
}

TEST_F(OutlineTest, CastsNoShadow) {
  Renderer renderer = make_renderer(outline_width, outline_height);
  const Mesh mesh = triangle();
  Scene scene;
  scene.surroundings = Surroundings::land;
  scene.floor = -0.6f;
  const Image empty = drawn(renderer, scene);
  renderer.set_bodies(std::array{mesh.body()});
  const Image plain_image = with(renderer, scene, false), marked = with(renderer, scene, true);
  // The body and its shadow: whatever changes lies at the body's silhouette, which the floor does not change.
  std::array<Vector2, 3> corners;
  for (std::size_t i = 0; i < 3; ++i)
    corners[i] = pinhole(front(), Vector3(mesh.positions.data() + 3 * i), outline_width, outline_height);
  const auto distance_to_edges = [&](const Vector2& p) {
    float nearest = 1e9f;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector2 d = corners[(i + 1) % 3] - corners[i];
      const float t = std::clamp((p - corners[i]).dot(d) / d.dot(d), 0.0f, 1.0f);
      nearest = std::min(nearest, (corners[i] + t * d - p).norm());
    }
    return nearest;
  };
  int changed = 0;
  for (int y = 0; y < outline_height; ++y)
    for (int x = 0; x < outline_width; ++x) {
      if (largest_difference(pixel(plain_image, x, y), pixel(marked, x, y)) == 0) continue;
      ++changed;
      ASSERT_LT(distance_to_edges({float(x) + 0.5f, float(y) + 0.5f}), line + 0.8f) << x << ", " << y;
    }
  EXPECT_GT(changed, 200);
}

}  // namespace
}  // namespace mercury::render
