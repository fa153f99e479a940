// SPDX-License-Identifier: Apache-2.0
// What VXA files mean, by the equations of their programs: the edge of a voxel is L (1 + CTE T), T = A sin(2 pi (t / P
// + phase)), and a bar of voxels carries waves with the speed sqrt(E / rho).
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <numbers>
#include <set>

#include "mercury/generator.h"
#include "mercury/origin.h"
#include "mercury/voxel.h"
#include "robots/importers/encodings.h"
#include "tests/robots/importers/documents.h"

namespace mercury {
namespace {

using std::numbers::pi;

TEST(Vxa, BecomesAVoxelRobotWithThePaletteAsMaterials) {
  const Import import = import_of({});
  ASSERT_EQ(import.robots.size(), 1u);
  const Robot& robot = import.robots.front();
  const auto grid = voxel_grid_of(robot);
  ASSERT_TRUE(grid);
  EXPECT_EQ((std::array{grid->nx, grid->ny, grid->nz}), (std::array{2, 1, 2}));
  EXPECT_EQ(grid->cells, (std::vector<MaterialId>{1, 2, 0, 3}));
  EXPECT_FLOAT_EQ(grid->edge, 0.1f);
  EXPECT_EQ(robot.name, "test");
  EXPECT_EQ(robot.material_names[1], "Muscle");
  EXPECT_EQ(robot.masses.size(), 16u);  // 4 x 2 x 2 corners... of three voxels in the shape of an L
}

TEST(Vxa, AmplitudeIsExpansionTimesTheTemperatureAboveTheBase) {
  const Robot robot = import_of({}).robots.front();
  EXPECT_FLOAT_EQ(robot.materials[1].amplitude, 0.14f);  // 0.01 (39 - 25)
  EXPECT_FLOAT_EQ(robot.materials[2].amplitude, 0);
  EXPECT_FLOAT_EQ(robot.materials[3].amplitude, -0.14f);
  VxaParts newer;
  newer.thermal =
      "<TempEnabled>1</TempEnabled><TempAmplitude>20</TempAmplitude><TempBase>25</TempBase>"
      "<VaryTempEnabled>1</VaryTempEnabled><TempPeriod>0.5</TempPeriod>";
  EXPECT_FLOAT_EQ(import_of(newer).robots.front().materials[1].amplitude, 0.2f);
}

// 0.025 m become 0.1 m: lengths are 4 times as long, so times are twice as long at the same gravity.
TEST(Vxa, TimesScaleSoThatGravityStays) {
  const Import import = import_of({});
  EXPECT_DOUBLE_EQ(import.report.length_scale, 4);
  EXPECT_DOUBLE_EQ(import.report.time_scale, 2);
  EXPECT_DOUBLE_EQ(import.settings.gravity, -9.81);
  EXPECT_FLOAT_EQ(import.robots.front().materials[1].frequency, static_cast<float>(2 * pi / (0.5 * 2)));
}

TEST(Vxa, PhaseOffsetsAreTurns) {
  VxaParts parts;
  parts.layers = "<PhaseOffset><Layer>0.25, 0.5</Layer><Layer><![CDATA[0.1,-0.75,]]></Layer></PhaseOffset>";
  const Robot robot = import_of(parts).robots.front();
  EXPECT_FLOAT_EQ(robot.materials[1].phase, static_cast<float>(pi / 2));
  EXPECT_FLOAT_EQ(robot.materials[3].phase, static_cast<float>(-1.5 * pi));
}

TEST(Vxa, NothingMovesWhileTheTemperatureDoesNotVary) {
  VxaParts parts;
  parts.thermal = "<TempEnabled>1</TempEnabled><TempAmp>39</TempAmp><VaryTempEnabled>0</VaryTempEnabled>";
  const Robot robot = import_of(parts).robots.front();
  for (const Material& material : robot.materials) EXPECT_EQ(material.amplitude, 0);
}

TEST(Vxa, StiffnessFollowsTheElasticModulus) {
  const Robot robot = import_of({}).robots.front();
  EXPECT_FLOAT_EQ(robot.materials[2].stiffness / robot.materials[1].stiffness, 2);
  VxaParts parts;
  parts.layers = "<Stiffness><MinElasticMod>1</MinElasticMod><Layer>1e5,4e5</Layer><Layer>0,1e5</Layer></Stiffness>";
  const Robot other = import_of(parts).robots.front();
  EXPECT_FLOAT_EQ(other.materials[2].stiffness / other.materials[1].stiffness, 4);
}

// Same density, edge four times smaller: k / m of the file is E L / (rho L^3), in times twice as long a quarter of it.
TEST(Vxa, StiffnessKeepsTheFrequencyOfAVoxelInScaledTime) {
  VxaParts large;
  large.lattice = "<Lattice_Dim>0.1</Lattice_Dim>";
  const Import small = import_of({}), same = import_of(large);
  const double expected = (0.1 / 0.025) * (0.1 / 0.025) / 4;
  EXPECT_NEAR(small.robots.front().materials[1].stiffness / same.robots.front().materials[1].stiffness, expected, 1e-5);
}

TEST(Vxa, OnlyVoxcraftCutsTheUpperHalfOff) {
  EXPECT_FALSE(import_of({}).robots.front().materials[1].half_wave);
  VxaParts parts;
  parts.simulator += "<RecordHistory><RecordStepSize>100</RecordStepSize></RecordHistory>";
  EXPECT_TRUE(import_of(parts).robots.front().materials[1].half_wave);
  EXPECT_FALSE(import_of(parts).robots.front().materials[2].half_wave);
  parts.simulator += "<EnableExpansion>1</EnableExpansion>";
  EXPECT_FALSE(import_of(parts).robots.front().materials[1].half_wave);
}

TEST(Vxa, AllEncodingsOfLayersAreRead) {
  VxaParts parts;
  const std::string layers[] = {std::string("\1\2", 2), std::string("\0\3", 2)};
  parts.compression = "BASE64";
  parts.data.clear();
  for (const std::string& layer : layers) parts.data += "<Layer>" + base64_encoded(layer) + "</Layer>";
  EXPECT_EQ(import_of(parts).robots, import_of({}).robots);
  parts.compression = "ZLIB";
  parts.data.clear();
  for (const std::string& layer : layers) {
    std::string stream(64, '\0');
    uLongf size = stream.size();
    compress(reinterpret_cast<Bytef*>(stream.data()), &size, reinterpret_cast<const Bytef*>(layer.data()),
             layer.size());
    parts.data += "<Layer>" + base64_encoded(std::string_view(stream).substr(0, size)) + "</Layer>";
  }
  EXPECT_EQ(import_of(parts).robots, import_of({}).robots);
}

TEST(Vxa, LayersAreFastestAlongX) {
  VxaParts parts;
  parts.size = "<X_Voxels>3</X_Voxels><Y_Voxels>2</Y_Voxels><Z_Voxels>1</Z_Voxels>";
  parts.data = "<Layer>112302</Layer>";
  const auto grid = voxel_grid_of(import_of(parts).robots.front());
  EXPECT_EQ(grid->at(2, 0, 0), 2);
  EXPECT_EQ(grid->at(0, 1, 0), 3);
  EXPECT_EQ(grid->at(1, 1, 0), air);
}

TEST(Vxa, EveryBodyIsARobot) {
  VxaParts parts;
  parts.size = "<X_Voxels>4</X_Voxels><Y_Voxels>1</Y_Voxels><Z_Voxels>1</Z_Voxels>";
  parts.data = "<Layer>1022</Layer>";
  const Import import = import_of(parts);
  ASSERT_EQ(import.robots.size(), 2u);
  EXPECT_EQ(import.report.robots, (std::vector<std::string>{"test", "test-2"}));
  EXPECT_EQ(import.robots[0].masses.size(), 12u);
  EXPECT_EQ(import.robots[1].masses.size(), 8u);
}

// 30 phases in a bar: each spring along the bar has the mean movement of the voxels that share it, as a vector.
TEST(Vxa, SpringsThatVoxelsShareHaveTheMeanMovement) {
  VxaParts parts;
  parts.gravity = "<FloorEnabled>0</FloorEnabled>";  // bodies on a floor have other springs, too
  parts.size = "<X_Voxels>30</X_Voxels><Y_Voxels>1</Y_Voxels><Z_Voxels>1</Z_Voxels>";
  parts.data = "<Layer>" + std::string(30, '1') + "</Layer>";
  const std::string phases = phases_along_x(30);
  parts.layers = "<PhaseOffset><Layer>" + phases + "</Layer></PhaseOffset>";
  const Import import = import_of(parts);
  const Robot& robot = import.robots.front();
  EXPECT_EQ(kind_of(robot), "import");
  EXPECT_TRUE(import.report.notes.empty());
  std::size_t across = 0;
  for (const Spring& spring : robot.springs) {
    const Vec3 &a = robot.masses[spring.a], &b = robot.masses[spring.b];
    const double middle = (static_cast<double>(a.x) + b.x) / 2 / 0.1 + 15;  // in voxels
    const Material& material = robot.materials[spring.material];
    const double left = std::floor(middle - 0.25), right = std::floor(middle + 0.25);
    const bool shared = left != right && left >= 0 && right < 30;
    if (shared) ++across;
    // The mean of two vectors of one length, 1/30 of a turn apart.
    EXPECT_NEAR(material.amplitude, shared ? 0.14 * std::cos(pi / 30) : 0.14, 1e-6);
    const double phase = 2 * pi * std::clamp(middle - 0.5, 0.0, 29.0) / 30;
    const double expected = shared ? phase : 2 * pi * std::clamp(std::floor(middle), 0.0, 29.0) / 30;
    EXPECT_NEAR(std::cos(material.phase), std::cos(expected), 1e-5);
    EXPECT_NEAR(std::sin(material.phase), std::sin(expected), 1e-5);
  }
  EXPECT_EQ(across, 29u * 6);
}

TEST(Vxa, MoreMaterialsThanATableHoldsAreRoundedAndSaidSo) {
  VxaParts parts;
  parts.size = "<X_Voxels>300</X_Voxels><Y_Voxels>1</Y_Voxels><Z_Voxels>1</Z_Voxels>";
  parts.data = "<Layer>" + std::string(300, '1') + "</Layer>";
  const std::string phases = phases_along_x(300);
  parts.layers = "<PhaseOffset><Layer>" + phases + "</Layer></PhaseOffset>";
  const Import import = import_of(parts);
  EXPECT_LE(import.robots.front().materials.size(), 256u);
  EXPECT_GT(import.robots.front().materials.size(), 100u);
  ASSERT_EQ(import.report.notes.size(), 1u);
  EXPECT_NE(import.report.notes.front().find("rounded to"), std::string::npos) << import.report.notes.front();
}

TEST(Vxa, WithAFewMaterialsEveryRobotCanMutate) {
  VxaParts parts;
  parts.size = "<X_Voxels>60</X_Voxels><Y_Voxels>1</Y_Voxels><Z_Voxels>1</Z_Voxels>";
  parts.data = "<Layer>" + std::string(60, '1') + "</Layer>";
  const std::string phases = phases_along_x(60);
  parts.layers = "<PhaseOffset><Layer>" + phases + "</Layer></PhaseOffset>";
  const Import import = import_of(parts, {.most_materials = 22});
  EXPECT_EQ(kind_of(import.robots.front()), "voxel");
  const Robot child = mutate_robot(import.robots.front(), {.strength = 1, .seed = 3}, "child");
  EXPECT_NE(child.springs, import.robots.front().springs);
  EXPECT_EQ(child.materials, import.robots.front().materials);
}

TEST(Vxa, WorldsBecomeEnvironments) {
  EXPECT_EQ(import_of({}).settings.environment, "land");
  EXPECT_DOUBLE_EQ(import_of({}).settings.friction, 0.5);
  VxaParts water;
  water.environment = "<FluidEnvironment>1</FluidEnvironment><AggregateDragCoefficient>750</AggregateDragCoefficient>";
  const Import swimmer = import_of(water);
  EXPECT_EQ(swimmer.settings.environment, "resistive");
  EXPECT_EQ(swimmer.settings.gravity, 0);
  // 750 kg/m3 of drag at 1000 kg/m3 is half of 1.5 at the density of the robot: 16 masses of 1 kg in three voxels,
  // where the water weighs 1 kg per voxel.
  EXPECT_NEAR(swimmer.settings.drag_coefficient, 1.5 * 16 / 3, 1e-9);
  VxaParts nothing;
  nothing.gravity = "<GravEnabled>0</GravEnabled><FloorEnabled>0</FloorEnabled>";
  EXPECT_EQ(import_of(nothing).settings.environment, "ocean-simple");
  EXPECT_EQ(import_of(nothing).settings.gravity, 0);
}

TEST(Vxa, VoxelsOfMaterialsThatThePaletteLacksAreLeftOutAndSaidSo) {
  VxaParts parts;
  parts.data = "<Layer>12</Layer><Layer>17</Layer>";
  const Import import = import_of(parts);
  EXPECT_EQ(voxel_grid_of(import.robots.front())->cells, (std::vector<MaterialId>{1, 2, 1, 0}));
  ASSERT_EQ(import.report.decisive.size(), 1u);
  EXPECT_EQ(import.report.decisive.front(), "left out: 1 voxel of material 7, which the palette of 3 does not have");
}

TEST(Vxa, ABaseWithoutVoxelsGivesNoRobotAndSaysWhy) {
  VxaParts parts;
  parts.data = "<Layer>00</Layer><Layer>00</Layer>";
  const std::string without_structure =
      "<VXA Version=\"1.0\"><VXC><Lattice><Lattice_Dim>0.01</Lattice_Dim></Lattice></VXC></VXA>";
  for (const std::string& text : {parts.text(), without_structure}) {
    const Import import = import_text(text, "vxa", "base");
    EXPECT_TRUE(import.robots.empty());
    ASSERT_FALSE(import.report.notes.empty());
    EXPECT_EQ(import.report.notes.front(), "it has no voxels: a base, for .vxd files to say them");
    EXPECT_FALSE(import.report.elements.empty());
  }
}

// CVXS_Voxel::CalcFloorEffect: a voxel at rest stays below uStatic N, one that moves is slowed by uDynamic N.
TEST(Vxa, FrictionAtRestIsThatOfTheFileAndNeverBelowThatOfMotion) {
  VxaParts parts;
  const Import import = import_of(parts);
  EXPECT_DOUBLE_EQ(import.settings.friction, 0.5);
  EXPECT_DOUBLE_EQ(import.settings.static_friction, 1);
  EXPECT_NE(to_toml(import.settings, import.report).find("\nstatic-friction = 1\n"), std::string::npos);
  std::string text = parts.text();
  for (std::size_t at = 0; (at = text.find("<uStatic>1<", at)) != std::string::npos;)
    text.replace(at, 11, "<uStatic>0.2<");
  EXPECT_DOUBLE_EQ(import_text(text, "vxa", "test").settings.static_friction, 0);
}

TEST(Vxa, ListsMayBeSeparatedBySpaces) {
  VxaParts commas, spaces;
  commas.layers = "<PhaseOffset><Layer>0,0.25</Layer><Layer>0.5,0.75</Layer></PhaseOffset>";
  spaces.layers = "<PhaseOffset><Layer> 0 0.25\n</Layer><Layer>0.5\t 0.75</Layer></PhaseOffset>";
  EXPECT_EQ(import_of(spaces).robots, import_of(commas).robots);
}

TEST(Vxa, ManyBodiesBecomeRobots) {
  VxaParts parts;
  parts.size = "<X_Voxels>41</X_Voxels><Y_Voxels>21</Y_Voxels><Z_Voxels>1</Z_Voxels>";
  std::string rows;
  for (int y = 0; y < 21; ++y)
    for (int x = 0; x < 41; ++x) rows += x % 2 == 0 && y % 2 == 0 ? '1' : '0';
  parts.data = "<Layer>" + rows + "</Layer>";
  EXPECT_EQ(import_of(parts).robots.size(), 21u * 11);
}

// The points of the voxels that a region touches, here a slab at the lower end of x, are fixed.
TEST(Vxa, HeldRegionsBecomeFixedMasses) {
  const auto region = [](const char* what, double x) {
    return "<FRegion><PrimType>0</PrimType><X>" + std::to_string(x) +
           "</X><Y>0</Y><Z>0</Z><dX>0.01</dX><dY>1</dY><dZ>1</dZ>" + what + "</FRegion>";
  };
  VxaParts parts;
  parts.data = "<Layer>12</Layer><Layer>13</Layer>";
  for (const std::string& held :
       {"<Fixed_Regions><NumFixed>1</NumFixed>" + region("<Fixed>1</Fixed>", 0) + "</Fixed_Regions>",
        "<Boundary_Conditions><NumBCs>1</NumBCs>" + region("<DofFixed>63</DofFixed>", 0) + "</Boundary_Conditions>"}) {
    parts.environment = held;
    const Import import = import_of(parts);
    const Robot& robot = import.robots.front();
    EXPECT_EQ(robot.fixed.size(), 2u * 2 * 3);  // two voxels of 2 x 1 x 2, with their common side
    for (std::size_t mass = 0; mass < robot.masses.size(); ++mass)
      EXPECT_EQ(std::ranges::count(robot.fixed, mass), robot.masses[mass].x < 0.05f ? 1 : 0);
    ASSERT_EQ(import.report.decisive.size(), 1u);
    EXPECT_EQ(import.report.decisive.front(), "held in its place, by fixed masses: 2 of 4 voxels");
  }
  parts.environment = "<Boundary_Conditions><NumBCs>2</NumBCs>" + region("<DofFixed>1</DofFixed>", 0) +
                      region("<DofFixed>0</DofFixed><ForceX>1</ForceX>", 0.99) + "</Boundary_Conditions>";
  const Import import = import_of(parts);
  EXPECT_TRUE(import.robots.front().fixed.empty());
  EXPECT_EQ(import.report.decisive, (std::vector<std::string>{"not kept: regions that hold voxels along some axes only",
                                                              "not kept: regions that push or move voxels"}));
}

TEST(Vxa, WhatDecidesTheMotionComesFirst) {
  VxaParts cilia;
  cilia.simulator = "<EnableCilia>1</EnableCilia>";
  cilia.layers = "<BaseCiliaForce><Layer>0,1,0,0,0,0</Layer><Layer>0,0,0,0,0,0</Layer></BaseCiliaForce>";
  EXPECT_NE(import_of(cilia).report.decisive.at(0).find("not kept: cilia"), std::string::npos);
  cilia.simulator = "<EnableCilia>0</EnableCilia>";
  EXPECT_TRUE(import_of(cilia).report.decisive.empty());
  std::string text = VxaParts{}.text();
  const std::size_t begin = text.find("<Gravity>"), end = text.find("</Gravity>") + 10;
  text.erase(begin, end - begin);
  EXPECT_EQ(import_text(text, "vxa", "test").report.decisive.at(0),
            "assumed: gravity of 9.81 m/s2 and a floor, which the file does not say");
}

TEST(Vxa, TheReportHasEveryElement) {
  VxaParts parts;
  parts.environment =
      "<Fixed_Regions><NumFixed>1</NumFixed><FRegion><PrimType>0</PrimType></FRegion></Fixed_Regions>"
      "<Moon phase=\"full\">far</Moon>";
  const ImportReport report = import_of(parts).report;
  const std::pair<const char*, ImportOutcome> expected[] = {
      {"/VXA/@Version", ImportOutcome::mapped},
      {"/VXA/Simulator/Damping/SlowDampingZ", ImportOutcome::approximated},
      {"/VXA/Environment/Fixed_Regions/NumFixed", ImportOutcome::ignored},
      {"/VXA/Environment/Fixed_Regions/FRegion/PrimType", ImportOutcome::ignored},
      {"/VXA/Environment/Moon", ImportOutcome::ignored},
      {"/VXA/Environment/Moon/@phase", ImportOutcome::ignored},
      {"/VXA/Environment/Gravity/GravAcc", ImportOutcome::mapped},
      {"/VXA/Environment/Thermal/TempAmp", ImportOutcome::mapped},
      {"/VXA/VXC/Lattice/Lattice_Dim", ImportOutcome::mapped},
      {"/VXA/VXC/Palette/Material[3]/Mechanical/CTE", ImportOutcome::mapped},
      {"/VXA/VXC/Palette/Material[3]/Mechanical/uStatic", ImportOutcome::approximated},
      {"/VXA/VXC/Structure/Data/Layer", ImportOutcome::mapped}};
  for (const auto& [place, outcome] : expected) {
    const ImportedElement* element = element_at(report, place);
    ASSERT_TRUE(element) << place;
    EXPECT_EQ(element->outcome, outcome) << place;
    EXPECT_FALSE(element->reason.empty());
  }
  EXPECT_EQ(element_at(report, "/VXA/Environment/Moon")->reason, "unknown");
  EXPECT_EQ(element_at(report, "/VXA/Environment/Moon")->value, "far");
  EXPECT_NE(element_at(report, "/VXA/Environment/Fixed_Regions/NumFixed")->reason, "unknown");
  EXPECT_EQ(element_at(report, "/VXA/VXC/Structure/Data/Layer")->value, "2 times");
  // 4 values of Gravity... 5 of Thermal, 3 materials of 7, Version twice, and the rest.
  std::set<std::string> places;
  for (const ImportedElement& element : report.elements)
    EXPECT_TRUE(places.insert(element.place).second) << element.place;
  EXPECT_EQ(report.elements.size(), 2 + 1 + 4 + 3 + 5 + 1 + 3 * 7 + 1 + 3 + 1u);
}

}  // namespace
}  // namespace mercury
