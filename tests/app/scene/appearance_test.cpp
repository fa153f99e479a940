// SPDX-License-Identifier: Apache-2.0
// Colors and shapes of a robot.
#include "app/scene/appearance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <span>
#include <string>

#include "app/scene/group_look.h"
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

// The diagonals of a voxel whose edges alone are muscles have the name of its actuator.
TEST(FaceMaterials, PassiveMaterialsOfAnActuatorsNameShowItsMuscle) {
  Robot robot{
      .materials = {{}, {.stiffness = 50, .amplitude = 0.1f, .frequency = 1}, {.stiffness = 40}, {.stiffness = 40}},
      .material_names = {"air", "left", "left", "passive"},
      .masses = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
      .springs = {{0, 1, 1, 1}, {1, 2, 2, 1.414f}, {0, 2, 3, 1}, {1, 3, 3, 1}},
      .faces = {{0, 1, 2}, {1, 3, 2}}};
  EXPECT_EQ(face_materials(robot), (std::vector<MaterialId>{2, 2}));
  robot.actuators = {{"left", {1}}};
  EXPECT_EQ(face_materials(robot), (std::vector<MaterialId>{1, 1}));
}

// Of one robot with these materials, each of which has a spring.
render::Legend legend_of(std::vector<Material> materials, std::vector<std::string> names) {
  Robot robot{.materials = std::move(materials), .material_names = std::move(names)};
  for (std::size_t id = 1; id < robot.materials.size(); ++id) {
    const auto first = static_cast<std::uint16_t>(robot.masses.size());
    robot.masses.insert(robot.masses.end(), {{0, 0, 0}, {1, 0, 0}});
    robot.springs.push_back({first, static_cast<std::uint16_t>(first + 1), static_cast<MaterialId>(id), 1});
  }
  const Robot* const pointer = &robot;
  const std::shared_ptr<const RobotShape> shape = shape_of(robot);
  return material_legend(std::span(&pointer, 1), std::span(&shape, 1));
}

TEST(MaterialLegend, NamesMaterialsOfARobotsOwnTable) {
  const Material soft{.stiffness = 40}, muscle{.stiffness = 50, .amplitude = 0.1f, .frequency = 1, .phase = 1};
  const render::Legend legend = legend_of({{}, muscle, soft, soft}, {"air", "flexor", "skin", "skin"});
  EXPECT_TRUE(legend.wheel.empty());
  ASSERT_EQ(legend.swatches.size(), 2u);
  EXPECT_EQ(legend.swatches[0], std::pair(render::muscle_color(1, 0.5f), std::string("flexor")));
  EXPECT_EQ(legend.swatches[1].second, "skin");
}

TEST(MaterialLegend, MusclesOfOneNameAndManyPhasesAreAWheel) {
  const auto muscle = [](float phase) {
    return Material{.stiffness = 50, .amplitude = 0.1f, .frequency = 1, .phase = phase};
  };
  const float turn = 2 * std::acos(-1.0f);
  // Phases a turn apart are the same.
  EXPECT_TRUE(legend_of({{}, muscle(1), muscle(1 - turn)}, {"air", "muscle", "muscle"}).wheel.empty());
  const render::Legend legend = legend_of({{}, muscle(1), muscle(2)}, {"air", "muscle", "muscle"});
  EXPECT_TRUE(legend.swatches.empty());
  ASSERT_EQ(legend.wheel.size() % 4, 0u);
  for (std::size_t quarter = 0; quarter < 4; ++quarter)
    EXPECT_EQ(legend.wheel[quarter * legend.wheel.size() / 4],
              render::muscle_color(static_cast<float>(quarter) * turn / 4, 0.5f));
}

// Mixtures of materials that have names of their own need none, as the pairs of the paper's robots.
TEST(MaterialLegend, LeavesMixturesOutAndStaysShort) {
  const Material soft{.stiffness = 40}, muscle{.stiffness = 50, .amplitude = 0.1f, .frequency = 1, .phase = 1};
  const render::Legend pairs =
      legend_of({{}, muscle, soft, muscle, soft, soft},
                {"air", "muscle 1", "bone", "muscle 1 + bone", "bone + muscle 1", "bone + gristle"});
  std::vector<std::string> names;
  for (const auto& [color, name] : pairs.swatches) names.push_back(name);
  EXPECT_EQ(names, (std::vector<std::string>{"muscle 1", "bone", "bone + gristle"}));

  std::vector<Material> many(1);
  std::vector<std::string> many_names{"air"};
  for (int i = 0; i < 20; ++i) {
    many.push_back(muscle);
    many_names.push_back("muscle " + std::to_string(i));
    many.push_back(soft);
    many_names.push_back("tissue " + std::to_string(i));
  }
  const render::Legend legend = legend_of(many, many_names);
  EXPECT_FALSE(legend.wheel.empty());
  EXPECT_LE(legend.swatches.size(), 7u);
  EXPECT_EQ(legend.swatches.back().second, "and 14 more");
}

// The 20 muscles of the default table.
TEST(MaterialLegend, ManyDefaultMusclesAreAWheel) {
  Robot robot;
  for (std::uint16_t id = 1; id <= 22; ++id) {
    robot.masses.insert(robot.masses.end(), {{0, 0, 0}, {1, 0, 0}});
    robot.springs.push_back({static_cast<std::uint16_t>(2 * id - 2), static_cast<std::uint16_t>(2 * id - 1),
                             static_cast<MaterialId>(id), 1});
  }
  const Robot* const pointer = &robot;
  const std::shared_ptr<const RobotShape> shape = shape_of(robot);
  const render::Legend legend = material_legend(std::span(&pointer, 1), std::span(&shape, 1));
  EXPECT_FALSE(legend.wheel.empty());
  EXPECT_EQ(legend.swatches.size(), 2u);  // tissue and bone
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
