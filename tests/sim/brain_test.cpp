// SPDX-License-Identifier: Apache-2.0
// Senses and brains: the equation against float64, and what holds for any batch.
#include "mercury/brain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "bodies.h"
#include "shared_batch.h"
#include "sim/physics/brain_plan.h"
#include "tests/refusal.h"
#include "thinkers.h"

namespace mercury {
namespace {

using test::bar;
using test::gated;
using test::lstm;
using test::matrix;
using test::SharedBatch;
using test::thinker;

class BrainOn : public test::SharedBatchTest {};
INSTANTIATE_TEST_SUITE_P(All, BrainOn, test::every_backend, test::SharedBatchTest::name);

constexpr float dt = 1e-3f;

std::vector<float> drives(SharedBatch& batch) { return batch.read(batch->actuation().drive); }

// Layers of doubles: what mercury/brain.h says, from the senses that the batch sampled.
struct BrainInDoubles {
  const Robot& robot;
  std::vector<std::vector<double>> y;

  explicit BrainInDoubles(const Robot& of) : robot(of) {
    for (const NeuronLayer& layer : robot.brain->layers) y.emplace_back(layer.neurons, 0.0);
  }
  const std::vector<double>& of(const std::string& name) const {
    const auto& layers = robot.brain->layers;
    return y[static_cast<std::size_t>(std::ranges::find(layers, name, &NeuronLayer::name) - layers.begin())];
  }
  static double act(Activation activation, double sum) {
    if (activation == Activation::linear) return sum;
    return activation == Activation::sigmoid ? 1 / (1 + std::exp(-sum)) : std::tanh(sum);
  }
  void think(std::span<const float> senses) {
    const auto& layers = robot.brain->layers;
    for (std::size_t l = 0; l < layers.size(); ++l) {
      std::vector<double> next = y[l];
      for (std::size_t i = 0; i < layers[l].neurons; ++i) {
        double sum = layers[l].bias.empty() ? 0.0 : static_cast<double>(layers[l].bias[i]);
        for (const NeuronInput& input : layers[l].inputs) {
          std::vector<double> z(senses.begin(), senses.end());
          for (std::size_t k = 0; k < layers.size(); ++k)
            if (layers[k].name == input.from) z = y[k];
          for (std::size_t k = 0; k < z.size() && input.edges.empty(); ++k)
            sum += static_cast<double>(input.weights[i * z.size() + k]) * z[k];
          for (const NeuronEdge& edge : input.edges)
            if (edge.to == i) sum += static_cast<double>(edge.weight) * z[edge.from];
        }
        const auto number = [&](const std::vector<float>& all) {
          return static_cast<double>(all[all.size() == 1 ? 0 : i]);
        };
        const double g = !layers[l].gate.empty()    ? of(layers[l].gate)[i]
                         : !layers[l].alpha.empty() ? number(layers[l].alpha)
                                                    : 1;
        const double k = !layers[l].keep_layer.empty() ? of(layers[l].keep_layer)[i]
                         : !layers[l].keep.empty()     ? number(layers[l].keep)
                                                       : 1 - g;
        next[i] = k * y[l][i] + g * act(layers[l].activation, sum);
      }
      y[l] = next;
    }
  }
};

TEST_P(BrainOn, LeavesADriveAloneThatIsHeld) {
  const Robot robot = thinker();
  SharedBatch batch = this->batch({.dt = dt, .environment = Ocean{}}, std::span(&robot, 1));
  const HeldDrive held{.robot = 0, .actuator = 1, .drive = 0.25f};
  batch->hold_drives(std::span(&held, 1));
  batch->step(60);
  const std::vector<float> neurons = batch->brain_state(0).neurons;
  EXPECT_EQ(drives(batch)[0], neurons[3]);
  EXPECT_EQ(drives(batch)[1], 0.25f);
  EXPECT_NE(neurons[4], 0.25f);
  batch->hold_drives({});
  batch->step(60);
  EXPECT_EQ(drives(batch)[1], batch->brain_state(0).neurons[4]);
}

TEST_P(BrainOn, GoesOnFromTheStateOfOneRobotBitForBit) {
  const std::vector<Robot> robots(2, thinker());
  const Configuration configuration{.dt = dt, .environment = Ocean{}};
  SharedBatch first = this->batch(configuration, robots);
  first->set_target(1, Vec3{1, 2, 3});
  first->step(50);
  const State state = first->state(1);
  EXPECT_EQ(state.brain, first->brain_state(1));
  SharedBatch other = this->batch(configuration, robots);
  other->set_clock(first->clock());
  other->set_target(0, Vec3{1, 2, 3});
  other->set_state(0, state);
  first->step(70);
  other->step(70);
  EXPECT_EQ(other->hash(0), first->hash(1));
  EXPECT_EQ(other->brain_state(0), first->brain_state(1));
  State wrong = state;
  wrong.brain.neurons.pop_back();
  const std::uint64_t before = other->hash(0);
  EXPECT_THROW(other->set_state(0, wrong), std::invalid_argument);
  EXPECT_EQ(other->hash(0), before);
}

TEST_P(BrainOn, ThinksAsTheEquationSays) {
  for (const Robot& robot : {thinker(), lstm(), gated()}) {
    SharedBatch batch = this->batch({.dt = dt, .environment = Ocean{}}, std::span(&robot, 1));
    batch->set_target(0, Vec3{1, 2, 3});
    BrainInDoubles reference(robot);
    for (int thought = 0; thought < 100; ++thought) {
      batch->step(20);
      const BrainState state = batch->brain_state(0);
      ASSERT_EQ(state.thoughts, static_cast<std::uint64_t>(thought + 1));
      reference.think(state.senses);
      std::size_t neuron = 0;
      for (const std::vector<double>& layer : reference.y)
        for (const double y : layer) EXPECT_NEAR(state.neurons[neuron++], y, 2e-6);
      for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(drives(batch)[i], state.neurons[neuron - 2 + i]);
    }
    for (const std::vector<double>& layer : reference.y) EXPECT_GT(std::abs(layer[0]), 0.01);
  }
}

// The equations as Gers, Schmidhuber and Cummins 2000 and PyTorch have them.
TEST_P(BrainOn, AnLstmIsFiveLayers) {
  const Robot robot = lstm();
  SharedBatch batch = this->batch({.dt = dt, .environment = Ocean{}}, std::span(&robot, 1));
  using Cells = std::array<double, 3>;
  Cells c{}, h{};
  for (int thought = 0; thought < 50; ++thought) {
    batch->step(20);
    const BrainState state = batch->brain_state(0);
    const auto sums = [&](std::size_t l) {
      const NeuronLayer& layer = robot.brain->layers[l];
      Cells all{};
      for (std::size_t i = 0; i < 3; ++i) {
        all[i] = static_cast<double>(layer.bias[i]);
        for (std::size_t k = 0; k < 7; ++k)
          all[i] += static_cast<double>(layer.inputs[0].weights[7 * i + k]) * static_cast<double>(state.senses[k]);
        for (std::size_t k = 0; k < 3; ++k) all[i] += static_cast<double>(layer.inputs[1].weights[3 * i + k]) * h[k];
      }
      return all;
    };
    const auto sigmoid = [](double x) { return 1 / (1 + std::exp(-x)); };
    const Cells i = sums(0), f = sums(1), o = sums(2), g = sums(3);
    for (std::size_t k = 0; k < 3; ++k) {
      c[k] = sigmoid(f[k]) * c[k] + sigmoid(i[k]) * std::tanh(g[k]);
      h[k] = sigmoid(o[k]) * std::tanh(c[k]);
      EXPECT_NEAR(state.neurons[9 + k], c[k], 2e-6);
      EXPECT_NEAR(state.neurons[12 + k], h[k], 2e-6);
    }
  }
  EXPECT_GT(std::abs(c[0]), 0.1);
}

TEST_P(BrainOn, HeldGatesHoldWhatACellKeeps) {
  const Robot robot = lstm();
  SharedBatch batch = this->batch({.dt = dt, .environment = Ocean{}}, std::span(&robot, 1));
  batch->step(200);
  const std::vector<float> before = batch->brain_state(0).neurons;
  batch->clamp_neuron(0, 0, 0.0f);  // input
  batch->clamp_neuron(0, 3, 1.0f);  // forget
  batch->clamp_neuron(0, 7, 0.0f);  // output of another cell
  batch->step(200);
  const std::vector<float> after = batch->brain_state(0).neurons;
  EXPECT_EQ(after[9], before[9]);
  EXPECT_NE(after[10], before[10]);
  EXPECT_EQ(after[13], 0.0f);
}

// Copies of an LSTM, each with its own state, beside the CPU backend.
TEST_P(BrainOn, GatesAsTheCpuDoes) {
  Robot robot = bodies::random_voxels({.x = 3, .y = 2, .z = 2}, 8);
  const std::size_t actuators = actuators_of(robot).size();
  ASSERT_GT(actuators, 3u);
  robot.sensors = {{.kind = SensorKind::strain, .actuator = "self", .gain = 5},
                   {.kind = SensorKind::clock, .frequency = 4}};
  Brain& brain = robot.brain.emplace();
  brain.per_actuator = true;
  const auto layer = [](const char* name, Activation activation, float bias) {
    NeuronLayer made{.name = name, .neurons = 1, .activation = activation, .alpha = {}, .bias = {bias}};
    made.inputs = {matrix("senses", {0.5f, bias, -0.7f}), matrix("motor", {2 * bias})};
    return made;
  };
  NeuronLayer cell = layer("cell", Activation::tanh, 0.2f);
  cell.gate = "input", cell.keep_layer = "forget";
  NeuronLayer motor{.name = "motor", .neurons = 1, .gate = "output", .keep = {0}};
  motor.inputs = {matrix("cell", {1})};
  brain.layers = {layer("input", Activation::sigmoid, 0.1f), layer("forget", Activation::sigmoid, 0.8f),
                  layer("output", Activation::sigmoid, -0.3f), cell, motor};
  std::vector<Robot> robots{robot, lstm(), thinker(), gated()};
  const Configuration configuration{.dt = dt, .environment = Ocean{}};
  SharedBatch batch = this->batch(configuration, robots);
  Simulation cpu({.dt = dt, .environment = Ocean{}, .device = {.kind = DeviceKind::cpu}}, robots);
  for (int thought = 0; thought < 20; ++thought) {
    for (std::size_t i = 0; i < robots.size(); ++i) batch->set_state(i, cpu.state(i));
    batch->step(20);
    cpu.step(20);
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const std::vector<float> got = batch->brain_state(i).neurons, expected = cpu.brain_state(i).neurons;
      ASSERT_EQ(got.size(), expected.size());
      for (std::size_t k = 0; k < got.size(); ++k) EXPECT_NEAR(got[k], expected[k], 2e-6) << i << ' ' << k;
    }
  }
  const std::vector<float> copies = cpu.brain_state(0).neurons;
  EXPECT_NE(copies[0], copies[1]);  // their muscles differ
}

// y += alpha (act - y), written with both factors.
TEST_P(BrainOn, ConstantGatesAreAnAlpha) {
  Robot robot = thinker();
  robot.brain->layers[1].keep = {0.5f};
  const std::vector<Robot> robots{robot, thinker()};
  SharedBatch batch = this->batch({.dt = dt, .environment = Ocean{}}, robots);
  for (int thought = 0; thought < 10; ++thought) {
    batch->step(20);
    const std::vector<float> with = batch->brain_state(0).neurons, without = batch->brain_state(1).neurons;
    for (std::size_t i = 0; i < with.size(); ++i) EXPECT_NEAR(with[i], without[i], 2e-6);
  }
}

TEST_P(BrainOn, ThinksEveryPeriodWhateverTheTimeStep) {
  Robot robot = thinker();
  robot.brain->period = 0.01f;
  for (const double step : {1e-3, 5e-4, 2.5e-3}) {
    SharedBatch batch = this->batch({.dt = step, .environment = Ocean{}}, std::span(&robot, 1));
    batch->step(std::lround(0.1 / step));
    EXPECT_EQ(batch->brain_state(0).thoughts, 10u);
  }
}

TEST_P(BrainOn, MovesTheRobotAsDrivesFromOutsideDo) {
  const Robot robot = thinker();
  Robot without = robot;
  without.sensors.clear();
  without.brain.reset();
  SharedBatch thinking = this->batch({.dt = dt, .environment = Ocean{}}, std::span(&robot, 1));
  SharedBatch driven = this->batch({.dt = dt, .environment = Ocean{}}, std::span(&without, 1));
  for (int i = 0; i < 20; ++i) {
    thinking->step(20);
    const std::vector<float> u = drives(thinking);
    driven.write(driven->actuation().drive, u);
    driven->step(20);
    ASSERT_EQ(thinking->hash(0), driven->hash(0));
  }
}

TEST_P(BrainOn, IsTheSameAloneAndInAnyBatchAndHoweverStepsAreDivided) {
  Robot slow = thinker();
  slow.brain->period = 0.033f;
  const Robot still = bodies::random_voxels({.x = 3, .y = 2, .z = 2}, 5);
  const std::vector<Robot> robots{still, thinker(), slow, lstm(), thinker(), gated(), still};
  const Configuration configuration{.dt = dt, .environment = Land{}};
  SharedBatch all = this->batch(configuration, robots);
  for (const std::int64_t steps : {1, 19, 20, 7, 53}) all->step(steps);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    SharedBatch alone = this->batch(configuration, std::span(&robots[i], 1));
    (void)alone->step_and_sample(100, 25);
    EXPECT_EQ(alone->hash(0), all->hash(i)) << i;
    EXPECT_EQ(alone->brain_state(0), all->brain_state(i)) << i;
  }
}

TEST_P(BrainOn, GoesOnBitForBitFromASavedState) {
  Robot robot = thinker();
  robot.sensors[1].delay = 0.1f;
  robot.sensors[2].noise = 0.1f;
  robot.brain->layers[0].inputs[0].rate = 0.01f;
  const std::vector<Robot> robots{robot, thinker(), bar(), lstm(), gated()};
  SharedBatch batch = this->batch({.dt = dt, .environment = Ocean{}}, robots);
  batch->step(133);
  const BatchState saved = batch->save();
  batch->step(200);
  const std::vector<std::uint64_t> hashes = batch->hashes();
  batch->restore(saved);
  batch->step(200);
  EXPECT_EQ(batch->hashes(), hashes);

  SharedBatch other = this->batch({.dt = dt, .environment = Ocean{}}, robots);
  other->restore(saved);
  other->step(200);
  EXPECT_EQ(other->hashes(), hashes);
  BatchState wrong = saved;
  wrong.brains[0].neurons.pop_back();
  EXPECT_THROW(other->restore(wrong), std::invalid_argument);
}

TEST_P(BrainOn, ResetBeginsFromScratchAndKeepsWeights) {
  const std::vector<Robot> robots{thinker(), thinker()};
  SharedBatch batch = this->batch({.dt = dt, .environment = Ocean{}}, robots);
  std::vector<float> weights = weights_of(*robots[0].brain);
  for (float& weight : weights) weight = -weight;
  batch->set_brain_weights(0, weights);
  batch->step(200);
  const std::vector<std::uint64_t> hashes = batch->hashes();
  EXPECT_NE(hashes[0], hashes[1]);
  batch->reset();
  batch->step(200);
  EXPECT_EQ(batch->hashes(), hashes);
  EXPECT_THROW(batch->set_brain_weights(0, std::span(weights).first(5)), std::invalid_argument);

  Robot changed = thinker();
  set_weights(*changed.brain, weights);
  SharedBatch other = this->batch({.dt = dt, .environment = Ocean{}}, std::span(&changed, 1));
  other->step(200);
  EXPECT_EQ(other->hash(0), hashes[0]);
}

TEST_P(BrainOn, KeepsItsBrainAsRobotsComeAndGo) {
  const std::vector<Robot> robots{bar(), thinker(), thinker()};
  SharedBatch batch = this->batch({.dt = dt, .environment = Ocean{}}, robots);
  SharedBatch alone = this->batch({.dt = dt, .environment = Ocean{}}, std::span(&robots[1], 1));
  batch->step(50);
  const std::size_t kept[] = {2};
  batch->keep(kept);
  batch->step(50);
  batch->add(robots[0]);
  batch->step(50);
  alone->step(150);
  EXPECT_EQ(batch->hash(0), alone->hash(0));
}

TEST_P(BrainOn, HasSensesInTheBodysFrame) {
  Robot robot = bodies::random_voxels({.x = 3, .y = 2, .z = 1}, 3);
  robot.sensors = {
      {.kind = SensorKind::velocity},        {.kind = SensorKind::turn_rate}, {.kind = SensorKind::up},
      {.kind = SensorKind::depth},           {.kind = SensorKind::height},    {.kind = SensorKind::target_direction},
      {.kind = SensorKind::target_distance}, {.kind = SensorKind::light},     {.kind = SensorKind::flow}};
  Brain& brain = robot.brain.emplace();
  const auto actuators = static_cast<std::uint32_t>(actuators_of(robot).size());
  brain.layers = {{.name = "all", .neurons = actuators, .alpha = {}, .bias = {}, .inputs = {}}};
  const std::array<Vec3, 3> rows = bodies::random_rotation(4);
  const auto turned = [&](Vec3 x) { return Vec3{dot(rows[0], x), dot(rows[1], x), dot(rows[2], x)}; };
  const auto turned_back = [&](Vec3 x) { return x.x * rows[0] + x.y * rows[1] + x.z * rows[2]; };

  // The rest shape turned about its center, at a place, with a velocity and a turn rate.
  Vec3 center;
  for (const Vec3& x : robot.masses) center += (1.0f / static_cast<float>(robot.masses.size())) * x;
  const Vec3 place{1, -2, 0.5f}, v{0.3f, -0.1f, 0.2f}, omega{0.5f, 1, -2};
  State state;
  for (const Vec3& x : robot.masses) {
    state.positions.push_back(place + turned(x - center));
    state.velocities.push_back(v + cross(omega, turned(x - center)));
  }
  Ocean ocean{.flow = {0.1f, 0, 0}};
  Environment environment = ocean;
  environment.light = {1, -2, 2.5f};
  environment.target = {4, -2, 4.5f};
  SharedBatch batch = this->batch({.dt = dt, .environment = environment}, std::span(&robot, 1));
  batch->set_state(0, state);
  batch->step(1);
  const std::vector<float> senses = batch->brain_state(0).senses;
  const auto expect_vector = [&](std::size_t first, Vec3 expected) {
    EXPECT_NEAR(senses[first], expected.x, 3e-6);
    EXPECT_NEAR(senses[first + 1], expected.y, 3e-6);
    EXPECT_NEAR(senses[first + 2], expected.z, 3e-6);
  };
  expect_vector(0, turned_back(v));
  expect_vector(3, turned_back(omega));
  expect_vector(6, turned_back({0, 0, 1}));
  EXPECT_NEAR(senses[9], -0.5, 1e-6);
  EXPECT_NEAR(senses[10], 0.5, 1e-6);
  expect_vector(11, turned_back(0.2f * Vec3{3, 0, 4}));
  EXPECT_NEAR(senses[14], 5, 1e-5);
  EXPECT_NEAR(senses[15], 0.2, 1e-6);  // 2 m away
  expect_vector(16, turned_back(ocean.flow - v));
}

TEST_P(BrainOn, FeelsStrainAndTouchOfAGroup) {
  Robot robot = bar();
  robot.sensors = {{.kind = SensorKind::strain, .actuator = "front"},
                   {.kind = SensorKind::strain_rate, .springs = {0, 3}},
                   {.kind = SensorKind::touch},
                   {.kind = SensorKind::touch, .masses = {0, 1}}};
  robot.brain.emplace().layers = {{.name = "motor", .neurons = 2, .alpha = {}, .bias = {}, .inputs = {}}};
  // Stretched by a tenth in all directions, and going on with 0.3 of the length per second.
  State state;
  for (const Vec3& x : robot.masses) {
    state.positions.push_back(1.1f * x);
    state.velocities.push_back(0.3f * x);
  }
  SharedBatch batch = this->batch({.dt = dt, .environment = Land{}}, std::span(&robot, 1));
  batch->set_state(0, state);
  batch->step(1);
  const std::vector<float> senses = batch->brain_state(0).senses;
  EXPECT_NEAR(senses[0], 0.1, 1e-6);
  EXPECT_NEAR(senses[1], 0.3, 1e-6);
  EXPECT_FLOAT_EQ(senses[2], 0.5f);  // of two layers of masses, the lower one is on the floor
  const auto low = [&](std::size_t i) { return robot.masses[i].z == 0 ? 0.5f : 0.0f; };
  EXPECT_FLOAT_EQ(senses[3], low(0) + low(1));
}

TEST_P(BrainOn, DelaysSensesByThoughts) {
  Robot robot = thinker();
  robot.sensors.push_back({.kind = SensorKind::neuron, .layer = "hidden", .neuron = 1});
  robot.sensors.push_back({.kind = SensorKind::neuron, .layer = "hidden", .neuron = 1, .delay = 0.06f});
  NeuronInput& input = robot.brain->layers[0].inputs[0];
  input.weights.resize(27);
  // The motors are a linear copy of both.
  robot.brain->layers[1] = {.name = "motor",
                            .neurons = 2,
                            .activation = Activation::linear,
                            .alpha = {},
                            .bias = {},
                            .inputs = {{.from = "senses", .weights = {}, .edges = {{0, 7, 1}, {1, 8, 1}}}}};
  SharedBatch batch = this->batch({.dt = dt, .environment = Ocean{}}, std::span(&robot, 1));
  std::vector<float> hidden{0};  // as each thought found it
  for (int thought = 0; thought < 12; ++thought) {
    batch->step(20);
    const std::vector<float> neurons = batch->brain_state(0).neurons;
    const auto now = static_cast<std::size_t>(thought);
    EXPECT_EQ(neurons[3], hidden[now]);
    EXPECT_EQ(neurons[4], now < 3 ? 0.0f : hidden[now - 3]);
    hidden.push_back(neurons[1]);
  }
  EXPECT_NE(hidden.back(), 0.0f);
}

TEST_P(BrainOn, LearnsTheMainDirectionByOjasRule) {
  Robot robot = bar();
  robot.sensors = {{.kind = SensorKind::clock, .gain = 1, .frequency = 3},
                   {.kind = SensorKind::clock, .gain = 0.4f, .frequency = 40}};
  // It reads one sine of each clock: their variances are 1/2 and 0.08. By averaging theory the weights go to (1, 0) at
  // a rate of 100 * 0.01 (1/2 - 0.08) = 0.42 1/s, and move there by 100 * 0.01 * 0.4 / 2 (1 / 37 + 1 / 43) = 0.01 in
  // the rhythm of the product of both sines.
  robot.brain.emplace().layers = {
      {.name = "unit",
       .neurons = 1,
       .activation = Activation::linear,
       .alpha = {},
       .bias = {},
       .inputs = {{.from = "senses", .weights = {}, .edges = {{0, 0, 0.2f}, {0, 2, 0.6f}}, .rate = 0.01f}}},
      {.name = "motor", .neurons = 2, .alpha = {}, .bias = {}, .inputs = {}}};
  robot.brain->period = 0.01f;
  SharedBatch batch = this->batch({.dt = 0.01, .environment = OceanSimple{}}, std::span(&robot, 1));
  batch->step(2500);
  const std::vector<float> weights = batch->brain_state(0).weights;
  EXPECT_NEAR(weights[0], 1, 0.03);
  EXPECT_NEAR(weights[1], 0, 0.03);
}

TEST_P(BrainOn, ClampedNeuronsKeepTheirValue) {
  const Robot robot = thinker();
  SharedBatch batch = this->batch({.dt = dt, .environment = Ocean{}}, std::span(&robot, 1));
  batch->clamp_neuron(0, 3, 0.25f);
  batch->clamp_neuron(0, 0, 0.0f);
  for (int i = 0; i < 5; ++i) {
    batch->step(20);
    EXPECT_EQ(drives(batch)[0], 0.25f);
    EXPECT_EQ(batch->brain_state(0).neurons[0], 0.0f);
  }
  batch->clamp_neuron(0, 3, std::nullopt);
  batch->step(20);
  EXPECT_NE(drives(batch)[0], 0.25f);
  EXPECT_THROW(batch->clamp_neuron(0, 5, 1.0f), std::out_of_range);
}

TEST_P(BrainOn, PerActuatorReadsItsOwnSensesAndItsNeighbors) {
  Robot robot = bodies::random_voxels({.x = 3, .y = 1, .z = 1}, 8);
  const std::vector<Actuator> actuators = actuators_of(robot);
  ASSERT_GT(actuators.size(), 3u);
  robot.sensors = {{.kind = SensorKind::strain, .actuator = "self", .gain = 2},
                   {.kind = SensorKind::neighbors},
                   {.kind = SensorKind::clock, .frequency = 4}};
  Brain& brain = robot.brain.emplace();
  brain.per_actuator = true;
  brain.layers = {{.name = "motor",
                   .neurons = 1,
                   .alpha = {},
                   .bias = {0.1f},
                   .inputs = {matrix("senses", {1, 0.5f, -0.3f, 0.7f, 0.2f})}}};
  SharedBatch batch = this->batch({.dt = dt, .environment = Ocean{}}, std::span(&robot, 1));
  std::vector<float> before(actuators.size());
  for (int thought = 0; thought < 10; ++thought) {
    batch->step(20);
    const BrainState state = batch->brain_state(0);
    ASSERT_EQ(state.neurons.size(), actuators.size());
    for (std::size_t a = 0; a < actuators.size(); ++a) {
      const float* s = state.senses.data() + 5 * a;
      EXPECT_EQ(s[1], a > 0 ? before[a - 1] : 0);
      EXPECT_EQ(s[2], a + 1 < actuators.size() ? before[a + 1] : 0);
      const double sum = 0.1 + static_cast<double>(s[0]) + 0.5 * static_cast<double>(s[1]) -
                         0.3 * static_cast<double>(s[2]) + 0.7 * static_cast<double>(s[3]) +
                         0.2 * static_cast<double>(s[4]);
      EXPECT_NEAR(state.neurons[a], std::tanh(sum), 1e-6);
    }
    before = state.neurons;
  }
  EXPECT_EQ(brain_layout(robot).senses.size(), 5 * actuators.size());
}

// Every kind of sense, of large and small parts of a deformed body, noise, delays, learning and copies of a brain,
// beside the CPU backend. Their sums have other orders, and the device fuses products and sums.
TEST_P(BrainOn, FeelsAndLearnsAsTheCpuDoes) {
  for (const bool per_actuator : {false, true}) {
    Robot robot = bodies::random_voxels({.x = 7, .y = 6, .z = 5}, 4);
    for (std::size_t i = 0; i < robot.masses.size(); ++i)
      robot.mass.push_back(0.5f + 0.01f * static_cast<float>(i % 100));
    const std::string actuator = per_actuator ? "self" : actuators_of(robot)[1].name;
    const auto actuators = static_cast<std::uint32_t>(actuators_of(robot).size());
    for (const SensorDescription& description : sensor_descriptions) {
      if (description.kind == SensorKind::neighbors && !per_actuator) continue;
      Sensor sensor{.kind = description.kind, .noise = 0.1f, .frequency = 5};
      if (description.kind == SensorKind::neuron) sensor.layer = "motor";
      robot.sensors.push_back(sensor);
      if (description.place != SensorPlace::springs && description.place != SensorPlace::masses) continue;
      sensor.actuator = actuator;
      sensor.delay = 0.03f;
      robot.sensors.push_back(sensor);
      sensor.actuator.clear();
      sensor.noise = 0;
      if (description.place == SensorPlace::springs)
        sensor.springs = {7, 1, 900};
      else
        sensor.masses = {3, 200, 5};
      robot.sensors.push_back(sensor);
    }
    Brain& brain = robot.brain.emplace();
    brain.period = 0.01f;
    brain.per_actuator = per_actuator;
    std::size_t width = 0;
    for (const Sensor& sensor : robot.sensors) width += description_of(sensor.kind).width;
    std::vector<float> weights(width * (per_actuator ? 1 : actuators));
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = 0.1f * std::sin(static_cast<float>(i));
    brain.layers = {
        {.name = "motor",
         .neurons = per_actuator ? 1 : actuators,
         .alpha = {0.7f},
         .bias = {},
         .inputs = {{.from = "senses", .weights = weights, .edges = {}, .rate = per_actuator ? 0 : 1e-3f}}}};
    Environment environment = Land{};
    environment.target = {3, 1, 2};
    State state;
    for (const Vec3& x : robot.masses) {
      state.positions.push_back({1.05f * x.x + 5, 0.02f * x.x + 0.96f * x.y - 3, x.z});
      state.velocities.push_back({0.1f * x.y, 0.2f * x.z - 0.3f * x.x, 0.05f});
    }
    SharedBatch batch = this->batch({.dt = dt, .environment = environment}, std::span(&robot, 1));
    Simulation cpu({.dt = dt, .environment = environment, .device = {.kind = DeviceKind::cpu}}, std::span(&robot, 1));
    cpu.set_state(0, state);
    for (int thought = 0; thought < 5; ++thought) {
      batch->set_state(0, cpu.state(0));  // so that the same body is measured
      for (Simulation* each : {&*batch, &cpu}) each->step(10);
      const BrainState got = batch->brain_state(0), expected = cpu.brain_state(0);
      ASSERT_EQ(got.senses.size(), expected.senses.size());
      for (std::size_t i = 0; i < got.senses.size(); ++i)
        ASSERT_NEAR(got.senses[i], expected.senses[i], 2e-6 * (1 + std::abs(expected.senses[i])))
            << thought << ' ' << i;
      for (std::size_t i = 0; i < got.neurons.size(); ++i)
        ASSERT_NEAR(got.neurons[i], expected.neurons[i], 2e-6) << thought << ' ' << i;
      for (std::size_t i = 0; i < got.weights.size(); ++i) ASSERT_NEAR(got.weights[i], expected.weights[i], 1e-6);
      EXPECT_EQ(got.thoughts, expected.thoughts);
    }
  }
}

TEST(Brain, EdgesAreAMatrixWithZeros) {
  Robot dense = thinker(), sparse = thinker();
  dense.brain->layers[0].inputs[1].weights = {0, 0, 0.5f, 0, 0, 0, -0.3f, 0, 0};
  sparse.brain->layers[0].inputs[1] = {.from = "hidden", .weights = {}, .edges = {{2, 0, -0.3f}, {0, 2, 0.5f}}};
  const std::vector<Robot> robots{dense, sparse};
  Simulation simulation({.dt = 1e-3, .device = {.kind = DeviceKind::cpu}}, robots);
  simulation.step(500);
  EXPECT_EQ(simulation.hash(0), simulation.hash(1));
}

TEST(Brain, NumbersItsParts) {
  const BrainLayout layout = brain_layout(thinker());
  EXPECT_EQ(layout.senses,
            (std::vector<std::string>{"clock sine", "clock cosine", "strain front", "strain back", "target_direction x",
                                      "target_direction y", "target_direction z"}));
  EXPECT_EQ(layout.neurons, (std::vector<std::string>{"hidden 0", "hidden 1", "hidden 2", "motor 0", "motor 1"}));
  EXPECT_EQ(layout.weights, 3u + 21 + 9 + 6);
  EXPECT_EQ(layout.outputs, (std::vector<std::uint32_t>{3, 4}));
  EXPECT_EQ(layout.driven, (std::vector<std::uint32_t>{0, 1}));
}

TEST(Brain, DifferentSeedsOfTheNoiseGiveDifferentSenses) {
  Robot robot = thinker();
  for (Sensor& sensor : robot.sensors) sensor.noise = 1;
  const auto senses = [&](std::uint64_t seed) {
    Simulation simulation({.dt = 1e-3, .device = {.kind = DeviceKind::cpu}}, std::span(&robot, 1));
    simulation.set_noise_seed(0, seed);
    simulation.step(1);
    return simulation.brain_state(0).senses;
  };
  EXPECT_EQ(senses(1), senses(1));
  EXPECT_NE(senses(1), senses(2));
}

TEST(Brain, RefusesWhatDoesNotFit) {
  const auto error = [](const std::function<void(Robot&)>& damage) {
    Robot robot = thinker();
    damage(robot);
    return refusal([&] { validate(robot); });
  };
  EXPECT_EQ(error([](Robot&) {}), "");
  EXPECT_EQ(error([](Robot& r) { r.sensors[1].actuator = "tail"; }),
            "/sensors/1/actuator: no actuator is named \"tail\"; the robot has front, back");
  EXPECT_EQ(error([](Robot& r) { r.sensors[2].delay = -1; }), "/sensors/2/delay: -1 is not accepted; give 0 to 100 s");
  EXPECT_EQ(error([](Robot& r) { r.sensors[3].actuator = "front", r.sensors[3].masses = {1}; }),
            "/sensors/3: has more than one of actuator, springs and masses; give one of them");
  EXPECT_EQ(error([](Robot& r) { r.sensors[0].neuron = 1; }), "/sensors/0: clock is of no neuron");
  EXPECT_EQ(error([](Robot& r) { r.sensors[0].masses = {1}; }),
            "/sensors/0: clock has no place; leave out actuator, springs and masses");
  EXPECT_EQ(error([](Robot& r) { r.sensors[0] = {.kind = SensorKind::touch, .masses = {400}}; }),
            "/sensors/0/masses: mass 400 is out of range, the robot has 20");
  EXPECT_EQ(error([](Robot& r) { r.sensors[0] = {.kind = SensorKind::neighbors}; }),
            "/sensors/0: neighbors are of a brain per actuator");
  EXPECT_EQ(error([](Robot& r) { r.brain->layers[0].inputs[0].weights.pop_back(); }),
            "/brain/layers/0/inputs/0/weights: 20 weights; 3 neurons with 7 inputs have 21");
  EXPECT_EQ(error([](Robot& r) { r.brain->layers[1].inputs[0].from = "eyes"; }),
            "/brain/layers/1/inputs/0/from: no layer is named \"eyes\"; the brain has hidden, motor");
  EXPECT_EQ(error([](Robot& r) { r.brain->layers[0].alpha = {0}; }),
            "/brain/layers/0/alpha: an alpha is above 0 and at most 1");
  EXPECT_EQ(error([](Robot& r) { r.brain->layers[0].bias[1] = INFINITY; }),
            "/brain/layers/0/bias: must be a finite number");
  EXPECT_EQ(
      error([](Robot& r) { r.brain->layers.pop_back(); }),
      "/brain/layers/0: the last layer has 3 neurons, the robot has 2 actuators; name outputs, or make them equal");
  EXPECT_EQ(error([](Robot& r) {
              r.brain->outputs = {{"front", "motor", 7}};
            }),
            "/brain/outputs/0/neuron: neuron 7 is out of range, layer \"motor\" has 2");
  EXPECT_EQ(error([](Robot& r) {
              r.brain->layers[0].inputs[1] = {"hidden", {}, {{0, 3, 1.0f}}, 0};
            }),
            "/brain/layers/0/inputs/1/edges/0: input 3 is out of range, there are 3");
  EXPECT_EQ(error([](Robot& r) { r = gated(); }), "");
  EXPECT_EQ(error([](Robot& r) { r.brain->layers[0].gate = "eyes"; }),
            "/brain/layers/0/gate: no layer is named \"eyes\"; the brain has hidden, motor");
  EXPECT_EQ(error([](Robot& r) { r.brain->layers[0].gate = "senses"; }),
            "/brain/layers/0/gate: no layer is named \"senses\"; the brain has hidden, motor");
  EXPECT_EQ(error([](Robot& r) { r.brain->layers[0].keep_layer = "motor"; }),
            "/brain/layers/0/keep: layer \"motor\" has 2 neurons, this layer 3; they need as many");
  EXPECT_EQ(error([](Robot& r) { r.brain->layers[1].gate = "motor"; }),
            "/brain/layers/1: has both alpha and a gate, which takes its place; give one of them");
  EXPECT_EQ(error([](Robot& r) {
              r.brain->layers[0].keep = {1, 1};
            }),
            "/brain/layers/0/keep: 2 numbers, the layer has 3 neurons");
  EXPECT_EQ(error([](Robot& r) { r.brain->layers[0].keep = {1.5f}; }),
            "/brain/layers/0/keep: a keep is 0 to 1, or the name of a layer");
  EXPECT_EQ(error([](Robot& r) { r.brain->layers[0].keep = {0}, r.brain->layers[0].keep_layer = "hidden"; }),
            "/brain/layers/0/keep: is both numbers and a layer; give one of them");
  EXPECT_EQ(error([](Robot& r) { r.brain->period = 0; }), "/brain/period: must be above 0 s");
  EXPECT_EQ(error([](Robot& r) { r.brain->layers[1].name = "hidden"; }), "/brain/layers/1: has the name of layer 0");
}

}  // namespace
}  // namespace mercury
