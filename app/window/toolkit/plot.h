// SPDX-License-Identifier: Apache-2.0
// A plot of several lines over time, with axes, ticks and units.
#pragma once

#include <imgui.h>

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "render/colormap.h"

namespace mercury::window {

enum class Stroke { solid, dashed, dotted };

struct PlotLine {
  std::string name;
  render::Color color;
  std::span<const double> x;
  std::span<const double> y;  // same length as x; values that are not finite leave a gap
  Stroke stroke = Stroke::solid;
};

struct PlotAxes {
  std::string title;  // "speed"
  std::string unit;   // "m/s"
  std::string x_title = "time [s]", x_unit = "s";
  float height = 140;    // [pixels]
  bool x_whole = false;  // x are whole numbers
};

// What the plots of a panel share along x: the part that is shown, the cursor, and a mark.
struct PlotView {
  std::optional<std::pair<double, double>> range;  // none = everything
  std::optional<double> cursor;                    // where the mouse was over one of the plots in the last frame
  std::optional<double> next_cursor;               // where it is in this one
  std::optional<double> mark;                      // such as the time of the view
  bool goes = false;                               // a press with Ctrl is held: the mouse goes along x
  std::optional<double> went_to;                   // where it is then

  // Keeps `factor` of the range around a point, within [low, high], all there is. Everything is shown again when the
  // range would be larger.
  void zoom(double at, double factor, double low, double high);
  // Moves the range by `distance`, within [low, high].
  void pan(double distance, double low, double high);
  // Call it before the plots of a frame.
  void begin_frame() { cursor = std::exchange(next_cursor, std::nullopt); }
};

// Draws a plot over the remaining width. Hovering shows the values under the cursor. With a `view`, the wheel zooms
// along x, a drag moves the part that is shown, and a double click shows everything. A drag that begins with Ctrl moves
// nothing; view->went_to then says where the mouse is.
void plot(const char* id, const PlotAxes& axes, std::span<const PlotLine> lines, PlotView* view = nullptr);

// The legend: color and name of each line, in rows.
void plot_legend(std::span<const PlotLine> lines);

// A number with few digits: "12.3 k", "0.02", "4.1e-05".
std::string short_number(double value);

}  // namespace mercury::window
