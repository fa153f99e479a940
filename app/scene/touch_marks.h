// SPDX-License-Identifier: Apache-2.0
// Where robots feel the ground: their touch sensors light up in pictures.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mercury/simulation.h"
#include "render/vector.h"

namespace mercury {

struct TouchMark {
  std::uint32_t body = 0;
  render::Vector3 center;  // below a mass on the ground, in the robot's coordinates [m]
  float radius = 0;        // half a spring [m]
  float share = 0;         // of the sensor's masses that are on the ground, in (0, 1]
};

class TouchObserver {
 public:
  explicit TouchObserver(const Simulation& simulation);

  bool feels() const { return !places_.empty(); }  // whether a robot has such sensors, and ground to feel
  // `positions`: as Simulation::read_positions(). One mark per mass on the ground that a sensor
  // feels; none for exploded robots.
  std::vector<TouchMark> marks(std::span<const Vec3> positions, std::span<const Telemetry> telemetry) const;

 private:
  struct Place {
    std::uint32_t robot = 0;
    std::vector<std::size_t> masses;  // of all robots' masses
    float radius = 0;                 // [m]
  };
  std::vector<Place> places_;
};

}  // namespace mercury
