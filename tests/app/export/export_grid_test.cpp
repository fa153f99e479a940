// SPDX-License-Identifier: Apache-2.0
// VTK grids: the arrays after the document, unpacked here, against values computed in double precision.
#include <gmock/gmock.h>
#include <zlib.h>

#include <cmath>

#include "app/export/export_format.h"
#include "mercury/error.h"
#include "tests/app/export/export_bodies.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::ElementsAre;

// The array of that name in a .vtu file.
template <class Number>
std::vector<Number> array_of(const std::string& vtu, const std::string& name) {
  const std::size_t element = vtu.find("Name=\"" + name + "\"");
  if (element == std::string::npos) throw std::runtime_error("there is no array " + name);
  const std::size_t offset = std::stoul(vtu.substr(vtu.find("offset=\"", element) + 8));
  const std::size_t start = vtu.find("<AppendedData encoding=\"raw\">\n_") + 31 + offset;
  if (number_at<std::uint32_t>(vtu, start) == 0) return {};
  uLongf size = number_at<std::uint32_t>(vtu, start + 4);
  std::vector<Number> numbers(size / sizeof(Number));
  const int result =
      uncompress(reinterpret_cast<Bytef*>(numbers.data()), &size,
                 reinterpret_cast<const Bytef*>(vtu.data() + start + 16), number_at<std::uint32_t>(vtu, start + 12));
  if (result != Z_OK) throw std::runtime_error(name + " cannot be unpacked");
  return numbers;
}

class ExportGrid : public FolderTest {
 protected:
  std::string written(const ExportedRobot& robot, double time = 0) const {
    write_vtu(robot, bent_.pose(time), path("bent.vtu"), {});
    return read("bent.vtu");
  }
  Bent bent_;
};

TEST_F(ExportGrid, PointsAndCellsAreThoseOfTheRobot) {
  const std::string vtu = written(exported_robot(bent_.robot), 1.25);
  const Robot& robot = bent_.robot;
  const auto positions = array_of<Vec3>(vtu, "position"), velocities = array_of<Vec3>(vtu, "velocity");
  EXPECT_EQ(positions, bent_.positions);
  EXPECT_EQ(velocities, bent_.velocities);
  EXPECT_THAT(array_of<double>(vtu, "TimeValue"), ElementsAre(1.25));
  std::vector<std::int32_t> corners, ends;
  std::vector<std::uint8_t> types, materials;
  for (const Face& face : robot.faces) {
    for (const std::uint16_t mass : {face.a, face.b, face.c}) corners.push_back(mass);
    ends.push_back(static_cast<std::int32_t>(corners.size()));
    types.push_back(5);  // VTK_TRIANGLE
  }
  for (const Spring& spring : robot.springs) {
    for (const std::uint16_t mass : {spring.a, spring.b}) corners.push_back(mass);
    ends.push_back(static_cast<std::int32_t>(corners.size()));
    types.push_back(3);  // VTK_LINE
    materials.push_back(spring.material);
  }
  EXPECT_EQ(array_of<std::int32_t>(vtu, "connectivity"), corners);
  EXPECT_EQ(array_of<std::int32_t>(vtu, "offsets"), ends);
  EXPECT_EQ(array_of<std::uint8_t>(vtu, "types"), types);
  auto found = array_of<std::uint8_t>(vtu, "material");
  found.erase(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(robot.faces.size()));
  EXPECT_EQ(found, materials);
}

TEST_F(ExportGrid, StrainAndForceOfSpringsFollowHookesLaw) {
  // strain = (|d| - L0) / L0, force = k (|d| - L0 (1 + dL0 sin(omega t + phi))), all in double precision.
  for (const double time : {0.0, 0.7, 123.4}) {
    ExportedRobot robot = exported_robot(bent_.robot);
    robot.environment = Land{.stiffness_scale = 3};
    const std::string vtu = written(robot, time);
    const auto strains = array_of<float>(vtu, "strain"), forces = array_of<float>(vtu, "force");
    const std::size_t faces = bent_.robot.faces.size(), springs = bent_.robot.springs.size();
    ASSERT_EQ(strains.size(), faces + springs);
    ASSERT_EQ(forces.size(), faces + springs);
    double largest = 0;
    for (std::size_t i = 0; i < springs; ++i) {
      const Spring& spring = bent_.robot.springs[i];
      const Material& material = default_materials()[spring.material];
      const Double3 d = minus(in_double(bent_.positions[spring.b]), in_double(bent_.positions[spring.a]));
      const double length = std::sqrt(dot(d, d)), rest = spring.rest_length;
      const double phase = double{material.frequency} * time + double{material.phase};
      const double now = rest * (1 + double{material.amplitude} * std::sin(phase));
      EXPECT_NEAR(strains[faces + i], (length - rest) / rest, 2e-6);
      EXPECT_NEAR(forces[faces + i], 3 * double{material.stiffness} * (length - now), 3e-5);
      largest = std::max(largest, std::abs(length - now));
    }
    EXPECT_GT(largest, 0.01);
  }
}

TEST_F(ExportGrid, FacesHaveTheMeanOfTheirEdges) {
  const std::string vtu = written(exported_robot(bent_.robot));
  const auto strains = array_of<float>(vtu, "strain");
  const std::size_t faces = bent_.robot.faces.size();
  for (std::size_t i = 0; i < faces; ++i) {
    const Face& face = bent_.robot.faces[i];
    double sum = 0, count = 0;
    for (std::size_t s = 0; s < bent_.robot.springs.size(); ++s) {
      const Spring& spring = bent_.robot.springs[s];
      const auto is_corner = [&](std::uint16_t mass) { return mass == face.a || mass == face.b || mass == face.c; };
      if (!is_corner(spring.a) || !is_corner(spring.b)) continue;
      sum += strains[faces + s];
      ++count;
    }
    ASSERT_EQ(count, 3);  // in a voxel robot every edge has a spring
    EXPECT_NEAR(strains[i], sum / count, 1e-6);
  }
}

TEST_F(ExportGrid, RobotWithoutFacesAndVelocitiesIsWritten) {
  Robot robot;
  robot.masses = {{0, 0, 0}, {0.5f, 0, 0}};
  robot.springs = {{0, 1, 21, 0.4f}};
  write_vtu(exported_robot(robot), rest_pose(robot), path("pair.vtu"), {});
  const std::string vtu = read("pair.vtu");
  EXPECT_EQ(vtu.find("velocity"), std::string::npos);
  EXPECT_THAT(array_of<float>(vtu, "strain"), ElementsAre(testing::FloatNear(0.25f, 1e-6f)));
  EXPECT_THAT(array_of<float>(vtu, "force"), ElementsAre(testing::FloatNear(4, 1e-5f)));  // tissue: 40 N/m
}

}  // namespace
}  // namespace mercury::test
