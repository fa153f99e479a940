// SPDX-License-Identifier: Apache-2.0
// Arrows that show forces and motion.
#pragma once

#include <string>
#include <vector>

#include "app/scene/coloring.h"
#include "mercury/simulation.h"
#include "render/scene.h"

namespace mercury {

struct ArrowKinds {
  bool drag = false, lift = false;  // on each face
  bool velocity = false;            // of each robot's centre of mass
  bool gravity = false;             // at each robot's centre of mass
  bool contact = false;             // of the floor with each mass on it

  bool any() const { return drag || lift || velocity || gravity || contact; }
};

// Turns forces and velocities into arrows. The scale is chosen so that the longest arrow of the middle robot is about
// half a robot long, and changes only by steps of 1, 2 and 5 as larger ones come; no arrow is drawn more than twice as
// long.
class Arrows {
 public:
  // Throws InputError("--show: ...") for drag or lift in an environment that does not act on faces, and for contact in
  // one without a floor.
  Arrows(const Simulation& simulation, ArrowKinds kinds);

  // `telemetry` one a robot. Exploded robots have none.
  std::vector<render::Arrow> at(const GroupState& state, std::span<const Telemetry> telemetry);

  // What the lengths mean, at the last at(): "drag: 0.1 m = 2 N". Empty without arrows.
  std::string key() const;

 private:
  // Grows with the largest value seen.
  struct Gauge {
    const char* name;
    const char* unit;
    float most = 0;
    float fit(float largest);
  };
  void add_faces(std::size_t robot, const GroupState& state, std::vector<render::Arrow>& drag,
                 std::vector<render::Arrow>& lift) const;
  void add_contacts(std::size_t robot, const GroupState& state, std::vector<render::Arrow>& contacts) const;

  const Simulation& simulation_;
  ArrowKinds kinds_;
  float longest_;  // of an arrow [m]
  Gauge force_{"force", "N"}, velocity_{"velocity", "m/s"}, contact_{"contact", "N"};
};

}  // namespace mercury
