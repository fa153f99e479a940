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
  std::span<const double> y;  // as many; what is not finite is left out
};

struct PlotAxes {
  std::string title;  // "speed"
  std::string unit;   // "m/s"
  std::string x_title = "time [s]", x_unit = "s";
  float height = 140;  // [pixels]
};

// Draws it over the whole width that is left. Hovering shows the values under the cursor.
void plot(const char* id, const PlotAxes& axes, std::span<const PlotLine> lines);

// Which line is whose, in rows of colours and names.
void plot_key(std::span<const PlotLine> lines);

// A number as short as an axis needs: "12.3 k", "0.02", "4.1e-05".
std::string short_number(double value);

}  // namespace mercury::window
