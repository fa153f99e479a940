// SPDX-License-Identifier: Apache-2.0
// Animals that a generator makes, so that they can be mutated and evolved. Their numbers were found by a search
// (CMA-ES) for speed at the Strouhal number of animals, 0.27.
//
// What resistive water allows. A sheet with the wave y = b sin(k (x - c t)) swims at U = s c, where s follows from a =
// k b and the ratio of C_T to C_N alone (docs/validation.md): 0.40, 0.61 and 0.71 at a = 0.3, 0.6 and 1. Its Strouhal
// number is
//
//   f 2 b / U = a / (pi s):   0.24, 0.31, 0.45
//
// so an animal's 0.2 to 0.4 needs a of 0.2 to 0.8, a body without blunt ends (C_N acts on them), and 1.2 waves or more
// on the body, since with fewer the whole body turns to and fro. Its speed is s f / waves body lengths per second. A
// muscle that shortens by x on a body of width w curves it by 2 x / w, and a = 2 x / (w k), as long as the body's own
// slowest vibration is not slower than the beat. That takes some MPa: the water's pressure is of the order of rho (1 -
// s)^2 (c a)^2, the body's inertia several times as large.
#include <cmath>

#include "mercury/real_body.h"
#include "mercury/tapered.h"
#include "robots/library/designs.h"

namespace mercury::library {
namespace {

// Its whole body waves, as an eel's does, by nearly as much at the head as at the tail.
Robot real_eel() {
  return with_real_body(
      grow({.stations = 22,
            .layers = 3,
            .segments = 16,
            .volume = 26.6,
            .depths = {0.0439, 0.0483, 0.0762, 0.0929, 0.0918, 0.09, 0.0876, 0.0845, 0.0826, 0.0746, 0.0397},
            .width = 0.598,
            .edge = 0.657,
            .frequency = 3.018,
            .waves = 1.849,
            .contractions = {0.034, 0.267, 0.154, 0.138, 0.191, 0.065},
            .environment = "water"},
           "eel"),
      {.modulus = 5.3e6f, .relaxation_time = 1e-4f});
}

// A deep body, a narrow stem and a rounded fin.
Robot real_fish() {
  return with_real_body(grow({.stations = 18,
                              .layers = 3,
                              .segments = 14,
                              .volume = 16.5,
                              .depths = {0.11, 0.13, 0.153, 0.195, 0.209, 0.186, 0.135, 0.1147, 0.0906, 0.0929, 0.0896},
                              .width = 0.428,
                              .edge = 0.76,
                              .frequency = 2.055,
                              .waves = 1.498,
                              .contractions = {0.105, 0.182, 0.282, 0.138, 0.28, 0.094},
                              .environment = "water"},
                             "fish"),
                        {.modulus = 2.75e6f, .relaxation_time = 2e-4f});
}

// Waves run from its tail to its head: what the wave lifts swings ahead, and the rest stands.
Robot real_inchworm() {
  return with_real_body(grow({.bending = TaperedBending::up_down,
                              .stations = 20,
                              .layers = 3,
                              .segments = 16,
                              .volume = 43.3,
                              .depths = {0.0949, 0.0949, 0.15, 0.15, 0.15, 0.15, 0.15, 0.15, 0.15, 0.1162, 0.0949},
                              .width = 0.583,
                              .edge = 0.7,
                              .frequency = 1,
                              .waves = -1.2,
                              .contractions = {0.168, 0.266, 0.266, 0.266, 0.266, 0.168},
                              .environment = "land"},
                             "inchworm"),
                        {.modulus = 4e5f, .relaxation_time = 0.005f});
}

// The eel with a brain: its own wave, at 0.6 of the amplitude, and all muscles a little to the side where the target
// is. The sum of a sine and a cosine of the clock is a wave of any phase.
Robot hunter() {
  Robot robot = real_eel();
  robot.name = "hunter";
  const std::vector<Actuator> actuators = actuators_of(robot);
  const auto muscle = [&](std::size_t i) { return robot.materials[actuators[i].materials.front()]; };
  robot.sensors = {{.kind = SensorKind::clock, .frequency = muscle(0).frequency},
                   {.kind = SensorKind::target_direction}};
  NeuronLayer turn{.name = "turn", .neurons = 1, .alpha = {0.1f}};
  turn.inputs = {{.from = "senses", .edges = {{0, 3, -4}}}};  // its y, to the left
  NeuronLayer wave{
      .name = "wave", .neurons = static_cast<std::uint32_t>(actuators.size()), .activation = Activation::linear};
  NeuronInput clock{.from = "senses"}, side{.from = "turn"};
  const auto rounded = [](double weight) { return static_cast<float>(std::round(weight * 1e4) / 1e4); };
  for (std::uint32_t i = 0; i < wave.neurons; ++i) {
    const auto phase = static_cast<double>(muscle(i).phase);
    clock.edges.push_back({i, 0, rounded(0.6 * std::cos(phase))});
    clock.edges.push_back({i, 1, rounded(0.6 * std::sin(phase))});
    side.weights.push_back(0.4f);
  }
  wave.inputs = {clock, side};
  robot.brain = Brain{.period = 0.01f, .layers = {turn, wave}};
  return robot;
}

}  // namespace

std::vector<Robot> animals() { return {real_eel(), real_fish(), real_inchworm(), hunter()}; }

}  // namespace mercury::library
