// SPDX-License-Identifier: Apache-2.0
// Arrows of forces and velocities.
#pragma once

#include <string>
#include <vector>

#include "app/scene/coloring.h"
#include "mercury/simulation.h"
#include "render/scene.h"

namespace mercury {

// Which arrows are shown, and how.
struct ArrowKinds {
  bool drag = false, lift = false;  // on each face
  bool velocity = false;            // of each robot's center of mass
  bool gravity = false;             // at each robot's center of mass
  bool contact = false;             // force of the floor on each mass
  bool force = false;               // net force on each mass
  float length = 1;                 // factor, 0.01 to 100
  float density = 1;                // share of the arrows of faces and masses that is drawn, 0 to 1
  float threshold = 0;              // arrows shorter than this share of the usual longest are left out, 0 to 1

  bool any() const { return drag || lift || velocity || gravity || contact || force; }
  friend bool operator==(const ArrowKinds&, const ArrowKinds&) = default;
};

// Turns forces and velocities into arrows. The scale makes the longest arrow of the median robot about half a robot
// long, times ArrowKinds::length. It grows with larger values by steps of 1, 2 and 5. No arrow is longer than twice
// that. Weak arrows are pale and strong ones vivid, in hues between those of the default muscles.
class Arrows {
 public:
  // Throws ParameterError("show", ...) for drag or lift in an environment without forces on faces, and for contact in
  // one without a floor.
  Arrows(const Simulation& simulation, ArrowKinds kinds);

  // All arrows at this time. `telemetry`: one per robot. Exploded robots have no arrows.
  std::vector<render::Arrow> at(const GroupState& state, std::span<const Telemetry> telemetry);

  // What the lengths of the last at() mean: "drag: 0.1 m = 2 N". Empty without arrows.
  std::string key() const;

 private:
  // The scale of one kind of arrow; it grows with the largest value so far.
  struct Gauge {
    const char* name;
    const char* unit;
    float most = 0;
    void fit(float largest);
  };
  void add_faces(std::size_t robot, const GroupState& state, std::vector<render::Arrow>& drag,
                 std::vector<render::Arrow>& lift) const;
  void add_contacts(std::size_t robot, const GroupState& state, std::vector<render::Arrow>& contacts) const;
  void add_forces(std::size_t robot, const GroupState& state, std::vector<render::Arrow>& forces) const;

  const Simulation& simulation_;
  ArrowKinds kinds_;
  float longest_;  // of an arrow whose value is that of its gauge [m]
  Gauge force_{"force", "N"}, velocity_{"velocity", "m/s"}, contact_{"contact", "N"}, net_{"net force", "N"};
};

}  // namespace mercury
