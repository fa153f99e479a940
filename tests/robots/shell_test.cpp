// SPDX-License-Identifier: Apache-2.0
// Shells by what their form promises: topology, thickness, symmetry, shares.
#include "mercury/shell.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "mercury/fnv.h"
#include "mercury/inspect.h"
#include "mercury/random.h"
#include "robots/portable_math.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

using testing::StartsWith;

ShellOptions of_form(ShellOptions::Form form) { return {.form = form}; }

class EveryForm : public testing::TestWithParam<ShellForm> {
 protected:
  static Robot shell(std::uint64_t index) {
    return random_shell_robot(of_form(static_cast<ShellOptions::Form>(static_cast<int>(GetParam()) + 1)), 1, index);
  }
  static bool is_hollow() { return GetParam() == ShellForm::ring || GetParam() == ShellForm::pod; }
};

TEST_P(EveryForm, HasAClosedSkinThatFacesOutwardsWithTheTopologyOfTheForm) {
  for (std::uint64_t index = 0; index < 20; ++index) {
    const Robot robot = shell(index);
    const Inspection found = inspect(robot);
    ASSERT_NO_THROW(validate(robot));
    EXPECT_TRUE(found.closed) << robot.name;
    EXPECT_EQ(found.open_edges, 0u);
    EXPECT_EQ(found.crowded_edges, 0u);
    EXPECT_GT(found.volume, 0);
    EXPECT_EQ(found.components, 1u);
    // A cup is a deformed ball; a wall around a hole, or a hollow ring, a torus.
    const bool sphere = GetParam() == ShellForm::bell || GetParam() == ShellForm::pod;
    EXPECT_EQ(found.euler_characteristic, sphere ? 2 : 0) << robot.name;
    EXPECT_GT(found.shortest_spring, 0.01f);
  }
}

TEST_P(EveryForm, HasItsLayersThePromisedThicknessApart) {
  const Robot robot = shell(3);
  ASSERT_EQ(robot.masses.size() % 2, 0u);
  for (std::size_t i = 0; i < robot.masses.size(); i += 2)
    EXPECT_NEAR(length(robot.masses[i] - robot.masses[i + 1]), 0.1, 1e-6);
}

TEST_P(EveryForm, EnclosesTheVolumeOfItsWall) {
  const Robot robot = shell(5);
  const Inspection found = inspect(robot);
  // A wall that bends little encloses half its skin (both sides) times its thickness; its rim adds to the skin.
  if (is_hollow())
    EXPECT_GT(found.volume, 0.5 * found.area * 0.1);
  else
    EXPECT_NEAR(found.volume, 0.5 * found.area * 0.1, 0.15 * found.volume);
}

TEST_P(EveryForm, IsAsWideAsAskedForWithoutLobes) {
  ShellGenome genome{.form = GetParam(), .segments = 40, .diameter = 3};
  const Inspection found = inspect(grow(genome));
  EXPECT_NEAR(found.extent.x, 3 + genome.thickness, 0.05);
  EXPECT_NEAR(found.extent.y, 3 + genome.thickness, 0.05);
}

TEST_P(EveryForm, LooksTheSameTurnedByALobe) {
  const Robot robot = grow({.form = GetParam(), .lobes = 5, .lobe_depth = 0.1, .lappets = 0.2, .twist = 0.2});
  const float angle = 2 * static_cast<float>(M_PI) / 5, c = std::cos(angle), s = std::sin(angle);
  for (std::size_t i = 0; i < robot.masses.size(); i += 7) {
    const Vec3 p = robot.masses[i], turned{c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    EXPECT_TRUE(std::ranges::any_of(robot.masses, [&](Vec3 mass) { return length(mass - turned) < 1e-5f; })) << i;
  }
}

TEST_P(EveryForm, HasTheAskedShareOfMuscles) {
  for (const double active : {0., 0.3, 1.}) {
    const Robot robot = grow({.form = GetParam(), .active = active});
    double muscles = 0, surface = 0;
    for (const Spring& spring : robot.springs) {
      // Springs within a layer join masses of the same parity.
      surface += spring.a % 2 == spring.b % 2;
      muscles += robot.materials[spring.material].amplitude != 0;
    }
    EXPECT_NEAR(muscles / surface, active, 2 / surface);
  }
}

TEST_P(EveryForm, HasEverySpringOnceAtItsLengthAtRest) {
  const Robot robot = shell(1);
  std::set<std::pair<int, int>> pairs;
  for (const Spring& spring : robot.springs) {
    EXPECT_TRUE(pairs.insert({std::min(spring.a, spring.b), std::max(spring.a, spring.b)}).second);
    EXPECT_EQ(spring.rest_length, length(robot.masses[spring.a] - robot.masses[spring.b]));
  }
}

INSTANTIATE_TEST_SUITE_P(Shells, EveryForm,
                         testing::Values(ShellForm::bell, ShellForm::tube, ShellForm::ring, ShellForm::pod));

TEST(Shells, HaveTheSameBitsOnEveryMachine) {
  // FNV-1a over the masses; sums, products, quotients and square roots alone lead to them.
  Fnv1a hash;
  for (std::uint64_t index = 0; index < 8; ++index)
    for (const Vec3 mass : random_shell_robot({}, 1, index).masses)
      for (const float coordinate : {mass.x, mass.y, mass.z}) hash.step(std::bit_cast<std::uint32_t>(coordinate));
  EXPECT_EQ(hash.value(), 7418501369885212733u);
}

TEST(Shells, WaveIsSineAndCosine) {
  // The angle in radians is itself rounded, by up to 4e-16 here.
  for (double turns = -1; turns < 1; turns += 0.00137) {
    EXPECT_NEAR(wave(turns).sine, std::sin(2 * M_PI * turns), 1e-15);
    EXPECT_NEAR(wave(turns).cosine, std::cos(2 * M_PI * turns), 1e-15);
  }
  EXPECT_EQ(wave(7.0625).sine, wave(-0.9375).sine);
  EXPECT_EQ(wave(0.25).sine, 1);
  EXPECT_EQ(wave(0.5).sine, 0);
}

TEST(Shells, NarrowAndWideOpeningsAreThat) {
  const auto mouth = [](double opening) {
    float lowest = INFINITY, radius = 0;
    for (const Vec3 mass : grow({.opening = opening}).masses)
      if (mass.z < lowest) lowest = mass.z, radius = std::hypot(mass.x, mass.y);
    return radius;
  };
  EXPECT_LT(mouth(0), 0.5f);
  EXPECT_GT(mouth(1), 0.65f);
}

TEST(Shells, RefuseWhatCannotBeBuilt) {
  EXPECT_EQ(refusal([] { random_shell_robot({.lobes = 2}, 1); }), "lobes: 2 is not accepted; give 3 to 16, or 0");
  EXPECT_EQ(refusal([] { random_shell_robot({.diameter = 0.3f}, 1); }),
            "thickness: more than a quarter of the diameter is not accepted; give less");
  EXPECT_THAT(refusal([] { grow(ShellGenome{.height = NAN}); }), StartsWith("height: nan is not accepted"));
  const auto read = [&](const std::string& origin) {
    Robot robot;
    robot.origin = origin;
    return refusal([&] { shell_genome_of(robot); });
  };
  EXPECT_EQ(read(R"({"kind":"voxel"})"), "");
  EXPECT_EQ(read(R"({"kind":"shell"})"), "/origin/form: is missing");
  EXPECT_EQ(read(R"({"kind":"shell","form":"cube"})"),
            "/origin/form: \"cube\" is not accepted; give bell, tube, ring or pod");
  EXPECT_EQ(read(R"({"kind":"shell","form":"bell","segments":"many"})"), "/origin/segments: give 12 to 128");
}

TEST(Shells, ManyAreSoundWithAnyOptions) {
  Random random(3);
  for (int i = 0; i < 60; ++i) {
    ShellOptions options;
    options.diameter = static_cast<float>(random.uniform(0.4, 5));
    options.thickness = options.diameter * static_cast<float>(random.uniform(0.03, 0.25));
    options.segments = 12 + static_cast<int>(random.below(40));
    options.opening = random.uniform();
    options.active = random.uniform();
    options.lobes = 3 + static_cast<int>(random.below(14));
    const Robot robot = random_shell_robot(options, 9, static_cast<std::uint64_t>(i));
    ASSERT_NO_THROW(validate(robot)) << i;
    ASSERT_TRUE(inspect(robot).closed) << i;
  }
}

TEST(ShellMutation, ChangesAtLeastOneNumber) {
  for (const double strength : {1e-30, 1e-3, 1.})
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      const ShellGenome parent = random_shell_genome({}, seed), child = mutate(parent, strength, seed);
      ASSERT_NE(child, parent);
      ASSERT_NO_THROW(validate(child));
      const ShellGenome pulsing = mutate_muscles(parent, strength, seed);
      ASSERT_NE(pulsing, parent);
      ASSERT_NO_THROW(validate(pulsing));
    }
  EXPECT_EQ(mutate(ShellGenome{}, 0, 1), ShellGenome{});
}

TEST(ShellMutation, OfMusclesKeepsTheForm) {
  const ShellGenome parent = random_shell_genome({}, 3), child = mutate_muscles(parent, 3, 1);
  ShellGenome with_its_muscles = parent;
  with_its_muscles.waves_around = child.waves_around;
  with_its_muscles.waves_along = child.waves_along;
  with_its_muscles.active = child.active;
  with_its_muscles.contraction = child.contraction;
  with_its_muscles.bending = child.bending;
  with_its_muscles.frequency = child.frequency;
  EXPECT_EQ(child, with_its_muscles);
}

TEST(ShellCrossover, TakesEachNumberFromAParentAndTheFormFromTheFirst) {
  const ShellGenome a = random_shell_genome({.segments = 20}, 1);
  const ShellGenome b = random_shell_genome({.diameter = 0.4f, .segments = 30}, 2);
  int heights_of_b = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const ShellGenome child = crossover(a, b, seed);
    ASSERT_NO_THROW(validate(child));  // thickness and diameter may come from different parents
    EXPECT_EQ(child.form, a.form);
    EXPECT_EQ(child.segments, a.segments);
    ASSERT_TRUE(child.height == a.height || child.height == b.height);
    ASSERT_TRUE(child.frequency == a.frequency || child.frequency == b.frequency);
    heights_of_b += child.height == b.height ? 1 : 0;
  }
  EXPECT_NEAR(heights_of_b, 200, 50);  // five standard deviations
}

}  // namespace
}  // namespace mercury
