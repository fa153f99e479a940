// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "evolution/run_folder/svg.h"

namespace mercury {

// From values to pixels.
struct Scale {
  double low = 0, high = 1;        // values
  double at_low = 0, at_high = 1;  // pixels
  double operator()(double value) const { return at_low + (value - low) / (high - low) * (at_high - at_low); }
};

// A range of values that is not empty.
struct Range {
  double low = 0, high = 1;
};
Range widened(Range range);

// Steps of 1, 2 or 5 times a power of ten: at most `most` of them in the range.
std::vector<double> ticks_in(Range range, int most);
// As many digits as a tick needs: "0.25", "1,000", "2e-07".
std::string tick_text(double value, double step);

// With commas between thousands.
std::string with_commas(std::uint64_t number);

// Lines across the box at the ticks of its left side, with numbers and a title.
void draw_left_axis(Svg& svg, const Box& box, const Scale& scale, std::string_view title);
// Numbers below the box.
void draw_bottom_axis(Svg& svg, const Box& box, const Scale& scale, std::string_view title, bool whole = false);

// "distance [m]" of a quantity; a formula as it is.
std::string axis_title(const std::string& formula);

}  // namespace mercury
