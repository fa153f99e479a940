// SPDX-License-Identifier: Apache-2.0
#include "render/text/scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace mercury::render {
namespace {

constexpr float smallest_positive = 1e-37f;  // as in shaders/values.glsl
constexpr float even_share = 0.01f;          // of the larger end: values below it are spread evenly

float transformed(float spacing, float value) {
  if (spacing > 0) return std::asinh(value / spacing);
  return spacing < 0 ? std::log(std::max(value, smallest_positive)) : value;
}

float restored(float spacing, float transformed) {
  if (spacing > 0) return spacing * std::sinh(transformed);
  return spacing < 0 ? std::exp(transformed) : transformed;
}

// "2", "0.05", "1e-05", with a real minus sign.
std::string short_text(float value, int digits = 3, bool fixed = false) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), fixed ? "%.*f" : "%.*g", digits, double(value));
  std::string result(text.data());
  if (!result.empty() && result[0] == '-') result.replace(0, 1, "\u2212");
  return result;
}

// Powers of ten on the scale, with their doubles and fives if those are few.
std::vector<float> log_ticks(const Scale& scale, int most) {
  const float largest = std::max(std::abs(scale.low), std::abs(scale.high));
  const float smallest = scale.low > 0 ? scale.low : 0.99f * even_share * largest;
  std::vector<float> values;
  const auto on_scale = [&](float value) { return value >= 0.999f * scale.low && value <= 1.001f * scale.high; };
  const auto fill = [&](std::initializer_list<int> factors, int decades) {
    values.clear();
    const int top = int(std::floor(std::log10(largest))), bottom = int(std::floor(std::log10(smallest)));
    for (int power = top; power >= bottom; power -= decades)
      for (const int factor : factors)
        for (const float sign : {1.0f, -1.0f}) {
          const float value = sign * float(factor) * std::pow(10.0f, float(power));
          if (std::abs(value) >= 0.999f * smallest && on_scale(value)) values.push_back(value);
        }
    if (scale.low <= 0 && scale.high >= 0) values.push_back(0);
    return int(values.size()) <= most;
  };
  bool few = fill({1, 2, 5}, 1) || fill({1}, 1);
  for (int decades = 2; !few && decades < 64; ++decades) few = fill({1}, decades);
  return values;
}

}  // namespace

ScaleFactors factors_of(const Scale& scale) {
  ScaleFactors result;
  const float largest = std::max(std::abs(scale.low), std::abs(scale.high));
  if (scale.logarithmic && largest > 0) result.spacing = scale.low > 0 ? -1 : even_share * largest;
  const float low = transformed(result.spacing, scale.low), width = transformed(result.spacing, scale.high) - low;
  result.factor = width != 0 ? 1 / width : 0;
  result.offset = width != 0 ? -low / width : 0.5f;
  return result;
}

float position_on(const Scale& scale, float value) {
  if (std::isnan(value)) return value;
  const ScaleFactors f = factors_of(scale);
  return transformed(f.spacing, value) * f.factor + f.offset;
}

float value_on(const Scale& scale, float position) {
  const ScaleFactors f = factors_of(scale);
  return f.factor != 0 ? restored(f.spacing, (position - f.offset) / f.factor) : scale.low;
}

Color color_on(const Scale& scale, float value) { return color_at(scale.map, position_on(scale, value)); }

std::string tick_text(float value, float step) {
  if (std::abs(value) < 1e-6f * std::abs(step)) value = 0;
  const float size = std::max(std::abs(value), std::abs(step));
  if (size >= 1e5f || std::abs(step) < 1e-4f) return short_text(value);
  // A step of 0.25 needs one digit more than its magnitude suggests, 0.125 two; of others, two digits count.
  const auto is_whole = [step](int digits) {
    const float scaled = std::abs(step) * std::pow(10.0f, float(digits));
    return std::abs(scaled - std::round(scaled)) <= 1e-3f;
  };
  const int first = int(std::ceil(-std::log10(std::abs(step)) - 1e-4f));
  for (int digits = std::max(0, first); digits <= std::max(0, first) + 2; ++digits)
    if (is_whole(digits)) return short_text(value, digits, true);
  return short_text(value, std::max(0, first + 1), true);
}

std::vector<Tick> ticks_of(const Scale& scale, int most) {
  std::vector<Tick> result;
  if (scale.logarithmic && scale.high > scale.low) {
    for (const float value : log_ticks(scale, most))
      result.push_back({position_on(scale, value), short_text(value, 5)});
    if (result.size() > 1) return result;
    result.clear();
  }
  const std::vector<float> values = ticks(scale.low, scale.high, most);
  const float step = values.size() > 1 ? values[1] - values[0] : values[0];
  for (const float value : values) result.push_back({position_on(scale, value), tick_text(value, step)});
  return result;
}

}  // namespace mercury::render
