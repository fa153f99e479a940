// SPDX-License-Identifier: Apache-2.0
// The simulation of the window, on a thread of its own.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/live/measurements.h"
#include "app/live/messages.h"
#include "app/live/snapshot.h"
#include "app/recording/repro.h"
#include "app/scene/view_settings.h"

namespace mercury {

struct Explosion {
  RobotId robot = 0;
  double time = 0;                           // [s]
  std::uint32_t culprit_spring = no_spring;  // index in Robot::springs
};

// Steps a simulation in slices of a few milliseconds and tells of it whenever somebody looks. All members are for one
// other thread, and none but wait_until_done() waits for physics: what is asked for is noted, the last wish of a kind
// counts, and is carried out between slices in this order: scene, view, reset, steps.
// The results depend on the steps alone, not on how they fall into slices.
class Physics {
 public:
  // Throws InputError for a configuration that cannot be used, DeviceError when the device is not there.
  explicit Physics(const Configuration& configuration, Messages& messages);
  ~Physics();
  Physics(const Physics&) = delete;
  Physics& operator=(const Physics&) = delete;

  // Simulates these robots, each valid, under this configuration, whose device must be the first one's. Robots that are
  // there already keep their state; new ones start at rest at the present time; one that was there before goes on from
  // where it left, unless time began anew since. If they cannot be simulated, as for want of memory, that is told, and
  // none is until the next call.
  void set_scene(std::vector<LiveRobot> robots, const Configuration& configuration);
  // One robot, from the start of a repro, whose changes happen again as its steps are made; reset() goes back there,
  // and steps asked for before are forgotten. The next set_scene() ends that: what the repro would still change, it
  // does not. `configuration` is the repro's.
  void set_repro(const LiveRobot& robot, const Configuration& configuration, std::shared_ptr<const Repro> repro);
  void set_view(const ViewSettings& settings);  // what snapshots hold details of
  void set_perturbations(
      std::vector<LivePerturbation> perturbations);  // those on masses that are not there are left out
  void play();
  void pause();
  void set_speed(double speed);   // above 0; unlimited_speed = as fast as it goes
  void step(std::int64_t count);  // pauses, then so many steps; several calls add up
  void reset();                   // time 0, all at rest; steps asked for before are forgotten
  void pause_on_explosion(bool pause);
  // Whether snapshots have velocities while robots play, too; else only at rest, and those that wait_until_done() waits
  // for.
  void watch_velocities(bool watch);

  // The newest snapshot told; asks for a newer one. Never nothing.
  std::shared_ptr<const Snapshot> newest();
  // Those since the last call, and robots that came back exploded.
  std::vector<Explosion> take_explosions();
  // What it takes to see a robot's explosion again; nothing unless it exploded since time began.
  std::optional<Repro> repro(RobotId robot) const;
  const Measurements& measurements() const;
  std::string device_name() const;

  // Waits until all that was asked for is carried out, steps as well, and newest() tells of it.
  void wait_until_done();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
