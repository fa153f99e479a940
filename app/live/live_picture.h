// SPDX-License-Identifier: Apache-2.0
// The newest snapshot as a scene to draw: where the robots stand, what they look like.
#pragma once

#include <Eigen/Core>

#include <memory>
#include <set>
#include <span>
#include <vector>

#include "app/live/snapshot.h"
#include "app/scene/group_scene.h"

namespace mercury {

// Knows no OpenGL but for handing bodies to a renderer.
class LivePicture {
 public:
  LivePicture();
  ~LivePicture();

  // Brings the scene to a snapshot, which is kept until the next one; in slow motion, to what is to be seen at that
  // wall time (slow_motion.h).
  void update(std::shared_ptr<const Snapshot> snapshot, const ViewSettings& settings, float aspect,
              const std::set<RobotId>& selected, const std::set<RobotId>& hidden, double wall);
  // Robots stand anew in rows that suit the picture and the settings' camera angles.
  void lay_out(float aspect);

  // Grows when the renderer must be given the bodies anew: call set_bodies() before drawing then.
  std::uint64_t bodies_revision() const;
  void set_bodies(render::Renderer& renderer) const;
  // Positions included. The caller may change caption, clock, labels and the like until the next update.
  render::Scene& scene();
  // One a robot of the snapshot, in the picture; those of exploded robots are empty, unless all have exploded.
  std::span<const render::Bounds> bounds() const;
  // Where a robot's masses are shown, in its own coordinates.
  std::span<const Vec3> positions_of(std::size_t robot) const;
  // Added to the robots' own coordinates [m].
  std::span<const Eigen::Vector3f> offsets() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
