// SPDX-License-Identifier: Apache-2.0
// The scale of a colour quantity: which values the ends of the colour map stand for.
#pragma once

#include <optional>
#include <utility>

#include "app/scene/coloring.h"
#include "render/scene.h"

namespace mercury {

// A scale that fits all values so far. It only grows, by steps of 1, 2 and 5, so that colours rarely change their
// meaning within a video. A scale that the user gives stays as it is.
class GrowingScale {
 public:
  GrowingScale(const ColorQuantity& quantity, std::optional<std::pair<float, float>> fixed);
  void fit(const ColorValues& values);
  const render::Scale& scale() const { return scale_; }
  // The quantity and its unit, with the scale.
  render::Legend legend() const;

 private:
  const ColorQuantity* quantity_;
  bool fixed_;
  render::Scale scale_;
};

// The smallest of 1, 2, 5 times a power of ten that is not below `value`; `value` > 0.
float round_up(float value);

}  // namespace mercury
