// SPDX-License-Identifier: Apache-2.0
// Files that build on a base: VXD of voxcraft-sim, RSC of RISE.
#include <gtest/gtest.h>

#include "mercury/voxel.h"
#include "tests/robots/importers/documents.h"

namespace mercury {
namespace {

const std::string changes =
    "<VXD><Structure replace=\"VXA.VXC.Structure\" Compression=\"ASCII_READABLE\"><X_Voxels>3</X_Voxels>"
    "<Y_Voxels>1</Y_Voxels><Z_Voxels>1</Z_Voxels><Data><Layer>121</Layer></Data></Structure>"
    "<Thermal replace=\"VXA.Environment.Thermal\"><VaryTempEnabled>1</VaryTempEnabled><TempAmplitude>10</TempAmplitude>"
    "<TempPeriod>1</TempPeriod></Thermal><Remark>evolved</Remark></VXD>";

TEST(Vxd, ReplacesPartsOfItsBase) {
  const Import import = import_text(changes, "vxd", "test", {}, VxaParts{}.text());
  const Robot& robot = import.robots.front();
  EXPECT_EQ(voxel_grid_of(robot)->cells, (std::vector<MaterialId>{1, 2, 1}));
  EXPECT_FLOAT_EQ(robot.materials[1].amplitude, 0.1f);
  EXPECT_TRUE(robot.materials[1].half_wave);  // a VXD is of voxcraft-sim
  ASSERT_TRUE(element_at(import.report, "/VXD/Remark"));
  EXPECT_EQ(element_at(import.report, "/VXD/Remark")->outcome, ImportOutcome::ignored);
  ASSERT_TRUE(element_at(import.report, "/VXA/VXC/Structure/@replace"));
  EXPECT_EQ(element_at(import.report, "/VXA/VXC/Structure/@replace")->outcome, ImportOutcome::mapped);
}

TEST(Vxd, WithoutChangesIsItsBase) {
  VxaParts voxcraft;
  voxcraft.simulator += "<EnableExpansion>0</EnableExpansion>";
  EXPECT_EQ(import_text("<VXD/>", "vxd", "test", {}, voxcraft.text()).robots, import_of(voxcraft).robots);
}

TEST(Vxd, BadPathsAreRefused) {
  const std::string base = VxaParts{}.text();
  EXPECT_EQ(refusal_of("<VXD><a replace=\"VXC.Structure\"/></VXD>", "vxd", base),
            "/VXD/a: replace=\"VXC.Structure\" names no part of the base, whose outermost element is VXA");
  EXPECT_EQ(refusal_of("<VXD><a replace=\"VXA..b\"/></VXD>", "vxd", base),
            "/VXD/a: replace=\"VXA..b\" is not a path such as VXA.VXC.Structure");
  EXPECT_EQ(refusal_of("<VXD><a replace=\"VXA\"/></VXD>", "vxd", base),
            "/VXD/a: replaces the whole base; give a VXA instead");
  EXPECT_EQ(refusal_of(base, "vxd", base), "/VXA: a file of another kind; its outermost element must be VXD");
  EXPECT_EQ(refusal_of("<VXD/>", "vxd", "<VXA>").substr(0, 6), "base: ");
}

const std::string rise_world =
    "<RSC Version=\"0.1\"><Simulator><Damping><GlobalDampingZ>0.01</GlobalDampingZ></Damping><Gravity>"
    "<GravAcc>-5</GravAcc><FloorEnabled>1</FloorEnabled></Gravity></Simulator><Voxel><Size>0.01</Size><Palette>"
    "<Material ID=\"4\"><Name>Flesh</Name><Mechanical><ElasticMod>3e4</ElasticMod><Density>1000</Density>"
    "<FrictionDynamic>0.7</FrictionDynamic><MaxExpansion>0.3</MaxExpansion><MinExpansion>-0.2</MinExpansion>"
    "</Mechanical></Material></Palette></Voxel></RSC>";

const std::string rise_robot =
    "<RSC><Structure><Bodies><Body ID=\"1\"><Orientation>0,0,0,1</Orientation><X_Voxels>3</X_Voxels>"
    "<Y_Voxels>1</Y_Voxels><Z_Voxels>2</Z_Voxels><MaterialID><Layer>4,4,4</Layer><Layer>4,0,4</Layer></MaterialID>"
    "<SegmentType><Layer>0,0,0</Layer><Layer>1,0,0</Layer></SegmentType>"
    "<ExpansionSignalID><Layer>0,0,0</Layer><Layer>0,0,1</Layer></ExpansionSignalID></Body>"
    "<Body ID=\"2\"><X_Voxels>1</X_Voxels><Y_Voxels>1</Y_Voxels><Z_Voxels>1</Z_Voxels>"
    "<MaterialID><Layer>4</Layer></MaterialID></Body></Bodies>"
    "<Constraints><Constraint><Type>HINGE_JOINT</Type></Constraint></Constraints></Structure></RSC>";

TEST(Rsc, BodiesBecomeRobotsWithThePaletteOfTheWorld) {
  const Import import = import_text(rise_robot, "rsc", "test", {}, rise_world);
  ASSERT_EQ(import.robots.size(), 2u);
  const auto grid = voxel_grid_of(import.robots[0]);
  ASSERT_TRUE(grid);
  // Three substances: soft of signal 0, rigid, soft of signal 1.
  EXPECT_EQ(grid->cells, (std::vector<MaterialId>{1, 1, 1, 2, 0, 3}));
  const std::vector<Material>& materials = import.robots[0].materials;
  EXPECT_FLOAT_EQ(materials[1].amplitude, 0.2f);  // the smaller of both
  EXPECT_FLOAT_EQ(materials[2].amplitude, 0);
  EXPECT_FLOAT_EQ(materials[2].stiffness / materials[1].stiffness, 10);
  EXPECT_NE(materials[1].phase, materials[3].phase);
  EXPECT_EQ(import.settings.environment, "land");
  EXPECT_DOUBLE_EQ(import.settings.gravity, -5);
  EXPECT_DOUBLE_EQ(import.settings.friction, 0.7);
  const ImportedElement* joint = element_at(import.report, "/RSC/Structure/Constraints/Constraint/Type");
  ASSERT_TRUE(joint);
  EXPECT_EQ(joint->outcome, ImportOutcome::ignored);
  EXPECT_TRUE(element_at(import.report, "base/RSC/Voxel/Size"));
}

TEST(Rsc, AFileMayHoldWorldAndRobot) {
  const Import both = import_text(rise_world + rise_robot, "rsc", "test");
  EXPECT_EQ(both.robots, import_text(rise_robot, "rsc", "test", {}, rise_world).robots);
}

TEST(Rsc, BadFilesAreRefused) {
  EXPECT_EQ(refusal_of(rise_robot, "rsc"),
            "/RSC: has no element Voxel with the palette, and no base has one; name the file of the world with --base");
  EXPECT_EQ(refusal_of(rise_world, "rsc"), "/RSC: has no element Structure, which holds the bodies");
  const auto with = [&](const std::string& old, const std::string& other) {
    std::string text = rise_robot;
    text.replace(text.find(old), old.size(), other);
    return refusal_of(text, "rsc", rise_world);
  };
  EXPECT_EQ(with("<Layer>4,4,4</Layer>", "<Layer>4,4</Layer>"),
            "/RSC/Structure/Bodies/Body[1]/MaterialID/Layer[1]: has 2 values, X_Voxels times Y_Voxels is 3");
  EXPECT_EQ(with("<Layer>4,4,4</Layer>", "<Layer>4,5,4</Layer>"),
            "/RSC/Structure/Bodies/Body[1]/MaterialID: voxel 1 has material 5, which the palette has not");
  EXPECT_EQ(with("<Z_Voxels>2", "<Z_Voxels>2000000"),
            "/RSC/Structure/Bodies/Body[1]: has too many voxels; at most 4194304 are accepted");
}

}  // namespace
}  // namespace mercury
