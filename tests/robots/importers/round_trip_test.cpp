// SPDX-License-Identifier: Apache-2.0
// Voxel robots as VXA, and back.
#include <gtest/gtest.h>

#include <cmath>

#include "mercury/cppn.h"
#include "mercury/error.h"
#include "mercury/muscle_laws.h"
#include "mercury/origin.h"
#include "mercury/random_voxel.h"
#include "mercury/real_body.h"
#include "mercury/robot_file.h"
#include "mercury/shell.h"
#include "mercury/voxel.h"
#include "tests/robots/importers/documents.h"

namespace mercury {
namespace {

void expect_same_after_a_round_trip(const Robot& robot, const VoxelGrid& grid) {
  const Import back = import_text(vxa_document(robot), "vxa", robot.name);
  ASSERT_EQ(back.robots.size(), 1u);
  EXPECT_EQ(back.report.length_scale, 1);
  const auto grid_back = voxel_grid_of(back.robots.front());
  ASSERT_TRUE(grid_back);
  EXPECT_EQ(*grid_back, grid);
  EXPECT_EQ(back.robots.front().masses, robot.masses);
  for (const MaterialId id : grid.cells) {
    if (id == air) continue;
    const Material &there = materials_of(robot)[id], &here = back.robots.front().materials[id];
    EXPECT_EQ(here.stiffness, there.stiffness) << int{id};
    EXPECT_EQ(here.amplitude, there.amplitude) << int{id};
    EXPECT_EQ(here.half_wave, there.half_wave) << int{id};
    if (there.amplitude == 0) continue;
    EXPECT_EQ(here.frequency, there.frequency) << int{id};
    EXPECT_EQ(here.phase, there.phase) << int{id};
  }
}

TEST(VxaRoundTrip, KeepsGridAndMaterials) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Robot robot = random_voxel_robot({.frequencies = static_cast<int>(seed % 5) + 1}, seed);
    expect_same_after_a_round_trip(robot, largest_body(*voxel_grid_of(robot)));
  }
}

TEST(VxaRoundTrip, KeepsPaintedRobots) {
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const Robot robot = random_cppn_robot({}, seed);
    expect_same_after_a_round_trip(robot, largest_body(paint(*cppn_genome_of(robot))));
  }
}

TEST(VxaRoundTrip, KeepsMutatedMuscles) {
  const Robot robot = with_mutated_muscles(random_voxel_robot({}, 7), 1, 3);
  expect_same_after_a_round_trip(robot, largest_body(*voxel_grid_of(robot)));
}

TEST(VxaRoundTrip, KeepsHalfWaves) {
  Robot robot = random_voxel_robot({}, 5);
  std::vector<Material> bases = base_materials_of(robot);
  for (Material& base : bases) base.half_wave = base.amplitude != 0;
  robot = with_base_materials(robot, bases);
  expect_same_after_a_round_trip(robot, largest_body(*voxel_grid_of(robot)));
}

// More substances than a voxel grid of base materials has: the origin of the import keeps them.
TEST(VxaRoundTrip, KeepsImportedRobots) {
  VxaParts parts;
  parts.lattice = "<Lattice_Dim>0.1</Lattice_Dim>";
  parts.size = "<X_Voxels>40</X_Voxels><Y_Voxels>1</Y_Voxels><Z_Voxels>1</Z_Voxels>";
  parts.data = "<Layer>" + std::string(40, '1') + "</Layer>";
  const std::string phases = phases_along_x(40);
  parts.layers = "<PhaseOffset><Layer>" + phases + "</Layer></PhaseOffset>";
  const Robot robot = import_of(parts).robots.front();
  const Robot back = import_text(vxa_document(robot), "vxa", "test").robots.front();
  EXPECT_EQ(back.springs, robot.springs);
  // The phase depends on the damping, which the file has in other units.
  ASSERT_EQ(back.materials.size(), robot.materials.size());
  for (std::size_t id = 0; id < robot.materials.size(); ++id) {
    Material material = back.materials[id];
    EXPECT_NEAR(material.phase, robot.materials[id].phase, 1e-6);
    material.phase = robot.materials[id].phase;
    EXPECT_EQ(material, robot.materials[id]) << id;
  }
}

// A bond of evosoro resists by zeta sqrt(k m), k = E edge and m = density edge^3. Over k, and in scaled time, that is
// zeta edge sqrt(density / E) T.
TEST(VxaRoundTrip, DampingOfBondsIsARelaxationTime) {
  VxaParts parts;
  parts.simulator = "<Damping><BondDampingZ>0.5</BondDampingZ></Damping>";
  parts.materials = VxaParts::material("Muscle", 4e5, 0.01);
  parts.data = "<Layer>11</Layer><Layer>11</Layer>";
  const Import import = import_of(parts);
  const Robot& robot = import.robots.front();
  for (std::size_t id = 1; id < robot.materials.size(); ++id)
    EXPECT_NEAR(robot.materials[id].relaxation_time, 0.5 * 0.025 * std::sqrt(1000 / 4e5) * import.report.time_scale,
                1e-9);
  EXPECT_TRUE(has_base_materials(robot)) << "it could not be mutated";
  EXPECT_EQ(import_text(vxa_document(robot), "vxa", "test").robots.front().materials, robot.materials);
}

// A damping of bonds that the robot does not have would be one when it is imported again.
TEST(VxaRoundTrip, RobotsWithoutDampingHaveNoneAgain) {
  VxaParts parts;
  parts.simulator = "<Damping><BondDampingZ>0</BondDampingZ></Damping>";  // without the element, evosoro has 0.1
  parts.materials = VxaParts::material("Muscle", 4e5, 0.01);
  parts.data = "<Layer>11</Layer><Layer>11</Layer>";
  const Robot robot = import_of(parts).robots.front();
  for (const Material& material : robot.materials) ASSERT_EQ(material.relaxation_time, 0);
  EXPECT_NE(vxa_document(robot).find("<BondDampingZ>0</BondDampingZ>"), std::string::npos);
  EXPECT_EQ(import_text(vxa_document(robot), "vxa", "test").robots.front().materials, robot.materials);
}

// Numbers such as 1e-05, which JSON can write in several ways.
TEST(VxaRoundTrip, OriginsAreTheSameInBothKindsOfRobotFiles) {
  VxaParts parts;
  parts.lattice = "<Lattice_Dim>7.3e-7</Lattice_Dim>";
  parts.layers =
      "<PhaseOffset><Layer>1.7e-9,0.3</Layer><Layer>0,1.00000001</Layer></PhaseOffset>"
      "<InitialVoxelSize><Layer>1e-5,0.3</Layer><Layer>0,0.1</Layer></InitialVoxelSize>";
  parts.environment = "<GrowthAmplitude>0.1</GrowthAmplitude>";
  const Robot robot = import_of(parts).robots.front();
  EXPECT_EQ(kind_of(robot), "import");
  for (const RobotFormat format : {RobotFormat::json, RobotFormat::cbor})
    EXPECT_EQ(parse_robot(serialize_robot(robot, format), format), robot);
}

// Rest lengths follow the sizes of the voxels, 1 + GrowthAmplitude times the value.
TEST(VxaRoundTrip, SizesOfVoxelsAreRestLengths) {
  VxaParts parts;
  parts.size = "<X_Voxels>1</X_Voxels><Y_Voxels>1</Y_Voxels><Z_Voxels>1</Z_Voxels>";
  parts.data = "<Layer>1</Layer>";
  parts.environment = "<GrowthAmplitude>0.5</GrowthAmplitude>";
  parts.layers = "<InitialVoxelSize><Layer>0.4</Layer></InitialVoxelSize>";
  const Robot robot = import_of(parts).robots.front();
  for (const Spring& spring : robot.springs)
    EXPECT_NEAR(spring.rest_length, 1.2 * rest_distance(robot, spring.a, spring.b), 1e-6);
}

// A world that is written comes back as the importer says it, apart from what follows from the robot: the time step and
// the stiffness of contacts.
void expect_same_world(const Robot& robot, ImportedSettings world) {
  const ImportedSettings back = import_text(vxa_document(robot, world), "vxa", "test").settings;
  EXPECT_NEAR(back.gravity, world.gravity, 1e-12);
  EXPECT_NEAR(back.friction, world.friction, 1e-12);
  EXPECT_NEAR(back.static_friction, world.static_friction, 1e-12);
  EXPECT_NEAR(back.damping, world.damping, 1e-12);
  EXPECT_NEAR(back.drag_coefficient, world.drag_coefficient, 1e-12);
  for (ImportedSettings* settings : {&world}) {
    settings->gravity = back.gravity;
    settings->friction = back.friction;
    settings->static_friction = back.static_friction;
    settings->damping = back.damping;
    settings->drag_coefficient = back.drag_coefficient;
    settings->dt = back.dt;
    settings->contact_stiffness = back.contact_stiffness;
    settings->stiffness_scale = back.stiffness_scale;
  }
  EXPECT_EQ(back, world);
}

TEST(VxaRoundTrip, KeepsTheWorld) {
  const Robot robot = random_voxel_robot({}, 3);
  expect_same_world(robot, {.environment = "land",
                            .gravity = -3.7,
                            .stiffness_scale = 200,
                            .friction = 0.35,
                            .static_friction = 0.7,
                            .self_collision = false,
                            .damping = 0.25,
                            .seconds = 7.5,
                            .settle = 0.5});
  expect_same_world(robot, {.environment = "land", .gravity = 0, .stiffness_scale = 200, .friction = 0});
  expect_same_world(robot, {.environment = "resistive", .drag_coefficient = 1.3, .seconds = 2});
  expect_same_world(robot, {.environment = "ocean-simple", .gravity = -1});  // without drag
}

// On land the importer's stiffness scale is 200: springs are as much softer, and pull as they did.
TEST(VxaRoundTrip, AStiffnessScaleIsPartOfTheSprings) {
  const Robot robot = random_voxel_robot({}, 3);
  const Import back = import_text(
      vxa_document(robot, ImportedSettings{.environment = "land", .gravity = -9.81, .stiffness_scale = 100}), "vxa",
      "test");
  const auto stiffness = [](const Robot& of) {
    return static_cast<double>(materials_of(of)[of.springs.front().material].stiffness);
  };
  EXPECT_NEAR(back.settings.stiffness_scale * stiffness(back.robots.front()), 100 * stiffness(robot),
              1e-4 * stiffness(robot));
}

// A real body has a table of its own, in which the materials of the grid are not.
TEST(VxaRoundTrip, RealBodiesHaveTheMaterialsOfTheirGrid) {
  const Robot paper = random_voxel_robot({.smallest = {4, 3, 3}, .largest = {4, 3, 3}}, 3),
              undamped = with_real_body(paper, {.relaxation_time = 0}), real = with_real_body(paper, {});
  EXPECT_EQ(vxa_document(undamped), vxa_document(paper));
  const Robot back = import_text(vxa_document(real), "vxa", "test").robots.front();
  EXPECT_EQ(voxel_grid_of(back)->cells.size(), voxel_grid_of(paper)->cells.size());
  EXPECT_NEAR(back.materials.at(1).relaxation_time, 0.01f, 1e-5f);
}

TEST(VxaRoundTrip, RobotsWithoutAGridAreRefused) { EXPECT_THROW(vxa_document(random_shell_robot({}, 1)), InputError); }

}  // namespace
}  // namespace mercury
