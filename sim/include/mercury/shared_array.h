// SPDX-License-Identifier: Apache-2.0
// Arrays in the memory of the device that steps robots. Programs use them in place, without a copy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace mercury {

template <class T>
struct SharedArray {
  std::shared_ptr<T> data;  // row after row; keeps the memory, even after its simulation is gone
  std::size_t rows = 0, columns = 0;
  int cuda_device = -1;  // whose memory it is; -1 = the host's
};

// Parts of the state that a program may share.
enum class StateArray {
  positions,         // [mass][3], of all robots in order [m]
  velocities,        // [mass][3] [m/s]
  centers,           // [robot][3], centers of mass [m]
  center_velocities  // [robot][3] [m/s]
};

// What drives the actuators, [robot][actuator]. Column a of row i is actuator a of actuators_of(robot i); columns that
// a robot does not have are ignored.
//
//   L(t) = L0 (1 + amplitude sin(frequency t + phase))     while it is not driven, as in material.h
//   L    = L0 (1 + amplitude drive)                        while it is driven
//
// At first no actuator is driven, and drives are NaN. A step that reads a number in `drive` sets `driven`, which may
// also be set before. A driven actuator whose drive is NaN or infinite explodes its robot: what writes the drives has
// failed. To follow the sine again, it takes a drive of NaN and `driven` 0.
//
// Amplitudes, frequencies and phases that are not finite are none: materials then keep their own. A drive replaces half
// waves, too. Amplitudes are limited to (-1, 1), drives to [-1, 1].
struct Actuation {
  SharedArray<float> amplitude;      // [1]
  SharedArray<float> frequency;      // [rad/s]
  SharedArray<float> phase;          // [rad]
  SharedArray<float> drive;          // u [1]
  SharedArray<std::uint8_t> driven;  // 0, 1, or held_drive
};

// Brains of robots that all have one, with as many weights, neurons and senses. What a program writes counts from the
// next thought on.
struct BrainArrays {
  SharedArray<float> weights;  // [robot][weight], in the order of BrainLayout
  SharedArray<float> neurons;  // [robot][neuron], activations y
  SharedArray<float> senses;   // [robot][sense], as sampled last; then the samples before, if senses have delays
};

// In Actuation::driven: a brain leaves the drive alone.
inline constexpr std::uint8_t held_drive = 2;

// The drive of one actuator that is set by hand (Simulation::hold_drives()).
struct HeldDrive {
  std::size_t robot = 0;
  std::size_t actuator = 0;  // index in actuators_of(robot)
  float drive = 0;           // u [1]
};

}  // namespace mercury
