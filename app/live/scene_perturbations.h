// SPDX-License-Identifier: Apache-2.0
// What pulls at the robots: the mouse, and the pins and springs of the document, which stay. A change is sent to the
// physics thread at once.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "app/live/physics.h"
#include "app/live/scene_document.h"
#include "app/options/attachment_options.h"

namespace mercury {

// Where the mass is in the snapshot; none if it is not there.
std::optional<Vec3> position_of(const Snapshot& snapshot, RobotId robot, std::uint16_t mass);

class ScenePerturbations {
 public:
  ScenePerturbations(SceneDocument& document, PhysicsThread& physics) : document_(document), physics_(physics) {}

  // The mouse.
  const std::optional<LivePerturbation>& by_mouse() const { return by_mouse_; }
  void set_by_mouse(std::optional<LivePerturbation> pull);

  // What stays.
  void attach(LivePerturbation spring);
  void pin(RobotId robot, std::uint16_t mass, const Vec3& target);
  bool attached_to(const std::vector<RobotId>& robots) const;
  void detach(const std::vector<RobotId>& robots);
  void send();
  // To be called in each frame: forgets attachments of robots that are gone, and moves pins after a reset.
  void update(const Snapshot& now);
  void before_reset(const Snapshot& now);
  // Attaches these as soon as their robots are there.
  void attach_later(std::vector<AttachedMass> masses) { to_attach_ = std::move(masses); }
  // Does so. `complete`: no more robots will come, report what is missing.
  void attach_opened(bool complete, Messages& messages);
  // Undo or redo has replaced the document: pins that were there before stay where they are, and pins that come back
  // from before a reset hold their masses where these are now.
  void aim_pins(const std::vector<Attachment>& before, const Snapshot& now);
  // What was attached at the moment shown.
  std::vector<Attachment> attached_at(const Snapshot& moment) const;

 private:
  SceneDocument& document_;
  PhysicsThread& physics_;
  std::optional<LivePerturbation> by_mouse_;
  std::vector<AttachedMass> to_attach_;     // of a scene whose robots are not all there yet
  std::uint64_t resets_ = 0;                // of the scene
  std::optional<std::uint64_t> pins_wait_;  // pins are off until a snapshot of the present has more resets than this
};

}  // namespace mercury
