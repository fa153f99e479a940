// SPDX-License-Identifier: Apache-2.0
// What a robot's sensors give at an instant (mercury/brain.h).
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "mercury/clock.h"
#include "mercury/environment.h"
#include "mercury/robot.h"
#include "sim/brain_plan.h"
#include "sim/physics/body_frame.h"

namespace mercury {

// Measures a robot; each quantity once, when a sense first needs it.
class SensedBody {
 public:
  // Refers to its arguments.
  SensedBody(const Robot& robot, const BrainPlan& plan, std::span<const Vec3> positions,
             std::span<const Vec3> velocities, const Environment& environment, Vec3 target);

  // Of a sense that depends on the body, without gain and noise.
  double measure(const BrainPlan::Sense& sense);

 private:
  struct OfPlace {
    std::optional<Double3> center, velocity;
    std::optional<double> strain, strain_rate;
  };
  std::span<const std::uint16_t> masses(std::uint32_t place) const;
  OfPlace& of(std::uint32_t place);
  Double3 center(std::uint32_t place);
  Double3 velocity(std::uint32_t place);
  double strain(std::uint32_t place, bool rate);
  double touch(std::uint32_t place) const;
  const Rotation& frame();
  Double3 turn_rate();

  const Robot& robot_;
  const BrainPlan& plan_;
  std::span<const Vec3> positions_, velocities_;
  const Environment& environment_;
  const Double3 target_;
  std::vector<OfPlace> places_;  // the whole body last
  std::optional<Rotation> frame_;
  std::optional<Double3> turn_rate_;
};

// Sine or cosine of a clock.
float clock_sense(const BrainPlan::Sense& sense, const Clock& clock);

}  // namespace mercury
