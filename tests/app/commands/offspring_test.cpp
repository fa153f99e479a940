// SPDX-License-Identifier: Apache-2.0
// mercury mutate, cross and grow.
#include <gmock/gmock.h>

#include <set>

#include "mercury/generator.h"
#include "mercury/inspect.h"
#include "mercury/muscle_laws.h"
#include "mercury/origin.h"
#include "mercury/random.h"
#include "mercury/random_voxel.h"
#include "mercury/robot_file.h"
#include "mercury/samples.h"
#include "mercury/shell.h"
#include "mercury/voxel.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::HasSubstr;

class Offspring : public FolderTest {
 protected:
  Offspring() {
    save_robot(path("a.json"), a_);
    save_robot(path("b.json"), b_);
  }
  std::vector<Robot> robots_in(const std::string& folder) const {
    const std::filesystem::path whole = path(folder);
    return load_robots(std::span(&whole, 1));
  }
  std::set<std::uint64_t> bodies_in(const std::string& folder) const {
    std::set<std::uint64_t> bodies;
    for (const Robot& robot : robots_in(folder)) bodies.insert(body_hash(robot));
    return bodies;
  }
  std::string refusal(const std::vector<std::string>& arguments) const {
    const Outcome outcome = mercury(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.messages;
    return outcome.messages;
  }

  Robot a_ = random_voxel_robot({}, 1), b_ = random_voxel_robot({}, 2);  // voxel-1-0, voxel-2-0
};

using MutateCommand = Offspring;
using CrossCommand = Offspring;
using GrowCommand = Offspring;

TEST_F(MutateCommand, WritesTheChildrenOfASeed) {
  const Outcome outcome =
      succeeded(mercury({"mutate", path("a.json"), "-o", path("c"), "--count", "3", "--seed", "7"}));
  EXPECT_EQ(listing("c"), (std::vector<std::string>{"voxel-1-0-m0.json", "voxel-1-0-m1.json", "voxel-1-0-m2.json"}));
  EXPECT_THAT(outcome.output, HasSubstr(path("c/voxel-1-0-m2.json") + "\n"));
  EXPECT_EQ(load_robot(path("c/voxel-1-0-m2.json")), mutate_robot(a_, {.seed = seed_of(7, 2)}, "voxel-1-0-m2"));
  EXPECT_EQ(ancestry_of(load_robot(path("c/voxel-1-0-m1.json")))->parents, std::vector{a_.name});
}

TEST_F(MutateCommand, ChildrenDifferFromEachOtherAndFromTheirParent) {
  // One voxel of one muscle: a mutant is one voxel of another material, of which there are 21.
  save_robot(path("small.json"), make_voxel_robot(VoxelGrid(1, 1, 1, 5), {.name = "small"}));
  succeeded(mercury({"mutate", path("small.json"), "-o", path("c"), "--count", "19"}));
  const std::set<std::uint64_t> bodies = bodies_in("c");
  EXPECT_EQ(bodies.size(), 19u);
  EXPECT_FALSE(bodies.contains(body_hash(load_robot(path("small.json")))));
}

TEST_F(MutateCommand, LeavesOutChildrenForWhichThereIsNoBody) {
  save_robot(path("small.json"), make_voxel_robot(VoxelGrid(1, 1, 1, 5), {.name = "small"}));
  const Outcome outcome = mercury({"mutate", path("small.json"), "-o", path("c"), "--count", "25"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_LE(bodies_in("c").size(), 21u);
  EXPECT_EQ(bodies_in("c").size(), listing("c").size());
  EXPECT_THAT(outcome.messages, HasSubstr("was left out: the bodies of 30 draws are there already\n"));
}

TEST_F(MutateCommand, ChangesMusclesAlone) {
  succeeded(mercury({"mutate", path("a.json"), "-o", path("late.json"), "--strength", "0", "--muscles", "2"}));
  const Robot late = load_robot(path("late.json"));
  EXPECT_EQ(late.name, "late");
  EXPECT_EQ(late.springs, a_.springs);
  EXPECT_NE(base_materials_of(late), base_materials_of(a_));
}

TEST_F(MutateCommand, TakesFoldersAndNames) {
  const Outcome outcome =
      mercury({"mutate", path("a.json"), path("b.json"), "-o", path("c/"), "--count", "2", "--name", "g1"});
  ASSERT_EQ(outcome.status, 0) << outcome.messages;
  EXPECT_EQ(listing("c"), (std::vector<std::string>{"g1-0.json", "g1-1.json", "g1-2.json", "g1-3.json"}));
  EXPECT_EQ(ancestry_of(load_robot(path("c/g1-2.json")))->parents, std::vector{b_.name});
  succeeded(mercury({"mutate", path("c"), "-o", path("d/"), "--format", "cbor"}));
  EXPECT_EQ(listing("d").size(), 4u);
  EXPECT_EQ(listing("d")[0], "g1-0-m0.cbor");
}

TEST_F(MutateCommand, MusclesOfRobotsThatNoGeneratorMadeChange) {
  succeeded(mercury({"mutate", "sample:dog", "-o", path("dogs"), "--count", "3", "--seed", "7", "--muscles", "2"}));
  const Robot dog = load_robot(sample_or_path("sample:dog"));
  ASSERT_EQ(listing("dogs").size(), 3u);
  for (std::uint64_t i = 0; i < 3; ++i) {
    const std::string name = "dog-m" + std::to_string(i);
    const Robot child = load_robot(path("dogs/" + name + ".json"));
    EXPECT_EQ(child, mutate_robot(dog, {.seed = seed_of(7, i), .muscles = 2}, name));
    EXPECT_EQ(child.masses, dog.masses);
    EXPECT_NE(child.materials, dog.materials);
    EXPECT_EQ(ancestry_of(child)->parents, std::vector{dog.name});
  }
}

TEST_F(MutateCommand, InvalidInputIsReported) {
  Robot unknown = a_;
  unknown.name = "made-by-hand";
  unknown.origin.clear();
  save_robot(path("unknown.json"), unknown);
  Robot broken = a_;
  broken.origin = R"({"kind":"voxel","size":[1,1,1],"edge":0.1,"cells":[77]})";
  save_robot(path("broken.json"), broken);
  EXPECT_EQ(refusal({"mutate", path("unknown.json"), "-o", path("c/")}),
            "mercury: made-by-hand: cannot be mutated; only " + generator_kinds() +
                " robots know how they were made, but --muscles 1 changes its muscles\n");
  EXPECT_EQ(refusal({"mutate", path("broken.json"), "-o", path("c/")}),
            "mercury: voxel-1-0: /origin: cells must be 0 (air) or base materials (1 to 22)\n");
  EXPECT_EQ(refusal({"mutate", path("a.json"), "-o", path("c/"), "--strength", "-1"}),
            "mercury: --strength: -1 is not accepted; give 0 or more\n");
  EXPECT_EQ(refusal({"mutate", path("a.json"), "-o", path("c/"), "--strength", "0"}),
            "mercury: --strength, --muscles: both are 0, which changes nothing; give one of them above 0\n");
  EXPECT_EQ(refusal({"mutate", path("a.json"), path("b.json"), "-o", path("c.json")}),
            "mercury: -o: " + path("c.json") + " is one file; give a folder for several robots\n");
  EXPECT_EQ(refusal({"mutate", "-o", path("c/")}), "mercury: no robots given; name files or folders\n");
  EXPECT_EQ(refusal({"mutate", path("a.json"), "-o", path("c/"), "--count", "0"}),
            "mercury: --count: 0 is not accepted; give 1 to 1000000\n");
  EXPECT_EQ(listing(), (std::vector<std::string>{"a.json", "b.json", "broken.json", "unknown.json"}));
}

TEST_F(CrossCommand, WritesTheChildrenOfTwo) {
  const Outcome outcome =
      mercury({"cross", path("a.json"), path("b.json"), "-o", path("c"), "--count", "4", "--seed", "7"});
  ASSERT_EQ(outcome.status, 0) << outcome.messages;
  EXPECT_EQ(load_robot(path("c/voxel-1-0-x0.json")), cross_robots(a_, b_, seed_of(7, 0), "voxel-1-0-x0"));
  std::set<std::uint64_t> bodies = bodies_in("c");
  EXPECT_EQ(bodies.size(), 4u);
  EXPECT_FALSE(bodies.contains(body_hash(a_)));
  EXPECT_FALSE(bodies.contains(body_hash(b_)));
}

TEST_F(CrossCommand, InvalidInputIsReported) {
  save_robot(path("shell.json"), random_shell_robot({}, 1));
  EXPECT_EQ(refusal({"cross", path("a.json"), "-o", path("c/")}),
            "mercury: ROBOTS: 1 robots are not accepted; give the files of two\n");
  EXPECT_EQ(refusal({"cross", path("a.json"), path("shell.json"), "-o", path("c/")}),
            "mercury: voxel-1-0 and shell-1-0: cannot be crossed, a voxel robot and a shell robot; give two robots of "
            "one kind\n");
  EXPECT_FALSE(std::filesystem::exists(path("c")));
}

TEST_F(GrowCommand, AnOriginThatNobodyEditedGivesTheSameRobot) {
  succeeded(mercury({"grow", path("a.json"), path("b.json"), "-o", path("c/")}));
  EXPECT_EQ(load_robot(path("c/voxel-1-0.json")), a_);
  EXPECT_EQ(load_robot(path("c/voxel-2-0.json")), b_);
}

TEST_F(GrowCommand, AnEditedOriginGivesAnotherBody) {
  auto document = nlohmann::json::parse(read("a.json"));
  document["origin"] = {{"kind", "voxel"}, {"size", {2, 1, 1}}, {"edge", 0.2}, {"cells", {3, 22}}, {"note", "mine"}};
  write("a.json", document.dump());
  succeeded(mercury({"grow", path("a.json"), "-o", path("a.json"), "--force"}));
  const Robot grown = load_robot(path("a.json"));
  EXPECT_EQ(grown.masses.size(), 12u);
  EXPECT_EQ(grown.name, "voxel-1-0");
  EXPECT_THAT(grown.origin, HasSubstr(R"("note":"mine")"));
}

TEST_F(GrowCommand, InvalidInputIsReported) {
  auto document = nlohmann::json::parse(read("a.json"));
  document["origin"]["edge"] = "wide";
  write("a.json", document.dump());
  EXPECT_EQ(refusal({"grow", path("a.json"), "-o", path("c.json")}),
            "mercury: voxel-1-0: /origin: edge must be a number of meters\n");
  EXPECT_EQ(refusal({"grow", path("b.json"), "-o", path("b.json")}),
            "mercury: -o: " + path("b.json") + " exists already; use --force to replace it, or give another name\n");
  EXPECT_THAT(refusal({"grow", path("b.json"), "-o", path("c.json"), "--seed", "3"}),
              HasSubstr("--seed: not an option of mercury grow"));
}

}  // namespace
}  // namespace mercury::test
