// SPDX-License-Identifier: Apache-2.0
// Senses and a brain as plain data: what a robot feels, and how its muscles follow from that.
//
// A brain thinks every `period` seconds, before a step. It first samples all senses, s, then updates its neurons, y,
// layer after layer, and then sets the drives u of its actuators (mercury/shared_array.h), which stay until it thinks
// again:
//
//   y  <-  k y + g act(W z + b)                  u = y of the output neurons, limited to [-1, 1]
//   g = alpha, k = 1 - g                         so y moves to act(W z + b) by a share of alpha
//
// z is what a layer's inputs name: the senses, or the neurons of a layer. The neurons of one layer change at the same
// time; a layer sees those before it as they are now, and itself and those after it as they were. So layers of alpha 1
// are a perceptron, a layer that is its own input is a recurrent network, or with an alpha below 1 a continuous-time
// one (Beer 1995: alpha = period / tau), and two such neurons an oscillator.
//
// The neurons of other layers may be g and k, neuron by neuron: the `gate` and the `keep` of a layer. So an LSTM
// (Hochreiter and Schmidhuber 1997; Gers et al. 2000) is five layers: input, forget and output gates, which are
// sigmoids of what the cell reads; the cell, with gate = input and keep = forget; and hidden = tanh(cell), with
// gate = output and keep = 0.
//
// An input with a `rate` learns by Oja's rule (Oja 1982): after its layer has changed,
//
//   w  <-  w + rate y (z - y w)
//
// The body's frame turns with the robot: its axes are those of the file, turned by the rotation that brings the rest
// shape closest to the current one (mass-weighted least squares; Horn 1987). It is continuous while the robot is not
// crushed to a line.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mercury/parameters.h"

namespace mercury {

enum class SensorKind : std::uint8_t {
  strain,
  strain_rate,
  touch,
  velocity,
  turn_rate,
  up,
  depth,
  height,
  target_direction,
  target_distance,
  light,
  flow,
  clock,
  neuron,
  neighbors
};

// Where a sensor may be.
enum class SensorPlace : std::uint8_t { springs, masses, body, none };

struct SensorDescription {
  SensorKind kind;
  std::string_view name;
  std::size_t width;  // numbers that it gives
  std::string_view unit;
  SensorPlace place;  // what it may be bound to: springs, or masses; the whole robot if the file names none
  std::string_view help;
};

// Files, checks, tables and docs follow from this list, which is in the order of SensorKind.
inline constexpr std::array sensor_descriptions{
    SensorDescription{SensorKind::strain, "strain", 1, "1", SensorPlace::springs, "Mean strain, (length - L0) / L0"},
    SensorDescription{SensorKind::strain_rate, "strain_rate", 1, "1/s", SensorPlace::springs,
                      "Mean rate of the strain"},
    SensorDescription{SensorKind::touch, "touch", 1, "1", SensorPlace::masses, "Share of the masses on the ground"},
    SensorDescription{SensorKind::velocity, "velocity", 3, "m/s", SensorPlace::masses, "Velocity in the body's frame"},
    SensorDescription{SensorKind::turn_rate, "turn_rate", 3, "rad/s", SensorPlace::body,
                      "Angular velocity in the body's frame"},
    SensorDescription{SensorKind::up, "up", 3, "1", SensorPlace::body, "Upward in the body's frame, a unit vector"},
    SensorDescription{SensorKind::depth, "depth", 1, "m", SensorPlace::masses, "Depth below z = 0"},
    SensorDescription{SensorKind::height, "height", 1, "m", SensorPlace::masses, "Height above the ground, z = 0"},
    SensorDescription{SensorKind::target_direction, "target_direction", 3, "1", SensorPlace::masses,
                      "Toward the target in the body's frame, a unit vector; 0 at the target"},
    SensorDescription{SensorKind::target_distance, "target_distance", 1, "m", SensorPlace::masses,
                      "Distance of the target"},
    SensorDescription{SensorKind::light, "light", 1, "1", SensorPlace::masses,
                      "Brightness, 1 / (1 + d2), d = distance of the light in m"},
    SensorDescription{SensorKind::flow, "flow", 3, "m/s", SensorPlace::masses,
                      "Velocity of the water past it in the body's frame"},
    SensorDescription{SensorKind::clock, "clock", 2, "1", SensorPlace::none, "Sine and cosine of frequency t + phase"},
    SensorDescription{SensorKind::neuron, "neuron", 1, "1", SensorPlace::none,
                      "A neuron as it was when the brain last thought, or `delay` earlier"},
    SensorDescription{SensorKind::neighbors, "neighbors", 2, "1", SensorPlace::none,
                      "Output of the previous and of the next actuator in a brain per actuator; 0 beyond the ends"}};

constexpr const SensorDescription& description_of(SensorKind kind) {
  return sensor_descriptions[static_cast<std::size_t>(kind)];
}

struct Sensor {
  SensorKind kind = SensorKind::clock;
  // At most one of them says where it is; the whole robot without. The masses of an actuator or of springs are those at
  // their ends.
  std::string actuator{};                // one of the robot's; in a brain per actuator, "self" is the one it drives
  std::vector<std::uint32_t> springs{};  // indices
  std::vector<std::uint16_t> masses{};   // indices
  std::string layer{};                   // whose `neuron` a sensor of that kind gives
  std::uint32_t neuron = 0;
  float gain = 1, noise = 0, delay = 0, frequency = 0, phase = 0;
  friend bool operator==(const Sensor&, const Sensor&) = default;

  static constexpr std::tuple parameters{
      Parameter("gain", &Sensor::gain, "", Accepts::any, {-10, 10}, "Factor of the sense"),
      Parameter("noise", &Sensor::noise, "", Accepts::at_least_zero, {0, 1},
                "Standard deviation of normal noise, added after the gain"),
      Parameter("delay", &Sensor::delay, "s", Accepts::between(0, 100), {0, 1},
                "How old the sense is, to the nearest multiple of the brain's period"),
      Parameter("frequency", &Sensor::frequency, "rad/s", Accepts::any, {0, 20}, "Of a clock"),
      Parameter("phase", &Sensor::phase, "rad", Accepts::any, {0, 6.2831853f}, "Of a clock")};
};

enum class Activation : std::uint8_t { linear, tanh, sigmoid, relu, sine };
inline constexpr std::array<std::string_view, 5> activation_names{"linear", "tanh", "sigmoid", "relu", "sine"};

struct NeuronEdge {
  std::uint32_t to = 0, from = 0;  // a neuron of the layer, an element of its input
  float weight = 0;
  friend bool operator==(const NeuronEdge&, const NeuronEdge&) = default;
};

// What the neurons of a layer read: all of a vector through a matrix, or some of it through edges.
struct NeuronInput {
  std::string from{};            // "senses", or the name of a layer
  std::vector<float> weights{};  // [neuron of the layer][element of `from`]; empty if there are edges
  std::vector<NeuronEdge> edges{};
  float rate = 0;  // of learning
  friend bool operator==(const NeuronInput&, const NeuronInput&) = default;
};

struct NeuronLayer {
  std::string name{};
  std::uint32_t neurons = 0;
  Activation activation = Activation::tanh;
  std::vector<float> alpha{};  // of each neuron, or one for all; empty = 1
  std::vector<float> bias{};   // of each neuron; empty = 0
  std::vector<NeuronInput> inputs{};
  std::string gate{};         // a layer of as many neurons, which are g in place of alpha; empty = alpha
  std::vector<float> keep{};  // k of each neuron, or one for all; empty = 1 - g
  std::string keep_layer{};   // a layer of as many neurons, which are k in place of `keep`
  bool is_gated() const { return !gate.empty() || !keep.empty() || !keep_layer.empty(); }
  friend bool operator==(const NeuronLayer&, const NeuronLayer&) = default;
};

struct NeuronOutput {
  std::string actuator{}, layer{};
  std::uint32_t neuron = 0;
  friend bool operator==(const NeuronOutput&, const NeuronOutput&) = default;
};

struct Brain {
  float period = 0.02f;       // how often it thinks [s]: every N = round(period / dt) steps, at least 1
  bool per_actuator = false;  // the layers exist once per actuator, with the same weights; the last one has one neuron
  std::uint64_t seed = 0;     // of the noise
  std::vector<NeuronLayer> layers{};
  std::vector<NeuronOutput> outputs{};  // empty = the last layer drives all actuators in their order
  friend bool operator==(const Brain&, const Brain&) = default;
};

inline constexpr std::size_t max_senses = 4096, max_neurons = 4096, max_inputs = 256,
                             max_weights = std::size_t{1} << 22;

struct Robot;

// What a robot's brain consists of, by number: senses, neurons and weights. The arrays of BrainState and of programs
// (Simulation::set_brain_weights()) have this order.
struct BrainLayout {
  std::vector<std::string> senses;     // a name per sense, "strain tail", "clock sine"
  std::vector<std::string> neurons;    // "hidden 3"
  std::size_t weights = 0;             // layer after layer: biases, then its inputs in their order, as in the file
  std::vector<std::uint32_t> outputs;  // a neuron per driven actuator
  std::vector<std::uint32_t> driven;   // those actuators, by their index in actuators_of()
};

// Of a robot that validate() accepts; empty without a brain.
BrainLayout brain_layout(const Robot& robot);
// All weights of a brain in the order of BrainLayout, and their change. Throws std::invalid_argument for another
// number.
std::vector<float> weights_of(const Brain& brain);
void set_weights(Brain& brain, const std::vector<float>& weights);

// Throws InputError with the place as a JSON pointer ("/brain/layers/1/inputs/0: ...") unless sensors and brain fit the
// robot and each other. The rest of the robot is valid. Sensors need no brain.
void validate_brain(const Robot& robot);

// Whether a sensor of the robot is of the target, of the light.
bool seeks_target(const Robot& robot);
bool seeks_light(const Robot& robot);
// The masses of each place whose touch the robot feels.
std::vector<std::vector<std::uint16_t>> touch_places(const Robot& robot);

// The state of a robot's brain; empty without one.
struct BrainState {
  std::vector<float> neurons;  // y, by neuron
  std::vector<float> senses;  // as sampled last and before, [sample][sense], the last one first, as far as delays reach
  std::vector<float> weights;  // as learned, or as set
  std::uint64_t thoughts = 0;  // how often it has thought
  friend bool operator==(const BrainState&, const BrainState&) = default;
};

// Before the first thought, of a robot that validate() accepts.
BrainState brain_at_start(const Robot& robot);

}  // namespace mercury
