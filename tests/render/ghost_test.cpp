// SPDX-License-Identifier: Apache-2.0
// Ghosts are translucent, never in front of what is nearer, and as dense wherever they have several faces.
#include <algorithm>
#include <array>

#include "tests/render/triangle.h"

namespace mercury::render {
namespace {

constexpr int ghost_width = 200, ghost_height = 150;
const Color white{255, 255, 255, 255};

Ghost ghost_of(const Mesh& mesh, float opacity = 0.4f) {
  return {.positions = mesh.positions, .faces = mesh.faces, .color = white, .opacity = opacity};
}

class GhostTest : public Offscreen {
 protected:
  static Image with(Renderer& renderer, std::span<const Ghost> ghosts) {
    Scene scene = plain();
    scene.ghosts = ghosts;
    return drawn(renderer, scene, front());
  }
};

// The pixel of the middle of the triangle.
Rgb middle_of(const Image& image) {
  const Vector2 at = pinhole(front(), {0.05f, 0, -0.05f}, ghost_width, ghost_height);
  return pixel(image, int(at.x), int(at.y));
}

int largest_change(const Image& a, const Image& b) {
  int largest = 0;
  for (int y = 0; y < ghost_height; ++y)
    for (int x = 0; x < ghost_width; ++x)
      largest = std::max(largest, largest_difference(pixel(a, x, y), pixel(b, x, y)));
  return largest;
}

TEST_F(GhostTest, LetsWhatIsBehindThrough) {
  Renderer renderer = make_renderer(ghost_width, ghost_height);
  const Mesh mesh = triangle();
  const Image empty = with(renderer, {});
  int before = middle_of(empty).sum();
  for (const float opacity : {0.1f, 0.4f, 0.9f}) {
    const std::array ghosts{ghost_of(mesh, opacity)};
    const Image image = with(renderer, ghosts);
    EXPECT_GT(middle_of(image).sum(), before) << opacity;
    EXPECT_EQ(pixel(image, 2, 2), pixel(empty, 2, 2));
    before = middle_of(image).sum();
  }
  EXPECT_LT(before, 3 * 255);
}

TEST_F(GhostTest, IsHiddenByWhatIsNearerAndWhereItCoincides) {
  Renderer renderer = make_renderer(ghost_width, ghost_height);
  const Mesh mesh = triangle(), behind = triangle(0.5f), nearer = triangle(-0.5f);
  renderer.set_bodies(std::array{mesh.body()});
  const Image alone = with(renderer, {});
  EXPECT_EQ(middle_of(with(renderer, std::array{ghost_of(behind)})), middle_of(alone));
  EXPECT_NE(middle_of(with(renderer, std::array{ghost_of(nearer)})), middle_of(alone));
  EXPECT_EQ(largest_change(with(renderer, std::array{ghost_of(mesh)}), alone), 0);
}

TEST_F(GhostTest, ShowsItsNearestFaceOnly) {
  Renderer renderer = make_renderer(ghost_width, ghost_height);
  const Mesh one = triangle();
  Mesh two = one;
  for (std::size_t i = 0; i < 9; ++i) two.positions.push_back(one.positions[i] + (i % 3 == 1 ? 0.3f : 0));
  for (const std::uint32_t corner : {3u, 4u, 5u}) two.faces.push_back(corner);
  EXPECT_EQ(middle_of(with(renderer, std::array{ghost_of(two)})), middle_of(with(renderer, std::array{ghost_of(one)})));
}

TEST_F(GhostTest, IsMovedByItsOffset) {
  Renderer renderer = make_renderer(ghost_width, ghost_height);
  Mesh mesh = triangle();
  Ghost moved = ghost_of(mesh);
  moved.offset = {0.25f, 0, 0.125f};
  const Image by_offset = with(renderer, std::array{moved});
  for (std::size_t i = 0; i < 9; i += 3) {
    mesh.positions[i] += 0.25f;
    mesh.positions[i + 2] += 0.125f;
  }
  EXPECT_LE(largest_change(with(renderer, std::array{ghost_of(mesh)}), by_offset), 1);
}

}  // namespace
}  // namespace mercury::render
