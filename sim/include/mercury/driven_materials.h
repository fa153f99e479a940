// SPDX-License-Identifier: Apache-2.0
// The materials of robots at an instant as what drives their actuators makes them: a program, a brain or a hand.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "mercury/material.h"

namespace mercury {

struct ActuatorSetting;

// A copy of what drives the actuators of all robots (Simulation::driven_materials()); empty if nothing does. Copies of
// it share their memory.
class DrivenMaterials {
 public:
  // Whether a drive replaces the sine of any of the robot's muscles. False for robots that are not there.
  bool drives(std::size_t robot) const;
  // The robot's table as its springs have it now; `own` is its table without drives, by id (Simulation::material()). A
  // driven material has frequency 0, and the phase whose sine is its drive.
  std::vector<Material> of(std::size_t robot, std::span<const Material> own) const;

 private:
  friend class SharedActuation;
  struct Arrays;
  std::span<const ActuatorSetting> settings(std::size_t robot) const;
  std::shared_ptr<const Arrays> arrays_;
};

}  // namespace mercury
