// SPDX-License-Identifier: Apache-2.0
#include "mercury/robot_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <sstream>

#include "mercury/random_voxel.h"
#include "robots/file/document.h"
#include "robots/file/whole_file.h"
#include "tests/folder.h"
#include "tests/refusal.h"
#include "tests/size_limit.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

class RobotFiles : public test::TestWithFolder {
 protected:
  // The message without the folder's name.
  std::string message_of(auto&& action) {
    std::string message = refusal<std::exception>(action);
    const std::string prefix = folder_.string() + "/";
    for (auto at = message.find(prefix); at != std::string::npos; at = message.find(prefix))
      message.erase(at, prefix.size());
    return message;
  }
};

Robot robot_with_hard_values() {
  Robot robot;
  robot.name = "Zitteraal \"ä\"\n\t\\ \x01 鰻";
  robot.materials = {{}, {50, 0.14f, 1, std::nextafter(1.f, 2.f)}, {1e-30f, -0.5f, -3, 7e7f, true, 1e-45f}};
  robot.material_names = {"air", "", "µ"};
  robot.masses = {{0.1f, -0.f, 1e-45f}, {1.f / 3, 999999.94f, 16777216.f / 32}, {-1.17549435e-38f, 5, 3e-5f}};
  robot.springs = {{0, 1, 1, 0.001f}, {2, 1, 2, 1e6f}};
  robot.faces = {{0, 1, 2}, {2, 1, 0}};
  robot.mass = {1e-45f, 1.f / 3, 3e38f};
  robot.velocity = {{-0.f, 1e-45f, 0.1f}, {}, {3e38f, -1, 0}};
  robot.fixed = {2, 0};
  robot.origin =
      R"({"kind":"test","seed":18446744073709551615,"a":[-9223372036854775808,0.1,1e+300,null,true,"x\u0000"],"b":{}})";
  return robot;
}

TEST_F(RobotFiles, EveryValueComesBackBitForBit) {
  for (const char* name : {"a.json", "a.cbor"}) {
    const Robot robot = robot_with_hard_values();
    save_robot(folder_ / name, robot);
    const Robot loaded = load_robot(folder_ / name);
    EXPECT_EQ(loaded, robot) << name;
    EXPECT_TRUE(std::signbit(loaded.masses[0].y)) << name;
  }
}

TEST_F(RobotFiles, NameHalfWavesOnlyWhereAMaterialHasThem) {
  Robot robot{.materials = {{}, {50, 0.1f, 1, 0}}, .masses = {{0, 0, 0}, {0, 3, 4}}, .springs = {{0, 1, 1, 5}}};
  EXPECT_THAT(serialize_robot(robot, RobotFormat::json), testing::Not(testing::HasSubstr("half_wave")));
  EXPECT_THAT(serialize_robot(robot, RobotFormat::cbor), testing::Not(testing::HasSubstr("half_wave")));
  robot.materials[1].half_wave = true;
  const std::string json = serialize_robot(robot, RobotFormat::json);
  EXPECT_THAT(json, testing::HasSubstr(R"("half_wave":true)"));
  EXPECT_EQ(json.find("half_wave"), json.rfind("half_wave")) << "air has none";
}

// A file of each kind, as this version writes it. They are read for ever.
constexpr std::string_view plain_file = R"({
"format":"mercury-robot",
"version":1,
"name":"pair",
"materials":[{"stiffness":0,"amplitude":0,"frequency":0,"phase":0},{"stiffness":50,"amplitude":0.1,"frequency":1,"phase":0,"half_wave":true}],
"masses":[[0,0,0],[0.1,0,0]],
"springs":[[0,1,1]],
"faces":[]
}
)";
constexpr std::string_view own_points_file = R"({
"format":"mercury-robot",
"version":1,
"requires":["mass","velocity","fixed","relaxation_time"],
"name":"pair",
"materials":[{"stiffness":0,"amplitude":0,"frequency":0,"phase":0},{"stiffness":50,"amplitude":0.1,"frequency":1,"phase":0,"relaxation_time":0.02,"half_wave":true}],
"masses":[[0,0,0],[0.1,0,0]],
"mass":[0.5,2],
"velocity":[[0,0,0],[0,0,-0.25]],
"fixed":[0],
"springs":[[0,1,1]],
"faces":[]
}
)";

std::string as_cbor(std::string_view json) {
  std::string cbor;
  CborWriter writer(cbor);
  read_json(json, writer);
  return cbor;
}

TEST_F(RobotFiles, OfEachKindAreReadAndWrittenAsEver) {
  Robot robot{.name = "pair",
              .materials = {{}, {50, 0.1f, 1, 0, true}},
              .masses = {{0, 0, 0}, {0.1f, 0, 0}},
              .springs = {{0, 1, 1, 0.1f}}};
  const auto expect_file = [&](std::string_view file) {
    EXPECT_EQ(parse_robot(file, RobotFormat::json), robot);
    EXPECT_EQ(serialize_robot(robot, RobotFormat::json), file);
    EXPECT_EQ(parse_robot(as_cbor(file), RobotFormat::cbor), robot);
    EXPECT_EQ(parse_robot(serialize_robot(robot, RobotFormat::cbor), RobotFormat::cbor), robot);
  };
  expect_file(plain_file);
  robot.materials[1].relaxation_time = 0.02f;
  robot.mass = {0.5f, 2};
  robot.velocity = {{}, {0, 0, -0.25f}};
  robot.fixed = {0};
  expect_file(own_points_file);
}

TEST_F(RobotFiles, RequireEachPartThatTheRobotHas) {
  const Robot plain{.materials = {{}, {50}}, .masses = {{0, 0, 0}, {1, 0, 0}}, .springs = {{0, 1, 1, 1}}};
  const auto requirement = [&](const auto& change) {
    Robot robot = plain;
    change(robot);
    const std::string json = serialize_robot(robot, RobotFormat::json);
    const std::size_t at = json.find("\"requires\":");
    return at == std::string::npos ? "" : json.substr(at + 11, json.find('\n', at) - at - 12);
  };
  EXPECT_EQ(requirement([](Robot&) {}), "");
  EXPECT_EQ(requirement([](Robot& r) { r.mass = {1, 1}; }), R"(["mass"])");
  EXPECT_EQ(requirement([](Robot& r) { r.velocity = {{}, {}}; }), R"(["velocity"])");
  EXPECT_EQ(requirement([](Robot& r) { r.fixed = {1}; }), R"(["fixed"])");
  EXPECT_EQ(requirement([](Robot& r) { r.materials[1].relaxation_time = 1; }), R"(["relaxation_time"])");
}

TEST_F(RobotFiles, VoxelRobotsComeBackWithTheirGrid) {
  for (std::uint64_t i = 0; i < 20; ++i)
    for (const RobotFormat format : {RobotFormat::json, RobotFormat::cbor}) {
      const Robot robot = random_voxel_robot({}, 11, i);
      const Robot loaded = parse_robot(serialize_robot(robot, format), format);
      ASSERT_EQ(loaded, robot);
      ASSERT_EQ(voxel_grid_of(loaded), voxel_grid_of(robot));
    }
}

TEST_F(RobotFiles, RestLengthsAreLeftOutWhereAllAreTheDistancesAtRest) {
  Robot robot{.masses = {{0, 0, 0}, {0, 3, 4}}, .springs = {{0, 1, 21, 5}}};
  EXPECT_THAT(serialize_robot(robot, RobotFormat::json), testing::HasSubstr("\"springs\":[[0,1,21]]"));
  EXPECT_EQ(parse_robot(serialize_robot(robot, RobotFormat::json), RobotFormat::json), robot);
  EXPECT_EQ(parse_robot(serialize_robot(robot, RobotFormat::cbor), RobotFormat::cbor), robot);
  robot.springs[0].rest_length = 4.5f;
  EXPECT_THAT(serialize_robot(robot, RobotFormat::json), testing::HasSubstr("\"springs\":[[0,1,21,4.5]]"));
}

TEST_F(RobotFiles, LinesOfAFileAreShort) {
  const Robot robot = random_voxel_robot({}, 1);
  std::istringstream lines(serialize_robot(robot, RobotFormat::json));
  for (std::string line; std::getline(lines, line);)
    EXPECT_TRUE(line.size() < 160 || line.starts_with("\"origin\"")) << line;
}

TEST_F(RobotFiles, UnknownMembersOfTheDocumentAndOfMaterialsAreKept) {
  const std::string document =
      R"({"comment": [1, {"masses": [[]]}, null], "springs": [[0, 1, 1]], "format": "mercury-robot",
    "materials": [{"stiffness": 1}, {"stiffness": 2, "color": {"r": [1]}, "name": "m"}],
    "version": 1, "masses": [[0, 0, 0], [1, 0, 0]], "faces": [], "x": 1.5})";
  const Robot robot = parse_robot(document, RobotFormat::json);
  EXPECT_EQ(robot.springs, (std::vector<Spring>{{0, 1, 1, 1}}));
  EXPECT_EQ(robot.materials, (std::vector<Material>{{1, 0, 0, 0}, {2, 0, 0, 0}}));
  EXPECT_EQ(robot.material_names, (std::vector<std::string>{"", "m"}));
  const std::string others = R"({"comment":[1,{"masses":[[]]},null],"x":1.5,"materials":{"1":{"color":{"r":[1]}}}})";
  EXPECT_EQ(robot.other, others);
  for (const RobotFormat format : {RobotFormat::json, RobotFormat::cbor}) {
    const std::string written = serialize_robot(robot, format);
    EXPECT_EQ(parse_robot(written, format), robot);
    EXPECT_EQ(serialize_robot(parse_robot(written, format), format), written);
  }
  EXPECT_EQ(json_member(serialize_robot(robot, RobotFormat::json), "comment"), R"([1,{"masses":[[]]},null])");
}

TEST_F(RobotFiles, UnknownMembersWithinTheDocumentAreWrittenWhereTheyWere) {
  const std::string document =
      R"({"format":"mercury-robot","version":1,"name":"a","materials":[{"stiffness":0,"note":"air"},)"
      R"({"stiffness":2,"amplitude":0.1,"supplier":{"name":"A","codes":[1,2.50]}}],)"
      R"("masses":[[0,0,0],[1,0,0]],"springs":[[0,1,1]],"faces":[],)"
      R"("actuators":[{"name":"leg","color":null,"materials":[1]}],)"
      R"("sensors":[{"kind":"clock","frequency":2,"label":"beat"}],)"
      R"("brain":{"author":"B","layers":[{"name":"out","neurons":1,"trained":true,)"
      R"("inputs":[{"from":"senses","weights":[[0.5,1]],"learned":[0]}]}],)"
      R"("outputs":[{"actuator":"leg","layer":"out","neuron":0,"gain":3}]}})";
  const Robot robot = parse_robot(document, RobotFormat::json);
  EXPECT_EQ(robot.other, R"({"brain":{"layers":{"0":{"inputs":{"0":{"learned":[0]}},"trained":true}},)"
                         R"("outputs":{"0":{"gain":3}},"author":"B"},"sensors":{"0":{"label":"beat"}},)"
                         R"("actuators":{"0":{"color":null}},)"
                         R"("materials":{"0":{"note":"air"},"1":{"supplier":{"name":"A","codes":[1,2.50]}}}})");
  EXPECT_EQ(parse_robot(serialize_robot(robot, RobotFormat::json), RobotFormat::json), robot);
  for (const RobotFormat format : {RobotFormat::json, RobotFormat::cbor}) {
    const std::string written = serialize_robot(robot, format);
    Robot again = parse_robot(written, format);
    EXPECT_NE(again.other.find("2.5"), std::string::npos);
    again.other = robot.other;  // of a number, CBOR keeps the value and not the digits
    EXPECT_EQ(again, robot);
  }
  const std::string written = serialize_robot(robot, RobotFormat::json);
  for (const char* part : {R"("supplier":{"name":"A","codes":[1,2.50]}})", R"("color":null})", R"("label":"beat"})",
                           R"("learned":[0]})", R"("trained":true})", R"("gain":3})", R"("author":"B"})"})
    EXPECT_THAT(written, testing::HasSubstr(part));
}

TEST_F(RobotFiles, UnknownMembersOfOtherPlacesDoNotStopAReader) {
  // Beside an array where an object belongs, the place of the error is that of the file.
  EXPECT_EQ(refusal([] {
              parse_robot(R"({"format":"mercury-robot","version":1,"materials":[{"stiffness":1,"x":[{"y":1}]},[2]],)"
                          R"("masses":[],"springs":[],"faces":[]})",
                          RobotFormat::json);
            }),
            "/materials: holds an array at 1, not an object");
  // A robot whose table was shortened has no members of materials that are not there.
  Robot robot = parse_robot(R"({"format":"mercury-robot","version":1,"masses":[[0,0,0]],"springs":[],"faces":[],)"
                            R"("materials":[{"stiffness":0},{"stiffness":1,"note":2}]})",
                            RobotFormat::json);
  robot.materials.pop_back();
  EXPECT_EQ(parse_robot(serialize_robot(robot, RobotFormat::json), RobotFormat::json).other, "");
}

TEST_F(RobotFiles, MembersThatJsonCannotHoldAreLeftOut) {
  Robot plain{.name = "a", .masses = {{0, 0, 0}}};
  std::string document = serialize_robot(plain, RobotFormat::cbor);
  ++document[0];                                        // one member more in the map
  document += std::string("\x61z\x81\x42\x01\x02", 6);  // "z": [h'0102']
  EXPECT_EQ(parse_robot(document, RobotFormat::cbor), plain);
  document[0] += 1;
  document += "\x61y\x01";  // "y": 1
  EXPECT_EQ(parse_robot(document, RobotFormat::cbor).other, R"({"y":1})");
}

TEST_F(RobotFiles, ARobotWithoutANameIsNamedByItsFile) {
  write("ray.json", R"({"format":"mercury-robot","version":1,"masses":[[0,0,0]],"springs":[],"faces":[]})");
  EXPECT_EQ(load_robot(folder_ / "ray.json").name, "ray");
}

TEST_F(RobotFiles, FoldersAreReadByName) {
  const Robot robot{.masses = {{0, 0, 0}}};
  fs::create_directory(folder_ / "b");
  fs::create_directory(folder_ / "b" / "inner.json");
  for (const char* name : {"b/2.json", "b/10.cbor", "b/1.json", "z.cbor"}) {
    Robot named = robot;
    named.name = name;
    save_robot(folder_ / name, named);
  }
  write("b/readme.txt", "no robot");
  const std::vector<fs::path> paths{folder_ / "z.cbor", folder_ / "b"};
  std::vector<std::string> names;
  for (const Robot& loaded : load_robots(paths)) names.push_back(loaded.name);
  EXPECT_THAT(names, testing::ElementsAre("z.cbor", "b/1.json", "b/10.cbor", "b/2.json"));
}

TEST_F(RobotFiles, ExtensionsMayBeInCapitals) {
  const Robot robot{.name = "a", .masses = {{0, 0, 0}}};
  for (const char* name : {"a.JSON", "b.Cbor", "c.json"}) save_robot(folder_ / name, robot);
  EXPECT_EQ(robot_format_of("b.Cbor"), RobotFormat::cbor);
  EXPECT_EQ(find_robot_format("b.Txt"), std::nullopt);
  EXPECT_EQ(extension_of("B/Robots.1/A.Tar.Gz"), ".gz");
  EXPECT_THAT(robot_files(std::vector{folder_}),
              testing::ElementsAre(folder_ / "a.JSON", folder_ / "b.Cbor", folder_ / "c.json"));
  for (const fs::path& file : robot_files(std::vector{folder_})) EXPECT_EQ(load_robot(file), robot) << file;
}

TEST_F(RobotFiles, FoldersInsideFoldersAreReadOnRequest) {
  for (const char* name : {"a", "a/b", "a/empty", "c"}) fs::create_directory(folder_ / name);
  for (const char* name : {"z.json", "a/2.json", "a/b/1.cbor", "c/0.json"}) write(name, "");
  fs::create_directory_symlink(folder_, folder_ / "c" / "circle");
  const std::vector<fs::path> all{folder_};
  EXPECT_THAT(robot_files(all), testing::ElementsAre(folder_ / "z.json"));
  EXPECT_THAT(robot_files(all, true), testing::ElementsAre(folder_ / "z.json", folder_ / "a/2.json",
                                                           folder_ / "a/b/1.cbor", folder_ / "c/0.json"));
  const auto refusal = message_of([&] { robot_files(std::vector{folder_ / "a" / "empty"}, true); });
  EXPECT_EQ(refusal, "a/empty: the folder and those in it hold no robot, neither *.json nor *.cbor");
}

TEST_F(RobotFiles, SeveralDocumentsAreToldApart) {
  std::vector<Robot> robots;
  for (const char* name : {"one", "two \" } ] {", "three"}) robots.push_back({.name = name, .masses = {{0, 0, 0}}});
  const auto all_of = [](const std::string& text) {
    std::vector<Robot> found;
    RobotDocuments documents(text);
    while (const std::optional<Robot> robot = documents.next()) found.push_back(*robot);
    return found;
  };
  std::string lines, joined = "\n ", cbor;
  for (const Robot& robot : robots) {
    std::string document = serialize_robot(robot, RobotFormat::json);
    joined += document.substr(0, document.size() - 1);  // no line between them
    std::erase(document, '\n');
    lines += document + "\r\n";
    cbor += serialize_robot(robot, RobotFormat::cbor);
  }
  EXPECT_EQ(all_of(lines), robots);
  EXPECT_EQ(all_of(joined), robots);
  EXPECT_EQ(all_of(cbor), robots);
  EXPECT_EQ(all_of("\xef\xbb\xbf" + lines), robots);  // a byte order mark
  EXPECT_THAT(all_of(""), testing::IsEmpty());
  EXPECT_THAT(all_of(" \n\n"), testing::IsEmpty());
}

TEST_F(RobotFiles, DocumentsBehindABadOneAreRead) {
  const Robot robot{.name = "good", .masses = {{0, 0, 0}}};
  const Robot bad{.name = "bad", .masses = {{0, 0, 0}, {1, 0, 0}}, .springs = {{0, 1, 1, 1}}};
  for (const RobotFormat format : {RobotFormat::json, RobotFormat::cbor}) {
    const std::string good = serialize_robot(robot, format);
    std::string broken = serialize_robot(bad, format);
    broken.replace(broken.find("springs"), 7, "sprongs");  // a part is missing
    const std::string text = good + broken + good + good.substr(0, good.size() / 2);
    RobotDocuments documents(text);
    EXPECT_EQ(documents.next(), robot);
    EXPECT_THAT(message_of([&] { documents.next(); }), testing::StartsWith("document 2: "));
    EXPECT_EQ(documents.next(), robot);
    EXPECT_THAT(message_of([&] { documents.next(); }), testing::StartsWith("document 4: "));
    EXPECT_EQ(documents.next(), std::nullopt);
  }
  RobotDocuments nonsense("]]] {}");
  EXPECT_THAT(message_of([&] { nonsense.next(); }), testing::StartsWith("document 1: "));
}

TEST_F(RobotFiles, WhatCannotBeReadIsNamed) {
  const auto load = [&](const char* name) { return message_of([&] { load_robots(std::vector{folder_ / name}); }); };
  fs::create_directory(folder_ / "empty");
  EXPECT_EQ(load("empty"), "empty: the folder holds no robot, neither *.json nor *.cbor");
  EXPECT_EQ(load("missing.json"), "missing.json: No such file or directory");
  EXPECT_EQ(load("missing"), "missing: No such file or directory");
  write("eel.txt", "");
  write("eel", "");
  EXPECT_EQ(load("eel.txt"), "eel.txt: extension .txt is not a robot's; give .json or .cbor");
  EXPECT_EQ(load("eel"), "eel: a robot file needs an extension; give .json or .cbor");
  ASSERT_EQ(::mkfifo((folder_ / "pipe.json").c_str(), 0600), 0);
  EXPECT_EQ(load("pipe.json"), "pipe.json: not a regular file");
}

TEST_F(RobotFiles, FilesAreWrittenWholeOrNotAtAll) {
  const Robot robot = random_voxel_robot({}, 1);
  save_robot(folder_ / "a.json", robot);
  const std::string before = read_whole_file(folder_ / "a.json");

  std::string message;
  {
    const SizeLimit limited(1000);
    message = message_of([&] { save_robot(folder_ / "a.json", random_voxel_robot({}, 2)); });
  }

  EXPECT_EQ(message, "a.json: the file grew beyond the size allowed here (ulimit -f)");
  EXPECT_EQ(read_whole_file(folder_ / "a.json"), before);
  EXPECT_THAT(listing(), testing::ElementsAre("a.json"));
  EXPECT_EQ(message_of([&] { save_robot(folder_ / "no" / "b.json", robot); }), "no/b.json: No such file or directory");
  fs::create_directory(folder_ / "c.json");
  write("c.json/x", "");
  EXPECT_EQ(message_of([&] { save_robot(folder_ / "c.json", robot); }), "c.json: Is a directory");
  EXPECT_THAT(listing(), testing::ElementsAre("a.json", "c.json"));
}

TEST_F(RobotFiles, ALinkIsFollowed) {
  fs::create_directory(folder_ / "real");
  fs::create_symlink("real/eel.json", folder_ / "link.json");
  const Robot robot{.name = "eel", .masses = {{0, 0, 0}}};
  save_robot(folder_ / "link.json", robot);
  save_robot(folder_ / "link.json", robot);
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.json"));
  EXPECT_EQ(load_robot(folder_ / "real" / "eel.json"), robot);
}

TEST_F(RobotFiles, APipeTakesWhatIsWrittenAndStaysAPipe) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  auto reading = std::async(std::launch::async, [&] {
    std::ifstream file(pipe);
    return std::string(std::istreambuf_iterator<char>(file), {});
  });
  write_whole_file(pipe, "some text");
  EXPECT_EQ(reading.get(), "some text");
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_THAT(listing(), testing::ElementsAre("pipe"));
}

TEST_F(RobotFiles, WhatCannotBeSavedLeavesNoFile) {
  Robot robot{.name = "a", .masses = {{0, 0, 0}}};
  const auto save = [&](const char* name) { return message_of([&] { save_robot(folder_ / name, robot); }); };
  EXPECT_EQ(save("a.obj"), "a.obj: extension .obj is not a robot's; give .json or .cbor");
  robot.origin = "{\"kind\": ";
  EXPECT_EQ(save("a.json"), "a.json: /origin: line 1, column 9: not valid JSON: unexpected end of input");
  robot.origin = "[1]";
  EXPECT_EQ(save("a.cbor"), "a.cbor: /origin: must be an object");
  robot.origin = "{\"a\":" + std::string(63, '[') + std::string(63, ']') + "}";
  EXPECT_EQ(save("a.cbor"), "a.cbor: /origin: nested deeper than 63 levels");
  robot.origin = "{\"a\":" + std::string(61, '[') + std::string(61, ']') + "}";
  EXPECT_EQ(save("deep.cbor"), "");
  EXPECT_EQ(load_robot(folder_ / "deep.cbor"), robot);
  fs::remove(folder_ / "deep.cbor");
  robot.origin.clear();
  robot.name = "\xff";
  EXPECT_EQ(save("a.json"), "a.json: a text is not valid UTF-8");
  EXPECT_EQ(save("a.cbor"), "a.cbor: a text is not valid UTF-8");
  robot = {.springs = {{0, 1, 1, 1}}};
  EXPECT_EQ(save("a.json"), "a.json: /masses: a robot needs at least one mass");
  EXPECT_TRUE(listing().empty());
}

}  // namespace
}  // namespace mercury
