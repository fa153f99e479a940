// SPDX-License-Identifier: Apache-2.0
// Footprints: where robots pressed into the sand, and what a picture shows of it.
//
//   physics   FootprintObserver   which masses, edges and faces touch the ground now   -> GroundContacts
//   drawing   Footprints          one per robot: its prints, each with the time in which something was there
//   renderer  Scene::prints       the prints of this moment, which become a map of the ground's height
//
// A print is made once and never moves. So the prints of an earlier moment are known: those that had been made by then.
// A picture of any moment shows the same, whether time went there in steps or jumped back.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include "app/scene/trail.h"
#include "mercury/simulation.h"
#include "render/scene.h"
#include "render/vector.h"

namespace mercury {

// A part of a robot's skin that touches the ground: a face, an edge, or a mass alone.
struct GroundContact {
  std::uint32_t body = 0;
  std::uint32_t part = 0;                  // of the body's skin; the same one has the same number
  std::array<render::Vector2, 3> corners;  // in the robot's coordinates [m]; those of an edge and a mass repeat
  float radius = 0;                        // of the print around them [m]
  float depth = 1;                         // of the print, as a share of a face's
};

struct GroundContacts {
  double time = 0;                   // [s]
  std::vector<GroundContact> parts;  // in the order of bodies
};

// Sees contacts on the simulating thread.
class FootprintObserver {
 public:
  explicit FootprintObserver(const Simulation& simulation);

  // Contacts are looked for this many steps apart, also where frames are rarer.
  std::int64_t interval() const { return interval_; }
  // `positions`: as Simulation::read_positions(). None of exploded robots.
  GroundContacts contacts(std::span<const Vec3> positions, std::span<const Telemetry> telemetry) const;

 private:
  const Simulation& simulation_;
  std::vector<float> lengths_;  // of each robot's short springs [m]
  std::int64_t interval_ = 1;
};

// The prints of one robot. They stay for a while after the robot has lifted its foot, and then fade. Where a foot
// slides over its own prints, it leaves no others. Of too many, the oldest are forgotten.
class Footprints {
 public:
  static constexpr std::size_t most = 4000;                          // of a robot
  static constexpr std::size_t most_of_group = 40'000, least = 400;  // that all may have together, and each of them

  explicit Footprints(std::size_t robots = 1)
      : most_(std::clamp(most_of_group / std::max<std::size_t>(robots, 1), least, most)) {}

  static constexpr double whole_for = 8, gone_after = 24;  // since the foot was lifted [s]

  // Time is now `time` [s]. What came later is forgotten or kept, as that of a Trail.
  void go_to(double time, Later later);
  // A contact at that time [s]; call it in the order of time. Times that are known already change nothing.
  void touch(double time, const GroundContact& contact);
  // All contacts up to that time have been given [s].
  void know_until(double time);
  // Appends the prints of the present, moved by `offset`.
  void show(const render::Vector2& offset, std::vector<render::Print>& prints) const;

 private:
  struct Print {
    GroundContact contact;
    double from = 0, until = 0;  // [s]
  };
  void cut(double time);
  void forget_oldest();
  void count_latest();
  void count(std::size_t print);
  // The print to which a contact belongs. Null if it makes another one.
  Print* covering(double time, const GroundContact& contact);

  std::size_t most_;
  std::vector<Print> prints_;                                // by `from`
  std::unordered_map<std::uint32_t, std::size_t> latest_;    // the last print of each part
  std::unordered_map<std::uint64_t, std::size_t> in_cell_;   // the last print of each cell of the ground
  double now_ = 0;                                           // [s]
  double known_ = -std::numeric_limits<double>::infinity();  // contacts are known up to this time [s]
};

}  // namespace mercury
