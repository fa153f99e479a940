// SPDX-License-Identifier: Apache-2.0
// Scene::rounded: skins that are finer than their masses.

#include "tests/render/offscreen.h"
#include "tests/render/triangle.h"
#include "tests/render/wobbling_bodies.h"

namespace mercury::render {
namespace {

class RoundedSkin : public Offscreen {
 protected:
  RoundedSkin() {
    scene.surroundings = Surroundings::none;
    scene.placements = group.placements;
    scene.materials = materials;
  }
  Image picture(Renderer& renderer) { return drawn(renderer, scene, Orbit{.elevation = 0.5f, .distance = 2}.camera()); }
  // Pixels that differ from the backdrop, which is one color but for its vignette.
  int covered(Renderer& renderer) {
    const Image image = picture(renderer);
    Placement hidden = group.placements[0];
    hidden.hidden = true;
    scene.placements = {&hidden, 1};
    const Image empty = picture(renderer);
    scene.placements = group.placements;
    return count_differing(image, empty, 2);
  }
  WobblingGroup group = make_wobbling_group(1, 5, 3, 1);
  std::vector<RenderMaterial> materials = wobbling_materials(0);
  Scene scene;
};

TEST_F(RoundedSkin, CoversNearlyAsMuchAsTheEdgedOneAndNotMore) {
  Renderer renderer = make_renderer(320, 240);
  renderer.set_bodies(group.views());
  const int edged = covered(renderer);
  scene.rounded = true;
  const int round = covered(renderer);
  EXPECT_GT(edged, 3000);
  EXPECT_LT(round, edged);
  EXPECT_GT(round, 0.84 * edged);
}

TEST_F(RoundedSkin, ShowsTheValuesOfTheFacesAndMassesItWasMadeFrom) {
  Renderer renderer = make_renderer();
  renderer.set_bodies(group.views());
  scene.rounded = true;
  scene.scale = Scale{.low = 0, .high = 1};
  // The same value everywhere is the same picture, by faces or masses.
  std::vector<float> of_faces(renderer.face_count(), 0.7f), of_masses(renderer.mass_count(), 0.7f);
  scene.face_values = of_faces;
  const Image by_faces = picture(renderer);
  scene.face_values = {};
  scene.mass_values = of_masses;
  EXPECT_EQ(count_differing(by_faces, picture(renderer), 2), 0);
  // High values of the right half are seen at the right.
  for (std::size_t i = 0; i < of_masses.size(); ++i) of_masses[i] = group.bodies[0].rest[3 * i] > 0 ? 1.0f : 0.0f;
  scene.mass_values = of_masses;
  const Image halves = picture(renderer);
  scene.mass_values = {};
  for (std::size_t f = 0; f < of_faces.size(); ++f)
    of_faces[f] = of_masses[group.bodies[0].faces[3 * f]] + of_masses[group.bodies[0].faces[3 * f + 1]] +
                              of_masses[group.bodies[0].faces[3 * f + 2]] >
                          1.5f
                      ? 1.0f
                      : 0.0f;
  scene.face_values = of_faces;
  // The two differ along the border alone.
  EXPECT_LT(count_differing(halves, picture(renderer), 40), 160 * 120 / 20);
  EXPECT_GT(count_differing(halves, by_faces, 40), 400);
}

TEST_F(RoundedSkin, IsEdgedWhereSpringsOrMassesAreShownOrCutsOpenIt) {
  Renderer renderer = make_renderer();
  renderer.set_bodies(group.views());
  for (int i = 0; i < 3; ++i) {
    scene.show = {.skin = true, .springs = i == 0, .masses = i == 1};
    scene.cut = i == 2 ? std::optional(Cut{}) : std::nullopt;
    scene.rounded = false;
    const Image edged = picture(renderer);
    scene.rounded = true;
    EXPECT_EQ(count_differing(edged, picture(renderer), 0), 0) << i;
  }
}

}  // namespace
}  // namespace mercury::render
