// SPDX-License-Identifier: Apache-2.0
// A group of simulated robots, laid out in a picture and ready to be drawn at any time of the simulation.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/scene/board.h"
#include "app/scene/camera_controller.h"
#include "app/scene/group_scene.h"
#include "app/scene/scene_details.h"
#include "app/scene/view_settings.h"
#include "app/video/position_bridge.h"
#include "mercury/simulation.h"
#include "render/renderer.h"

namespace mercury {

// What one frame shows.
struct FrameSnapshot {
  double time = 0;  // [s]
  std::unique_ptr<PositionSnapshot> positions;
  std::vector<Telemetry> telemetry;
  SceneDetails details;
};

// What pictures between two steps show of the robots: centers of mass of `telemetry` become those at that share of the
// way.
void interpolate_centers(std::span<const Telemetry> earlier, std::span<const Telemetry> later, float share,
                         std::span<Telemetry> telemetry);

// The simulating thread calls take() and the drawing thread everything else, possibly at the same time. Refers to the
// simulation, whose robots stay the same.
class GroupDrawing {
 public:
  // `aspect` of the picture; `names`: one per robot, shown instead of its own; empty = its own. Uses no OpenGL. Throws
  // InputError for a setting that does not suit the robots or their environment.
  GroupDrawing(const Simulation& simulation, const ViewSettings& settings, float aspect,
               std::span<const std::string> names = {});

  // Gives the robots to a renderer. Call it before draw(), and again when the renderer has drawn others.
  void set_bodies(render::Renderer& renderer) const { scene_.set_bodies(renderer); }

  // The simulation's current state. `with_details`: else its colors and arrows are not needed. `share`: positions are
  // this share of a step later than the simulation's step (playback()).
  FrameSnapshot take(PositionBridge& bridge, bool with_details = true, float share = 0);
  // See DetailObserver, for moments between two snapshots.
  std::optional<std::int64_t> next_look() const { return details_.next_look(); }
  void look() { details_.look(simulation_.telemetry()); }
  // At that share of the way from one step to the next: centers and positions are mixed, the rest is that of the nearer
  // step, which needs its details.
  static FrameSnapshot between(const FrameSnapshot& earlier, const FrameSnapshot& later, float share,
                               PositionBridge& bridge);
  // Draws it. `bridge`: that of take(). `elapsed`: since the previous picture, for the camera [s of video].
  void draw(FrameSnapshot& snapshot, PositionBridge& bridge, render::Renderer& renderer, double elapsed);

  // draw() in parts, for groups that share a camera and a scale of colors. show() makes it the picture that is drawn.
  void show(FrameSnapshot& snapshot, PositionBridge& bridge, render::Renderer& renderer);
  const render::Scene& scene() { return scene_.scene(); }
  std::span<const render::Bounds> camera_boxes() const { return scene_.camera_boxes(); }
  // The camera that keeps these boxes in view.
  render::Camera camera(std::span<const render::Bounds> boxes, double elapsed);
  // What is shown from the next show() on.
  void set_shown(const Shown& shown);
  // Takes the ends of the scale that another group with the same colors had in its last show().
  void share_scale(GroupDrawing& other);

 private:
  const Simulation& simulation_;
  ViewSettings settings_;
  GroupPlacement placement_;
  GroupScene scene_;
  CameraController camera_;
  DetailObserver details_;
};

}  // namespace mercury
