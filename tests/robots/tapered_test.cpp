// SPDX-License-Identifier: Apache-2.0
// Tapered robots, and real bodies of cells that are no cubes.
#include "mercury/tapered.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numeric>

#include "mercury/body_properties.h"
#include "mercury/generator.h"
#include "mercury/inspect.h"
#include "mercury/real_body.h"
#include "mercury/robot_file.h"
#include "robots/hexahedra.h"
#include "robots/library/designs.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;
using testing::Ge;
using testing::StartsWith;

double mass_of_all(const Robot& robot) { return std::accumulate(robot.mass.begin(), robot.mass.end(), 0.0); }

// The moduli C_ijkl of an infinite lattice of boxes, over E: xxxx, yyyy, zzzz, xxyy, yyzz, zzxx.
std::array<double, 6> moduli_of(const std::array<double, 3>& sizes) {
  const std::array<double, 8> shares = spring_shares(sizes);
  std::array<double, 6> moduli{};
  for (std::size_t a = 0; a < 8; ++a)
    for (std::size_t b = a + 1; b < 8; ++b) {
      std::array<double, 3> n{};
      for (std::size_t i = 0; i < 3; ++i)
        n[i] = (static_cast<double>(b >> i & 1) - static_cast<double>(a >> i & 1)) * sizes[i];
      const double squared = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        moduli[i] += shares[a ^ b] * n[i] * n[i] * n[i] * n[i] / (squared * squared);
        moduli[3 + i] += shares[a ^ b] * n[i] * n[i] * n[j] * n[j] / (squared * squared);
      }
    }
  return moduli;
}

TEST(Hexahedra, ACubeHasTheSpringsOfAVoxel) {
  EXPECT_THAT(
      spring_shares({0.3, 0.3, 0.3}),
      ElementsAre(0, DoubleNear(0.15, 1e-6), DoubleNear(0.15, 1e-6), DoubleNear(0.2, 1e-6), DoubleNear(0.15, 1e-6),
                  DoubleNear(0.2, 1e-6), DoubleNear(0.2, 1e-6), DoubleNear(0.45, 1e-6)));
}

// E and Poisson's ratio 1/4 need C_iiii = 1.2 and C_iijj = 0.4. Longer boxes cannot have both.
TEST(Hexahedra, BoxesAreAsIsotropicAsSpringsCanBe) {
  const std::array<double, 6> nearly = moduli_of({1, 1.2, 0.9});
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(nearly[i], i < 3 ? 1.2 : 0.4, 0.01) << i;
  for (const std::array<double, 3>& sizes :
       {std::array{1.0, 1.2, 0.9}, {1.0, 0.7, 0.8}, {2.0, 1.0, 1.0}, {1.0, 1.0, 0.4}}) {
    const std::array<double, 6> moduli = moduli_of(sizes);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(moduli[i], 1.2, 0.2) << sizes[0] << ' ' << sizes[1] << ' ' << i;
    EXPECT_THAT(spring_shares(sizes), Each(Ge(0.0)));
  }
}

TEST(TaperedRobots, AreOneBallWithTheVolumeThatIsAskedFor) {
  for (std::uint64_t index = 0; index < 30; ++index) {
    const Robot robot = random_tapered_robot({.volume = 12}, 1, index);
    const Inspection found = inspect(robot);
    EXPECT_TRUE(found.closed) << robot.name;
    EXPECT_EQ(found.components, 1u);
    EXPECT_EQ(found.euler_characteristic, 2);
    EXPECT_NEAR(found.volume, 0.012, 0.012 * 0.02) << robot.name;  // sides are not flat
    EXPECT_GT(found.extent.x, 2 * found.extent.z);
    EXPECT_GT(found.extent.z, found.extent.y);
  }
  const Inspection lying = inspect(random_tapered_robot({.bending = TaperedBending::up_down}, 1));
  EXPECT_GT(lying.extent.y, lying.extent.z);
}

// A bar of cells that are nearly cubes.
TEST(TaperedRobots, HaveTheModulusAndTheDensityOfTheirMaterial) {
  TaperedGenome bar{.stations = 20, .layers = 2, .edge = 1};
  bar.depths.fill(0.1);
  bar.width = 0.5;
  const Robot robot = with_real_body(grow(bar), {.modulus = 2e5f, .density = 900, .relaxation_time = 0.002f});
  const BodyProperties properties = body_properties(robot);
  // Springs are as stiff as the time step allows; those of the cells alone have the modulus.
  EXPECT_LT(*properties.modulus, 2e5);
  EXPECT_GT(*properties.modulus, 1e5);
  EXPECT_NEAR(*properties.density, 900, 1);
  const Robot paper = grow(bar);
  const std::vector<double> modulus(paper.materials.size(), 2e5), density(paper.materials.size(), 900);
  const auto [mass, stiffness] = sum_hexahedra(paper, generator_of(paper)->cells(paper), modulus, density);
  double sum = 0;
  for (std::size_t s = 0; s < stiffness.size(); ++s)
    sum += stiffness[s] * static_cast<double>(paper.springs[s].rest_length) *
           static_cast<double>(paper.springs[s].rest_length);
  EXPECT_NEAR(sum / (6 * skin_volume(paper)), 2e5, 0.02 * 2e5);
  for (std::size_t id = 1; id < robot.materials.size(); ++id) EXPECT_EQ(robot.materials[id].relaxation_time, 0.002f);
  EXPECT_EQ(physics_of(robot), Physics::real);
}

TEST(TaperedRobots, KeepTheirMassAsTheyChange) {
  const RealMaterial material{.modulus = 1e6f};
  const Robot parent = with_real_body(random_tapered_robot({}, 3), material);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Robot child = mutate_robot(parent, {.strength = 3, .seed = seed, .muscles = 1}, "child");
    EXPECT_NE(child.masses, parent.masses);
    EXPECT_NEAR(mass_of_all(child), 30e-3 * 1070, 0.01);
    EXPECT_EQ(real_material_of(child), material);
    EXPECT_LE(child.materials.size(), std::size_t{max_materials});
  }
}

TEST(TaperedRobots, BendTowardsTheSkinThatShortens) {
  const Robot robot = grow({.segments = 4, .waves = 0});
  for (const Spring& spring : robot.springs) {
    const Material& material = robot.materials[spring.material];
    const float y = robot.masses[spring.a].y;
    if (material.amplitude != 0) {
      EXPECT_EQ(material.amplitude > 0, y > 0);
    }
  }
}

TEST(TaperedRobots, MutationsMoveBodyOrMusclesAndCrossoverMixesThem) {
  const TaperedGenome a = random_tapered_genome({}, 1), b = random_tapered_genome({.volume = 5}, 2);
  for (const double strength : {1e-30, 1e-3, 1.0})
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      const TaperedGenome child = mutate(a, strength, seed);
      ASSERT_NE(child, a);
      ASSERT_NO_THROW(validate(child));
      EXPECT_EQ(child.volume, a.volume);
      const TaperedGenome mixed = crossover(a, b, seed);
      EXPECT_EQ(mixed.volume, a.volume);
      EXPECT_TRUE(mixed.waves == a.waves || mixed.waves == b.waves);
    }
  EXPECT_EQ(mutate(a, 0, 1), a);
}

TEST(TaperedRobots, ComeBackFromTheirOrigin) {
  const Robot robot = random_tapered_robot({.environment = "land"}, 5);
  EXPECT_EQ(grow(*tapered_genome_of(robot), robot.name), robot);
  const auto read = [&](const std::string& origin) {
    Robot other;
    other.origin = origin;
    return refusal([&] { tapered_genome_of(other); });
  };
  EXPECT_EQ(read(R"({"kind":"voxel"})"), "");
  EXPECT_EQ(read(R"({"kind":"tapered"})"), "/origin/bending: is missing");
  EXPECT_EQ(read(R"({"kind":"tapered","bending":"sideways","stations":"many"})"), "/origin/stations: give 4 to 100");
  EXPECT_THAT(refusal([] { grow({.width = NAN}); }), StartsWith("width: nan is not accepted"));
}

TEST(SampleAnimals, AreWhatTheGeneratorMakes) {
  for (const Robot& animal : library::animals()) {
    const auto path = std::filesystem::path(MERCURY_ROBOT_LIBRARY).parent_path() / (animal.name + ".json");
    EXPECT_EQ(load_robot(path), animal) << path << " is not what generate_library writes";
    EXPECT_EQ(generator_of(animal)->regrow(animal), animal);
  }
}

}  // namespace
}  // namespace mercury
