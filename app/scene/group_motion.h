// SPDX-License-Identifier: Apache-2.0
// Where the robots of a group are shown while they move.
//
//   grid    each robot travels through the picture as it travels through the world
//   cells   its center of mass stays in the middle of its cell; on land it keeps its height
//   race    it stays in its lane, as far from the start line as it is from its start, whichever way it went
//
// A robot that has exploded counts at the place where it was last.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "app/scene/group_layout.h"
#include "app/scene/trail.h"
#include "app/scene/view_settings.h"
#include "mercury/configuration.h"
#include "render/camera.h"
#include "render/vector.h"

namespace mercury {

// The offsets at which a group starts, by its settings. `boxes` and `rooms`: one per robot.
std::vector<render::Vector3> group_offsets(std::span<const render::Bounds> boxes, std::span<const Room> rooms,
                                           const ViewSettings& settings, const Environment& environment, float aspect);

// The layout that the motion of a group follows. A board has cells of its own, through which robots travel.
Layout motion_of(const ViewSettings& settings);

class GroupMotion {
 public:
  // Lanes run along this direction.
  void set(Layout layout, const Environment& environment, const render::Vector3& along);

  // The offset of a robot that starts with `offset` and has come along `trail`.
  render::Vector3 offset_of(const render::Vector3& offset, const Room& room, const Trail& trail) const;
  // The offset of the ghost of a robot that is shown with `shown`; the ghost's center of mass is at `ghost`. The two
  // are as far apart as they are, in cells at most by the room's radius; in a race the ghost is in the same lane.
  render::Vector3 ghost_offset(const render::Vector3& shown, const Room& room, const Trail& trail, Vec3 ghost) const;
  // How far the robot is from its start [m]; in a race, its place along its lane.
  float progress_of(const Trail& trail) const;
  // The box that a camera shows: `box` is around the robot, `offset` its own at the start.
  render::Bounds camera_box(const render::Bounds& box, const render::Vector3& offset, const Room& room) const;

  Layout layout() const { return layout_; }
  bool on_land() const { return on_land_; }
  const render::Vector3& along() const { return along_; }

 private:
  Layout layout_ = Layout::grid;
  bool on_land_ = false;
  Environment environment_;
  render::Vector3 along_{1, 0, 0};
};

// While the mouse pulls at a robot, the robot follows it: what is subtracted of its way stays as it was. Afterward it
// glides back into its cell.
class HeldRobot {
 public:
  // The robot that is held now, and the time since the last call [s].
  void hold(std::optional<std::size_t> robot, double elapsed);
  // What is added to the offset `wanted` of this robot in the picture; call it once per robot and picture.
  render::Vector3 correction(std::size_t robot, const render::Vector3& wanted);

 private:
  struct Offset {
    std::size_t robot = 0;
    bool held = true;
    std::optional<render::Vector3> kept;  // the offset at which it was taken hold of
    render::Vector3 correction{0, 0, 0};
  };
  std::vector<Offset> offsets_;
};

}  // namespace mercury
