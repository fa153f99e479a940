// SPDX-License-Identifier: Apache-2.0
// How numbers become colors: a color map between two values.
#pragma once

#include <string>
#include <vector>

#include "render/colormap.h"

namespace mercury::render {

struct Scale {
  float low = 0, high = 1;
  Colormap map = Colormap::viridis;
  // Equal ratios are equally far apart. If `low` is not above 0, values near 0 are spread evenly instead, those beyond
  // a hundredth of the larger end by their ratios, to both sides (the inverse hyperbolic sine).
  bool logarithmic = false;
};

// Where a value is on the scale: 0 = low, 1 = high, and beyond. The middle if low == high; NaN for NaN.
float position_on(const Scale& scale, float value);
// The value at a position; the inverse of position_on().
float value_on(const Scale& scale, float position);
// Values beyond the ends have the ends' colors; NaN is gray.
Color color_on(const Scale& scale, float value);

// What position_on() computes, for shaders (shaders/values.glsl): position = transformed(value) * factor + offset.
// `spacing`: 0 = the value itself, below 0 = its logarithm, above 0 = asinh(value / spacing).
struct ScaleFactors {
  float factor = 1, offset = 0, spacing = 0;
};
ScaleFactors factors_of(const Scale& scale);

// "0.25", "1e-05": as few digits as write multiples of `step`.
std::string tick_text(float value, float step);

// At most about `most` round values on the scale.
struct Tick {
  float position = 0;  // on the scale, 0 to 1
  std::string text;
};
std::vector<Tick> ticks_of(const Scale& scale, int most = 6);

}  // namespace mercury::render
