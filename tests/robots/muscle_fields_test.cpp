// SPDX-License-Identifier: Apache-2.0
#include "robots/muscle_fields.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include "mercury/cppn.h"
#include "mercury/generator.h"
#include "mercury/inspect.h"
#include "mercury/random.h"
#include "mercury/real_body.h"
#include "mercury/voxels.h"
#include "robots/portable_math.h"
#include "tests/refusal.h"
#include "tests/robots/field_robots.h"
#include "tests/robots/surface.h"

namespace mercury {
namespace {

TEST(PortableMath, AngleOfAPointAgreesWithTheLibrarys) {
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    const SineCosine point{random.normal(), random.normal()};
    const double exact = std::atan2(point.sine, point.cosine) / turn, turns = turns_of(point);
    EXPECT_GE(turns, 0);
    EXPECT_LT(turns, 1);
    EXPECT_NEAR(std::remainder(turns - exact, 1), 0, 1e-15);
  }
  EXPECT_EQ(turns_of({0, 0}), 0);
  EXPECT_EQ(turns_of({0, 2}), 0);
  EXPECT_EQ(turns_of({3, 0}), 0.25);
  EXPECT_EQ(turns_of({0, -1}), 0.5);
  EXPECT_EQ(turns_of({-1e-300, 1}), 0) << "rounds to a whole turn";
}

TEST(MuscleFields, APlaceMovesAndIsStiffAsItsOutputsSay) {
  const FieldMuscles muscles{.frequencies = 2, .frequency = 6, .amplitude = 0.2f};
  const FieldValue value = field_value(3, {.phase = -1.75, .frequency = 0.1, .amplitude = 0, .stiffness = 1}, muscles);
  EXPECT_NEAR(value.stiffness, 100, 1e-12) << "twice that of a muscle";
  for (const double turns : {0., 0.1, 0.6})
    EXPECT_NEAR(wave_of(value, turns), 0.1 * std::sin(turn * (turns + 0.25)), 1e-8);
  EXPECT_EQ(value.frequency, 1);
  EXPECT_EQ(field_value(3, {.frequency = -0.1}, muscles).frequency, 0);
  EXPECT_EQ(field_value(3, {.frequency = 0.1}, {}).frequency, 0);
  EXPECT_NEAR(wave_of(field_value(1, {.amplitude = 7}, muscles), 0.25), 0.2, 1e-8) << "the largest";
  EXPECT_FALSE(field_value(1, {.amplitude = -7}, muscles).moves());
  EXPECT_FALSE(field_value(bone, {.amplitude = 1}, muscles).moves());
  EXPECT_NEAR(field_value(bone, {.stiffness = -1}, muscles).stiffness, 50, 1e-12);
  EXPECT_NEAR(field_value(tissue, {}, muscles).stiffness, 40, 1e-12);
}

TEST(MuscleFields, ASpringMovesByTheMeanOfItsPlaces) {
  Random random(4);
  std::array<FieldValue, 3> values;
  for (FieldValue& value : values) value = {random.uniform(20, 200), random.normal(), random.normal(), 0};
  const FieldValue mean = mean_value(values);
  EXPECT_NEAR(mean.stiffness, (values[0].stiffness + values[1].stiffness + values[2].stiffness) / 3, 1e-12);
  for (const double turns : {0., 0.2, 0.7})
    EXPECT_NEAR(wave_of(mean, turns),
                (wave_of(values[0], turns) + wave_of(values[1], turns) + wave_of(values[2], turns)) / 3, 1e-12);
  const std::array two{FieldValue{50, 0.1, 0, 0}, FieldValue{50, 0, 0.3, 1}};
  EXPECT_EQ(mean_value(two), (FieldValue{50, 0, 0.15, 1})) << "the frequency that moves it more";
  const std::array opposite{FieldValue{50, 0.1, 0.2, 0}, FieldValue{50, -0.1, -0.2, 0}};
  EXPECT_FALSE(mean_value(opposite).moves());
}

TEST(MuscleFields, FewValuesKeepTheirs) {
  std::vector<FieldValue> values;
  for (int i = 0; i < 1000; ++i)
    values.push_back({50. + 10 * (i % 5), 0.1 * (i % 7), 0.1 * (i % 3), i % 7 + i % 3 == 0 ? 0 : i % 2});
  const FieldPalette palette = palette_of(values, 255);
  EXPECT_EQ(palette.values.size(), 5u * (7 * 3 - 1) * 2 + 5);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(palette.values[palette.of[i]], values[i]);
  EXPECT_TRUE(palette_of({}, 255).values.empty());
}

TEST(MuscleFields, ManyValuesShareThoseNearby) {
  // A disc of n cells of equal area cannot be nearer to its cells' middles than 0.18 of its area per cell in the mean
  // square (hexagons: 5 / (18 sqrt(3))); boxes cut at their means are not far from that.
  Random random(5);
  std::vector<FieldValue> values;
  while (values.size() < 20000) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    if (x * x + y * y < 1) values.push_back({50, x, y, 0});
  }
  for (std::size_t i = 0; i < 200; ++i) values.push_back({50, 0, 0, 0});
  for (const std::size_t most : {std::size_t{3}, std::size_t{36}, std::size_t{255}}) {
    const FieldPalette palette = palette_of(values, most);
    EXPECT_EQ(palette.values.size(), most);
    double squares = 0;
    std::map<int, FieldValue> sums;
    std::map<int, int> counts;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const FieldValue& part = palette.values[palette.of[i]];
      ASSERT_EQ(part.moves(), values[i].moves());
      squares += std::pow(part.cosine - values[i].cosine, 2) + std::pow(part.sine - values[i].sine, 2);
      sums[palette.of[i]].cosine += values[i].cosine;
      ++counts[palette.of[i]];
    }
    EXPECT_LT(squares / 20000, 1.5 * 0.18 * std::numbers::pi / static_cast<double>(most - 1)) << most;
    for (const auto& [part, sum] : sums)
      EXPECT_NEAR(palette.values[static_cast<std::size_t>(part)].cosine, sum.cosine / counts[part], 1e-12);
  }
}

TEST(MuscleFields, MaterialsMoveAsTheirValues) {
  const std::array values{FieldValue{60, 0.1, -0.05, 1}, FieldValue{80, 0, 0, 0}, FieldValue{70, -0.1, 0.02, 0}};
  const auto [materials, names] = table_of(values, {.frequencies = 2, .frequency = 8});
  EXPECT_EQ(names, (std::vector<std::string>{"air", "muscle 1", "tissue 1", "muscle 2"}));
  for (const double time : {0., 0.3, 1.1}) {
    EXPECT_NEAR(wave_of(materials[1], time), wave_of(values[0], 8 * time / turn), 1e-7);
    EXPECT_NEAR(wave_of(materials[3], time), wave_of(values[2], 4 * time / turn), 1e-7) << "half the frequency";
  }
  EXPECT_EQ(materials[2], (Material{.stiffness = 80}));
}

enum : std::uint32_t { x, y, z, distance, bias, presence, kind, phase };
constexpr std::uint32_t amplitude = UINT32_MAX - 1, stiffness = UINT32_MAX;

// A bar that is muscle everywhere, with these further edges.
CppnGenome bar(std::vector<CppnEdge> edges) {
  CppnGenome genome{.nx = 12, .ny = 2, .nz = 2};
  genome.network.outputs = cppn_outputs;
  genome.network.edges = {{bias, presence, 1}, {bias, kind, 1}};
  genome.network.edges.insert(genome.network.edges.end(), edges.begin(), edges.end());
  return genome;
}

// Where the middle of a spring lies in the bar, from -1 to 1.
double along(const Robot& robot, const Spring& spring) {
  return static_cast<double>(robot.masses[spring.a].x + robot.masses[spring.b].x) / 2 / 0.6;
}

// The bar has 12 voxels along x. A spring across it stands between two of them.
bool is_within_a_voxel(double at) { return std::abs(std::remainder(6 * at, 1)) > 0.4; }

TEST(PaintedFields, ALinearPhaseIsATravelingWaveWithoutSteps) {
  const Robot robot = grow(bar({{x, phase, 0.7f}, {bias, amplitude, 1}}));
  ASSERT_NO_THROW(validate(robot));
  for (const Spring& spring : robot.springs) {
    // Between voxels of two phases the amplitude shrinks by the cosine of half their difference.
    const Material& material = robot.materials[spring.material];
    const double at = along(robot, spring), difference = 0.7 / 6;
    const bool between = !is_within_a_voxel(at) && std::abs(at) < 0.99;
    const double wave = 0.14 * (between ? std::cos(turn / 2 * difference) : 1);
    const bool at_the_end = std::abs(at) > 0.99;  // one voxel beside it, not two
    const double turns = 0.7 * (at_the_end ? std::copysign(11. / 12, at) : at);
    for (const double time : {0., 0.4, 0.9})
      EXPECT_NEAR(wave_of(material, time), wave * std::sin(5 * time + turn * turns), 1e-6) << at;
    EXPECT_EQ(material.stiffness, 50);
  }
}

TEST(PaintedFields, AmplitudeAndStiffnessFollowTheirOutputs) {
  const Robot robot = grow(bar({{x, amplitude, 1}, {x, stiffness, -1}}));
  for (const Spring& spring : robot.springs) {
    const double at = along(robot, spring);
    if (!is_within_a_voxel(at)) continue;
    EXPECT_NEAR(robot.materials[spring.material].amplitude, 0.14 * (1 + at) / 2, 1e-6);
    EXPECT_NEAR(robot.materials[spring.material].stiffness, 50 * std::exp2(-at), 1e-3);
  }
}

CppnOptions painted_options(int frequencies = 1) {
  return {.smallest = {8, 6, 6},
          .largest = {12, 6, 6},
          .muscles = PaintedMuscles::fields,
          .frequencies = frequencies,
          .environment = "ocean"};
}

TEST(PaintedFields, RandomRobotsAreSoundDifferAndGrowAgain) {
  std::set<std::size_t> materials;
  for (std::uint64_t index = 0; index < 40; ++index) {
    const Robot robot = random_cppn_robot(painted_options(index % 2 ? 2 : 1), 1, index);
    ASSERT_NO_THROW(validate(robot));
    ASSERT_TRUE(half_edges_cancel(robot));
    ASSERT_EQ(spring_components(robot), 1u);
    ASSERT_LE(robot.materials.size(), 256u);
    ASSERT_EQ(robot.material_names.size(), robot.materials.size());
    std::set<float> amplitudes, stiffnesses, frequencies;
    for (const Material& material : robot.materials) {
      amplitudes.insert(material.amplitude);
      stiffnesses.insert(material.stiffness);
      if (material.amplitude > 0) frequencies.insert(material.frequency);
    }
    EXPECT_GT(amplitudes.size(), 10u);
    EXPECT_GT(stiffnesses.size(), 10u);
    EXPECT_LE(frequencies.size(), index % 2 ? 2u : 1u);
    materials.insert(robot.materials.size());
    const auto genome = cppn_genome_of(robot);
    ASSERT_TRUE(genome.has_value());
    EXPECT_EQ(grow(*genome, robot.name), robot);
  }
  EXPECT_EQ(*materials.rbegin(), 256u) << "some use the whole table";
}

TEST(PaintedFields, HaveRealBodiesWhoseVoxelsMoveAsPainted) {
  for (std::uint64_t index = 0; index < 20; ++index) {
    const Robot robot = random_cppn_robot(painted_options(), 2, index);
    const Robot real = with_real_body(robot, {});
    ASSERT_NO_THROW(validate(real));
    const Voxels voxels = voxels_of(robot);
    ASSERT_FALSE(voxels.all.empty());
    std::set<MaterialId> values;
    std::map<std::uint32_t, MaterialId> middle;
    for (const Spring& spring : real.springs) middle[pair_of(spring.a, spring.b)] = spring.material;
    for (const Voxel& voxel : voxels.all) {
      values.insert(voxel.material);
      const Material &painted = robot.materials[voxel.material],
                     &made = real.materials[middle.at(pair_of(voxel.corners[0], voxel.corners[7]))];
      EXPECT_EQ(made.amplitude, painted.amplitude);
      EXPECT_EQ(made.phase, painted.phase);
    }
    EXPECT_LE(values.size(), 36u);
  }
}

TEST(PaintedFields, ChildrenDifferStayValidAndHaveFields) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const CppnGenome a = random_cppn_genome(painted_options(), 5, seed), b = mutate(a, 2, seed);
    ASSERT_NO_THROW(validate(b));
    EXPECT_NE(grow(a), grow(b));
    const CppnGenome child = crossover(a, random_cppn_genome(painted_options(), 6, seed), seed);
    ASSERT_NO_THROW(validate(child));
    EXPECT_EQ(child.network.outputs, cppn_outputs);
    EXPECT_NE(grow(child), grow(a));
    // Without fields in one parent, the child is as the first one.
    const CppnGenome plain = random_cppn_genome({}, 7, seed);
    ASSERT_NO_THROW(validate(crossover(a, plain, seed)));
    EXPECT_EQ(crossover(a, plain, seed).network.outputs, cppn_outputs);
    ASSERT_NO_THROW(validate(crossover(plain, a, seed)));
    EXPECT_EQ(crossover(plain, a, seed).network.outputs, cppn_phase_outputs);
  }
}

TEST(PaintedFields, BadOriginsAreRefusedWithTheirPlace) {
  Robot robot = grow(bar({{bias, amplitude, 1}}));
  const auto refused = [&](const std::string& from, const std::string& to) {
    Robot changed = robot;
    changed.origin.replace(changed.origin.find(from), from.size(), to);
    return refusal([&] { cppn_genome_of(changed); });
  };
  EXPECT_EQ(refused("\"outputs\":6", "\"outputs\":6"), "");
  EXPECT_EQ(refused("\"outputs\":6", "\"outputs\":5"), "/origin/outputs: 5 is not accepted; give 4 or 6");
  EXPECT_EQ(refused("\"outputs\":6", "\"outputs\":-6"), "/origin/outputs: a whole number >= 0 is expected");
  EXPECT_EQ(refused("\"outputs\":6,", ""), "/origin/edges/2: there is no node 4294967294");
  EXPECT_EQ(refused("\"frequencies\":1", "\"frequencies\":3"), "/origin/frequencies: give 1 or 2 with fields");
  EXPECT_EQ(refusal([] { random_cppn_genome(painted_options(3), 1); }),
            "muscle_frequencies: 3 is not accepted with fields; give 1 or 2");
}

TEST(PaintedFields, GenesAreReadBackAndGrowTheSameRobot) {
  for (std::uint64_t index = 0; index < 10; ++index)
    expect_same_genes_read_back(random_cppn_robot(painted_options(2), 4, index), index);
}

}  // namespace
}  // namespace mercury
