// SPDX-License-Identifier: Apache-2.0
// VXA files that break a rule are refused in one line that says where and why.
#include <gtest/gtest.h>

#include "robots/importers/encodings.h"
#include "tests/robots/importers/documents.h"

namespace mercury {
namespace {

std::string refusal_of_parts(const VxaParts& parts) { return refusal_of(parts.text(), "vxa"); }

TEST(BadVxa, TheValidFileIsAccepted) { EXPECT_EQ(refusal_of_parts({}), ""); }

TEST(BadVxa, NoXml) {
  EXPECT_EQ(refusal_of("", "vxa"), "holds no XML element");
  EXPECT_EQ(refusal_of("<VXA>\n<VXC>", "vxa"), "line 2: not valid XML: Start-end tags mismatch");
  EXPECT_EQ(refusal_of("<robot/>", "vxa"), "/robot: a file of another kind; its outermost element must be VXA or VXC");
}

// Nine entities, each ten times the one before it: 10^9 words.
TEST(BadVxa, EntityBombs) {
  std::string bomb = "<?xml version=\"1.0\"?><!DOCTYPE VXA [<!ENTITY a0 \"ha\">";
  for (int i = 1; i < 10; ++i) {
    bomb += "<!ENTITY a" + std::to_string(i) + " \"";
    for (int k = 0; k < 10; ++k) bomb += "&a" + std::to_string(i - 1) + ";";
    bomb += "\">";
  }
  bomb += "]><VXA>&a9;</VXA>";
  EXPECT_EQ(refusal_of(bomb, "vxa"), "a document type declaration is not accepted; robot files need none");
}

TEST(BadVxa, ElementsWithoutEnd) {
  std::string deep, wide = "<VXA>";
  for (int i = 0; i < 100'000; ++i) deep += "<VXA>";
  EXPECT_NE(refusal_of(deep, "vxa").find("not valid XML"), std::string::npos);
  for (int i = 0; i < 100'000; ++i) deep += "</VXA>";
  EXPECT_EQ(refusal_of(deep, "vxa"), "nested deeper than 64 levels");
  for (int i = 0; i < 100'000; ++i) wide += "<a/>";
  EXPECT_EQ(refusal_of(wide + "</VXA>", "vxa"), "more than 100000 elements");
}

TEST(BadVxa, SizesThatCannotBe) {
  VxaParts parts;
  const auto size = [&](const std::string& x, const std::string& y, const std::string& z) {
    parts.size = "<X_Voxels>" + x + "</X_Voxels><Y_Voxels>" + y + "</Y_Voxels><Z_Voxels>" + z + "</Z_Voxels>";
    return refusal_of_parts(parts);
  };
  EXPECT_EQ(size("-3", "1", "2"), "/VXA/VXC/Structure/X_Voxels: -3 is not accepted; give 1 to 4194304");
  EXPECT_EQ(size("0", "1", "2"), "/VXA/VXC/Structure/X_Voxels: 0 is not accepted; give 1 to 4194304");
  EXPECT_EQ(size("2", "1e9", "2"), "/VXA/VXC/Structure/Y_Voxels: 1000000000 is not accepted; give 1 to 4194304");
  EXPECT_EQ(size("2", "1", "1e99"), "/VXA/VXC/Structure/Z_Voxels: 1e+99 is not accepted; give a whole number");
  EXPECT_EQ(size("2", "two", "2"), "/VXA/VXC/Structure/Y_Voxels: \"two\" is not a number");
  EXPECT_EQ(size("2", "1.5", "2"), "/VXA/VXC/Structure/Y_Voxels: 1.5 is not accepted; give a whole number");
  EXPECT_EQ(size("2", "nan", "2"), "/VXA/VXC/Structure/Y_Voxels: \"nan\" is not a number");
  EXPECT_EQ(size("4000000", "4000000", "4000000"),
            "/VXA/VXC/Structure: 4000000x4000000x4000000 voxels are too many; at most 4194304 are accepted");
  EXPECT_EQ(size("2", "1", "2000000"), "/VXA/VXC/Structure/Data: has 2 layers, Z_Voxels is 2000000");
  EXPECT_EQ(size("4000000", "1", "1"), "/VXA/VXC/Structure/Data: has 2 layers, Z_Voxels is 1");
}

TEST(BadVxa, LayersOfAnotherLength) {
  VxaParts parts;
  parts.data = "<Layer>12</Layer><Layer>033</Layer>";
  EXPECT_EQ(refusal_of_parts(parts), "/VXA/VXC/Structure/Data/Layer[2]: has 3 voxels, X_Voxels times Y_Voxels is 2");
  parts.data = "<Layer>12</Layer><Layer/>";
  EXPECT_EQ(refusal_of_parts(parts), "/VXA/VXC/Structure/Data/Layer[2]: has 0 voxels, X_Voxels times Y_Voxels is 2");
  parts.data = "<Layer>12</Layer>";
  EXPECT_EQ(refusal_of_parts(parts), "/VXA/VXC/Structure/Data: has 1 layers, Z_Voxels is 2");
  parts.data = "<Layer>1 </Layer><Layer>03</Layer>";
  EXPECT_EQ(refusal_of_parts(parts), "/VXA/VXC/Structure/Data/Layer[1]: has 1 voxels, X_Voxels times Y_Voxels is 2");
  parts = {};
  parts.layers = "<PhaseOffset><Layer>0,0</Layer><Layer>0</Layer></PhaseOffset>";
  EXPECT_EQ(refusal_of_parts(parts),
            "/VXA/VXC/Structure/PhaseOffset/Layer[2]: has 1 values, X_Voxels times Y_Voxels is 2");
  parts.layers = "<PhaseOffset><Layer>0,0</Layer><Layer>0,much</Layer></PhaseOffset>";
  EXPECT_EQ(refusal_of_parts(parts), "/VXA/VXC/Structure/PhaseOffset/Layer[2]: value 2 is not a number");
  parts.layers = "<PhaseOffset><Layer>0,0</Layer></PhaseOffset>";
  EXPECT_EQ(refusal_of_parts(parts), "/VXA/VXC/Structure/PhaseOffset: has 1 layers, Z_Voxels is 2");
}

TEST(BadVxa, DamagedEncodings) {
  VxaParts parts;
  parts.compression = "BASE64";
  parts.data = "<Layer>AQI=</Layer><Layer>A?M=</Layer>";
  EXPECT_EQ(refusal_of_parts(parts), "/VXA/VXC/Structure/Data/Layer[2]: not valid base64: character 2 cannot be there");
  parts.compression = "ZLIB";
  parts.data = "<Layer>AQI=</Layer><Layer>AQI=</Layer>";
  EXPECT_EQ(refusal_of_parts(parts), "/VXA/VXC/Structure/Data/Layer[1]: not valid zlib data: incorrect header check");
  parts.compression = "RAW_DATA";
  EXPECT_EQ(refusal_of_parts(parts),
            "/VXA/VXC/Structure: compression \"RAW_DATA\" is not accepted; give ASCII_READABLE, BASE64 or ZLIB");
}

TEST(BadVxa, MaterialsThatCannotBe) {
  VxaParts parts;
  parts.data = "<Layer>12</Layer><Layer>0!</Layer>";
  EXPECT_EQ(refusal_of_parts(parts), "/VXA/VXC/Structure/Data/Layer[2]: holds a character below \"0\"");
  parts = {};
  parts.materials = VxaParts::material("a", 1e5, 0) + VxaParts::material("b", 0, 0) + VxaParts::material("c", 1e5, 0);
  EXPECT_EQ(refusal_of_parts(parts),
            "/VXA/VXC/Palette/Material[2]/Mechanical/Elastic_Mod: Elastic_Mod is 0, and voxels have this "
            "material; give more than 0");
  parts.materials = "<Material><Mechanical><Elastic_Mod>soft</Elastic_Mod></Mechanical></Material>";
  EXPECT_EQ(refusal_of_parts(parts), "/VXA/VXC/Palette/Material/Mechanical/Elastic_Mod: \"soft\" is not a number");
}

TEST(BadVxa, ValuesThatCannotBe) {
  VxaParts parts;
  parts.lattice = "<Lattice_Dim>-0.01</Lattice_Dim>";
  EXPECT_EQ(refusal_of_parts(parts),
            "/VXA/VXC/Lattice/Lattice_Dim: an edge of -0.01 m is not accepted; give 1e-9 to 1000");
  parts = {};
  parts.gravity = "<GravEnabled>perhaps</GravEnabled>";
  EXPECT_EQ(refusal_of_parts(parts), "/VXA/Environment/Gravity/GravEnabled: \"perhaps\" is not accepted; give 0 or 1");
}

// 65,536 corners and more do not fit the 16 bits of a robot's masses.
TEST(BadVxa, BodiesTooLargeForARobot) {
  VxaParts parts;
  parts.size = "<X_Voxels>40</X_Voxels><Y_Voxels>40</Y_Voxels><Z_Voxels>40</Z_Voxels>";
  parts.data.clear();
  for (int z = 0; z < 40; ++z) parts.data += "<Layer>" + std::string(1600, '1') + "</Layer>";
  EXPECT_EQ(refusal_of_parts(parts),
            "/VXA/VXC/Structure: voxel grid: the body has 68921 masses, at most 65535 are accepted");
}

TEST(BadVxa, TruncatedFilesAreRefusedWhereverTheyEnd) {
  const std::string text = VxaParts{}.text();
  for (std::size_t end = 0; end < text.size() - 1; ++end)
    ASSERT_NE(refusal_of(std::string_view(text).substr(0, end), "vxa"), "") << end;
}

}  // namespace
}  // namespace mercury
