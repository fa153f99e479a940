// SPDX-License-Identifier: Apache-2.0
// Every reader, given a damaged document, returns a robot that validate() accepts or throws an InputError of one line.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "mercury/error.h"
#include "mercury/random.h"
#include "mercury/random_voxel.h"
#include "mercury/robot_file.h"
#include "robots/file/document.h"

namespace mercury {
namespace {

Robot small_robot() {
  Robot robot = random_voxel_robot({.smallest = {2, 1, 1}, .largest = {2, 1, 1}, .air = 0}, 1);
  const auto defaults = default_materials();
  robot.materials.assign(defaults.begin(), defaults.begin() + 3);
  robot.materials[2].half_wave = true;
  robot.materials[1].relaxation_time = 0.02f;
  robot.mass.assign(robot.masses.size(), 0.5f);
  robot.velocity.assign(robot.masses.size(), {0, 0, 0.25f});
  robot.fixed = {1, 0};
  robot.material_names = {"air", "a", "b"};
  for (Spring& spring : robot.springs) spring.material = 1;
  return robot;
}

// The robot with actuators: one of materials, which files that Mercury writes have, and one of springs.
std::string document_with_actuators(RobotFormat format) {
  std::string json = serialize_robot(small_robot(), RobotFormat::json);
  const std::string actuators = R"("actuators":[{"name":"left","materials":[2]},{"name":"tail","springs":[0,1,2,7]}],)";
  json.insert(json.find("\"origin\""), actuators);
  if (format == RobotFormat::json) return json;
  std::string cbor;
  CborWriter writer(cbor);
  read_json(json, writer);
  return cbor;
}

std::string mutated(std::string document, Random& random) {
  const auto place = [&] { return static_cast<std::size_t>(random.below(document.size())); };
  constexpr std::string_view pieces[] = {"[",
                                         "]",
                                         "{",
                                         "}",
                                         ",",
                                         ":",
                                         "\"",
                                         "-",
                                         "1e9",
                                         "null",
                                         "true",
                                         "0.0",
                                         "99999999999999999999",
                                         "\x9f",
                                         "\xbf",
                                         "\xff",
                                         "\xfb",
                                         "\x1b",
                                         "\x7f",
                                         "\xf9",
                                         "\xc1"};
  const auto edits = 1 + random.below(4);
  for (std::uint64_t edit = 0; edit < edits && !document.empty(); ++edit) {
    const std::size_t at = place();
    switch (random.below(6)) {
      case 0:
        document[at] = static_cast<char>(random.below(256));
        break;
      case 1:
        document[at] = static_cast<char>(document[at] ^ (1 << random.below(8)));
        break;
      case 2:
        document.erase(at, random.below(20));
        break;
      case 3:
        document.insert(at, pieces[random.below(std::size(pieces))]);
        break;
      case 4:
        document.insert(at, document.substr(place(), random.below(40)));
        break;
      default:
        document.resize(at);
        break;
    }
  }
  return document;
}

class Fuzz : public testing::TestWithParam<RobotFormat> {};

void expect_a_robot_or_a_line(const std::string& sound, RobotFormat format) {
  int loaded = 0, refused = 0;
  for (std::uint64_t seed = 0; seed < 6000; ++seed) {
    Random random(seed);
    const std::string document = mutated(sound, random);
    try {
      const Robot robot = parse_robot(document, format);
      ASSERT_NO_THROW(validate(robot)) << "seed " << seed;
      // What can be read can be written, and reads back the same.
      ASSERT_EQ(parse_robot(serialize_robot(robot, format), format), robot) << "seed " << seed;
      ++loaded;
      try {
        voxel_grid_of(robot);
      } catch (const InputError&) {
      }
    } catch (const InputError& error) {
      const std::string message = error.what();
      ASSERT_FALSE(message.empty());
      ASSERT_LT(message.size(), 250u) << "seed " << seed;
      ASSERT_TRUE(std::none_of(message.begin(), message.end(), [](char c) { return c >= 0 && c < ' '; }))
          << "seed " << seed;
      ++refused;
    }
  }
  // Both outcomes are common, so the edits reach into the readers rather than break everything at once.
  EXPECT_GT(loaded, 100);
  EXPECT_GT(refused, 1000);
}

TEST_P(Fuzz, DamagedDocumentsGiveARobotOrALine) {
  expect_a_robot_or_a_line(serialize_robot(small_robot(), GetParam()), GetParam());
}

TEST_P(Fuzz, DamagedActuatorsGiveARobotOrALine) {
  const std::string sound = document_with_actuators(GetParam());
  ASSERT_EQ(parse_robot(sound, GetParam()).actuators.size(), 2u);
  expect_a_robot_or_a_line(sound, GetParam());
}

TEST_P(Fuzz, NoiseIsRefused) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Random random(seed);
    std::string noise(random.below(200), '\0');
    for (char& c : noise) c = static_cast<char>(random.below(256));
    ASSERT_THROW(parse_robot(noise, GetParam()), InputError) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, Fuzz, testing::Values(RobotFormat::json, RobotFormat::cbor),
                         [](const auto& format) { return format.param == RobotFormat::json ? "json" : "cbor"; });

}  // namespace
}  // namespace mercury
