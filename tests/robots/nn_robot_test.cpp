// SPDX-License-Identifier: Apache-2.0
#include "mercury/nn_robot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <set>

#include "mercury/fnv.h"
#include "mercury/random.h"
#include "tests/robots/nn_bodies.h"

namespace mercury {
namespace {

TEST(NnRobot, SpringsCombineTheMaterialsThatTheNetworkGivesTheirMasses) {
  // Score of material 7 is x, of material 21 is -x; the place is the point.
  NnGenome genome = simple_genome(identity, minus_identity);
  auto& weights = genome.network.layers[1].weights;
  weights[(3 + 6) * 6 + 0] = 1;
  weights[(3 + 20) * 6 + 3] = 1;
  const Robot robot = grow(genome);
  check_body(robot);
  EXPECT_EQ(robot.masses.size(), 200u);
  // The center moved by the mean only: any spring of one base material shows the side of its mass.
  std::map<std::uint16_t, std::set<MaterialId>> of_mass;
  std::set<MaterialId> materials;
  for (const Spring& s : robot.springs) {
    materials.insert(s.material);
    if (s.material == 7 || s.material == 21) of_mass[s.a].insert(s.material), of_mass[s.b].insert(s.material);
  }
  EXPECT_EQ(materials, (std::set<MaterialId>{7, 21, combine(7, 21)}));
  float lowest_of_7 = 1, highest_of_21 = -1;
  for (const auto& [mass, own] : of_mass) {
    ASSERT_EQ(own.size(), 1u);
    const float x = robot.masses[mass].x;
    if (own.contains(7))
      lowest_of_7 = std::min(lowest_of_7, x);
    else
      highest_of_21 = std::max(highest_of_21, x);
  }
  EXPECT_GT(lowest_of_7, highest_of_21);
  for (const Spring& s : robot.springs) {
    const auto side = [&](std::uint16_t mass) { return robot.masses[mass].x > (lowest_of_7 + highest_of_21) / 2; };
    const bool mixed = s.material == combine(7, 21);
    if (of_mass.contains(s.a) && of_mass.contains(s.b)) {
      EXPECT_EQ(mixed, side(s.a) != side(s.b));
    }
  }
}

TEST(NnRobot, PlacesAreCenteredAndReachTheUnitSphere) {
  const Robot robot = grow(simple_genome(identity, minus_identity));
  double mean[3] = {}, farthest = 0;
  for (const Vec3& x : robot.masses) {
    mean[0] += x.x, mean[1] += x.y, mean[2] += x.z;
    farthest = std::max(farthest, static_cast<double>(length(x)));
  }
  for (const double m : mean) EXPECT_NEAR(m / 200, 0, 1e-6);
  EXPECT_NEAR(farthest, 1, 1e-5);
}

TEST(NnRobot, NeighborsInSpaceAreNearInMemory) {
  const Robot robot = grow(random_nn_genome({}, 4));
  double distance = 0;
  for (const Spring& s : robot.springs) distance += std::abs(s.a - s.b);
  // Two of 512 random numbers are 171 apart on average.
  EXPECT_LT(distance / static_cast<double>(robot.springs.size()), 85);
}

// FNV-1a over all bits of a body.
std::uint64_t hash_of(const Robot& robot) {
  Fnv1a hash;
  for (const Vec3& x : robot.masses) hash.add(x);
  for (const Spring& s : robot.springs) {
    for (const std::uint32_t number : {s.a, s.b, std::uint16_t{s.material}}) hash.add(number);
    hash.add(s.rest_length);
  }
  for (const Face& f : robot.faces)
    for (const std::uint32_t corner : {f.a, f.b, f.c}) hash.add(corner);
  return hash.value();
}

// These hashes do not say what is right; they hold for every compiler, optimization and machine.
TEST(NnRobot, ASeedGrowsTheSameBitsEverywhere) {
  EXPECT_EQ(hash_of(grow(random_nn_genome({.spacing = 0}, 1))), 15080024903124239027u);
  EXPECT_EQ(hash_of(grow(random_nn_genome({.hidden = {20, 30, 40}, .points = 300, .spacing = 0, .mirrored = 1}, 2))),
            18007120144977833535u);
  EXPECT_EQ(hash_of(grow(random_nn_genome({.hidden = {}, .points = 3000, .alpha = 0.15f, .spacing = 0}, 3))),
            8435448039254982332u);
  EXPECT_EQ(hash_of(grow(random_nn_genome({.spacing = 0.6f}, 1))), 2804734140950173474u);
  EXPECT_EQ(hash_of(grow(random_nn_genome({.hidden = {20, 30, 40}, .points = 300, .spacing = 0.6f, .mirrored = 1}, 2))),
            237037505877357863u);
}

TEST(NnRobot, SizesOfTheNetworkAreFree) {
  for (const std::vector<int>& hidden : {std::vector<int>{}, {6}, {17}, {64}, {7, 40, 9}, {64, 64, 64, 64}}) {
    const Robot robot = grow(random_nn_genome({.hidden = hidden, .points = 100, .mirrored = 1}, 7));
    check_body(robot);
    EXPECT_EQ(sizes_of(nn_genome_of(robot)->network).size(), hidden.size() + 2);
  }
  // Another number of inputs than three.
  NnGenome genome = random_nn_genome({.points = 100}, 8);
  Layer& first = genome.network.layers[0];
  first.inputs = 4;
  Random random(9);
  first.weights.resize(4 * 64);
  for (float& weight : first.weights) weight = static_cast<float>(random.normal());
  check_body(grow(genome));
}

TEST(NnRobot, AMirroredBodyIsItsOwnMirrorImage) {
  const Robot robot = grow(random_nn_genome({.points = 300, .mirrored = 1}, 10));
  const auto has_twin = [&](const Vec3& mass) {
    return std::any_of(robot.masses.begin(), robot.masses.end(), [&](const Vec3& other) {
      return length(other - Vec3{mass.x, -mass.y, mass.z}) < 1e-4f;
    });
  };
  EXPECT_TRUE(std::all_of(robot.masses.begin(), robot.masses.end(), has_twin));
}

TEST(NnRobot, MutantsAndChildrenOfRobotsGrow) {
  const NnGenome a = random_nn_genome({.points = 100}, 11), b = random_nn_genome({.points = 100}, 12);
  const NnGenome mutant = mutate(a, 0.1, 0.1, 13);
  EXPECT_EQ(mutant.network, mutate(a.network, 0.1, 0.1, 13));
  EXPECT_EQ(mutant.cloud_seed, a.cloud_seed);
  const Robot mutated = grow(mutant);
  check_body(mutated);
  EXPECT_NE(mutated.masses, grow(a).masses);
  EXPECT_EQ(*nn_genome_of(mutated), mutant);
  const NnGenome child = crossover(a, b, 14);
  EXPECT_EQ(child.network, crossover(a.network, b.network, 14));
  check_body(grow(child));
}

}  // namespace
}  // namespace mercury
