// SPDX-License-Identifier: Apache-2.0
// Colors and shapes of a robot.
#include "app/scene/appearance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mercury/voxel.h"

namespace mercury::test {
namespace {

// Two voxels side by side, bone at low x and muscle 3 at high x.
Robot two_voxels() {
  VoxelGrid grid(2, 1, 1, bone);
  grid.cell(1, 0, 0) = 3;
  return make_voxel_robot(grid);
}

TEST(FaceMaterials, EachSideOfAVoxelHasItsVoxelsMaterial) {
  const Robot robot = two_voxels();
  const auto materials = face_materials(robot);
  ASSERT_EQ(materials.size(), robot.faces.size());
  for (std::size_t i = 0; i < robot.faces.size(); ++i) {
    const Face face = robot.faces[i];
    const float middle = (robot.masses[face.a].x + robot.masses[face.b].x + robot.masses[face.c].x) / 3;
    EXPECT_EQ(materials[i], middle < 0 ? bone : 3) << i;
  }
}

TEST(FaceMaterials, FaceWithoutSpringsIsAir) {
  const Robot robot{.masses = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .faces = {{0, 1, 2}}};
  EXPECT_EQ(face_materials(robot), std::vector<MaterialId>{air});
}

TEST(MaterialColors, PairIsABlendOfItsTwoMaterials) {
  const auto colors = material_colors(default_materials(), true);
  ASSERT_EQ(colors.size(), 254u);
  EXPECT_EQ(colors[tissue], render::tissue_color);
  EXPECT_EQ(colors[bone], render::bone_color);
  EXPECT_EQ(colors[combine(2, bone)], render::mix(colors[2], colors[bone], 0.5f));
}

TEST(MaterialColors, MusclesDiffer) {
  const auto colors = material_colors(default_materials(), true);
  for (std::size_t a = 1; a <= muscle_count; ++a)
    for (std::size_t b = 1; b < a; ++b) EXPECT_NE(colors[a], colors[b]) << a << " and " << b;
}

// A spring is shortest, and its activation 1, when sin(omega t + phi) = -1.
TEST(Activation, IsOneWhenTheMuscleIsShortest) {
  const std::vector<Material> materials{{}, {50, 0.14f, 2, 0}, {50, 0.07f, 2, 0}, {100, 0, 0, 0}};
  std::vector<render::RenderMaterial> drawn(materials.size());
  set_activations(materials, 1.5 * M_PI / 2, drawn);
  EXPECT_NEAR(drawn[1].activation, 1, 1e-6);
  EXPECT_NEAR(drawn[2].activation, 0.5, 1e-6);
  EXPECT_EQ(drawn[3].activation, 0);
  set_activations(materials, 0.5 * M_PI / 2, drawn);
  EXPECT_NEAR(drawn[1].activation, -1, 1e-6);
}

TEST(BodyShape, HasTheRobotsArrays) {
  const Robot robot = two_voxels();
  const BodyShape shape(robot, 100);
  const render::Body body = shape.body();
  EXPECT_EQ(body.rest_positions.size(), 3 * robot.masses.size());
  EXPECT_EQ(body.faces.size(), 3 * robot.faces.size());
  EXPECT_EQ(body.springs.size(), 2 * robot.springs.size());
  EXPECT_EQ(body.face_materials.size(), robot.faces.size());
  for (std::size_t i = 0; i < robot.springs.size(); ++i)
    EXPECT_EQ(body.spring_materials[i], 100u + robot.springs[i].material);
}

}  // namespace
}  // namespace mercury::test
