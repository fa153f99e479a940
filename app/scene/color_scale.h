// SPDX-License-Identifier: Apache-2.0
// The scale of a color quantity: which values the ends of the color map stand for.
#pragma once

#include <deque>
#include <span>
#include <vector>

#include "app/scene/view_settings.h"
#include "render/scene.h"

namespace mercury {

// A scale that fits the values that are visible: from their 2nd to their 98th percentile, or for signed quantities as
// far to both sides as the farther of the two. It grows at once and shrinks when no value of the last 2 pi seconds (the
// period of the slowest muscle) needs it any more, so that it rests while robots repeat their motion. It depends on
// simulated time alone: a film of the same recording has the same colors. A scale that the user gives stays as it is.
class ColorScale {
 public:
  explicit ColorScale(const ViewSettings& settings);

  // `time` of the simulation [s]; `values`: those that are visible, in any order; those that are not finite do not
  // count. `others`: they are not those of the last call at a later time, so that nothing before counts. An earlier
  // time than that of the last call has the same effect.
  void fit(double time, std::vector<float> values, bool others);
  const render::Scale& scale() const { return scale_; }
  // The quantity and its unit, with the scale and the histogram of the last values.
  render::Legend legend() const;

 private:
  struct Range {
    float low = 0, high = 0;
  };
  struct Moment {
    double time;  // [s]
    Range range;
  };
  Range range_of(std::vector<float>& values) const;
  void remember(double time, Range range);
  Range needed() const;
  void count(std::span<const float> values);

  const ColorQuantity* quantity_;
  bool fixed_;
  render::Scale scale_;
  std::deque<Moment> moments_;  // of the last 2 pi seconds, oldest first
  double time_ = 0;             // of the last call [s]
  std::vector<float> histogram_;
};

// The smallest of 1, 2, 5 times a power of ten that is not below `value`; `value` > 0.
float round_up(float value);

// At most 2^14 of the elements from first[i] to first[i] + count[i] of `values`, evenly spread; the same ones whenever
// the ranges are the same. What a percentile of more of them would cost is not visible.
struct ValueRange {
  std::size_t first = 0, count = 0;
};
std::vector<float> sample(std::span<const float> values, std::span<const ValueRange> ranges);

}  // namespace mercury
