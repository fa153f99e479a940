// SPDX-License-Identifier: Apache-2.0
// The mouse on the picture: camera, selection, pulling, figures of what is under it.
#pragma once

#include <optional>

#include "app/live/live_scene.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/toolkit/toasts.h"
#include "app/window/viewport/orbit_controller.h"
#include "app/window/viewport/viewport_area.h"

namespace mercury::window {

class MouseController {
 public:
  MouseController(LiveScene& scene, OrbitController& camera, EventLog& log, Toasts& toasts)
      : scene_(scene), camera_(camera), log_(log), toasts_(toasts) {}

  // Takes the mouse where no panel has it. Call between begin_frame() and end_frame(); `camera` is the one the picture
  // was drawn with last.
  void update(const ViewportArea& area, const render::Camera& camera);
  // Force and figures, over the picture.
  void draw(const ViewportArea& area, const render::Camera& camera);
  bool busy() const { return drag_ != Drag::none; }

 private:
  enum class Drag { none, turn, pan, pull };
  void press(const ViewportArea& area, const render::Camera& camera);
  void drag(const ViewportArea& area, const render::Camera& camera);
  void release(const ViewportArea& area, const render::Camera& camera);
  void hover(const ViewportArea& area, const render::Camera& camera);

  LiveScene& scene_;
  OrbitController& camera_;
  EventLog& log_;
  Toasts& toasts_;
  Drag drag_ = Drag::none;
  int button_ = 0;
  bool dragged_ = false;
  ImVec2 pressed_at_{0, 0};
  float pull_depth_ = 0;  // of the pulled place along the line of sight [m]
  bool follows_ = false;  // the press was a double click
  std::optional<Hit> hovered_;
  ImVec2 rests_at_{-1, -1};
  double rested_ = 0;  // how long the mouse has not moved [s]
};

}  // namespace mercury::window
