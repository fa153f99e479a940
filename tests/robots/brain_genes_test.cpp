// SPDX-License-Identifier: Apache-2.0
// What evolution changes in brains: by how much, and how two of them mix.
#include "robots/brain_genes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "mercury/generator.h"
#include "mercury/random_voxel.h"
#include "mercury/voxel.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

constexpr double sigmas = 4;  // of every statistic below

// step' / step is log-normal with tau = 1 / sqrt(2 n); weights move by normal numbers of the child's own step.
TEST(BrainMutation, HasTheStepsOfTheory) {
  constexpr std::size_t n = 50, children = 4000;
  constexpr double strength = 3, step = 0.2;
  const double tau = 1 / std::sqrt(2.0 * n);
  const BrainGenes parent{.weights = std::vector<float>(n, 0.5f), .step = step};
  double logs = 0, squared_logs = 0, moves = 0, squared_moves = 0, mean_squares = 0;
  for (std::uint64_t seed = 0; seed < children; ++seed) {
    const BrainGenes child = parent.mutated(strength, seed);
    const double log = std::log(child.step / step);
    logs += log;
    squared_logs += log * log;
    for (const float weight : child.weights) {
      const double move = (static_cast<double>(weight) - 0.5) / strength;
      moves += move / child.step;
      squared_moves += move * move / (child.step * child.step);
      mean_squares += move * move / n;
    }
  }
  constexpr double m = children;
  EXPECT_NEAR(logs / m, 0, sigmas * tau / std::sqrt(m));
  EXPECT_NEAR(std::sqrt(squared_logs / m), tau, sigmas * tau / std::sqrt(2 * m));
  EXPECT_NEAR(moves / (n * m), 0, sigmas / std::sqrt(n * m));
  EXPECT_NEAR(squared_moves / (n * m), 1, sigmas * std::sqrt(2 / (n * m)));
  // Without regard to the step: E = step^2 e^(2 tau^2), and E of its square = step^4 e^(8 tau^2) (1 + 2 / n).
  const double expected = step * step * std::exp(2 * tau * tau);
  const double variance = std::pow(step, 4) * std::exp(8 * tau * tau) * (1 + 2.0 / n) - expected * expected;
  EXPECT_NEAR(mean_squares / m, expected, sigmas * std::sqrt(variance / m));
}

TEST(BrainMutation, DependsOnTheSeedAlone) {
  const BrainGenes parent{.weights = {1, 2, 3}};
  EXPECT_EQ(parent.mutated(1, 5).weights, parent.mutated(1, 5).weights);
  EXPECT_EQ(parent.mutated(1, 5).step, parent.mutated(1, 5).step);
  EXPECT_NE(parent.mutated(1, 5).weights, parent.mutated(1, 6).weights);
}

TEST(BrainMutation, KeepsNumbersFiniteAndStepsInTheirRange) {
  BrainGenes genes{.weights = {std::numeric_limits<float>::max(), 0}};
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    genes = genes.mutated(1e36, seed);
    ASSERT_TRUE(std::isfinite(genes.weights[0]) && std::isfinite(genes.weights[1]));
    ASSERT_GE(genes.step, BrainGenes::smallest_step);
    ASSERT_LE(genes.step, BrainGenes::largest_step);
  }
}

TEST(BrainCrossover, TakesWholeNeurons) {
  Robot robot = random_voxel_robot({.smallest = {4, 3, 3}, .largest = {4, 3, 3}}, 3);
  give_brain_per_actuator(robot, 3);
  NeuronInput edges;
  edges.from = "hidden";
  edges.edges = {{0, 1, 0.f}, {0, 3, 0.f}, {2, 2, 0.f}};
  robot.brain->layers[0].inputs.push_back(edges);
  const std::size_t count = weights_of(*robot.brain).size();
  const BrainGenes a{.weights = std::vector<float>(count, 1), .step = 0.1},
      b{.weights = std::vector<float>(count, 2), .step = 0.4};
  double from_b = 0;
  constexpr int children = 400, neurons = 5;
  for (std::uint64_t seed = 0; seed < children; ++seed) {
    const BrainGenes child = a.crossed(b, *robot.brain, seed);
    EXPECT_DOUBLE_EQ(child.step, 0.2);
    Brain brain = *robot.brain;
    set_weights(brain, child.weights);
    for (const NeuronLayer& layer : brain.layers)
      for (std::size_t neuron = 0; neuron < layer.neurons; ++neuron) {
        std::set<float> values{layer.bias[neuron]};
        for (const NeuronInput& input : layer.inputs) {
          const std::size_t width = input.weights.size() / layer.neurons;
          for (std::size_t i = 0; i < width; ++i) values.insert(input.weights[neuron * width + i]);
          for (const NeuronEdge& edge : input.edges)
            if (edge.to == neuron) values.insert(edge.weight);
        }
        ASSERT_EQ(values.size(), 1u);
        from_b += *values.begin() == 2 ? 1 : 0;
      }
  }
  EXPECT_NEAR(from_b / (children * neurons), 0.5, sigmas * 0.5 / std::sqrt(double{children * neurons}));
}

TEST(BrainPerActuator, FitsTheRobotsOfEveryGenerator) {
  for (const Generator& generator : generators()) {
    Robot robot = generator.make({}, "", 1, 0);
    const std::size_t actuators = actuators_of(robot).size();
    ASSERT_GT(actuators, 0u) << generator.kind;
    give_brain_per_actuator(robot, mean_muscle_frequency(robot));
    EXPECT_NO_THROW(validate(robot)) << generator.kind;
    EXPECT_EQ(brain_layout(robot).outputs.size(), actuators) << generator.kind;
  }
}

TEST(BrainPerActuator, HasAClockAsFastAsTheMuscles) {
  VoxelGrid grid(2, 1, 1);
  grid.cell(0, 0, 0) = 1;  // 1 rad/s
  grid.cell(1, 0, 0) = 9;  // 3 rad/s
  Robot robot = make_voxel_robot(grid);
  robot.actuators = {{"slow", {1}}, {"fast", {9}}};
  EXPECT_FLOAT_EQ(mean_muscle_frequency(robot), 2);
  EXPECT_FLOAT_EQ(mean_muscle_frequency(make_voxel_robot(VoxelGrid(1, 1, 1, bone))), 3);
}

TEST(BrainStructure, IsAllButTheWeights) {
  Robot a = random_voxel_robot({}, 3), b = random_voxel_robot({}, 4);
  EXPECT_FALSE(same_brain_structure(a, b));
  give_brain_per_actuator(a, 3);
  give_brain_per_actuator(b, 3);
  set_weights(*b.brain, random_brain_genes(*b.brain, 1).weights);
  EXPECT_TRUE(same_brain_structure(a, b));
  b.brain->layers[0].alpha = {0.5f};
  EXPECT_FALSE(same_brain_structure(a, b));
  b.brain->layers[0].alpha.clear();
  b.brain->layers[0].gate = "hidden";
  EXPECT_FALSE(same_brain_structure(a, b));
  give_brain_per_actuator(b, 4);
  EXPECT_FALSE(same_brain_structure(a, b));
}

TEST(BrainGenesAsBytes, AreCheckedWhenTheyAreRead) {
  const auto read = [](const BrainGenes& genes, std::size_t count) {
    ByteWriter writer;
    genes.write(writer);
    const std::string bytes = std::move(writer).take();
    ByteReader reader(bytes);
    return BrainGenes::read(reader, count);
  };
  const BrainGenes genes{.weights = {1.5f, -0.f, 1e-40f}, .step = 0.03};
  EXPECT_EQ(read(genes, 3).weights, genes.weights);
  EXPECT_EQ(read(genes, 3).step, genes.step);
  EXPECT_EQ(refusal([&] { read(genes, 4); }), "genome: has 3 weights, its brain 4");
  EXPECT_EQ(refusal([&] { read({.weights = {INFINITY}}, 1); }), "genome: a weight of its brain is not finite");
  for (const double step : {0.0, -1.0, 11.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(refusal([&] { read({.weights = {1}, .step = step}, 1); }),
              "genome: the step of its brain's weights is out of range");
}

}  // namespace
}  // namespace mercury
