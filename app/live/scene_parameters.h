// SPDX-License-Identifier: Apache-2.0
// The parameters of the window's scene: its configuration, where robots begin, materials, and what is held by hand.
// Each change is an edit.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/live/scene_document.h"

namespace mercury {

class SceneCore;

// SceneDocument has the values. An invalid value changes nothing: it is reported and the result is false.
class SceneParameters {
 public:
  explicit SceneParameters(SceneCore& core) : core_(core) {}

  // Keeps the device. A change of the environment is an edit of its own. Robots that come to land are set down at rest;
  // undo takes every robot back to where and how it was before the change.
  bool set_configuration(const Configuration& configuration);
  // Pushes all robots a tenth of a second from now, or in the next step while time stands: the parameters push and
  // push_at of the environment [m/s].
  bool push(const Vec3& velocity);
  // Where robots begin: at rest, or as the first trial of a run does. New ones do so, and all after a reset; at time 0
  // all move there at once.
  bool set_start(const TrialStart& start);

  std::span<const Material> materials(RobotId robot) const;  // in use; empty if the robot is unknown
  bool set_material(const std::vector<RobotId>& robots, MaterialId id, const Material& material);
  // Changes all materials but air: multiplies stiffness, amplitude and frequency of the robot's file, adds to the
  // phase.
  bool scale_materials(const std::vector<RobotId>& robots, const MaterialScale& scale);
  void reset_materials(const std::vector<RobotId>& robots);  // to those of the robot's file

  // Drives the actuators of this name by hand, in place of their sines and brains: u in [-1, 1]; none = releases them.
  // Like the materials, drives belong to undo and the timeline; scene files keep them.
  void drive_actuator(const std::vector<RobotId>& robots, const std::string& actuator, std::optional<float> drive);
  void release_actuators(const std::vector<RobotId>& robots);
  // The neuron of its brain has this value whatever it reads (0 silences it), none = it thinks again; kept as drives
  // are.
  void clamp_neuron(RobotId robot, std::size_t neuron, std::optional<float> value);
  void release_neurons(RobotId robot);

 private:
  SceneCore& core_;
};

}  // namespace mercury
