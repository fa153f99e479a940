// SPDX-License-Identifier: Apache-2.0
// Network robots whose muscles are fields.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "mercury/error.h"
#include "mercury/generator.h"
#include "mercury/nn_robot.h"
#include "mercury/random.h"
#include "robots/bytes.h"
#include "robots/genes.h"
#include "robots/muscle_fields.h"
#include "tests/robots/field_robots.h"

namespace mercury {
namespace {

NnOptions network_options(int frequencies = 1) {
  return {.points = 200, .muscles = NetworkMuscles::fields, .frequencies = frequencies, .environment = "ocean"};
}

TEST(NetworkFields, RandomRobotsAreSoundDifferAndGrowAgain) {
  for (std::uint64_t index = 0; index < 30; ++index) {
    Robot robot;
    ASSERT_NO_THROW(robot = random_nn_robot(network_options(index % 2 ? 2 : 1), 1, index)) << index;
    ASSERT_NO_THROW(validate(robot));
    ASSERT_LE(robot.materials.size(), 256u);
    std::set<float> amplitudes, phases, stiffnesses, frequencies;
    for (const Material& material : robot.materials) {
      amplitudes.insert(material.amplitude);
      phases.insert(material.phase);
      stiffnesses.insert(material.stiffness);
      if (material.amplitude > 0) frequencies.insert(material.frequency);
    }
    EXPECT_GT(amplitudes.size(), 10u) << index;
    EXPECT_GT(phases.size(), 10u) << index;
    EXPECT_GT(stiffnesses.size(), 10u) << index;
    EXPECT_LE(frequencies.size(), index % 2 ? 2u : 1u);
    const auto genome = nn_genome_of(robot);
    ASSERT_TRUE(genome.has_value());
    EXPECT_EQ(grow(*genome, robot.name), robot);
    EXPECT_EQ(genome->network.layers.back().outputs, 29);
    // The same body as without fields: those are drawn last.
    NnOptions kinds = network_options();
    kinds.muscles = NetworkMuscles::kinds;
    EXPECT_EQ(random_nn_robot(kinds, 1, index).masses, robot.masses);
  }
}

TEST(NetworkFields, ASpringMovesByTheMeanOfItsMasses) {
  NnOptions options = network_options();
  options.spacing = 0;
  options.mirrored = 0;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const NnGenome genome = random_nn_genome(options, seed);
    const Robot robot = grow(genome);
    // The cloud once more, to find each mass's point and its value.
    Random random(genome.cloud_seed);
    std::vector<float> points(genome.points * 3);
    for (float& number : points) number = static_cast<float>(random.normal());
    const std::vector<float> outputs = evaluate(genome.network, points);
    ASSERT_EQ(outputs.size(), genome.points * 29);
    std::array<double, 3> mean{};
    for (std::size_t i = 0; i < genome.points; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        mean[axis] += static_cast<double>(outputs[i * 29 + axis]) / static_cast<double>(genome.points);
    std::vector<std::array<double, 3>> places(genome.points);
    double farthest = 0;
    for (std::size_t i = 0; i < genome.points; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        places[i][axis] = static_cast<double>(outputs[i * 29 + axis]) - mean[axis];
      farthest = std::max(farthest, std::hypot(places[i][0], places[i][1], places[i][2]));
    }
    const auto value_at = [&](std::uint16_t mass) {
      const Vec3 place = robot.masses[mass];
      for (std::size_t i = 0; i < genome.points; ++i) {
        const std::array<double, 3>& p = places[i];
        if (std::hypot(p[0] / farthest - static_cast<double>(place.x), p[1] / farthest - static_cast<double>(place.y),
                       p[2] / farthest - static_cast<double>(place.z)) > 1e-5)
          continue;
        const float* output = &outputs[i * 29];
        const auto kind = static_cast<MaterialId>(std::max_element(output + 3, output + 25) - output - 3 + 1);
        const auto field = [&](int index) { return 0.25 * static_cast<double>(output[25 + index]); };
        return field_value(kind, {field(0), field(1), 0.5 + field(2), field(3)},
                           {genome.frequencies, genome.frequency, genome.amplitude});
      }
      ADD_FAILURE() << "no point of mass " << mass;
      return FieldValue{};
    };
    double squares = 0;
    for (const Spring& spring : robot.springs) {
      const FieldValue value = mean_value(std::array{value_at(spring.a), value_at(spring.b)});
      const Material& material = robot.materials[spring.material];
      EXPECT_EQ(material.amplitude > 0, value.moves());
      for (const double turns : {0., 0.25})
        squares += std::pow(wave_of(material, turns * turn / 5) - wave_of(value, turns), 2);
    }
    // 255 cubes that fill the cloud of values, which is 2 amplitudes wide, have sides of (8 / 255)^(1/3) amplitudes.
    const double side = std::cbrt(8. / 255) * 0.14;
    EXPECT_LT(squares / static_cast<double>(robot.springs.size()), 2 * side * side / 12) << seed;
  }
}

TEST(NetworkFields, GenesAreReadBackAndGrowTheSameRobot) {
  for (std::uint64_t index = 0; index < 10; ++index)
    expect_same_genes_read_back(random_nn_robot(network_options(2), 4, index), index);
}

TEST(NetworkGenes, RandomOnesAreThoseOfRandomRobots) {
  const Generator& networks = generator_named("nn");
  const ParameterValues values{{"points", std::int64_t{64}}};
  for (std::uint64_t index = 0; index < 20; ++index) {
    ByteWriter drawn, made;
    networks.genes->random(networks, values, 3, index)->write(drawn);
    networks.genes->of(networks.make(values, {}, 3, index))->write(made);
    EXPECT_EQ(drawn.bytes(), made.bytes());
  }
  const ParameterValues flat{{"points", std::int64_t{64}}, {"alpha", 1e-6f}};
  EXPECT_THROW(networks.genes->random(networks, flat, 1, 0), InputError) << "no body of this alpha";
  EXPECT_THROW(networks.make(flat, {}, 1, 0), InputError);
}

}  // namespace
}  // namespace mercury
