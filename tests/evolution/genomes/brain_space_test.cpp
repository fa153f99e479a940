// SPDX-License-Identifier: Apache-2.0
// Evolution of brains: what changes, what stays, and that it finds a target. genome_space_test.cpp has what holds for
// genomes of all kinds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mercury/evolution.h"
#include "mercury/genome.h"
#include "mercury/random_voxel.h"
#include "mercury/robot_file.h"
#include "mercury/simulation.h"
#include "mercury/trials.h"
#include "mercury/voxel.h"
#include "robots/brain_genes.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

Robot thinking_robot(std::uint64_t seed = 3, float clock = 3) {
  Robot robot = random_voxel_robot({.smallest = {4, 2, 2}, .largest = {4, 2, 2}}, seed);
  give_brain_per_actuator(robot, clock);
  set_weights(*robot.brain, random_brain_genes(*robot.brain, seed).weights);
  return robot;
}

TEST(BrainSpaces, BrainAloneChangesWeightsAndNothingElse) {
  Robot founder = thinking_robot();
  founder.mass.assign(founder.masses.size(), 2);  // any robot will do
  founder.sensors.push_back({.kind = SensorKind::touch, .masses = {1, 2}});
  for (std::uint32_t neuron = 0; neuron < 4; ++neuron) {
    auto& weights = founder.brain->layers[0].inputs[0].weights;
    weights.insert(weights.begin() + 9 * neuron + 8, 0.25f);
  }
  const auto space = make_genome_space({.genes = Genes::brain, .founders = {founder}});
  EXPECT_EQ(space->random(1, 0)->grow(founder.name), founder);
  for (std::uint64_t index = 1; index < 5; ++index) {
    Robot child = space->random(1, index)->mutate(1, index)->grow(founder.name);
    EXPECT_NE(weights_of(*child.brain), weights_of(*founder.brain));
    set_weights(*child.brain, weights_of(*founder.brain));
    EXPECT_EQ(child, founder);
  }
}

TEST(BrainSpaces, SampleHunterCanEvolveInAllWays) {
  const Robot hunter = load_robot(MERCURY_HUNTER);
  for (const Genes genes : all_gene_sets()) {
    const auto space = make_genome_space({.genes = genes, .founders = {hunter}});
    const Robot first = space->random(1, 0)->grow("first");
    EXPECT_EQ(first.brain, hunter.brain) << name_of(genes);
    EXPECT_EQ(first.sensors, hunter.sensors) << name_of(genes);
    const Robot child = space->random(1, 3)->grow("child");
    EXPECT_NO_THROW(validate(child)) << name_of(genes);
    ASSERT_TRUE(child.brain) << name_of(genes);
    EXPECT_EQ(child.brain != hunter.brain, contains(genes, Genes::brain)) << name_of(genes);
    EXPECT_EQ(child.masses != hunter.masses, contains(genes, Genes::body)) << name_of(genes);
  }
}

TEST(BrainSpaces, RandomRobotsGetABrainPerActuator) {
  for (const Genes genes : {Genes::body | Genes::brain, Genes::muscles | Genes::brain, Genes::both | Genes::brain}) {
    const auto space = make_genome_space({.kind = "voxel", .genes = genes});
    const GenomePointer a = space->random(1, 0), b = space->random(1, 1);
    const Robot robot = a->grow("a");
    ASSERT_TRUE(robot.brain);
    EXPECT_TRUE(robot.brain->per_actuator);
    EXPECT_NE(weights_of(*robot.brain), weights_of(*b->grow("b").brain));
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Robot child = a->mutate(4, seed)->grow("child");
      EXPECT_EQ(child.brain.has_value(), !actuators_of(child).empty()) << seed;
    }
  }
  // Given robots without a brain as well.
  Robot founder = thinking_robot();
  founder.brain.reset();
  founder.sensors.clear();
  const auto space = make_genome_space({.genes = Genes::both | Genes::brain, .founders = {founder}});
  EXPECT_EQ(space->random(1, 0)->encode(), space->random(2, 0)->encode());
  EXPECT_TRUE(space->random(1, 0)->grow("a").brain);
}

// One of them or both, a third each.
TEST(BrainSpaces, BodiesAndBrainsTakeTurns) {
  const auto space = make_genome_space({.genes = Genes::body | Genes::brain, .founders = {thinking_robot()}});
  const GenomePointer parent = space->random(1, 0);
  const Robot before = parent->grow("robot");
  int body_alone = 0, brain_alone = 0, together = 0;
  constexpr int children = 300;
  for (std::uint64_t seed = 0; seed < children; ++seed) {
    const Robot after = parent->mutate(1, seed)->grow("robot");
    const bool body = after.springs != before.springs, brain = after.brain != before.brain;
    body_alone += body && !brain;
    brain_alone += brain && !body;
    together += body && brain;
  }
  const double spread = 4 * std::sqrt(children * 2.0 / 9);
  EXPECT_NEAR(body_alone, children / 3.0, spread);
  EXPECT_NEAR(brain_alone, children / 3.0, spread);
  EXPECT_NEAR(together, children / 3.0, spread);
}

TEST(BrainSpaces, BrainsOfOtherStructureAreNotMixed) {
  const Robot a = thinking_robot(3), b = thinking_robot(3, 5), c = thinking_robot(4);
  const auto space = make_genome_space({.genes = Genes::brain, .founders = {a, b, c}});
  const auto founder = [&](std::uint64_t i) { return space->random(1, i); };
  int mixed = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    EXPECT_EQ(founder(0)->cross(*founder(1), seed)->grow("a").brain, a.brain);
    const Robot child = founder(0)->cross(*founder(2), seed)->grow("a");
    EXPECT_EQ(child.masses, a.masses);
    mixed += child.brain != a.brain && child.brain != c.brain;
  }
  EXPECT_GT(mixed, 5);  // of 10, one in 16 of which has no or all neurons of the other parent
}

TEST(BrainSpaces, RefuseWhatHasNothingToChange) {
  const auto refused = [](const GenomeSpaceRequest& request) { return refusal([&] { make_genome_space(request); }); };
  const std::string what = "; start from sample:hunter or a file with a brain, or give body,brain or muscles,brain";
  EXPECT_EQ(refused({.kind = "voxel", .genes = Genes::brain}),
            "genes: brain alone needs robots that have one, and voxel robots have none" + what);
  Robot robot = thinking_robot(), brainless = robot;
  brainless.brain.reset();
  brainless.name = "stone";
  EXPECT_EQ(refused({.genes = Genes::brain, .founders = {robot, brainless}}),
            "genes: brain alone needs robots that have one, and robot stone has none" + what);
  for (NeuronLayer& layer : robot.brain->layers) layer.bias.clear(), layer.inputs.clear();
  EXPECT_EQ(refused({.genes = Genes::brain, .founders = {robot}}),
            "robot " + robot.name + ": its brain has no weights that could change");
}

BrainGrowth growth() { return {.brain_growth = true, .new_neurons = 0.2, .new_connections = 0.2}; }

// Of a file with sensors and actuators, its senses drive all actuators; of robots without, each actuator has a brain.
TEST(GrowingBrainSpaces, BeginWithoutHiddenNeurons) {
  Robot founder = thinking_robot();
  founder.brain.reset();
  founder.sensors = {{.kind = SensorKind::clock, .frequency = 3}, {.kind = SensorKind::target_direction}};
  for (const Genes genes : {Genes::brain, Genes::muscles | Genes::brain, Genes::body | Genes::brain}) {
    const auto space = make_genome_space({.genes = genes, .founders = {founder}, .growth = growth()});
    const Robot first = space->random(1, 0)->grow("first"), second = space->random(1, 1)->grow("second");
    ASSERT_TRUE(first.brain) << name_of(genes);
    EXPECT_EQ(first.sensors, founder.sensors);
    ASSERT_EQ(first.brain->layers.size(), 1u);
    EXPECT_EQ(first.brain->layers[0].neurons, actuators_of(founder).size());
    EXPECT_EQ(first.brain->layers[0].inputs.at(0).weights.size(), 5 * actuators_of(founder).size());
    EXPECT_NE(weights_of(*first.brain), weights_of(*second.brain));
  }
  const auto space = make_genome_space({.kind = "voxel", .genes = Genes::body | Genes::brain, .growth = growth()});
  const Robot random = space->random(1, 0)->grow("random");
  ASSERT_TRUE(random.brain && random.brain->per_actuator);
  ASSERT_EQ(random.brain->layers.size(), 1u);
  EXPECT_EQ(random.brain->layers[0].neurons, 1u);
  EXPECT_EQ(random.brain->layers[0].inputs.at(0).weights.size(), 8u);
}

// Bodies change under them, brains cross, and whatever comes of it is a robot.
TEST(GrowingBrainSpaces, ChildrenOfChangedBodiesKeepWhatTheyGrew) {
  for (const bool given : {false, true}) {
    GenomeSpaceRequest request{.kind = "voxel", .genes = Genes::both | Genes::brain, .growth = growth()};
    if (given) request.founders = {thinking_robot(3), thinking_robot(4)};
    const auto space = make_genome_space(request);
    std::vector<GenomePointer> living;
    for (std::uint64_t index = 0; index < 6; ++index) living.push_back(space->random(1, index));
    std::size_t most = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
      Random random(seed);
      const GenomePointer &a = living[random.below(6)], &b = living[random.below(6)];
      GenomePointer child = a;
      if (random.chance(0.5)) child = a->cross_by_fitness(*b, std::partial_ordering::greater, seed);
      child = child->mutate(1, seed);
      const Robot robot = child->grow("child");
      ASSERT_NO_THROW(validate(robot)) << seed;
      ASSERT_EQ(robot.brain.has_value(), !actuators_of(robot).empty()) << seed;
      if (robot.brain) most = std::max(most, robot.brain->layers.size());
      EXPECT_EQ(child->distance(*a), a->distance(*child));
      EXPECT_EQ(child->distance(*child), 0);
      living[random.below(6)] = child;
    }
    EXPECT_GT(most, 2u);
  }
}

// Brains of other senses or layers have no common markings; they are of different species.
TEST(GrowingBrainSpaces, BrainsOfOtherFramesAreNotMixed) {
  const Robot a = thinking_robot(3), b = thinking_robot(3, 5), c = thinking_robot(4);
  const auto space = make_genome_space({.genes = Genes::brain, .founders = {a, b, c}, .growth = growth()});
  const GenomePointer first = space->random(1, 0), second = space->random(1, 1), third = space->random(1, 2);
  EXPECT_EQ(first->grow("a").brain, a.brain);  // founders are as they are
  EXPECT_EQ(first->distance(*second), std::numeric_limits<double>::infinity());
  EXPECT_LT(*first->distance(*third), 2);  // only weights differ
  EXPECT_EQ(first->cross(*second, 1)->grow("a").brain, a.brain);
  EXPECT_NE(first->cross(*third, 1)->grow("a").brain, a.brain);
}

TEST(GrowingBrainSpaces, RefuseWhatCannotGrow) {
  const auto refused = [](const GenomeSpaceRequest& request) { return refusal([&] { make_genome_space(request); }); };
  Robot robot = thinking_robot(), brainless = robot, learning = robot;
  brainless.brain.reset();
  brainless.sensors.clear();
  learning.brain->per_actuator = false;
  learning.sensors = {{.kind = SensorKind::clock}};
  give_layer_of_outputs(learning);
  NeuronLayer& layer = learning.brain->layers[0];
  layer.inputs.push_back({.from = "senses", .weights = std::vector<float>(2 * layer.neurons), .rate = 0.5f});
  EXPECT_EQ(refused({.growth = growth()}), "brain_growth: brains do not change; give brain among the genes");
  EXPECT_EQ(refused({.genes = Genes::brain, .founders = {robot}, .growth = {.recurrence = 0}}),
            "recurrence: goes with brain growth alone");
  EXPECT_EQ(refused({.genes = Genes::brain, .founders = {robot}, .growth = {.brain_growth = true, .new_neurons = 2}}),
            "new_neurons: 2 is not accepted; give 0 to 1");
  EXPECT_EQ(refused({.genes = Genes::brain, .founders = {brainless}, .growth = growth()}),
            "genes: brain alone needs robots that have one or sensors, and robot " + robot.name +
                " has none; start from sample:hunter or a file with a brain, or give body,brain or muscles,brain");
  EXPECT_EQ(refused({.genes = Genes::brain, .founders = {learning}, .growth = growth()}),
            "robot " + robot.name + ": /brain/layers/0: learns while the robot lives, which brains that grow do not");
  EvolutionSettings settings;
  settings.algorithm.name = "neat";
  for (const Genes genes : {Genes::brain, Genes::body})
    EXPECT_EQ(refusal([&] { validate(settings, *make_genome_space({.genes = genes, .founders = {robot}})); }),
              "algorithm: neat divides robots into species by brains that grow; let brains grow");
  settings.algorithm.name = "cma-es";
  EXPECT_THAT(refusal([&] {
                validate(settings,
                         *make_genome_space({.genes = Genes::brain, .founders = {robot}, .growth = growth()}));
              }),
              testing::StartsWith("algorithm: cma-es needs genomes that are a fixed list of numbers"));
}

// A flat body of 10 x 2 voxels, whose sides have four muscles each. Its neurons know the time and where the target is,
// and do not move it yet.
Robot eel_without_skills() {
  VoxelGrid grid(10, 2, 1);
  for (int x = 0; x < 10; ++x)
    for (int y = 0; y < 2; ++y) grid.cell(x, y, 0) = static_cast<MaterialId>(1 + 4 * y + 2 * x / 5);
  Robot robot = make_voxel_robot(grid, {.name = "eel"});
  robot.actuators = {{"left front", {1}},  {"left 2", {2}},  {"left 3", {3}},  {"left back", {4}},
                     {"right front", {5}}, {"right 2", {6}}, {"right 3", {7}}, {"right back", {8}}};
  robot.sensors = {{.kind = SensorKind::clock, .frequency = 12}, {.kind = SensorKind::target_direction}};
  NeuronLayer motor{.name = "motor", .neurons = 8, .bias = std::vector<float>(8)};
  motor.inputs = {{.from = "senses", .weights = std::vector<float>(8 * 5)}};
  robot.brain = Brain{.layers = {motor}};
  validate(robot);
  return robot;
}

// A search for a target beside it.
EvolutionSettings search_for_a_target() {
  EvolutionSettings settings;
  settings.algorithm.name = "ga";
  settings.algorithm.population = 16;
  settings.objectives = {"-target_distance"};
  settings.trials = one_trial();
  settings.trials.seconds = 8;
  settings.configuration.environment = Ocean{};
  settings.configuration.environment.stiffness_scale = 20;  // strong muscles
  settings.configuration.environment.target = {1.5f, 0.5f, 0};
  settings.configuration.dt = 0.004;
  settings.configuration.device = {.kind = DeviceKind::cpu, .threads = 2};
  settings.generations = 20;
  return settings;
}

// Not by the quantity: through a simulation, and the mean of the positions in double precision.
double distance_after_the_trial(const Robot& robot, const EvolutionSettings& settings) {
  Simulation simulation(settings.configuration, std::span(&robot, 1));
  simulation.step(std::llround(settings.trials.seconds / settings.configuration.dt));
  double sum[3] = {};
  const State state = simulation.state(0);
  for (const Vec3& p : state.positions) {
    sum[0] += static_cast<double>(p.x);
    sum[1] += static_cast<double>(p.y);
    sum[2] += static_cast<double>(p.z);
  }
  const auto count = static_cast<double>(state.positions.size());
  const Vec3 target = settings.configuration.environment.target;
  return std::hypot(sum[0] / count - target.x, sum[1] / count - target.y, sum[2] / count - target.z);
}

TEST(BrainEvolution, BringsARobotNearerToItsTarget) {
  const Robot founder = eel_without_skills();
  const auto space = make_genome_space({.genes = Genes::brain, .founders = {founder}});
  const EvolutionSettings settings = search_for_a_target();
  const auto assessor = make_assessor(settings);
  Evolution evolution(settings, *space);
  while (evolution.advance(*assessor)) {
  }
  const Individual& best = evolution.living().front();
  const Robot champion = best.genome->grow("champion");
  const double before = distance_after_the_trial(founder, settings),
               after = distance_after_the_trial(champion, settings);
  EXPECT_NEAR(-best.score(), after, 1e-5);
  EXPECT_EQ(champion.masses, founder.masses);
  EXPECT_EQ(champion.springs, founder.springs);
  EXPECT_LT(after, before - 0.1) << before;
}

// From the bytes of the living, which is all that a run folder keeps.
void expect_to_go_on(const GenomeSpaceRequest& request, const std::string& algorithm) {
  const auto space = make_genome_space(request);
  EvolutionSettings settings = search_for_a_target();
  settings.algorithm.name = algorithm;
  settings.generations = 4;
  settings.trials.seconds = 0.4;
  settings.algorithm.crossover = 0.5;
  const auto assessor = make_assessor(settings);
  Evolution whole(settings, *space), stopped(settings, *space);
  std::vector<Individual> born;
  for (int i = 0; i < 2; ++i) {
    whole.advance(*assessor);
    std::ranges::move(stopped.advance(*assessor)->born, std::back_inserter(born));
  }
  const auto again = make_genome_space(request);
  std::vector<Individual> living = stopped.living();
  for (Individual& individual : living) individual.genome = again->decode(individual.genome->encode());
  Evolution resumed(settings, *again);
  resumed.restore(1, std::move(living), born);
  while (!whole.is_over()) {
    const std::optional<Generation> expected = whole.advance(*assessor), got = resumed.advance(*assessor);
    EXPECT_EQ(got->living, expected->living);
    ASSERT_EQ(got->born.size(), expected->born.size());
    for (std::size_t i = 0; i < got->born.size(); ++i) {
      ASSERT_EQ(got->born[i].genome->encode(), expected->born[i].genome->encode());
      ASSERT_EQ(got->born[i].parents, expected->born[i].parents);
      ASSERT_EQ(got->born[i].assessment.hash, expected->born[i].assessment.hash);  // of the final states
    }
  }
}

TEST(BrainEvolution, GoesOnBitForBitAfterItWasStopped) {
  for (const Genes genes : {Genes::brain, Genes::both | Genes::brain}) {
    GenomeSpaceRequest request{.genes = genes, .founders = {thinking_robot(3), thinking_robot(4)}};
    expect_to_go_on(request, "ga");
    request.growth = growth();
    for (const char* algorithm : {"neat", "ga"}) expect_to_go_on(request, algorithm);
  }
}

}  // namespace
}  // namespace mercury
