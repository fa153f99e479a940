// SPDX-License-Identifier: Apache-2.0
// What holds for every generator of the registry, whatever robots it makes.
#include "mercury/generator.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "mercury/configuration.h"
#include "mercury/error.h"
#include "mercury/muscle_laws.h"
#include "mercury/origin.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

// Without CGAL, network robots cannot be grown.
std::vector<Generator> working_generators() {
  std::vector<Generator> working = generators();
  if (!MERCURY_NN) std::erase_if(working, [](const Generator& generator) { return generator.kind == "nn"; });
  return working;
}

class EveryGenerator : public testing::TestWithParam<Generator> {};

// A robot from fewer masses than usual, so that the tests are fast.
ParameterValues small(const Generator& generator) {
  if (generator.kind == "nn") return {{"points", std::int64_t{100}}};
  return {};
}

Robot made(const Generator& generator, std::uint64_t seed, std::uint64_t index = 0) {
  return generator.make(small(generator), "land", seed, index);
}

TEST_P(EveryGenerator, MakesValidRobotsThatNameTheirKindAndEnvironment) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Robot robot = made(GetParam(), seed, 2);
    EXPECT_NO_THROW(validate(robot));
    EXPECT_EQ(robot.name, GetParam().kind + "-" + std::to_string(seed) + "-2");
    EXPECT_EQ(kind_of(robot), GetParam().kind);
    EXPECT_EQ(environment_of(robot), "land");
    EXPECT_EQ(generator_of(robot)->kind, GetParam().kind);
  }
  EXPECT_EQ(environment_of(GetParam().make(small(GetParam()), "", 1, 0)), GetParam().environment);
  if (!GetParam().environment.empty()) {
    EXPECT_NO_THROW(environment_named(GetParam().environment));
  }
}

TEST_P(EveryGenerator, MakesTheSameRobotFromTheSameSeedAndAnotherFromAnother) {
  EXPECT_EQ(made(GetParam(), 7, 3), made(GetParam(), 7, 3));
  EXPECT_NE(made(GetParam(), 7, 3).masses, made(GetParam(), 7, 4).masses);
  EXPECT_NE(made(GetParam(), 7, 3).masses, made(GetParam(), 8, 3).masses);
}

TEST_P(EveryGenerator, MakesTheSameRobotsWhateverTheirNumber) {
  RandomRobots request{.kind = GetParam().kind, .count = 4, .seed = 3, .first = 2, .values = small(GetParam())};
  const std::vector<Robot> robots = make_random_robots(request);
  ASSERT_THAT(robots, SizeIs(4));
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(robots[i], GetParam().make(request.values, "", 3, 2 + i)) << robots[i].name;
}

TEST_P(EveryGenerator, RegrowsARobotFromItsOrigin) {
  const Robot robot = made(GetParam(), 4, 1);
  Robot origin_alone{.name = robot.name};
  origin_alone.origin = robot.origin;
  EXPECT_EQ(GetParam().regrow(origin_alone), robot);
  EXPECT_THAT(refusal([] { GetParam().regrow({.name = "empty"}); }), HasSubstr("/origin"));
}

TEST_P(EveryGenerator, MutatesARobotIntoAnotherOfItsKind) {
  const Robot parent = made(GetParam(), 4, 1);
  const Robot child = GetParam().mutate(parent, {.strength = 5, .seed = 9}, "child");
  EXPECT_EQ(child.name, "child");
  EXPECT_NO_THROW(validate(child));
  EXPECT_EQ(kind_of(child), GetParam().kind);
  EXPECT_EQ(environment_of(child), "land");
  EXPECT_NE(child.springs, parent.springs);
  EXPECT_EQ(child, GetParam().mutate(parent, {.strength = 5, .seed = 9}, "child"));
  EXPECT_EQ(child, mutate_robot(parent, {.strength = 5, .seed = 9}, "child"));
}

TEST_P(EveryGenerator, MutantsDifferFromTheirParent) {
  const Robot parent = made(GetParam(), 4, 1);
  for (const double strength : {0.01, 1.})
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Robot child = GetParam().mutate(parent, {.strength = strength, .seed = seed}, parent.name);
      EXPECT_TRUE(child.masses != parent.masses || child.springs != parent.springs) << strength << ' ' << seed;
    }
}

TEST_P(EveryGenerator, MutatesMusclesAlone) {
  const Robot parent = made(GetParam(), 4, 1);
  const MutationRequest request{.strength = 0, .seed = 9, .muscles = 2};
  const Robot child = GetParam().mutate(parent, request, "child");
  EXPECT_NO_THROW(validate(child));
  EXPECT_EQ(child.masses, parent.masses);
  EXPECT_EQ(child.faces, parent.faces);
  EXPECT_FALSE(std::ranges::equal(materials_of(child), materials_of(parent)));
  EXPECT_EQ(child, GetParam().mutate(parent, request, "child"));
  EXPECT_EQ(GetParam().regrow(child), child);
  // Changed muscles are inherited.
  if (!has_base_materials(child)) return;  // a shell's follow from its numbers
  EXPECT_EQ(GetParam().mutate(child, {.seed = 3}, "grandchild").materials, child.materials);
}

TEST_P(EveryGenerator, RefusesMutationsThatAreNone) {
  const Robot parent = made(GetParam(), 4, 1);
  EXPECT_EQ(refusal([&] { mutate_robot(parent, {.strength = -1}, "child"); }),
            "strength: -1 is not accepted; give 0 or more");
  EXPECT_EQ(refusal([&] { mutate_robot(parent, {.muscles = std::nan("")}, "child"); }),
            "muscles: nan is not accepted; give 0 or more");
}

TEST_P(EveryGenerator, CrossesTwoRobotsIntoAnotherOfTheirKind) {
  const Robot a = made(GetParam(), 4, 1), b = made(GetParam(), 5, 1);
  const Robot child = GetParam().cross(a, b, 9, "child");
  EXPECT_EQ(child.name, "child");
  EXPECT_NO_THROW(validate(child));
  EXPECT_EQ(kind_of(child), GetParam().kind);
  EXPECT_EQ(environment_of(child), "land");
  EXPECT_NE(child.springs, a.springs);
  EXPECT_NE(child.springs, b.springs);
  EXPECT_EQ(child, cross_robots(a, b, 9, "child"));
  EXPECT_EQ(GetParam().regrow(child), child);
}

TEST_P(EveryGenerator, CrossesARobotWithItselfIntoTheSameBody) {
  const Robot a = made(GetParam(), 4, 1), child = cross_robots(a, a, 9, "child");
  EXPECT_EQ(child.masses, a.masses);
  EXPECT_EQ(child.springs, a.springs);
  EXPECT_TRUE(std::ranges::equal(materials_of(child), materials_of(a)));
}

TEST_P(EveryGenerator, ChildrenNameTheirParents) {
  const Robot a = made(GetParam(), 4, 1), b = made(GetParam(), 5, 1);
  EXPECT_EQ(ancestry_of(a), std::nullopt);
  const Robot mutant = mutate_robot(a, {.strength = 2, .seed = 9, .muscles = 0.5}, "mutant");
  EXPECT_EQ(ancestry_of(mutant), (Ancestry{.parents = {a.name}, .mutation_seed = 9, .strength = 2, .muscles = 0.5}));
  EXPECT_EQ(ancestry_of(cross_robots(a, b, 8, "child")), (Ancestry{.parents = {a.name, b.name}, .crossover_seed = 8}));
  EXPECT_EQ(ancestry_of(mutate_robot(mutant, {.seed = 3}, "grandchild"))->parents, std::vector{mutant.name});
}

TEST_P(EveryGenerator, RegrowingKeepsTheWholeOrigin) {
  Robot robot = mutate_robot(made(GetParam(), 4, 1), {}, "mutant");
  robot.origin.insert(1, R"("note": "mine" ,)");
  EXPECT_EQ(GetParam().regrow(robot), robot);
}

TEST_P(EveryGenerator, KeepsActuatorsWhereTheTableOfMaterialsIsTheSame) {
  Robot parent = made(GetParam(), 4, 1);
  parent.actuators = actuators_of(parent);
  ASSERT_THAT(parent.actuators, Not(IsEmpty()));
  parent.actuators.front().name = "mine";
  EXPECT_EQ(GetParam().regrow(parent), parent);
  for (const Robot& child : {mutate_robot(parent, {.strength = 2, .seed = 9, .muscles = 1}, "mutant"),
                             cross_robots(parent, made(GetParam(), 5, 1), 9, "child")}) {
    const bool same =
        materials_of(child).size() == materials_of(parent).size() && child.material_names == parent.material_names;
    EXPECT_EQ(child.actuators, same ? parent.actuators : std::vector<Actuator>());
    EXPECT_TRUE(same || GetParam().kind == "shell" || GetParam().kind == "cppn") << "the table is the parent's";
    EXPECT_NO_THROW(validate(child));
  }
}

TEST(Generators, DropActuatorsWhoseMaterialsAreNotGrown) {
  Robot robot = made(generator_named("shell"), 4);
  ASSERT_GT(robot.springs.size(), 2u);
  const Robot before = robot;
  const auto of_one_material = static_cast<std::uint32_t>(
      std::ranges::find_if(robot.springs, [&](const Spring& s) { return s.material == robot.springs[0].material; }) -
      robot.springs.begin());
  add_actuator(robot, "one spring", std::vector{of_one_material});
  ASSERT_GT(robot.materials.size(), before.materials.size());
  EXPECT_EQ(generator_named("shell").regrow(robot), before);
}

TEST_P(EveryGenerator, AcceptsItsDefaultsAndRefusesWhatIsOutOfRange) {
  EXPECT_NO_THROW(GetParam().validate({}));
  for (const GeneratorParameter& parameter : GetParam().parameters) {
    EXPECT_NO_THROW(check(parameter, parameter.initial)) << parameter.name;
    const auto refuses = [&](const ParameterValue& value) {
      const std::string message = refusal([&] { GetParam().validate({{parameter.name, value}}); });
      EXPECT_THAT(message, testing::StartsWith(parameter.name + ": "));
      EXPECT_THAT(message, HasSubstr("give " + accepted_values(parameter)));
    };
    if (std::holds_alternative<std::int64_t>(parameter.initial)) refuses(std::int64_t(parameter.accepts.lowest) - 1);
    if (std::holds_alternative<double>(parameter.initial)) refuses(parameter.accepts.lowest - 1);
    if (std::holds_alternative<double>(parameter.initial)) refuses(std::nan(""));
    if (std::holds_alternative<double>(parameter.initial)) refuses(HUGE_VAL);
    if (std::holds_alternative<float>(parameter.initial)) refuses(static_cast<float>(parameter.accepts.lowest) - 1);
    if (std::holds_alternative<std::string>(parameter.initial)) refuses("tartan");
    if (std::holds_alternative<SizeRange>(parameter.initial)) refuses(SizeRange{});
    // A value of another kind.
    refuses(std::holds_alternative<std::string>(parameter.initial) ? ParameterValue(1.0) : ParameterValue("one"));
  }
}

TEST_P(EveryGenerator, IsDescribedInFull) {
  const Generator& generator = GetParam();
  EXPECT_THAT((std::vector{generator.title, generator.noun, generator.help, generator.example.name}),
              testing::Each(testing::Not(IsEmpty())));
  for (const GeneratorParameter& parameter : generator.parameters) {
    EXPECT_EQ(parameter.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string::npos) << parameter.name;
    EXPECT_THAT(parameter.help, testing::Not(IsEmpty()));
    EXPECT_FALSE(parameter.help.ends_with('.'));
    // A window's slider needs an end.
    EXPECT_TRUE(std::holds_alternative<std::string>(parameter.initial) || std::isfinite(parameter.accepts.highest) ||
                parameter.usual_highest)
        << parameter.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryGenerator, testing::ValuesIn(working_generators()),
                         [](const auto& parameter) { return parameter.param.kind; });

TEST(Generators, HaveNamesOfTheirOwnForThemselvesAndTheirParameters) {
  std::set<std::string> kinds, parameters;
  for (const Generator& generator : generators()) {
    EXPECT_TRUE(kinds.insert(generator.kind).second) << generator.kind;
    for (const GeneratorParameter& parameter : generator.parameters)
      EXPECT_TRUE(parameter.shared || parameters.insert(parameter.name).second) << parameter.name;
    EXPECT_EQ(std::ranges::count(generator.parameters, true, &GeneratorParameter::shared), 4) << generator.kind;
  }
  EXPECT_EQ(find_generator("fish"), nullptr);
  EXPECT_EQ(generator_of({.name = "eel"}), nullptr);
  EXPECT_EQ(refusal([] { generator_named("fish"); }),
            "kind: \"fish\" is not a kind of robot; give " + generator_kinds());
  EXPECT_THAT(generator_kinds(":N"), HasSubstr(":N or "));
  EXPECT_THAT(refusal([] { mutate_robot({.name = "eel"}, {}, "child"); }), HasSubstr("eel: cannot be mutated"));
  EXPECT_EQ(
      refusal([] {
        mutate_robot({.name = "rod", .masses = {{}, {1, 0, 0}}, .springs = {{0, 1, tissue, 1}}}, {.muscles = 1}, "c");
      }),
      "rod: cannot be mutated; it has no muscles");
  const Robot voxel = made(generator_named("voxel"), 1), shell = made(generator_named("shell"), 1);
  EXPECT_THAT(refusal([&] { cross_robots(voxel, {.name = "eel"}, 1, "child"); }), HasSubstr("eel: cannot be crossed"));
  EXPECT_EQ(refusal([&] { cross_robots(voxel, shell, 1, "child"); }),
            "voxel-1-0 and shell-1-0: cannot be crossed, a voxel robot and a shell robot; give two robots of one kind");
}

TEST(Generators, LeaveOutRobotsThatCannotBeMadeWhereTheCallerAsksForThem) {
  if (!MERCURY_NN) GTEST_SKIP() << "this build grows no network robots";
  const RandomRobots request{.kind = "nn", .count = 2, .values = {{"points", std::int64_t{64}}, {"alpha", 1e-6f}}};
  std::vector<FailedRobot> failed;
  EXPECT_THAT(make_random_robots(request, &failed), IsEmpty());
  ASSERT_THAT(failed, SizeIs(2));
  EXPECT_EQ(failed[1].index, 1u);
  EXPECT_THAT(refusal([&] { make_random_robots(request); }), testing::StartsWith("nn-1-0: alpha: "));
}

}  // namespace
}  // namespace mercury
