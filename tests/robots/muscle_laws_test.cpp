// SPDX-License-Identifier: Apache-2.0
#include "mercury/muscle_laws.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mercury/random.h"
#include "mercury/random_voxel.h"
#include "robots/mutation_step.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

Robot default_robot() { return random_voxel_robot({}, 3); }

// A robot whose table says nothing of base materials and pairs.
Robot own_robot() {
  Robot robot{.name = "own", .masses = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  robot.materials = {{}, {50, 0.2f, 3, 1}, {40, 0, 0, 0}, {60, -0.1f, 5, 0}};
  robot.springs = {{0, 1, 1, 1}, {0, 2, 2, 1}};
  return robot;
}

std::vector<Material> own_bases() {
  const auto table = default_materials();
  return {table.begin() + 1, table.begin() + 1 + base_material_count};
}

TEST(BaseMaterials, AreTwentyTwoInTheDefaultTableAndInTablesMadeOfOthers) {
  EXPECT_EQ(base_materials_of(default_robot()), own_bases());
  std::vector<Material> bases = own_bases();
  bases[4].phase = 1.25f;
  const Robot robot = with_base_materials(default_robot(), bases);
  EXPECT_TRUE(has_base_materials(robot));
  EXPECT_EQ(base_materials_of(robot), bases);
  EXPECT_EQ(robot.materials, material_table(std::span(bases).first<base_material_count>()));
}

TEST(BaseMaterials, OfAnyOtherTableAreAllItsMaterials) {
  EXPECT_FALSE(has_base_materials(own_robot()));
  const std::vector<Material> bases = base_materials_of(own_robot());
  ASSERT_EQ(bases.size(), 3u);
  EXPECT_EQ(bases[2], own_robot().materials[3]);
  std::vector<Material> changed = bases;
  changed[0].frequency = 7;
  const Robot robot = with_base_materials(own_robot(), changed);
  EXPECT_EQ(robot.materials[0], Material{});
  EXPECT_EQ(base_materials_of(robot), changed);
}

TEST(BaseMaterials, ThatAreTheDefaultsNeedNoTable) {
  std::vector<Material> bases = own_bases();
  bases[0].amplitude = 0.2f;
  const Robot changed = with_base_materials(default_robot(), bases);
  EXPECT_FALSE(changed.materials.empty());
  EXPECT_EQ(with_base_materials(changed, own_bases()), default_robot());
}

TEST(BaseMaterials, AreInUseAloneAndInPairs) {
  Robot robot{.masses = {{0, 0, 0}, {1, 0, 0}}};
  robot.springs = {{0, 1, combine(3, 7), 1}, {0, 1, bone, 1}};
  const std::vector<bool> used = base_materials_in_use(robot);
  ASSERT_EQ(used.size(), std::size_t{base_material_count});
  for (std::size_t i = 0; i < used.size(); ++i) EXPECT_EQ(used[i], i == 2 || i == 6 || i == 21) << i;
  EXPECT_EQ(base_materials_in_use(own_robot()), (std::vector<bool>{true, true, false}));
}

TEST(BaseMaterials, OfAnotherNumberOrNotValidAreRefused) {
  EXPECT_EQ(refusal([] { with_base_materials(own_robot(), own_bases()); }),
            "robot own: needs 3 base materials, not 22");
  std::vector<Material> bases = own_bases();
  bases[1].amplitude = 1;
  EXPECT_EQ(refusal([&] { with_base_materials(default_robot(), bases); }),
            "base material 2: amplitude must lie between -1 and 1");
}

TEST(MuscleMutation, KeepsItsRangesWhateverItsStrength) {
  for (const double strength : {0.1, 1., 10., 1000.})
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const std::vector<Material> bases = own_bases(), materials = mutate_muscle_laws(bases, strength, seed);
      ASSERT_EQ(materials.size(), bases.size());
      for (std::size_t i = 0; i < materials.size(); ++i) {
        ASSERT_EQ(materials[i].stiffness, bases[i].stiffness);
        if (bases[i].amplitude == 0) {
          ASSERT_EQ(materials[i], bases[i]);
        }
        ASSERT_LE(std::abs(materials[i].amplitude), 0.4f);
        ASSERT_GE(materials[i].frequency, 0);
        ASSERT_LE(materials[i].frequency, 20);
        ASSERT_GE(materials[i].phase, 0);
        ASSERT_LT(materials[i].phase, 2 * std::numbers::pi);
      }
    }
}

TEST(MuscleMutation, DoesNotWeakenMusclesBeyondItsRanges) {
  const std::vector<Material> strong{{50, 0.9f, 35, 0}};
  bool stays_beyond = false;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Material material = mutate_muscle_laws(strong, 1, seed)[0];
    EXPECT_LE(material.amplitude, 0.9f);
    EXPECT_LE(material.frequency, 35);
    stays_beyond = stays_beyond || (material.amplitude > 0.5f && material.frequency > 25);
  }
  EXPECT_TRUE(stays_beyond);
}

TEST(MuscleMutation, MovesAsManyNumbersAsItSays) {
  // 20 muscles of 5 frequencies, 1,000 seeds: 20,000 amplitudes and phases, each moved with probability 1/4 (standard
  // deviation 0.003), of a size of 0.04 and 0.4 rad (1 %).
  double amplitudes = 0, phases = 0, amplitude_squares = 0, phase_squares = 0, together = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const std::vector<Material> bases = own_bases(), materials = mutate_muscle_laws(bases, 0.5, seed);
    for (std::size_t i = 0; i < muscle_count; ++i) {
      const double by_amplitude = materials[i].amplitude - bases[i].amplitude;
      const double by_phase = std::remainder(materials[i].phase - bases[i].phase, 2 * std::numbers::pi);
      amplitudes += by_amplitude != 0 ? 1 : 0;
      phases += by_phase != 0 ? 1 : 0;
      amplitude_squares += by_amplitude * by_amplitude;
      phase_squares += by_phase * by_phase;
      together += materials[i].frequency == materials[i / 4 * 4].frequency ? 1 : 0;
    }
  }
  EXPECT_NEAR(amplitudes / 20000, 0.25, 0.015);
  EXPECT_NEAR(phases / 20000, 0.25, 0.015);
  EXPECT_NEAR(std::sqrt(amplitude_squares / amplitudes), 0.5 * 0.04, 0.001);
  EXPECT_NEAR(std::sqrt(phase_squares / phases), 0.5 * 0.4, 0.01);
  // The first of four always; the others unless one of both moved by itself: 0.975^2.
  EXPECT_NEAR(together / 20000, (1 + 3 * 0.975 * 0.975) / 4, 0.01);
}

TEST(MuscleMutation, AlwaysChangesAMuscleInUse) {
  std::vector<bool> used(base_material_count, false);
  used[6] = used[20] = true;
  for (const double strength : {1e-30, 1.})
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
      const std::vector<Material> bases = own_bases();
      ASSERT_NE(mutate_muscle_laws(bases, strength, seed, used)[6], bases[6]) << seed;
    }
  EXPECT_EQ(mutate_muscle_laws(own_bases(), 0, 1), own_bases());
}

TEST(MuscleMutation, LeavesABodyWithoutMusclesAlone) {
  const std::vector<Material> passive{{50, 0, 0, 0}, {70, 0, 0, 0}};
  EXPECT_EQ(mutate_muscle_laws(passive, 5, 1), passive);
}

TEST(MuscleMutation, DependsOnItsArgumentsAlone) {
  const Robot robot = default_robot();
  const Robot child = with_mutated_muscles(robot, 1, 7);
  EXPECT_EQ(child, with_mutated_muscles(robot, 1, 7));
  EXPECT_NE(child, with_mutated_muscles(robot, 1, 8));
  EXPECT_EQ(child.springs, robot.springs);
  EXPECT_NO_THROW(validate(child));
}

TEST(MuscleMutation, OfAnOwnTableReplacesItsEntries) {
  const Robot child = with_mutated_muscles(own_robot(), 1, 7);
  EXPECT_NE(child.materials[1], own_robot().materials[1]);  // the only muscle in use
  EXPECT_EQ(child.materials[2], own_robot().materials[2]);
  EXPECT_EQ(child.springs, own_robot().springs);
}

TEST(MuscleMutation, RefusesStrengthsThatAreNone) {
  EXPECT_EQ(refusal([] { mutate_muscle_laws(own_bases(), -1, 1); }), "muscles: give a strength of 0 or more");
  EXPECT_EQ(refusal([] { mutate_muscle_laws(own_bases(), std::nan(""), 1); }), "muscles: give a strength of 0 or more");
}

TEST(MuscleCrossover, TakesEachLawFromAParent) {
  const std::vector<Material> a = own_bases(), b = mutate_muscle_laws(a, 5, 1);
  int of_b = 0, differing = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const std::vector<Material> child = cross_muscle_laws(a, b, seed);
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_TRUE(child[i] == a[i] || child[i] == b[i]);
      differing += a[i] != b[i] ? 1 : 0;
      of_b += a[i] != b[i] && child[i] == b[i] ? 1 : 0;
    }
  }
  EXPECT_NEAR(static_cast<double>(of_b) / differing, 0.5, 0.05);
  EXPECT_EQ(refusal([&] { cross_muscle_laws(a, {}, 1); }),
            "crossover: two robots with the same number of materials are needed, not 22 and 0");
}

TEST(MuscleCrossover, OfRobotsMixesPairsToo) {
  const Robot a = default_robot(), b = with_mutated_muscles(a, 5, 1), child = with_crossed_muscles(a, b, 2);
  EXPECT_TRUE(has_base_materials(child));
  EXPECT_NE(base_materials_of(child), base_materials_of(a));
  EXPECT_NE(base_materials_of(child), base_materials_of(b));
  EXPECT_EQ(with_crossed_muscles(own_robot(), b, 2), own_robot());
}

TEST(BoundedNumbers, AreThemselvesInsideAndSmoothAtTheBounds) {
  constexpr double low = -1, high = 3, margin = (high - low) / 20;
  for (double number = low + margin; number <= high - margin; number += 0.1)
    EXPECT_NEAR(bounded(number, low, high), number, 1e-14);
  EXPECT_EQ(bounded(low - margin, low, high), low);
  EXPECT_NEAR(bounded(high + margin, low, high), high, 1e-15);
  constexpr double h = 1e-5;
  const auto slope_at = [&](double number) {
    return (bounded(number + h, low, high) - bounded(number - h, low, high)) / (2 * h);
  };
  double before = slope_at(-9);
  for (double number = -9; number < 9; number += 0.01) {
    const double value = bounded(number, low, high);
    EXPECT_GE(value, low);
    EXPECT_LE(value, high);
    EXPECT_NEAR(slope_at(number), before, 0.01 / (2 * margin) + 1e-6);  // the parabola's curvature
    before = slope_at(number);
    EXPECT_NEAR(bounded(number + 2 * (high - low + 2 * margin), low, high), value, 1e-12);  // a period
    EXPECT_NEAR(bounded(unbounded(value, low, high), low, high), value, 1e-14);
  }
  for (const double far : {1e20, -1e300, 12345678.9}) {
    EXPECT_GE(bounded(far, low, high), low);
    EXPECT_LE(bounded(far, low, high), high);
  }
}

TEST(MuscleNumbers, AreOneForEachFrequencyAndTwoForEachMuscle) {
  Robot robot = own_robot();
  const std::vector<Material> bases = base_materials_of(robot);
  EXPECT_EQ(muscle_numbers(bases, {}, bases).size(), 2u + 2 * 2);
  EXPECT_EQ(muscle_numbers(bases, {true, true, false}, bases).size(), 1u + 2);
  EXPECT_EQ(muscle_numbers(own_bases(), {}, own_bases()).size(), 5u + 2 * 20);
  EXPECT_EQ(with_muscle_numbers(bases, {}, muscle_numbers(bases, {}, bases)), bases);
  EXPECT_EQ(with_muscle_numbers(own_bases(), {}, muscle_numbers(own_bases(), {}, own_bases())), own_bases());
}

TEST(MuscleNumbers, MoveWhatTheyAreForByTheStepOfAMutation) {
  const std::vector<Material> bases = own_bases();
  const std::vector<double> numbers = muscle_numbers(bases, {}, bases);
  const auto moved = [&](std::size_t which) {
    std::vector<double> other = numbers;
    other[which] += 1;
    return with_muscle_numbers(bases, {}, other);
  };
  const std::vector<Material> faster = moved(0), stronger = moved(5), later = moved(6);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_FLOAT_EQ(faster[i].frequency, bases[i].frequency + 0.5f);  // muscles of 1 rad/s stay together
  EXPECT_EQ(faster[4], bases[4]);
  EXPECT_FLOAT_EQ(stronger[0].amplitude, bases[0].amplitude + 0.04f);
  EXPECT_FLOAT_EQ(later[0].phase, bases[0].phase + 0.4f);
  EXPECT_EQ(later[1], bases[1]);
}

TEST(MuscleNumbers, OfAnySizeGiveValidMuscles) {
  Random random(1);
  const std::vector<Material> bases = own_bases();
  for (const double size : {1.0, 100.0, 1e9}) {
    std::vector<double> numbers = muscle_numbers(bases, {}, bases);
    for (double& number : numbers) number = size * random.normal();
    for (const Material& material : with_muscle_numbers(bases, {}, numbers)) {
      EXPECT_NO_THROW(validate(material, "material"));
      EXPECT_LE(std::abs(material.amplitude), max_muscle_amplitude);
      EXPECT_LE(material.frequency, max_muscle_frequency);
      EXPECT_GE(material.frequency, 0);
      EXPECT_GE(material.phase, 0);
      EXPECT_LT(material.phase, 2 * std::numbers::pi_v<float>);
    }
  }
}

}  // namespace
}  // namespace mercury
