// SPDX-License-Identifier: Apache-2.0
// The sample robots: each stays whole and gets somewhere in the environment that its origin names.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "mercury/inspect.h"
#include "mercury/origin.h"
#include "mercury/robot_file.h"
#include "mercury/simulation.h"
#include "mercury/voxel.h"
#include "robots/library/designs.h"

namespace mercury {
namespace {

std::vector<Robot> library_files() { return load_robots(std::vector<std::filesystem::path>{MERCURY_ROBOT_LIBRARY}); }

TEST(RobotLibrary, TheFilesAreWhatTheGeneratorMakes) {
  for (const Robot& design : library::all_robots()) {
    const auto path = std::filesystem::path(MERCURY_ROBOT_LIBRARY) / (design.name + ".json");
    EXPECT_EQ(load_robot(path), design) << path << " is not what generate_library writes";
  }
}

TEST(RobotLibrary, HasAtLeastTenRobotsOfEachEnvironmentInSmallFiles) {
  std::map<std::string, int> count;
  for (const Robot& robot : library_files()) ++count[environment_of(robot)];
  EXPECT_GE(count["ocean"] + count["land"], 10);
  EXPECT_GE(count["land"], 4);
  EXPECT_GE(count["ocean"], 4);
  EXPECT_EQ(count.size(), 2u);
  std::uintmax_t bytes = 0;
  for (const auto& file : std::filesystem::directory_iterator(MERCURY_ROBOT_LIBRARY))
    if (file.path().extension() == ".json" || file.path().extension() == ".cbor") {
      EXPECT_LT(file.file_size(), 300'000u) << file.path();
      bytes += file.file_size();
    }
  EXPECT_LT(bytes, 2'500'000u);
}

TEST(RobotLibrary, BodiesAreClosedAndInOnePiece) {
  for (const Robot& robot : library_files()) {
    const Inspection found = inspect(robot);
    EXPECT_TRUE(found.closed) << robot.name;
    EXPECT_EQ(found.components, 1u) << robot.name;
    EXPECT_GT(found.volume, 0) << robot.name;
    EXPECT_GT(found.muscles, 0u) << robot.name;
    EXPECT_LE(found.masses, 1365u) << robot.name << " does not fit the chip's 48 kB";
  }
}

#ifdef __SANITIZE_ADDRESS__
constexpr double seconds = 0.5;  // sanitizers are 30 times slower; a short run is enough to find errors
#else
constexpr double seconds = 20;
#endif

TEST(RobotLibrary, EachMovesAQuarterOfItsLengthInItsOwnEnvironment) {
  const std::vector<Robot> robots = library_files();
  for (const char* environment : {"ocean", "land"}) {
    std::vector<Robot> group;
    for (const Robot& robot : robots)
      if (environment_of(robot) == environment) group.push_back(robot);
    Simulation simulation({.environment = environment_named(environment), .device = {.kind = DeviceKind::cpu}}, group);
    const auto before = simulation.telemetry();
    simulation.step(static_cast<std::int64_t>(seconds / simulation.configuration().dt));
    const auto after = simulation.telemetry();
    for (std::size_t i = 0; i < group.size(); ++i) {
      EXPECT_FALSE(after[i].exploded) << group[i].name;
      // In a robot grown by a network, springs as short as a centimeter lie between long ones and follow them.
      EXPECT_LT(after[i].largest_strain, kind_of(group[i]) == "nn" ? 8 : 1.6) << group[i].name;
      Vec3 way = after[i].center_of_mass - before[i].center_of_mass;
      if (std::string_view(environment) == "land") way.z = 0;
      const float expected = seconds < 20 ? 0 : inspect(group[i]).length / 4;
      EXPECT_GE(length(way), expected) << group[i].name;
    }
  }
}

}  // namespace
}  // namespace mercury
