// SPDX-License-Identifier: Apache-2.0
// The mouse on the viewport: turns and moves the camera, selects robots, pulls on masses, pushes robots, shows details
// of what is under the pointer.
#pragma once

#include <functional>
#include <optional>

#include "app/live/live_scene.h"
#include "app/live/picking.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/toolkit/toasts.h"
#include "app/window/viewport/orbit_controller.h"
#include "app/window/viewport/viewport.h"

namespace mercury::window {

// The gestures that the user has made.
struct UsedGestures {
  bool turned = false, moved = false, zoomed = false, pulled = false;
};

// What happens to clicks beside selecting and turning.
struct MouseActions {
  std::function<bool(const Hit& hit)> click;  // on a robot; returns true if that is all
  std::function<void(const Hit& hit)> menu;   // a right click on a robot
};

class MouseController {
 public:
  // `pinned`: the mass and spring that were clicked, while their robot is selected.
  MouseController(LiveScene& scene, OrbitController& camera, EventLog& log, Toasts& toasts, std::optional<Hit>& pinned)
      : scene_(scene), camera_(camera), log_(log), toasts_(toasts), pinned_(pinned) {}

  void set_actions(MouseActions actions) { actions_ = std::move(actions); }
  // Handles the mouse where no panel uses it. Call between begin_frame() and end_frame() of ImGuiLayer. `camera`: the
  // one the last frame was drawn with.
  void update(const ViewportArea& area, const render::Camera& camera);
  // Draws the force of a pull, the velocity of a push and, if `figures`, the details under the pointer.
  void draw(const ViewportArea& area, const render::Camera& camera, bool figures);
  // The robot under the pointer, by its index in the snapshot.
  std::optional<std::size_t> hovered() const;
  // What it is over there.
  const std::optional<Hit>& hovered_hit() const { return hovered_; }
  // True while a button is held.
  bool busy() const { return drag_ != Drag::none; }
  const UsedGestures& used() const { return used_; }

 private:
  enum class Drag { none, turn, pan, pull, push, box };
  void press(const ViewportArea& area, const render::Camera& camera);
  void drag(const ViewportArea& area, const render::Camera& camera);
  void release(const ViewportArea& area, const render::Camera& camera);
  void hover(const ViewportArea& area, const render::Camera& camera);

  void click(const ViewportArea& area, const render::Camera& camera);
  void select_box(const ViewportArea& area, const render::Camera& camera);
  void draw_springs(const ViewportArea& area, const render::Camera& camera) const;
  void draw_box() const;
  render::Vector3 pushed_to(const ViewportArea& area, const render::Camera& camera) const;
  void draw_push(const ViewportArea& area, const render::Camera& camera) const;
  void draw_pull(const ViewportArea& area, const render::Camera& camera) const;
  void draw_details(const ViewportArea& area) const;

  LiveScene& scene_;
  OrbitController& camera_;
  EventLog& log_;
  Toasts& toasts_;
  MouseActions actions_;
  UsedGestures used_;
  Drag drag_ = Drag::none;
  int button_ = 0;
  bool dragged_ = false;
  ImVec2 pressed_at_{0, 0};
  float pull_depth_ = 0;      // of the pulled or pushed point along the line of sight [m]
  render::Vector3 pushed_{};  // the point where a push begins [m]
  bool follows_ = false;      // the press was a double click
  std::optional<Hit> hovered_;
  std::optional<Hit>& pinned_;
  ImVec2 last_position_{-1, -1};
  double rest_time_ = 0;  // since the mouse last moved [s]
  double next_pick_ = 0;  // when hovered_ is looked up again, in ImGui's time [s]
};

}  // namespace mercury::window
