// SPDX-License-Identifier: Apache-2.0
// The scene that the window draws, made from the newest snapshot: layout, colors, arrows, labels.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "app/live/snapshot.h"
#include "app/scene/group_scene.h"
#include "render/vector.h"

namespace mercury {

// The color of ghosts.
render::Color ghost_color(render::Theme theme);

// Uses no OpenGL, except through the renderer in set_bodies().
class LivePicture {
 public:
  LivePicture();
  ~LivePicture();

  // Updates the scene from a snapshot and keeps the snapshot until the next call. In slow motion the scene shows the
  // robots between two snapshots (slow_motion.h); `wall` is the present wall time [s]. `held`: the robot at which the
  // mouse pulls.
  void update(std::shared_ptr<const Snapshot> snapshot, const ViewSettings& settings, float aspect,
              const std::set<RobotId>& selected, const std::set<RobotId>& hidden, std::optional<RobotId> held,
              double wall);
  // Arranges the robots again in rows that suit the picture's aspect ratio and the camera angles of the settings.
  void lay_out(float aspect);

  // Changes when the bodies change. Then call set_bodies() before drawing.
  std::uint64_t bodies_revision() const;
  void set_bodies(render::Renderer& renderer) const;
  // The bridge by which positions on the GPU get into the renderer. Its context must be current when it is replaced
  // and in the destructor.
  void set_bridge(std::shared_ptr<PositionBridge> bridge);
  // Hands positions that are on the GPU to the renderer, which has these bodies. Call it before drawing.
  void show_positions(render::Renderer& renderer);
  bool positions_on_device() const;  // of the snapshot
  // The scene with positions. The caller may change texts such as caption, clock and labels until the next update.
  render::Scene& scene();
  // Bounds per robot of the snapshot, with offsets. Those of exploded robots are empty unless all robots have exploded.
  std::span<const render::Bounds> bounds() const;
  // The same for cameras (GroupScene::camera_boxes).
  std::span<const render::Bounds> camera_boxes() const;
  // The same for each robot, also those that have exploded: where they were last.
  std::span<const render::Bounds> last_boxes() const;
  // The positions of a robot's masses as drawn, without its offset [m].
  std::span<const Vec3> positions_of(std::size_t robot) const;
  // What is added to each robot's own coordinates in the picture [m].
  std::span<const render::Vector3> offsets() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
