// SPDX-License-Identifier: Apache-2.0
// Genes of brains that grow, against the paper (Stanley and Miikkulainen 2002) and calculations by hand. What NEAT
// finds with them is in neat_test.cpp.
#include "evolution/genomes/growing_brain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>

#include "mercury/random.h"
#include "mercury/robot_file.h"
#include "mercury/simulation.h"
#include "mercury/voxel.h"
#include "robots/brain_genes.h"
#include "tests/evolution/thought.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

using testing::ElementsAre;
using testing::IsSupersetOf;
using testing::UnorderedElementsAre;

constexpr BrainGrowth splitting{.brain_growth = true, .new_neurons = 1, .new_connections = 0},
    connecting{.brain_growth = true, .new_neurons = 0, .new_connections = 1, .recurrence = 0},
    feeding_back{.brain_growth = true, .new_neurons = 0, .new_connections = 1, .recurrence = 1},
    all_at_once{.brain_growth = true, .new_neurons = 0.3, .new_connections = 0.3, .recurrence = 0.4};

// Senses and a layer of outputs: sines and cosines of clocks, and muscles.
Robot robot_with(std::size_t clocks, std::uint32_t outputs) {
  VoxelGrid grid(static_cast<int>(outputs), 1, 1);
  Robot robot;
  for (std::uint32_t i = 0; i < outputs; ++i) grid.cell(static_cast<int>(i), 0, 0) = static_cast<MaterialId>(i + 1);
  robot = make_voxel_robot(grid, {.name = "robot"});
  for (std::uint32_t i = 0; i < outputs; ++i)
    robot.actuators.push_back({std::to_string(i), {static_cast<MaterialId>(i + 1)}});
  for (std::size_t i = 0; i < clocks; ++i)
    robot.sensors.push_back({.kind = SensorKind::clock, .frequency = static_cast<float>(5 + 3 * i)});
  give_layer_of_outputs(robot);
  return robot;
}

// Senses 1, 2 and 3 and the output 4 of the paper's figure 4. Neurons 5 and 6 split 2 -> 4 and 5 -> 4.
struct Figure4 {
  Robot robot = [] {
    Robot made = make_voxel_robot(VoxelGrid(1, 1, 1, 1));
    made.sensors.assign(3, {.kind = SensorKind::depth});
    give_layer_of_outputs(made);
    return made;
  }();
  BrainFrame frame{robot};
  Marking n1 = sense_marking(0), n2 = sense_marking(1), n3 = sense_marking(2), n4 = neuron_marking(0, 0),
          n5 = split_marking(n2, n4, 0), n6 = split_marking(n5, n4, 0);
  // By innovation number.
  std::map<int, std::pair<Marking, Marking>> genes{{1, {n1, n4}}, {2, {n2, n4}}, {3, {n3, n4}}, {4, {n2, n5}},
                                                   {5, {n5, n4}}, {6, {n5, n6}}, {7, {n6, n4}}, {8, {n1, n5}},
                                                   {9, {n3, n5}}, {10, {n1, n6}}};

  GrowingBrain parent(const std::set<int>& numbers, const std::set<int>& disabled, float weight) const {
    GrowingBrain brain{.biases = {weight}, .neurons = {{n5, 0.5, weight}}};
    if (numbers.contains(6)) brain.neurons.push_back({n6, 0.75, weight});
    for (const int number : numbers) {
      const auto [from, to] = genes.at(number);
      brain.connections.emplace_back(from, to, weight, !disabled.contains(number));
    }
    std::ranges::sort(brain.neurons, {}, &NeuronGene::marking);
    std::ranges::sort(brain.connections, {}, &ConnectionGene::marking);
    return brain;
  }
  GrowingBrain first = parent({1, 2, 3, 4, 5, 8}, {2}, 1), second = parent({1, 2, 3, 4, 5, 6, 7, 9, 10}, {2, 5}, 2);

  std::set<int> numbers_of(const GrowingBrain& brain) const {
    std::set<int> numbers;
    for (const auto& [number, ends] : genes)
      for (const ConnectionGene& gene : brain.connections)
        if (gene.from == ends.first && gene.to == ends.second) numbers.insert(number);
    EXPECT_EQ(numbers.size(), brain.connections.size());
    return numbers;
  }
  const ConnectionGene& gene(const GrowingBrain& brain, int number) const {
    return *std::ranges::find(brain.connections, connection_marking(genes.at(number).first, genes.at(number).second),
                              &ConnectionGene::marking);
  }
};

TEST(GrowingBrains, CrossAsInFigure4) {
  const Figure4 figure;
  std::map<std::set<int>, int> children;
  int off[11] = {}, from_second = 0;
  constexpr int runs = 4000;
  for (std::uint64_t seed = 0; seed < runs; ++seed) {
    const GrowingBrain child = figure.first.crossed(figure.second, std::partial_ordering::equivalent, seed);
    const std::set<int> numbers = figure.numbers_of(child);
    EXPECT_THAT(numbers, IsSupersetOf({1, 2, 3, 4, 5}));
    ++children[numbers];
    for (const int number : {1, 2, 5}) off[number] += !figure.gene(child, number).enabled;
    from_second += figure.gene(child, 3).weight == 2;
    Robot grown = figure.robot;
    grown.brain = child.grown(figure.frame);
    EXPECT_NO_THROW(validate(grown)) << seed;
  }
  // Genes that one parent has alone are inherited at random: all ten in one of 32 children, as in the figure.
  EXPECT_EQ(children.size(), 32u);
  const double spread = 4 * std::sqrt(runs * 0.25);
  EXPECT_NEAR((children[{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}]), runs / 32.0, 4 * std::sqrt(runs / 32.0));
  EXPECT_NEAR(from_second, runs / 2.0, spread);
  EXPECT_EQ(off[1], 0);
  EXPECT_NEAR(off[2], runs * 0.75, spread);
  EXPECT_NEAR(off[5], runs * 0.75, spread);
}

TEST(GrowingBrains, TakeWhatOnlyOneParentHasFromTheFitterOne) {
  const Figure4 figure;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto numbers = [&](std::partial_ordering fitness) {
      return figure.numbers_of(figure.first.crossed(figure.second, fitness, seed));
    };
    EXPECT_EQ(numbers(std::partial_ordering::greater), (std::set{1, 2, 3, 4, 5, 8}));
    EXPECT_EQ(numbers(std::partial_ordering::less), (std::set{1, 2, 3, 4, 5, 6, 7, 9, 10}));
  }
}

// Of figure 4's parents, five connections are of one parent alone, 8 and 6, 7, 9, 10; the weights of the five others
// and the biases of neurons 4 and 5 differ by 1, but for connection 3, by 4.5: (6 * 1 + 4.5) / 7 = 1.5.
TEST(GrowingBrains, HaveTheDistanceOfThePaper) {
  const Figure4 figure;
  GrowingBrain second = figure.second;
  for (ConnectionGene& gene : second.connections)
    if (gene.from == figure.n3 && gene.to == figure.n4) gene.weight = 5.5f;
  EXPECT_DOUBLE_EQ(figure.first.distance(second), 5 + 0.4 * 1.5);
  EXPECT_DOUBLE_EQ(second.distance(figure.first), 5 + 0.4 * 1.5);
  EXPECT_EQ(second.distance(second), 0);
}

TEST(GrowingBrains, BeginWithConnectionsFromSensesToOutputs) {
  const Robot robot = robot_with(2, 3);
  const BrainFrame frame(robot);
  const GrowingBrain all = GrowingBrain::minimal(frame, {}, 1);
  EXPECT_EQ(all.connections.size(), 12u);
  EXPECT_TRUE(all.neurons.empty());
  const Brain brain = all.grown(frame);
  ASSERT_EQ(brain.layers.size(), 1u);
  EXPECT_EQ(brain.layers[0].inputs.at(0).weights.size(), 12u);
  // A share of them, and at least one each.
  double connections = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const GrowingBrain few = GrowingBrain::minimal(frame, {.first_connections = 0.5}, seed);
    std::set<Marking> connected;
    for (const ConnectionGene& gene : few.connections) connected.insert(gene.to);
    EXPECT_EQ(connected.size(), 3u);
    connections += static_cast<double>(few.connections.size());
  }
  EXPECT_NEAR(connections / 300, 3 * (1 + 0.5 * 3), 0.5);
  EXPECT_EQ(GrowingBrain::minimal(frame, {.first_connections = 0}, 1).connections.size(), 3u);
}

// The connection is turned off; the new one into the neuron has the weight 1, the one out of it the old weight.
TEST(GrowingBrains, SplitAConnectionByANeuronHalfwayBetween) {
  const Robot robot = robot_with(2, 2);
  const BrainFrame frame(robot);
  const GrowingBrain parent = GrowingBrain::minimal(frame, {}, 1);
  std::set<Marking> split;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const GrowingBrain child = parent.mutated(frame, splitting, 1, seed);
    ASSERT_EQ(child.neurons.size(), 1u);
    ASSERT_EQ(child.connections.size(), parent.connections.size() + 2);
    const NeuronGene neuron = child.neurons[0];
    EXPECT_EQ(neuron.depth, 0.5);
    EXPECT_EQ(neuron.bias, 0);
    const auto off = std::ranges::find(child.connections, false, &ConnectionGene::enabled);
    const auto in = std::ranges::find(child.connections, neuron.marking, &ConnectionGene::to);
    const auto out = std::ranges::find(child.connections, neuron.marking, &ConnectionGene::from);
    EXPECT_EQ(std::ranges::count(child.connections, false, &ConnectionGene::enabled), 1);
    EXPECT_EQ(std::pair(in->from, out->to), std::pair(off->from, off->to));
    EXPECT_EQ(in->weight, 1);
    EXPECT_EQ(out->weight, off->weight);
    split.insert(off->marking);
    const Brain brain = child.grown(frame);
    ASSERT_EQ(brain.layers.size(), 2u);
    EXPECT_EQ(brain.layers[0].name, "grown 1");
  }
  EXPECT_EQ(split.size(), parent.connections.size());
}

// Whatever the order and whoever else was changed: 60 children in two generations that split two of eight connections.
TEST(GrowingBrains, HaveTheSameMarkingForTheSameChange) {
  const Robot robot = robot_with(2, 2);
  const BrainFrame frame(robot);
  const GrowingBrain a = GrowingBrain::minimal(frame, {}, 1), b = GrowingBrain::minimal(frame, {}, 2);
  using Changes = std::set<std::pair<Marking, Marking>>;  // what was split
  std::map<Changes, std::vector<Marking>> neurons;
  std::map<Changes, int> found;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    const GrowingBrain child =
        (seed % 2 ? a : b).mutated(frame, splitting, 1, seed).mutated(frame, splitting, 1, seed + 1000);
    Changes changes;
    for (const ConnectionGene& gene : child.connections)
      if (!gene.enabled) changes.insert({gene.from, gene.to});
    std::vector<Marking> markings;
    for (const NeuronGene& gene : child.neurons) markings.push_back(gene.marking);
    const auto [at, is_new] = neurons.emplace(changes, markings);
    EXPECT_EQ(at->second, markings);
    ++found[changes];
  }
  EXPECT_EQ(std::ranges::count_if(found, [](const auto& each) { return each.second > 1; }),
            static_cast<std::ptrdiff_t>(found.size()));
  EXPECT_GE(found.size(), 28u);  // pairs of eight, and one and a half of it
  // Of other changes, other markings.
  std::set<std::vector<Marking>> different;
  for (const auto& [changes, markings] : neurons) different.insert(markings);
  EXPECT_EQ(different.size(), neurons.size());
}

// A connection that was turned on again can be split again: by another neuron.
TEST(GrowingBrains, SplitAConnectionAgainByAnotherNeuron) {
  Figure4 figure;
  GrowingBrain brain{.biases = {0}};
  brain.connections.emplace_back(figure.n2, figure.n4, 3.f);
  for (int times = 0; times < 3; ++times) {
    for (ConnectionGene& gene : brain.connections) gene.enabled = gene.from == figure.n2 && gene.to == figure.n4;
    brain = brain.mutated(figure.frame, splitting, 1, 1);
  }
  std::vector<Marking> markings;
  for (const NeuronGene& neuron : brain.neurons) markings.push_back(neuron.marking);
  EXPECT_THAT(markings, UnorderedElementsAre(figure.n5, split_marking(figure.n2, figure.n4, 1),
                                             split_marking(figure.n2, figure.n4, 2)));
}

TEST(GrowingBrains, AddConnectionsThatLeadDeeperOrFeedBack) {
  const Robot robot = robot_with(1, 2);
  const BrainFrame frame(robot);
  const GrowingBrain parent = GrowingBrain::minimal(frame, {.first_connections = 0}, 1).mutated(frame, splitting, 1, 1);
  const auto depth_of = [&](Marking marking) {
    if (marking == parent.neurons[0].marking) return 0.5;
    return marking == frame.neuron(0) || marking == frame.neuron(1) ? 1.0 : 0.0;
  };
  std::set<Marking> forward, back;
  for (std::uint64_t seed = 0; seed < 200; ++seed)
    for (const bool feeds_back : {false, true}) {
      const GrowingBrain child = parent.mutated(frame, feeds_back ? feeding_back : connecting, 1, seed);
      for (const ConnectionGene& gene : child.connections) {
        if (std::ranges::count(parent.connections, gene.marking, &ConnectionGene::marking)) continue;
        EXPECT_EQ(depth_of(gene.from) >= depth_of(gene.to), feeds_back);
        (feeds_back ? back : forward).insert(gene.marking);
      }
    }
  // Of 2 senses, 1 neuron and 2 outputs, 2 * 3 + 2 connections lead deeper, 4 of which are there already; 3 * 3 - 2
  // connections of neurons do not.
  EXPECT_EQ(forward.size(), 4u);
  EXPECT_EQ(back.size(), 7u);
}

// Neurons of a simulation are those of the equation, thought by thought.
TEST(GrowingBrains, ThinkAsTheirDepthsSay) {
  Robot robot = robot_with(2, 3);
  const BrainFrame frame(robot);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    GrowingBrain genes = GrowingBrain::minimal(frame, {}, seed);
    for (std::uint64_t step = 0; step < 60; ++step) genes = genes.mutated(frame, all_at_once, 1, seed_of(seed, step));
    robot.brain = genes.grown(frame);
    ASSERT_GT(robot.brain->layers.size(), 3u);
    EXPECT_TRUE(std::ranges::any_of(robot.brain->layers, [&](const NeuronLayer& layer) {
      return std::ranges::any_of(layer.inputs, [&](const NeuronInput& input) { return input.from == layer.name; });
    }));
    Simulation simulation({.device = {.kind = DeviceKind::cpu}}, {&robot, 1});
    Thought thought(*robot.brain);
    for (int i = 0; i < 40; ++i) {
      simulation.step(i == 0 ? 1 : 20);
      const BrainState state = simulation.brain_state(0);
      thought.think({state.senses.begin(), state.senses.end()});
      std::size_t next = 0;
      for (const NeuronLayer& layer : robot.brain->layers)
        for (const double neuron : thought.state(layer.name))
          ASSERT_NEAR(static_cast<double>(state.neurons[next++]), neuron, 1e-3) << i;
    }
  }
}

// Whatever happens to it.
TEST(GrowingBrains, AreAlwaysValidBrainsThatReadBack) {
  const Robot robot = robot_with(2, 3);
  Robot of_actuators = robot;
  give_brain_per_actuator(of_actuators, 3);
  for (const Robot& founder : {robot, of_actuators, load_robot(MERCURY_HUNTER)}) {
    const BrainFrame frame(founder);
    std::vector<GrowingBrain> living{GrowingBrain::of(frame, *founder.brain), GrowingBrain::minimal(frame, {}, 1)};
    for (std::uint64_t seed = 0; seed < 1500; ++seed) {
      Random random(seed);
      const GrowingBrain& parent = living[random.below(living.size())];
      const GrowingBrain& mate = living[random.below(living.size())];
      const auto fitness = random.chance(0.5) ? std::partial_ordering::greater : std::partial_ordering::unordered;
      const GrowingBrain child = (random.chance(0.3) ? parent.crossed(mate, fitness, seed) : parent)
                                     .mutated(frame, all_at_once, random.uniform(0.1, 3), seed);
      Robot grown = founder;
      grown.brain = child.grown(frame);
      ASSERT_NO_THROW(validate(grown)) << seed;
      ByteWriter writer;
      child.write(writer, frame);
      ByteReader reader(writer.bytes());
      ASSERT_EQ(GrowingBrain::read(reader, frame), child) << seed;
      ASSERT_TRUE(reader.is_at_end());
      EXPECT_GE(child.distance(parent), 0);
      EXPECT_DOUBLE_EQ(child.distance(mate), mate.distance(child));
      living.push_back(child);
      if (living.size() > 20) living.erase(living.begin() + static_cast<std::ptrdiff_t>(random.below(20)));
    }
    const auto most = std::ranges::max(living, {}, [](const GrowingBrain& brain) { return brain.neurons.size(); });
    EXPECT_GT(most.neurons.size(), 20u);
  }
}

TEST(GrowingBrains, StopGrowingBeforeABrainHasTooManyLayers) {
  const Robot robot = robot_with(1, 1);
  const BrainFrame frame(robot);
  GrowingBrain genes = GrowingBrain::minimal(frame, {}, 1);
  for (std::uint64_t seed = 0; seed < 400; ++seed) genes = genes.mutated(frame, splitting, 1, seed);
  EXPECT_EQ(genes.neurons.size(), GrowingBrain::most_grown);
  Robot grown = robot;
  grown.brain = genes.grown(frame);
  EXPECT_NO_THROW(validate(grown));
}

TEST(GrowingBrains, LeaveOutNeuronsThatLeadNowhere) {
  Figure4 figure;
  GrowingBrain brain = figure.first;
  const auto hidden = [&] { return brain.grown(figure.frame).layers.size() - 1; };
  EXPECT_EQ(hidden(), 1u);
  for (ConnectionGene& gene : brain.connections)
    if (gene.from == figure.n5) gene.enabled = false;
  EXPECT_EQ(hidden(), 0u);
}

TEST(GrowingBrains, BeginAsTheGivenBrainIs) {
  const Robot hunter = load_robot(MERCURY_HUNTER);
  const BrainFrame frame(hunter);
  EXPECT_EQ(GrowingBrain::of(frame, *hunter.brain).grown(frame), *hunter.brain);
}

// A robot that grew before has layers of that name.
TEST(GrowingBrains, GrowAgainFromAFile) {
  Robot robot = robot_with(1, 1);
  for (int times = 0; times < 3; ++times) {
    const BrainFrame frame(robot);
    robot.brain = GrowingBrain::of(frame, *robot.brain)
                      .mutated(frame, connecting, 1, 1)
                      .mutated(frame, splitting, 1, 2)
                      .grown(frame);
    ASSERT_NO_THROW(validate(robot));
  }
  std::vector<std::string> names;
  for (const NeuronLayer& layer : robot.brain->layers) names.push_back(layer.name);
  EXPECT_THAT(names, testing::Contains("regrown 1"));
}

TEST(GrowingBrains, KeepGates) {
  Robot robot = robot_with(2, 2);
  NeuronLayer gate = robot.brain->layers.back();
  gate.name = "gate";
  gate.activation = Activation::sigmoid;
  robot.brain->layers.insert(robot.brain->layers.begin(), gate);
  robot.brain->layers.back().gate = "gate";
  const BrainFrame frame(robot);
  GrowingBrain genes = GrowingBrain::of(frame, *robot.brain);
  for (std::uint64_t seed = 0; seed < 60; ++seed) genes = genes.mutated(frame, all_at_once, 1, seed);
  robot.brain = genes.grown(frame);
  EXPECT_NO_THROW(validate(robot));
  EXPECT_GT(robot.brain->layers.size(), 2u);
  EXPECT_EQ(robot.brain->layers.back().gate, "gate");
}

TEST(GrowingBrains, RefuseBrainsThatTheyCannotBe) {
  Robot robot = robot_with(1, 2);
  robot.brain->layers[0].inputs.push_back({.from = "senses", .weights = {1, 2, 3, 4}, .rate = 0.1f});
  validate(robot);
  EXPECT_EQ(refusal([&] { BrainFrame{robot}; }),
            "/brain/layers/0: learns while the robot lives, which brains that grow do not");
  robot.brain->layers[0].inputs.clear();
  for (int i = 0; i < 127; ++i)
    robot.brain->layers.insert(robot.brain->layers.begin(), {.name = std::to_string(i), .neurons = 1});
  EXPECT_EQ(refusal([&] { BrainFrame{robot}; }),
            "/brain/layers: 128 layers; brains that grow have at most 127 at first");
}

}  // namespace
}  // namespace mercury
