// SPDX-License-Identifier: Apache-2.0
// The mouse on the picture: camera, selection, pulling, figures of what is under it.
#pragma once

#include <optional>

#include "app/window/picture/desk.h"

namespace mercury::window {

// Where the picture is in the window, in ImGui's coordinates.
struct PictureArea {
  ImVec2 low, high;
  float width() const { return high.x - low.x; }
  float height() const { return high.y - low.y; }
  float aspect() const { return width() / height(); }
};

class Hands {
 public:
  // Takes the mouse where no panel has it. Call between begin_frame() and end_frame(); `camera` is the one the picture
  // was drawn with last.
  void work(Desk& desk, const PictureArea& area, const render::Camera& camera);
  // Force and figures, over the picture.
  void draw(Desk& desk, const PictureArea& area, const render::Camera& camera);
  bool busy() const { return grip_ != Grip::none; }

 private:
  enum class Grip { none, turn, pan, pull };
  void press(Desk& desk, const PictureArea& area, const render::Camera& camera);
  void drag(Desk& desk, const PictureArea& area, const render::Camera& camera);
  void release(Desk& desk, const PictureArea& area, const render::Camera& camera);
  void hover(Desk& desk, const PictureArea& area, const render::Camera& camera);

  Grip grip_ = Grip::none;
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
