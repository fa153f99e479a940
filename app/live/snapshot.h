// SPDX-License-Identifier: Apache-2.0
// The state that a view shows. The physics thread makes it; it never changes afterward (physics.h, Threads).
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "app/options/trial_start.h"
#include "app/scene/robot_shape.h"
#include "app/scene/scene_details.h"
#include "app/video/position_bridge.h"
#include "mercury/simulation.h"

namespace mercury {

// Identifies a robot of the window. Ids are never reused.
using RobotId = std::uint64_t;

// A speed: as fast as the device allows.
inline constexpr double unlimited_speed = std::numeric_limits<double>::infinity();

// What a user holds of a robot by hand. NaN = nothing; the lists may be empty.
struct ByHand {
  std::vector<float> drives;   // u per actuator
  std::vector<float> neurons;  // value per neuron of its brain
};

// A robot and its changes in the window.
struct LiveRobot {
  RobotId id = 0;
  std::string name;  // replaces the robot's own name
  std::shared_ptr<const Robot> robot;
  std::shared_ptr<const std::vector<Material>> materials;  // replaces its table, same length; or null
  std::shared_ptr<const ByHand> by_hand = {};              // null = nothing is held
  RobotId begins_as = 0;  // a new robot begins in the state of this one, if it is the same body; 0 = of none
  friend bool operator==(const LiveRobot&, const LiveRobot&) = default;
};

// The table in use, indexed by material id.
std::span<const Material> materials_of(const LiveRobot& robot);

// What drives these robots by hand, for Simulation::hold_drives().
std::vector<HeldDrive> held_drives(std::span<const LiveRobot> robots);
// The values of its neurons that are held by hand; may be empty.
std::span<const float> held_neurons(const LiveRobot& robot);
// Clamps and releases neurons of a robot of a simulation so that these are held `now`, where those were `before`.
void clamp_neurons(Simulation& simulation, std::size_t robot, std::span<const float> before,
                   std::span<const float> now);

// The robots as the window has them, where they begin: with their names, materials and what is held by hand.
Simulation simulation_of(std::span<const LiveRobot> robots, const Configuration& configuration,
                         const TrialStart& start = {});

// The robots of a snapshot, in the order of the window's list of robots.
struct LiveRobots {
  std::uint64_t revision = 0;  // grows when robots are added, removed or replaced
  std::vector<LiveRobot> robots;
  std::vector<std::size_t> mass_offsets;             // size + 1
  std::unordered_map<RobotId, std::size_t> indices;  // of all robots, or empty
  std::size_t springs = 0;                           // of all robots
  // For frames; made by the physics thread, constant while `revision` is.
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

// The positions of a snapshot: on the host, or on the GPU until somebody on the host asks for them. The physics thread
// sets them; afterward every thread may read them.
class SnapshotPositions {
 public:
  std::size_t size() const { return size_; }  // number of masses
  // Positions on the host, to be written [m].
  std::span<Vec3> set_on_host(std::size_t masses);
  void set_on_device(std::unique_ptr<PositionSnapshot> positions, std::size_t masses);
  // Gives back the memory of the GPU.
  void release_device() { device_.reset(); }

  // Null = they are on the host.
  const PositionSnapshot* device() const { return device_.get(); }
  // The first call copies them from the GPU and waits for that. Throws DeviceError.
  std::span<const Vec3> host() const;
  // The same for `count` of them from `first` on; those of a robot arrive much sooner than those of all.
  std::span<const Vec3> host(std::size_t first, std::size_t count) const;

 private:
  std::size_t size_ = 0;
  std::unique_ptr<PositionSnapshot> device_;
  mutable std::mutex mutex_;
  mutable bool on_host_ = true;
  mutable std::vector<Vec3> host_;
  mutable std::map<std::size_t, std::vector<Vec3>> host_parts_;  // copied by themselves, by the first mass
};

// What a view says about the timeline of its robots (timeline.h). Times are simulated [s].
struct TimelineState {
  double begin = 0, head = 0;  // the moments that can be shown
  bool viewing = false;        // shows an earlier moment, or a recording
  bool recording = false;      // of a file
  bool seeking = false;        // is on its way to `target`
  double target = 0;
  bool looping = false;
  double loop_begin = 0, loop_end = 0;
  std::size_t bytes = 0, budget = 0, keyframes = 0;  // of memory: used, at most
};

// What a brain felt and did when it thought last, in the order of BrainLayout.
struct BrainActivity {
  RobotId robot = 0;
  std::vector<float> senses, neurons;
};

// The same at moments of a recording, from its start to its end.
struct BrainHistory {
  RobotId robot = 0;
  std::vector<double> times;  // [s]
  std::vector<BrainActivity> activity;
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
  // Of the robot that is watched (PhysicsThread::watch_brain()). Of a recording, if it has them; its history then, too.
  std::optional<BrainActivity> brain;
  std::shared_ptr<const BrainHistory> brain_history;
  SceneDetails details;
  const ColorQuantity* color = &material_color();  // the quantity in details.values
  std::vector<LivePerturbation> perturbations;

  // The same moment of what goes along with these robots (comparison.h), or null: the second side, and the ghosts. A
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

// Memory of snapshots, used again: a snapshot of a large scene is tens of megabytes, too much to allocate per frame.
// Whoever drops the last reference to a snapshot, on whatever thread, gives its memory back to the pool. The pool may
// be destroyed before its snapshots.
class SnapshotPool {
 public:
  // A snapshot that may still hold old values: the caller sets every member.
  std::shared_ptr<Snapshot> take() {
    std::unique_ptr<Snapshot> snapshot;
    {
      const std::lock_guard lock(free_->mutex);
      if (!free_->snapshots.empty()) {
        snapshot = std::move(free_->snapshots.back());
        free_->snapshots.pop_back();
      }
    }
    if (!snapshot) snapshot = std::make_unique<Snapshot>();
    return {snapshot.release(), [free = free_](Snapshot* done) {
              std::unique_ptr<Snapshot> owned(done);
              owned->positions.release_device();
              owned->second.reset();
              owned->ghosts.reset();
              const std::lock_guard lock(free->mutex);
              if (free->snapshots.size() < most_free) free->snapshots.push_back(std::move(owned));
            }};
  }

 private:
  static constexpr std::size_t most_free = 4;
  struct Free {
    std::mutex mutex;
    std::vector<std::unique_ptr<Snapshot>> snapshots;
  };
  std::shared_ptr<Free> free_ = std::make_shared<Free>();
};

}  // namespace mercury
