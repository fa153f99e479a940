// SPDX-License-Identifier: Apache-2.0
// A plot of several lines over time, with axes, ticks and units.
#pragma once

#include <imgui.h>

#include <span>
#include <string>
#include <vector>

#include "render/colormap.h"

namespace mercury::window {

struct PlotLine {
  std::string name;
  render::Color color;
  std::span<const double> x;
  std::span<const double> y;  // same length as x; values that are not finite leave a gap
};

struct PlotAxes {
  std::string title;  // "speed"
  std::string unit;   // "m/s"
  std::string x_title = "time [s]", x_unit = "s";
  float height = 140;    // [pixels]
  bool x_whole = false;  // x are whole numbers
};

// Draws a plot over the remaining width. Hovering shows the values under the cursor.
void plot(const char* id, const PlotAxes& axes, std::span<const PlotLine> lines);

// The legend: colour and name of each line, in rows.
void plot_legend(std::span<const PlotLine> lines);

// A number with few digits: "12.3 k", "0.02", "4.1e-05".
std::string short_number(double value);

}  // namespace mercury::window
