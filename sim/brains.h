// SPDX-License-Identifier: Apache-2.0
// The brains of a batch: their states, and when they think.
//
//   step 0         20        40        60
//        |thought|steps...|thought|steps...        N = round(period / dt) steps of the robot's clock
//
// A thought reads positions and velocities as they are before the step, and leaves drives for the steps that follow. It
// depends on nothing but the robot, its state and the clock: so a robot behaves alike in any batch.
//
// A backend that can lets the brains think between its own steps, and has their states meanwhile. They come back when
// somebody reads or changes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mercury/backend.h"
#include "mercury/brain.h"
#include "mercury/configuration.h"
#include "mercury/robot.h"
#include "mercury/shared_array.h"
#include "sim/physics/brain_plan.h"
#include "sim/senses.h"
#include "sim/shared_arrays.h"

namespace mercury {

// Of a robot with a brain that validate() accepts.
BrainPlan make_brain_plan(const Robot& robot);

BrainState state_at_start(const BrainPlan& plan);

class Brains {
 public:
  bool empty() const { return count_ == 0; }

  // Before the backend exchanges robots: takes the states back from it.
  void leave_backend();
  // As robots come and go.
  void append(std::span<const std::shared_ptr<const Robot>> added);
  void truncate(std::size_t size);
  void keep(std::span<const std::size_t> robots);
  // Shared arrays with the numbers of all brains. Throws InputError unless all robots have brains of one size.
  // think_in_backend() comes first.
  const BrainArrays& share(const Backend& backend);
  // Begin and end what reads or changes brains from outside of steps: programs may have written into shared arrays, and
  // see what has changed.
  void begin_access() const;
  void end_access();
  // As at the start; weights, clamps and targets stay.
  void reset(std::size_t robot);

  // To be called before the backend steps. Whether it lets the brains think; the functions down to think() are for the
  // other case.
  bool think_in_backend(Backend& backend);
  // The backend is about to step.
  void expect_thoughts() { backend_is_newer_ = weights_are_newer_ = backend_ != nullptr; }

  // The steps until a brain thinks next; 0 = one thinks now.
  std::int64_t steps_until_thought(const Clock& clock) const;
  // Whether a brain that thinks now needs the state of its robot.
  bool need_state(const Clock& clock) const;
  // All brains think that do so at this instant. `positions` and `velocities` of all robots are empty unless needed.
  void think(const Clock& clock, std::span<const std::shared_ptr<const Robot>> robots,
             std::span<const std::size_t> mass_offsets, std::span<const Vec3> positions,
             std::span<const Vec3> velocities, const Environment& environment);
  // The drives as the brains left them, if they have changed since the last call.
  std::vector<DriveSetting> take_drives();

  BrainState state(std::size_t robot) const;
  // The senses as sampled last, and the neurons, of all brains. Throws std::invalid_argument for other sizes.
  void read(std::span<float> senses, std::span<float> neurons) const;
  // Throw std::invalid_argument.
  void require_state(std::size_t robot, const BrainState& state) const;
  void set_state(std::size_t robot, const BrainState& state);
  void set_weights(std::size_t robot, std::span<const float> weights);
  void clamp(std::size_t robot, std::size_t neuron, std::optional<float> value);
  void set_target(std::size_t robot, std::optional<Vec3> target);
  void set_noise_seed(std::size_t robot, std::uint64_t seed);

 private:
  struct OfRobot {
    std::shared_ptr<const BrainPlan> plan;
    BrainState state;
    std::vector<std::pair<std::uint32_t, float>> clamps;  // neuron and value
    std::uint64_t noise_seed = 0;
  };
  void sample(OfRobot& brain, const Clock& clock, const SensedBody& body, const SensedWorld& world, Vec3 target) const;
  // Reads what the backend has, if it is newer.
  void fetch(bool weights) const;
  // fetch() before a change, which the backend then learns of.
  OfRobot* to_change(std::size_t robot, bool weights = false);
  // From and to the row of a robot in shared arrays that the host has.
  void take(std::size_t robot) const;
  void give(std::size_t robot) const;
  PackedBrains packed() const;

  std::vector<std::unique_ptr<OfRobot>> of_;  // one per robot; null = no brain
  std::vector<std::optional<Vec3>> targets_;  // one per robot
  std::size_t count_ = 0;                     // of brains
  bool changed_ = false;                      // neurons, since take_drives()
  std::optional<bool> by_backend_;            // nothing = it has not been asked
  Backend* backend_ = nullptr;                // that lets them think
  mutable bool backend_is_newer_ = false, weights_are_newer_ = false;
  bool changed_for_backend_ = false, weights_for_backend_ = false;
  std::optional<BrainArrays> shared_;
};

}  // namespace mercury
