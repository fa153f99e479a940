// SPDX-License-Identifier: Apache-2.0
#include "app/scene/color_scale.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

namespace mercury {

float round_up(float value) {
  const float power = std::pow(10.0f, std::floor(std::log10(value)));
  for (const float step : {1.0f, 2.0f, 5.0f, 10.0f})
    if (step * power >= value * (1 - 1e-6f)) return step * power;
  return 10 * power;
}

GrowingScale::GrowingScale(const ColorQuantity& quantity, std::optional<std::pair<float, float>> fixed)
    : quantity_(&quantity), fixed_(fixed.has_value()) {
  const float high = quantity.smallest_end;
  scale_ = {.low = quantity.is_signed ? -high : 0, .high = high, .map = quantity.map};
  if (fixed) std::tie(scale_.low, scale_.high) = *fixed;
}

void GrowingScale::fit(const ColorValues& values) {
  if (fixed_ || !quantity_->has_values()) return;
  // The skin shows faces or masses. A few springs go far beyond those and would make everything else pale.
  const std::vector<float>& shown = !values.face.empty()   ? values.face
                                    : !values.mass.empty() ? values.mass
                                                           : values.spring;
  float largest = 0;
  for (const float value : shown)
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  if (largest <= scale_.high) return;
  scale_.high = round_up(largest);
  if (quantity_->is_signed) scale_.low = -scale_.high;
}

render::Legend GrowingScale::legend() const {
  return {.title = std::string(quantity_->key), .unit = std::string(quantity_->unit), .scale = scale_};
}

}  // namespace mercury
