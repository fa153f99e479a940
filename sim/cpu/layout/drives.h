// SPDX-License-Identifier: Apache-2.0
// Actuators of a body that a program drives (mercury/shared_array.h).
//
// What a program drives is the movement of a material: amplitude, frequency and phase. The stiffness stays, so nothing
// that is prepared for springs depends on it, except for the factor L(t) / L0 that they read. Driven materials have
// factors that no others share. Before the first step of a call these factors, and nothing else, are changed:
//
//   the program's arrays            the body's materials        the batch's muscles           springs
//   amplitude ... drive [robot]  ->  as they are now         ->  amplitude, phase, per_step -> factor by id
//
// So drives may change at every call without scheduling, grouping or copying a spring.
#pragma once

#include <vector>

#include "mercury/backend.h"
#include "sim/cpu/layout/muscles.h"

namespace mercury::cpu {

struct Body;

struct DrivenMaterial {
  MaterialId id = 0;
  std::uint8_t actuator = 0;  // column of the program's arrays
  FactorId factor = 0;
  Material own;  // without the drive
};

struct Drives {
  const float *amplitude = nullptr, *frequency = nullptr, *phase = nullptr, *drive = nullptr;  // the robot's rows
  std::uint8_t* driven = nullptr;                                                              // the same
  std::vector<DrivenMaterial> materials;  // those that springs have, by actuator
};

// The sources drive the body from now on, as a robot of this index; the ones before do no longer. Factors are to be
// added before the next step.
void set_drives(Body& body, const ActuationSources& sources, std::size_t robot);
// The body has its own materials again. Factors are to be added before the next step.
void remove_drives(Body& body);

// Adds the factors of the driven materials: one for those of an actuator that move alike by themselves.
void add_driven_factors(Body& body, Muscles& muscles);
// Reads the program's arrays and changes the body's materials and their factors. Returns false if a drive has failed.
bool read_drives(Body& body, Muscles& muscles);

}  // namespace mercury::cpu
