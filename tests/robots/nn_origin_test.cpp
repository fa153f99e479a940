// SPDX-License-Identifier: Apache-2.0
#include "mercury/nn_robot.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "mercury/error.h"
#include "mercury/random.h"
#include "tests/refusal.h"
#include "tests/robots/nn_bodies.h"

namespace mercury {
namespace {

TEST(NnOrigin, ASavedGenomeGrowsTheIdenticalRobot) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Robot robot = grow(random_nn_genome({.points = 100, .alpha = seed % 2 ? 0.4f : 0.f}, seed), "x");
    const auto genome = nn_genome_of(robot);
    ASSERT_TRUE(genome);
    EXPECT_EQ(*genome, random_nn_genome({.points = 100, .alpha = seed % 2 ? 0.4f : 0.f}, seed));
    EXPECT_EQ(grow(*genome, "x"), robot);
  }
}

TEST(NnOrigin, WithoutASpacingHasNone) {  // files of versions before 0.3.0
  NnGenome genome = random_nn_genome({.points = 100, .spacing = 0}, 1);
  EXPECT_EQ(to_origin(genome).find("spacing"), std::string::npos);
  EXPECT_EQ(nn_genome_of(grow(genome))->spacing, 0);
  genome.spacing = 0.3f;
  EXPECT_EQ(nn_genome_of(grow(genome))->spacing, 0.3f);
}

TEST(NnOrigin, EveryFloatComesBackFromTheOrigin) {
  NnGenome genome = simple_genome(identity, identity);
  Random random(6);
  genome.network.layers = {Layer{400, 25, std::vector<float>(400 * 25), std::vector<float>(25)}};
  for (float& weight : genome.network.layers[0].weights) {
    do weight = std::bit_cast<float>(static_cast<std::uint32_t>(random.bits()));
    while (!std::isfinite(weight));
  }
  auto& weights = genome.network.layers[0].weights;
  weights[0] = -0.f;
  weights[1] = std::numeric_limits<float>::denorm_min();
  weights[2] = std::numeric_limits<float>::max();
  genome.cloud_seed = ~std::uint64_t{0};
  Robot robot;
  robot.origin = to_origin(genome);
  const auto back = nn_genome_of(robot);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->cloud_seed, genome.cloud_seed);
  for (std::size_t i = 0; i < weights.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint32_t>(back->network.layers[0].weights[i]),
              std::bit_cast<std::uint32_t>(weights[i]));
}

TEST(NnOrigin, OriginsThatCannotBeUsedAreRefusedWithTheirPlace) {
  const auto read = [](const std::string& origin) -> std::string {
    Robot robot;
    robot.origin = origin;
    std::string found;
    const std::string why = refusal([&] { found = nn_genome_of(robot) ? "genome" : "none"; });
    return why + found;
  };
  EXPECT_EQ(read(""), "none");
  EXPECT_EQ(read(R"({"kind":"voxel"})"), "none");
  EXPECT_EQ(read("[1]"), "/origin: a JSON object is expected");
  EXPECT_EQ(read("{"), "/origin: a JSON object is expected");
  EXPECT_EQ(read(R"({"kind":"nn"})"), "/origin/weights: is missing");

  NnGenome genome = simple_genome(identity, identity);
  std::string origin = to_origin(genome);
  EXPECT_EQ(read(origin), "genome");
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = origin;
    text.replace(text.find(from), from.size(), to);
    return read(text);
  };
  EXPECT_EQ(replaced("[3,6,25]", "[3,7,25]"), "/origin/sizes: the sizes of the layers in weights are expected");
  EXPECT_EQ(replaced("[[1,0,0]", "[[1,0]"), "/origin/weights/0: rows of equal length are expected");
  EXPECT_EQ(replaced("[[1,0,0]", "[[1,0,\"a\"]"), "/origin/weights/0/0: numbers are expected");
  EXPECT_EQ(replaced("\"points\":200", "\"points\":20"), "/origin: points: 20 is not accepted; give 64 to 65535");
  EXPECT_EQ(replaced("\"points\":200", "\"points\":-1"), "/origin/points: a whole number >= 0 is expected");
  EXPECT_EQ(replaced("\"mirrored\":false", "\"mirrored\":0"), "/origin/mirrored: true or false is expected");
  EXPECT_EQ(replaced("\"alpha\":0", "\"alpha\":0,\"spacing\":\"wide\""),
            "/origin/spacing: a share of the mean spacing is expected");
  EXPECT_EQ(replaced("\"alpha\":0", "\"alpha\":0,\"spacing\":2"),
            "/origin: spacing: give a share of the mean spacing, 0 to 1");
  EXPECT_EQ(replaced("\"alpha\":0", "\"alpha\":-1"),
            "/origin: alpha: give a radius > 0 m, or 0 for the smallest that holds all points");
}

}  // namespace
}  // namespace mercury
