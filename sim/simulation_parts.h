// SPDX-License-Identifier: Apache-2.0
// What a Simulation owns. Its functions are in simulation.cpp (robots and time), simulation_state.cpp (states,
// explosions, telemetry) and simulation_controls.cpp (materials, perturbations).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mercury/folding.h"
#include "mercury/simulation.h"
#include "sim/brains.h"
#include "sim/shared_arrays.h"

namespace mercury {

// When a robot exploded and by which spring. A backend reports only the step and perhaps a mass; the rest takes a
// search over the frozen robot, so it is done when somebody first asks, and kept. The frozen state cannot change
// meanwhile.
struct KnownExplosion {
  std::int64_t step = -1;  // RobotStatus::exploded_step that this belongs to; -1 = nothing is known yet
  double at = 0;           // [s]
  std::uint32_t culprit_spring = no_spring;
};

struct Simulation::Parts {
  Configuration configuration;
  Clock clock;
  std::vector<std::shared_ptr<const Robot>> robots;            // the backend refers to them
  std::vector<const Robot*> pointers;                          // the same, for the backend
  std::vector<std::size_t> offsets{0};                         // mass_offsets()
  std::vector<std::unique_ptr<MaterialTable>> changed_tables;  // as they are now; null = the robot's own
  std::vector<std::optional<Environment>> environments;        // one per robot; nothing = the configuration's
  mutable std::vector<KnownExplosion> explosions;              // one per robot
  mutable std::vector<RobotStatus> reported;                   // one per robot, used by telemetry()
  std::function<MeasuredFolding(const Robot&)> folding_of;     // none = of no robot
  // One per robot; nothing = not known yet, null = not measured.
  mutable std::vector<std::optional<std::shared_ptr<const BodyCells>>> cells;
  mutable std::optional<bool> backend_measures;  // their inversion; none = it has not been asked
  bool upright = false;                          // is measured
  double check_seconds = 0;                      // LoadTimes::check
  std::vector<float> lifts;                      // by which robots at rest stand higher; empty = not known
  SharedState shared_state;
  SharedActuation shared_actuation;
  Brains brains;
  std::unique_ptr<Backend> backend;  // last: released before the robots

  // Throws as Simulation's constructors do.
  Parts(const Configuration& initial, std::unique_ptr<Backend> stepped_by,
        std::span<const std::shared_ptr<const Robot>> first_robots, const WorkWatch& watch = {});

  std::size_t size() const { return robots.size(); }
  std::size_t masses(std::size_t robot) const { return offsets[robot + 1] - offsets[robot]; }

  // Throw std::out_of_range.
  void require(std::size_t robot) const;
  void require_material(std::size_t robot, MaterialId id) const;

  // Checks robots and takes them after the others, without the backend. Throws InputError, and has no effect then.
  void append(std::span<const std::shared_ptr<const Robot>> added, const WorkWatch& watch = {});
  // Forgets the robots from this index on, without the backend.
  void truncate(std::size_t size);
  // One per robot: how much higher it stands at rest than in its file, so that it is on the floor if there is one [m].
  std::span<const float> rest_lifts();
  // Puts robots from this index on at rest, on the floor if there is one.
  void put_at_rest(std::size_t first);

  bool find_cells() const;  // returns whether the folding of any robot is measured
  // Whether telemetry needs the positions: the backend does not measure all that somebody asks for.
  bool reads_posture() const;
  // To telemetry of all robots, explosions included, what positions say and somebody asks for.
  void add_posture(std::span<Telemetry> telemetry) const;
  // Without the explosion.
  State state(std::size_t robot) const;
  // All materials of a robot as they are now. Ids that the robot does not have are air.
  MaterialTable table(std::size_t robot) const;

  const KnownExplosion& explosion(std::size_t robot, const RobotStatus& status) const;
  // Fills in the explosion, if there is one. `out` is a State or a Telemetry.
  void add_explosion(auto& out, std::size_t robot, const RobotStatus& status) const {
    if (status.exploded_step < 0) return;
    const KnownExplosion& known = explosion(robot, status);
    out.exploded = true;
    out.exploded_at = known.at;
    out.culprit_spring = known.culprit_spring;
  }
  void change_clock(const Clock& changed);

  // Adds the environment's push to the velocities of all robots that have not exploded.
  void push();
  // When the environment pushes; nothing = it does not, or not any more.
  std::optional<std::int64_t> push_step() const;
  bool pushes_within(std::int64_t steps) const;

  // change(brains), between begin_access() and end_access().
  void change_brains(auto&& change) {
    brains.begin_access();
    change(brains);
    brains.end_access();
  }
  // Whether there are brains that think here, between calls of the backend.
  bool host_thinks();
  // Steps the backend, and lets the brains think meanwhile.
  void advance(std::int64_t steps);
  // To be called before the backend steps, and after it has changed the state. Returns how many steps it may take.
  std::int64_t before_step();
  void after_change() const { shared_state.publish(*backend, pointers); }
  // Gives the backend the environments of robots that have their own.
  void write_environments();
  // To be called when robots have come or gone. `kept` = the old indices of the first ones.
  void after_exchange(std::span<const std::size_t> kept);
};

// How far a robot is lifted (or lowered) so that its lowest mass is at z = 0 on land [m]; 0 in other environments.
float lift_to_floor(std::span<const Vec3> positions, const Environment& environment);

// Throws std::invalid_argument for a clock that Simulation::set_clock() refuses.
void require_clock(const Clock& clock, const Configuration& configuration);

}  // namespace mercury
