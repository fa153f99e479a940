// SPDX-License-Identifier: Apache-2.0
// What is shown of a group, and how: the settings that windows and videos share.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "app/scene/arrows.h"
#include "app/scene/board.h"
#include "app/scene/camera_plan.h"
#include "app/scene/color_quantity.h"
#include "app/scene/group_layout.h"
#include "app/scene/side_difference.h"
#include "render/scene.h"

namespace mercury {

struct Shown {
  bool skin = true, springs = false, masses = false;
  bool path = false;      // of each center of mass
  bool labels = false;    // name, distance and rank at each robot
  bool captions = false;  // name at each robot
  bool legend = false;    // of the colors
  bool clock = true;
  bool scale_bar = false;
  ArrowKinds arrows;

  friend bool operator==(const Shown&, const Shown&) = default;
};

struct ViewSettings {
  const ColorQuantity* color = &material_color();
  std::optional<std::pair<float, float>> scale;  // of the colors; absent = fits what is visible (ColorScale)
  std::optional<render::Colormap> colormap;      // absent = that of the quantity
  bool log_scale = false;
  bool scale_all = false;  // of a window: it counts robots outside the view, too
  Shown shown;
  render::Theme theme = render::Theme::dark;
  bool plain = false;                       // a plain backdrop rather than water or land
  std::optional<render::Color> background;  // of a figure: bodies and their shadows alone over it; opacity 0 or 255
  std::optional<float> flat_backdrop;       // while a figure is drawn, see render::Scene
  bool text_aside = false;                  // likewise
  bool smooth = false;                      // all skins are rounded, also those of many robots
  bool faceted = false;                     // none is, but those of robots that networks grew
  bool footprints = true;                   // on land, where the quality of the drawing has them
  bool hero = false;                        // a still of the first robot, see hero_style.h
  float aperture = 0;              // diameter of a still's lens, as a share of the distance to what is in focus
  std::optional<render::Cut> cut;  // opens each robot
  Layout layout = Layout::grid;
  std::optional<Grid> grid;
  CameraPlan camera;
  CameraBookmarks bookmarks;              // of the window
  std::optional<SideDifference> compare;  // a second side, and what it simulates differently
  bool folding = false;                   // measure how robots are folded, for the plots of the window
  std::string caption;                    // text in the upper left corner; further lines are smaller
  std::shared_ptr<const Board> board;     // the robots are drawn in its cells; nullptr = no board
  bool interop = true;                    // let CUDA write into OpenGL's memory if possible
  double speed = 1;                       // simulated seconds per second of the video, for the clock

  friend bool operator==(const ViewSettings&, const ViewSettings&) = default;
};

// Changes the layout and shows what it needs: trails, without which nobody sees that a robot in its cell moves, and the
// distances of a race.
void set_layout(ViewSettings& view, Layout layout);

}  // namespace mercury
