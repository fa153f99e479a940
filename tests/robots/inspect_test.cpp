// SPDX-License-Identifier: Apache-2.0
#include "mercury/inspect.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mercury/random_voxel.h"
#include "mercury/voxel.h"
#include "tests/robots/surface.h"

namespace mercury {
namespace {

TEST(Inspection, OfAVoxel) {
  VoxelGrid grid(1, 1, 1, bone);
  grid.edge = 0.5f;
  const Inspection found = inspect(make_voxel_robot(grid));
  EXPECT_EQ(found.masses, 8u);
  EXPECT_EQ(found.springs, 28u);
  EXPECT_EQ(found.faces, 12u);
  EXPECT_EQ(found.extent, (Vec3{0.5f, 0.5f, 0.5f}));
  EXPECT_FLOAT_EQ(found.shortest_spring, 0.5f);
  EXPECT_FLOAT_EQ(found.longest_spring, 0.5f * std::sqrt(3.f));
  EXPECT_EQ(found.springs_a_mass, 7);
  EXPECT_EQ(found.components, 1u);
  EXPECT_EQ(found.loose_masses, 0u);
  EXPECT_TRUE(found.closed);
  EXPECT_EQ(found.euler_characteristic, 2);
  EXPECT_NEAR(found.volume, 0.125, 1e-7);
  EXPECT_NEAR(found.area, 1.5, 1e-6);
  EXPECT_EQ(found.muscles, 0u);
  ASSERT_EQ(found.materials.size(), 1u);
  EXPECT_EQ(found.materials[0].name, "bone");
  EXPECT_EQ(found.materials[0].springs, 28u);
}

TEST(Inspection, ARingHasEulerCharacteristicZero) {
  VoxelGrid grid(3, 3, 1, tissue);
  grid.cell(1, 1, 0) = air;
  EXPECT_EQ(inspect(make_voxel_robot(grid)).euler_characteristic, 0);
}

TEST(Inspection, EdgesOfMoreThanTwoFacesAreCounted) {
  VoxelGrid grid(2, 2, 2, 1);
  grid.cell(0, 0, 0) = air;
  grid.cell(1, 1, 0) = air;  // the two others of the lower layer meet along one edge
  const Inspection found = inspect(make_voxel_robot(grid));
  EXPECT_EQ(found.crowded_edges, 1u);
  EXPECT_EQ(found.open_edges, 0u);
  EXPECT_TRUE(found.closed);
}

TEST(Inspection, AHoleInTheSkinIsFound) {
  Robot robot = make_voxel_robot(VoxelGrid(2, 1, 1, 1));
  robot.faces.pop_back();
  const Inspection found = inspect(robot);
  EXPECT_FALSE(found.closed);
  EXPECT_EQ(found.open_edges, 3u);
}

TEST(Inspection, ASkinInsideOutHasANegativeVolume) {
  Robot robot = make_voxel_robot(VoxelGrid(2, 1, 1, 1));
  for (Face& face : robot.faces) std::swap(face.b, face.c);
  const Inspection found = inspect(robot);
  EXPECT_TRUE(found.closed);
  EXPECT_NEAR(found.volume, -0.002, 1e-8);
}

TEST(Inspection, APlainTriangleOfTwoParts) {
  const Robot robot{.materials = {{}, {50, 0.1f, 1, 0}, {10, 0, 0, 0}},
                    .material_names = {"air", "", "gut"},
                    .masses = {{1e5f, 0, 0}, {1e5f, 2, 0}, {1e5f, 0, 3}, {1e5f, 0, 4}, {1e5f, 9, 9}},
                    .springs = {{0, 1, 1, 2}, {2, 3, 2, 1}},
                    .faces = {{0, 1, 2}}};
  const Inspection found = inspect(robot);
  EXPECT_EQ(found.components, 3u);
  EXPECT_EQ(found.loose_masses, 1u);
  EXPECT_EQ(found.open_edges, 3u);
  EXPECT_FALSE(found.closed);
  EXPECT_EQ(found.euler_characteristic, 1);
  EXPECT_DOUBLE_EQ(found.area, 3);
  EXPECT_EQ(found.length, 9);
  EXPECT_EQ(found.muscles, 1u);
  EXPECT_EQ(found.springs_a_mass, 0.8);
  ASSERT_EQ(found.materials.size(), 2u);
  EXPECT_EQ(found.materials[0].name, "material 1");
  EXPECT_EQ(found.materials[1].name, "gut");
  ASSERT_EQ(found.actuators.size(), 1u);
  EXPECT_EQ(found.actuators[0].actuator, (Actuator{"material 1", {1}}));
  EXPECT_EQ(found.actuators[0].springs, 1u);
}

TEST(Inspection, ARobotWithoutSpringsOrFaces) {
  const Inspection found = inspect(Robot{.masses = {{1, 2, 3}}});
  EXPECT_FALSE(found.closed);
  EXPECT_EQ(found.euler_characteristic, 0);
  EXPECT_EQ(found.length, 0);
  EXPECT_EQ(found.components, 1u);
}

TEST(Inspection, AgreesWithPlainCountingOnRandomRobots) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Robot robot = random_voxel_robot({}, seed);
    const Inspection found = inspect(robot);
    ASSERT_EQ(found.closed, half_edges_cancel(robot));
    ASSERT_EQ(found.components, spring_components(robot));
    ASSERT_NEAR(found.volume, enclosed_volume(robot), 1e-5);
    std::size_t springs = 0;
    for (const MaterialUse& use : found.materials) springs += use.springs;
    ASSERT_EQ(springs, robot.springs.size());
  }
}

TEST(BodyHash, IsThatOfTheBodyAndItsMaterials) {
  const Robot robot = random_voxel_robot({}, 1);
  Robot same = robot;
  same.name = "another";
  same.origin.clear();
  same.materials.assign(default_materials().begin(), default_materials().end());
  EXPECT_EQ(body_hash(same), body_hash(robot));
  const auto differs = [&](auto change) {
    Robot other = same;
    change(other);
    return body_hash(other) != body_hash(robot);
  };
  EXPECT_TRUE(differs([](Robot& r) { r.masses[3].y += 1e-6f; }));
  EXPECT_TRUE(differs([](Robot& r) { r.springs[5].material ^= 1; }));
  EXPECT_TRUE(differs([](Robot& r) { r.springs[5].rest_length *= 1.01f; }));
  EXPECT_TRUE(differs([](Robot& r) { r.faces.pop_back(); }));
  EXPECT_TRUE(differs([](Robot& r) { r.materials[2].phase += 0.1f; }));
  EXPECT_TRUE(differs([](Robot& r) { r.materials[2].relaxation_time = 0.1f; }));
  EXPECT_TRUE(differs([](Robot& r) { r.mass.assign(r.masses.size(), 1); }));
  EXPECT_TRUE(differs([](Robot& r) { r.velocity.assign(r.masses.size(), {}); }));
  EXPECT_TRUE(differs([](Robot& r) { r.fixed = {0}; }));
}

}  // namespace
}  // namespace mercury
