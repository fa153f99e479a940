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
//   L(t) = L0 (1 + amplitude sin(frequency t + phase))     while the drive is NaN, as in material.h
//   L    = L0 (1 + amplitude drive)                        otherwise
//
// A number that is not finite means that there is none: materials then keep their own amplitude, frequency or phase,
// and follow the sine, or its half wave, which a drive replaces too. Amplitudes are limited to (-1, 1), drives to [-1,
// 1].
struct Actuation {
  SharedArray<float> amplitude;  // [1]
  SharedArray<float> frequency;  // [rad/s]
  SharedArray<float> phase;      // [rad]
  SharedArray<float> drive;      // u [1]
};

}  // namespace mercury
