// SPDX-License-Identifier: Apache-2.0
// What is in the files, read byte by byte, against the robot that they were written from.
#include <gmock/gmock.h>

#include <charconv>
#include <map>
#include <set>

#include "app/scene/appearance.h"
#include "mercury/error.h"
#include "tests/app/export/export_bodies.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ExportFiles : public FolderTest {
 protected:
  std::string written(const char* format, const ExportChoices& choices = {}) const {
    const std::string name = std::string("bent.") + format;
    export_format(format).pose(exported_robot(bent_.robot), bent_.pose(), path(name), choices);
    return read(name);
  }
  Bent bent_;
};

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

float float_of(const std::string& word) {
  float number = 0;
  const auto end = std::from_chars(word.data(), word.data() + word.size(), number);
  EXPECT_EQ(end.ptr, word.data() + word.size()) << word;
  return number;
}

std::set<std::uint16_t> masses_of_skin(const Robot& robot) {
  std::set<std::uint16_t> masses;
  for (const Face& face : robot.faces) masses.insert({face.a, face.b, face.c});
  return masses;
}

TEST_F(ExportFiles, StlHasEachFaceWithItsOutwardNormal) {
  const std::string stl = written("stl");
  const std::size_t faces = bent_.robot.faces.size();
  ASSERT_EQ(stl.size(), 84 + 50 * faces);
  EXPECT_FALSE(stl.starts_with("solid"));  // the mark of the text form
  EXPECT_EQ(number_at<std::uint32_t>(stl, 80), faces);
  double volume = 0;
  for (std::size_t i = 0; i < faces; ++i) {
    const std::size_t place = 84 + 50 * i;
    const Face& face = bent_.robot.faces[i];
    const Vec3 a = number_at<Vec3>(stl, place + 12), b = number_at<Vec3>(stl, place + 24),
               c = number_at<Vec3>(stl, place + 36);
    EXPECT_EQ(a, bent_.positions[face.a]);
    EXPECT_EQ(b, bent_.positions[face.b]);
    EXPECT_EQ(c, bent_.positions[face.c]);
    const Double3 normal = in_double(number_at<Vec3>(stl, place));
    const Double3 area = cross(minus(in_double(b), in_double(a)), minus(in_double(c), in_double(a)));
    EXPECT_NEAR(dot(normal, normal), 1, 1e-6);
    EXPECT_NEAR(dot(normal, area), std::sqrt(dot(area, area)), 1e-9);  // parallel, and outward as the face is
    EXPECT_EQ(number_at<std::uint16_t>(stl, place + 48), 0);
    volume += dot(in_double(a), cross(in_double(b), in_double(c))) / 6;
  }
  EXPECT_NEAR(volume, volume_of(bent_.robot, bent_.positions), 1e-12);
  EXPECT_GT(volume, 0.01);
}

TEST_F(ExportFiles, ObjReadsBackToTheSameFloatsAndFaces) {
  std::istringstream lines(written("obj"));
  const std::set<std::uint16_t> masses = masses_of_skin(bent_.robot);
  const std::vector<std::uint16_t> order(masses.begin(), masses.end());
  std::vector<Vec3> vertices;
  std::multiset<std::array<std::uint16_t, 3>> faces, expected;
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> words = words_of(line);
    if (words[0] == "v") vertices.push_back({float_of(words[1]), float_of(words[2]), float_of(words[3])});
    if (words[0] != "f") continue;
    std::array<std::uint16_t, 3> face{};
    for (std::size_t i = 0; i < 3; ++i) face[i] = order.at(static_cast<std::size_t>(std::stoi(words[i + 1]) - 1));
    faces.insert(face);
  }
  ASSERT_EQ(vertices.size(), order.size());
  for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(vertices[i], bent_.positions[order[i]]) << i;
  for (const Face& face : bent_.robot.faces) expected.insert({face.a, face.b, face.c});
  EXPECT_EQ(faces, expected);
}

TEST_F(ExportFiles, ObjGivesEachFaceTheColorOfItsMaterial) {
  std::istringstream lines(written("obj")), materials(read("bent.mtl"));
  std::map<std::string, std::array<float, 3>> colors;
  std::string name;
  for (std::string line; std::getline(materials, line);) {
    const std::vector<std::string> words = words_of(line);
    if (!words.empty() && words[0] == "newmtl") name = words.at(1);
    if (!words.empty() && words[0] == "Kd") colors[name] = {float_of(words[1]), float_of(words[2]), float_of(words[3])};
  }
  std::multiset<std::array<float, 3>> found, expected;
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> words = words_of(line);
    if (words[0] == "mtllib") {
      EXPECT_EQ(words.at(1), "bent.mtl");
    }
    if (words[0] == "usemtl") name = words.at(1);
    if (words[0] == "f") found.insert(colors.at(name));
  }
  const auto of_materials = material_colors(default_materials(), true);
  for (const MaterialId id : face_materials(bent_.robot)) expected.insert(render::linear_of(of_materials[id]));
  EXPECT_EQ(found, expected);
  EXPECT_GT(colors.size(), 2u);
}

TEST_F(ExportFiles, ObjWithSpringsHasALinePerSpring) {
  std::istringstream lines(written("obj", {.springs = true}));
  std::size_t count = 0, vertices = 0;
  for (std::string line; std::getline(lines, line);) {
    count += line.starts_with("l ");
    vertices += line.starts_with("v ");
  }
  EXPECT_EQ(count, bent_.robot.springs.size());
  EXPECT_EQ(vertices, bent_.robot.masses.size());  // each mass of a voxel robot has a spring
}

TEST_F(ExportFiles, PlyHasExactColorsPerFaceAndThePositionsOfTheSkin) {
  const std::string ply = written("ply");
  const std::size_t masses = masses_of_skin(bent_.robot).size(), faces = bent_.robot.faces.size();
  EXPECT_THAT(ply, HasSubstr("element vertex " + std::to_string(masses) + "\n"));
  EXPECT_THAT(ply, HasSubstr("element face " + std::to_string(faces) + "\n"));
  const std::size_t start = ply.find("end_header\n") + 11, vertex = 12 + 3, face = 1 + 3 * 4 + 3;
  ASSERT_EQ(ply.size(), start + masses * vertex + faces * face);
  const auto colors = material_colors(default_materials(), true);
  const auto materials = face_materials(bent_.robot);
  for (std::size_t i = 0; i < faces; ++i) {
    const std::size_t place = start + masses * vertex + i * face;
    EXPECT_EQ(ply[place], 3);
    const Face& of = bent_.robot.faces[i];
    std::size_t corner = 0;
    for (const std::uint16_t mass : {of.a, of.b, of.c}) {
      const auto index = static_cast<std::size_t>(number_at<std::int32_t>(ply, place + 1 + 4 * corner++));
      EXPECT_EQ(number_at<Vec3>(ply, start + index * vertex), bent_.positions[mass]);
    }
    const auto color = number_at<std::array<std::uint8_t, 3>>(ply, place + 13);
    EXPECT_THAT(color, ElementsAre(colors[materials[i]].r, colors[materials[i]].g, colors[materials[i]].b));
  }
}

TEST_F(ExportFiles, GlbStandsUprightAndHasThePositions) {
  const std::string glb = written("glb");
  ASSERT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(number_at<std::uint32_t>(glb, 4), 2u);
  EXPECT_EQ(number_at<std::uint32_t>(glb, 8), glb.size());
  const std::uint32_t text = number_at<std::uint32_t>(glb, 12);
  EXPECT_EQ(text % 4, 0u);
  EXPECT_EQ(glb.substr(16, 4), "JSON");
  EXPECT_EQ(glb.substr(20 + text + 4, 4), std::string("BIN\0", 4));
  const auto json = nlohmann::json::parse(glb.substr(20, text));
  // The rotation of a unit quaternion (x, y, z, w) turns +z into +y: v' = v + 2 q x (q x v + w v).
  const auto q = json["nodes"][0]["rotation"].get<std::vector<double>>();
  const Double3 axis{q[0], q[1], q[2]}, up{0, 0, 1}, inner = cross(axis, up);
  const Double3 turned = cross(axis, {inner[0] + q[3] * up[0], inner[1] + q[3] * up[1], inner[2] + q[3] * up[2]});
  EXPECT_NEAR(up[0] + 2 * turned[0], 0, 1e-12);
  EXPECT_NEAR(up[1] + 2 * turned[1], 1, 1e-12);
  EXPECT_NEAR(up[2] + 2 * turned[2], 0, 1e-12);
  const auto& accessor = json["accessors"][0];
  const std::set<std::uint16_t> masses = masses_of_skin(bent_.robot);
  ASSERT_EQ(accessor["count"], masses.size());
  std::size_t place = 20 + text + 8;
  Vec3 high = bent_.positions[*masses.begin()];
  for (const std::uint16_t mass : masses) {
    EXPECT_EQ(number_at<Vec3>(glb, place), bent_.positions[mass]);
    high = {std::max(high.x, bent_.positions[mass].x), std::max(high.y, bent_.positions[mass].y),
            std::max(high.z, bent_.positions[mass].z)};
    place += sizeof(Vec3);
  }
  EXPECT_THAT(accessor["max"].get<std::vector<float>>(), ElementsAre(high.x, high.y, high.z));
  std::size_t corners = 0;
  for (const auto& primitive : json["meshes"][0]["primitives"])
    corners += json["accessors"][primitive["indices"].get<std::size_t>()]["count"].get<std::size_t>();
  EXPECT_EQ(corners, 3 * bent_.robot.faces.size());
}

TEST_F(ExportFiles, FilesThatCannotBeWrittenLeaveNothingBehind) {
  for (const ExportFormat& format : export_formats()) {
    if (!holds_pose(format)) continue;
    EXPECT_THROW(format.pose(exported_robot(bent_.robot), bent_.pose(), path("missing/bent.x"), {}), InputError);
  }
  write("file", "");
  EXPECT_THROW(write_obj(exported_robot(bent_.robot), bent_.pose(), path("file/bent.obj"), {}), InputError);
  EXPECT_THAT(listing(), ElementsAre("file"));
}

TEST_F(ExportFiles, ObjThatCannotBeKeptKeepsNoMaterialsEither) {
  std::filesystem::create_directories(path("bent.mtl"));  // a folder where the file should be
  EXPECT_ANY_THROW(written("obj"));
  EXPECT_THAT(listing(), ElementsAre("bent.mtl"));
}

TEST(ExportFormats, NamesAndExtensionsAreThereOnceAndEachHoldsSomething) {
  std::set<std::string_view> names, extensions;
  for (const ExportFormat& format : export_formats()) {
    EXPECT_TRUE(names.insert(format.name).second) << format.name;
    EXPECT_TRUE(extensions.insert(format.extension).second) << format.extension;
    EXPECT_TRUE(holds_pose(format) || holds_motion(format)) << format.name;
    EXPECT_EQ(export_format_of("a/B" + std::string(format.extension)), &format);
    EXPECT_FALSE(format.help.ends_with("."));
  }
  EXPECT_EQ(export_format_of("EEL.GLB"), &export_format("glb"));
  EXPECT_EQ(export_format_of("eel.json"), nullptr);
  EXPECT_THROW(export_format("gif"), ParameterError);
}

}  // namespace
}  // namespace mercury::test
