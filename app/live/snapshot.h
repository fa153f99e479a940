// SPDX-License-Identifier: Apache-2.0
// The state that a picture shows. The physics thread makes it; it never changes afterwards (physics.h, Threads).
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "app/live/snapshot_positions.h"
#include "app/live/timeline_state.h"
#include "app/scene/robot_shape.h"
#include "app/scene/scene_details.h"
#include "mercury/simulation.h"

namespace mercury {

// Identifies a robot of the window. Ids are never reused.
using RobotId = std::uint64_t;

// A speed: as fast as the device allows.
inline constexpr double unlimited_speed = std::numeric_limits<double>::infinity();

// A robot and its changes in the window.
struct LiveRobot {
  RobotId id = 0;
  std::string name;  // replaces the robot's own name
  std::shared_ptr<const Robot> robot;
  std::shared_ptr<const std::vector<Material>> materials;  // replaces its table, same length; or null
  RobotId begins_as = 0;  // a new robot begins in the state of this one, if it is the same body; 0 = at rest
};

// The table in use, indexed by material id.
std::span<const Material> materials_of(const LiveRobot& robot);

// The robots of a snapshot, in the order of the window's list of robots.
struct LiveRobots {
  std::uint64_t revision = 0;  // grows when robots are added, removed or replaced
  std::vector<LiveRobot> robots;
  std::vector<std::size_t> mass_offsets;             // size + 1
  std::unordered_map<RobotId, std::size_t> indices;  // of all robots, or empty
  std::size_t springs = 0;                           // of all robots
  // For pictures; made by the physics thread, constant while `revision` is.
  std::vector<std::shared_ptr<const RobotShape>> shapes;
  std::shared_ptr<const render::BodyData> bodies;

  std::size_t size() const { return robots.size(); }
  // Returns nothing if the robot is missing.
  std::optional<std::size_t> index_of(RobotId id) const;
};

// A perturbation by the user: a spring of rest length 0 from a mass to a point in the robot's own frame.
struct LivePerturbation {
  // By the mouse, while it is held; or attached, until it is removed. A pin is stiff, and after a reset it holds the
  // mass where it starts.
  enum class Kind { mouse, spring, pin };
  RobotId robot = 0;
  std::uint16_t mass = 0;
  Vec3 target;           // [m]
  float stiffness = 50;  // [N/m]
  Kind kind = Kind::mouse;
  friend bool operator==(const LivePerturbation&, const LivePerturbation&) = default;
};

struct Snapshot {
  std::shared_ptr<const LiveRobots> robots;
  Configuration configuration;
  double time = 0;  // [s]
  std::int64_t steps = 0;
  std::uint64_t resets = 0;          // number of jumps in time, such as returns to time 0
  std::uint64_t stops = 0;           // number of pauses by an explosion or a failure
  std::uint64_t failed_seconds = 0;  // number of second sides that ended by a failure
  std::uint64_t failed_ghosts = 0;   // the same of ghosts
  SnapshotPositions positions;       // [m], of all masses; robot i starts at robots->mass_offsets[i]; in its own frame
  std::vector<Vec3> velocities;      // [m/s], as many; empty while robots play, unless requested
  std::vector<Telemetry> telemetry;  // per robot
  SceneDetails details;
  const ColorQuantity* color = &material_color();  // the quantity in details.values
  std::vector<LivePerturbation> perturbations;

  // The same moment of what goes along with these robots (companion.h), or null: the second side, and the ghosts. A
  // ghost has the id of its robot.
  std::shared_ptr<const Snapshot> second, ghosts;

  TimelineState timeline;

  bool playing = false;
  double speed = 1;               // requested, in simulated seconds per second
  double due_at = 0;              // wall time at which it should be shown, if playing at a finite speed [s]
  double achieved_speed = 0;      // over about the last second; 0 = paused
  double springs_per_second = 0;  // 0 while paused
  double step_seconds = 0;        // wall time of one step [s], 0 = unknown
  double gathering_seconds = 0;   // wall time of making this snapshot [s]

  std::span<const Vec3> positions_of(std::size_t robot) const;
  std::span<const Vec3> velocities_of(std::size_t robot) const;  // empty if the snapshot has none
};

}  // namespace mercury
