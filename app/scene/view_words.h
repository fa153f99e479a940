// SPDX-License-Identifier: Apache-2.0
// How a picture shows robots, as users write it: words and numbers of the command line and of programs.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/scene/view_settings.h"

namespace mercury {

struct ViewWords {
  std::string color{material_color().key};       // key of a quantity: "strain"
  std::optional<std::pair<float, float>> scale;  // ends of the colors' scale; absent = fits
  std::string colormap;                          // "magma"; empty = that of the quantity
  bool log_scale = false;                        // equal ratios are equally far apart
  std::optional<std::string> show;               // exactly what is shown: "skin,labels"; absent = the usual
  float arrow_length = 1;                        // factor, 0.01 to 100
  float arrow_density = 1;                       // share of the arrows that is drawn, above 0 to 1
  float arrow_threshold = 0;                     // share of the usual longest arrow, 0 to 1: shorter ones are left out
  std::string caption;                           // text in the upper left corner; further lines are smaller
  std::string theme = "dark";                    // "dark" or "light"
  bool plain = false;                            // a plain backdrop rather than water or land
  std::string background;                        // "white", "transparent", "#rrggbb"; empty = the surroundings
  bool scale_bar = false;                        // in addition to what is shown
  bool smooth = false;                           // round skins rather than edged ones, also of many robots
  bool faceted = false;                          // edged skins rather than round ones, also of few robots
  bool footprints = true;                        // in the sand on land
  std::optional<std::string> cut;                // opens each robot beyond a plane: "y:30%"
  std::optional<std::string> layout;             // "grid", "cells" or "race"; absent = the usual
  std::optional<Grid> grid;                      // absent = what fills the picture
  std::string camera;                            // see camera_named(); empty = the whole group
  std::optional<float> azimuth, elevation;       // where the eye is [degrees]
  std::optional<float> zoom;                     // above 1 = closer
  std::optional<std::string> bookmarks;          // of the window: see bookmarks_from()
  std::optional<std::string> compare;            // a second side, as SideDifference says
};

// `usual`: the layout without another word. Throws ParameterError that names the member that cannot be used.
ViewSettings view_settings(const ViewWords& words, Layout usual = Layout::grid);

// "skin,labels,clock": shows exactly these. Throws ParameterError("show", ...) that lists the possible words.
Shown shown_from(const std::string& text);
std::vector<std::string> shown_words();
// As shown_from() reads it; without the sizes of arrows.
std::string shown_text(Shown shown);

}  // namespace mercury
