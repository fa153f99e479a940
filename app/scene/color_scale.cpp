// SPDX-License-Identifier: Apache-2.0
#include "app/scene/color_scale.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <tuple>

namespace mercury {
namespace {

constexpr double low_percentile = 0.02, high_percentile = 0.98;
constexpr double held = 2 * std::numbers::pi;  // [s]
constexpr double shrink_time = 0.5;            // of the exponential approach to a smaller range [s]
constexpr double moment = held / 128;          // values closer in time than this share one [s]
constexpr float widest_ratio = 1e4f;           // of the ends of a logarithmic scale that fits
constexpr std::size_t most_values = std::size_t(1) << 14;
constexpr std::size_t bins = 32;

float percentile(std::vector<float>& values, double share) {
  const auto index = static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  std::ranges::nth_element(values, values.begin() + index);
  return values[static_cast<std::size_t>(index)];
}

// A number that looks random but depends on `x` alone (the finalizer of MurmurHash3).
std::uint32_t scattered(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x85ebca6bu;
  x = (x ^ (x >> 13)) * 0xc2b2ae35u;
  return x ^ (x >> 16);
}

}  // namespace

float round_up(float value) {
  const float power = std::pow(10.0f, std::floor(std::log10(value)));
  for (const float step : {1.0f, 2.0f, 5.0f, 10.0f})
    if (step * power >= value * (1 - 1e-6f)) return step * power;
  return 10 * power;
}

std::vector<float> sample(std::span<const float> values, std::span<const ValueRange> ranges) {
  std::size_t total = 0;
  for (const ValueRange& range : ranges) total += range.count;
  const std::size_t taken = std::min(total, most_values);
  std::vector<float> result;
  result.reserve(taken);
  std::size_t range = 0, before = 0;  // elements of earlier ranges
  for (std::size_t i = 0; i < taken; ++i) {
    // One element of each of `taken` equal parts. A constant stride could hit the same place of every robot.
    const std::size_t begin = i * total / taken, end = (i + 1) * total / taken;
    const std::size_t at = begin + scattered(static_cast<std::uint32_t>(i)) % (end - begin);
    while (at - before >= ranges[range].count) before += ranges[range++].count;
    result.push_back(values[ranges[range].first + at - before]);
  }
  return result;
}

ColorScale::ColorScale(const ViewSettings& settings) : quantity_(settings.color), fixed_(settings.scale.has_value()) {
  const float high = quantity_->smallest_end;
  scale_ = {.low = quantity_->is_signed ? -high : 0,
            .high = high,
            .map = settings.colormap.value_or(quantity_->map),
            .logarithmic = settings.log_scale};
  if (fixed_) std::tie(scale_.low, scale_.high) = *settings.scale;
}

// The range that these values, of which there is at least one, need.
ColorScale::Range ColorScale::range_of(std::vector<float>& values) const {
  Range range{percentile(values, low_percentile), percentile(values, high_percentile)};
  if (quantity_->is_signed) {
    range.high = std::max({-range.low, range.high, quantity_->smallest_end});
    return {-range.high, range.high};
  }
  range.high = std::max(range.high, quantity_->smallest_end);
  if (scale_.logarithmic) range.low = std::max(range.low, range.high / widest_ratio);
  // Values that are all the same have a scale from 0, like a bar that is full.
  if (range.high - range.low < 1e-3f * range.high) range.low = scale_.logarithmic ? range.high / 10 : 0;
  return range;
}

void ColorScale::remember(double time, Range range) {
  while (!moments_.empty() && moments_.front().time < time - held) moments_.pop_front();
  if (moments_.empty() || time - moments_.back().time >= moment) {
    moments_.push_back({time, range});
    return;
  }
  Range& last = moments_.back().range;
  last = {std::min(last.low, range.low), std::max(last.high, range.high)};
}

ColorScale::Range ColorScale::needed() const {
  Range all = moments_.front().range;
  for (const Moment& m : moments_) all = {std::min(all.low, m.range.low), std::max(all.high, m.range.high)};
  return all;
}

void ColorScale::count(std::span<const float> values) {
  histogram_.assign(bins, 0);
  for (const float value : values) {
    const float bin = render::position_on(scale_, value) * static_cast<float>(bins);
    ++histogram_[static_cast<std::size_t>(std::clamp(bin, 0.0f, static_cast<float>(bins - 1)))];
  }
  const float most = *std::ranges::max_element(histogram_);
  // Square roots, so that a few values beside many stay visible.
  for (float& share : histogram_) share = std::sqrt(share / most);
}

void ColorScale::fit(double time, std::vector<float> values, bool others) {
  if (!quantity_->has_values()) return;
  std::erase_if(values, [](float value) { return !std::isfinite(value); });
  const double elapsed = time - time_;
  time_ = time;
  if (others || elapsed < 0) moments_.clear();
  if (values.empty()) {
    histogram_.clear();
    return;
  }
  const bool first = moments_.empty();
  remember(time, range_of(values));
  if (!fixed_) {
    const Range wanted = needed();
    const auto kept = first ? 0 : static_cast<float>(std::exp(-elapsed / shrink_time));
    scale_.low = std::min(wanted.low, wanted.low + kept * (scale_.low - wanted.low));
    scale_.high = std::max(wanted.high, wanted.high + kept * (scale_.high - wanted.high));
  }
  count(values);
}

render::Legend ColorScale::legend() const {
  return {.title = std::string(quantity_->key),
          .unit = std::string(quantity_->unit),
          .scale = scale_,
          .histogram = histogram_};
}

}  // namespace mercury
