// SPDX-License-Identifier: Apache-2.0
// The arrays that a Simulation shares with programs (mercury/shared_array.h).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mercury/backend.h"
#include "mercury/driven_materials.h"
#include "mercury/shared_array.h"
#include "sim/physics/actuation.h"

namespace mercury {

// A robot's material table by id, max_materials elements.
using MaterialTable = std::array<Material, max_materials>;

// Those parts of the state that a program shares.
class SharedState {
 public:
  // Makes the array if it is not there, or has another size.
  SharedArray<float> array(const Backend& backend, std::span<const Robot* const> robots,
                           std::span<const std::size_t> mass_offsets, StateArray which);
  SharedArray<std::uint8_t> exploded(const Backend& backend, std::span<const Robot* const> robots);

  PublishedArrays targets() const;
  // Writes the current state into them.
  void publish(const Backend& backend, std::span<const Robot* const> robots) const;
  void forget();

 private:
  std::array<SharedArray<float>, 4> arrays_;  // by StateArray
  SharedArray<std::uint8_t> exploded_;
};

// The drive of one actuator.
struct DriveSetting {
  std::size_t robot;
  std::uint32_t actuator;
  float drive;
};

// Once a program has asked for the arrays, they drive the actuators.
class SharedActuation {
 public:
  // `tables`: the robots' materials as they are now; null = the robot's own.
  const Actuation& arrays(Backend& backend, std::span<const std::shared_ptr<const Robot>> robots,
                          std::span<const std::unique_ptr<MaterialTable>> tables);
  // Makes arrays for other robots, if there are any. `kept` = the old indices of the first ones; the others are new.
  void rearrange(Backend& backend, std::span<const std::shared_ptr<const Robot>> robots,
                 std::span<const std::unique_ptr<MaterialTable>> tables, std::span<const std::size_t> kept);
  // Changes the materials of the backend, and explodes robots whose drives have failed, unless it reads the arrays
  // itself. To be called before every step.
  void apply(Backend& backend, std::int64_t step, std::span<const std::shared_ptr<const Robot>> robots,
             std::span<const std::unique_ptr<MaterialTable>> tables);
  // Writes drives into arrays that have been made.
  void set_drives(const Backend& backend, std::span<const DriveSetting> settings);
  // Simulation::hold_drives(), into arrays that have been made.
  void hold(const Backend& backend, std::span<const HeldDrive> held);
  // The arrays as they are now.
  DrivenMaterials driven_materials(const Backend& backend) const;
  bool is_made() const { return made_; }
  // Lets the backend read the arrays again, after it failed to exchange robots.
  void attach(Backend& backend);
  // The robots' own materials have changed in the backend.
  void materials_changed() { applied_is_known_ = false; }

 private:
  void make(Backend& backend, std::span<const std::shared_ptr<const Robot>> robots,
            std::span<const std::unique_ptr<MaterialTable>> tables, std::span<const float> old,
            std::span<const std::uint8_t> old_driven, std::span<const std::size_t> kept);

  ActuatorSetting setting(std::size_t at) const;

  Actuation arrays_;
  std::vector<std::uint8_t> actuator_of_;  // ActuationSources::actuator_of
  std::vector<std::uint32_t> applied_;     // the bits of the four arrays of numbers at the last step
  std::vector<std::uint8_t> applied_driven_;
  std::vector<std::size_t> counts_;  // of the robots' actuators
  bool made_ = false, by_backend_ = false, applied_is_known_ = false;
};

}  // namespace mercury
