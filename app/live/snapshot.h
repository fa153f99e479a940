// SPDX-License-Identifier: Apache-2.0
// What the physics thread tells of a snapshot; never changes once it is given away.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "app/scene/robot_shape.h"
#include "app/scene/scene_details.h"
#include "mercury/simulation.h"

namespace mercury {

// Names a robot of the window for as long as it lives there; never used again.
using RobotId = std::uint64_t;

// So fast as it goes.
inline constexpr double unlimited_speed = std::numeric_limits<double>::infinity();

// A robot as the window wants it simulated.
struct LiveRobot {
  RobotId id = 0;
  std::string name;  // in place of the robot's own
  std::shared_ptr<const Robot> robot;
  std::shared_ptr<const std::vector<Material>> materials;  // in place of its own table, as long as that; or nothing
};

std::span<const Material> materials_of(const LiveRobot& robot);

// The robots of a snapshot, in the order of the window's list.
struct LiveRobots {
  std::uint64_t revision = 0;  // grows whenever robots come, go or are replaced
  std::vector<LiveRobot> robots;
  std::vector<std::size_t> mass_offsets;            // size + 1
  std::unordered_map<RobotId, std::size_t> places;  // of all robots, or empty
  std::size_t springs = 0;                          // of all robots
  // For pictures, made by the physics thread; the same as long as the revision is.
  std::vector<std::shared_ptr<const RobotShape>> shapes;
  std::shared_ptr<const render::BodyData> bodies;

  std::size_t size() const { return robots.size(); }
  // Nothing if it is not there.
  std::optional<std::size_t> index_of(RobotId id) const;
};

// A pull on a mass by a hand: a spring of rest length 0 to a point of the robot's own frame.
struct LivePerturbation {
  RobotId robot = 0;
  std::uint16_t mass = 0;
  Vec3 target;           // [m]
  float stiffness = 50;  // [N/m]
  friend bool operator==(const LivePerturbation&, const LivePerturbation&) = default;
};

struct Snapshot {
  std::shared_ptr<const LiveRobots> robots;
  Configuration configuration;
  double time = 0;  // [s]
  std::int64_t steps = 0;
  std::uint64_t resets = 0;          // how often the robots were put back to time 0
  std::uint64_t stops = 0;           // how often physics stopped by itself: at an explosion or a failure
  std::vector<Vec3> positions;       // of all masses, robot i's from robots->mass_offsets[i]; its own frame
  std::vector<Vec3> velocities;      // as many; empty while robots play and nobody asks for them
  std::vector<Telemetry> telemetry;  // one a robot
  SceneDetails details;
  const ColorQuantity* color = &material_color();  // whose values details.values are
  std::vector<LivePerturbation> perturbations;

  bool playing = false;
  double speed = 1;               // wanted, simulated seconds a second
  double due_at = 0;              // when this snapshot is to be seen, if playing at a finite speed [s of wall time]
  double achieved_speed = 0;      // over the last second or so; 0 = at rest
  double springs_per_second = 0;  // while stepping
  double step_seconds = 0;        // of wall time one step takes, 0 = not known
  double gathering_seconds = 0;   // that it took to gather this snapshot

  std::span<const Vec3> positions_of(std::size_t robot) const;
  std::span<const Vec3> velocities_of(std::size_t robot) const;  // empty where they were not read
};

}  // namespace mercury
