// SPDX-License-Identifier: Apache-2.0
// What the mouse does in the window's scene: picks robots, pulls at a mass, and attaches pins and springs that stay.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "app/live/picking.h"

namespace mercury {

class DrawnScene;
class SceneComparison;
class SceneCore;
class SceneSelection;

// A perturbation by the mouse as the window draws it. Positions are those in the view.
struct PerturbationDetails {
  RobotId robot = 0;
  std::uint16_t mass = 0;
  render::Vector3 at, target;  // of the mass and of the mouse [m]
  float stiffness = 0;         // [N/m]
  float force = 0;             // [N]
};

// Rays and positions are those in the view, or in that of the second side.
class SceneMouse {
 public:
  // `drawn`: the view of the first side.
  SceneMouse(SceneCore& core, const SceneSelection& selection, const DrawnScene& drawn,
             const SceneComparison& comparison)
      : core_(core), selection_(selection), drawn_(drawn), comparison_(comparison) {}

  void point_at_second(bool second) { pointed_second_ = second; }
  bool points_at_second() const;
  const Snapshot& pointed_snapshot() const;
  const DrawnScene& pointed_drawn() const;
  std::optional<Hit> pick(const render::Ray& ray) const;
  HitDetails describe(const Hit& hit) const;

  void begin_perturbation(const Hit& hit, float stiffness = 0);  // [N/m]; 0 = suits the robot
  void move_perturbation(const render::Vector3& target);
  void set_perturbation_stiffness(float stiffness);
  void end_perturbation();
  std::optional<PerturbationDetails> perturbation() const;

  // Springs that stay until they are removed or their robot goes; each change is an edit. attach_perturbation() ends
  // the perturbation and leaves its spring; pin() holds a mass where it is, and after a reset where it starts.
  void attach_perturbation();
  void pin(const Hit& hit);
  bool has_attachments(const std::vector<RobotId>& robots) const;
  void remove_attachments(const std::vector<RobotId>& robots);
  std::vector<PerturbationDetails> attachments() const;

  // LiveScene::frame() calls it.
  void update();

 private:
  std::optional<PerturbationDetails> details_of(const LivePerturbation& pull) const;

  SceneCore& core_;
  const SceneSelection& selection_;
  const DrawnScene& drawn_;
  const SceneComparison& comparison_;
  bool pointed_second_ = false;  // the mouse is on the second side
  mutable int described_ = 0;    // frames until snapshots stop reading velocities for describe()
};

}  // namespace mercury
