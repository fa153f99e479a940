// SPDX-License-Identifier: Apache-2.0
// The scene that the window draws, made from the newest snapshot: layout, colors, arrows, labels.
#pragma once

#include <deque>
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
class DrawnScene {
 public:
  DrawnScene();
  ~DrawnScene();

  // Updates the scene from a snapshot and keeps the snapshot until the next call. In slow motion the scene shows the
  // robots between two snapshots (SlowMotion); `wall` is the current wall time [s]. `held`: the robot at which the
  // mouse pulls.
  void update(std::shared_ptr<const Snapshot> snapshot, const ViewSettings& settings, float aspect,
              const std::set<RobotId>& selected, const std::set<RobotId>& hidden, std::optional<RobotId> held,
              double wall);
  // The camera of the view, for the next update() (GroupScene::see).
  void see(const render::Camera& camera, float aspect);
  // Arranges the robots again in rows that suit the view's aspect ratio and the camera angles of the settings.
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
  // Counts updates that changed the view.
  std::uint64_t changes() const;
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
  // What is added to each robot's own coordinates in the view [m].
  std::span<const render::Vector3> offsets() const;
  // The middle of a robot's cell, or of where it starts in other layouts [m].
  render::Vector3 cell_center(std::size_t robot) const;
  // Whether a robot is left out of the view: hidden by the user, or torn apart.
  bool is_hidden(std::size_t robot) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// Pictures between two steps. In slow motion a step lasts many frames, and robots would move in jerks.
//
//   wall time  ---|--------|--------|--------|---->
//   snapshots     A        B        C
//   frames                 . . . . . . . . .        on the lines from A to B and from B to C
//
// A frame shows the state one step and 35 ms ago, so that the snapshots before and after it are known.
//
// While physics pauses or makes more than `most_rate` steps per second, shows the newest snapshot as it is.
class SlowMotion {
 public:
  static constexpr double most_rate = 250;    // steps per second of wall time, up to which frames are interpolated
  static constexpr double allowance = 0.035;  // time to compute, publish and fetch a step [s]

  // Adds the newest snapshot.
  void take(std::shared_ptr<const Snapshot> snapshot);

  struct Shown {
    double time = 0;                  // simulated [s]
    std::span<const Vec3> positions;  // on the host; empty if they are on the GPU
    const PositionSnapshot* device = nullptr;
    std::span<const Telemetry> telemetry;  // of the newest snapshot, with interpolated centers of mass
  };
  // The state at a wall time [s]. The spans are valid until the next call of either member.
  Shown at(double wall);

 private:
  double wanted(double wall) const;

  std::deque<std::shared_ptr<const Snapshot>> snapshots_;  // of the same robots, oldest first
  double shown_ = 0;                                       // time of the last frame; it never goes back
  std::vector<Vec3> positions_;
  std::vector<Telemetry> telemetry_;
};

}  // namespace mercury
