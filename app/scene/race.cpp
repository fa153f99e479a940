// SPDX-License-Identifier: Apache-2.0
#include "app/scene/race.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mercury {

using render::Vector3;

void MarkTimes::update(double time, std::span<const float> progress) {
  constexpr float most_marks = 100'000;
  const bool first = times_.size() != progress.size();
  times_.resize(progress.size());
  if (first) before_.assign(progress.begin(), progress.end());
  for (std::size_t i = 0; i < progress.size(); ++i) {
    std::vector<double>& times = times_[i];
    while (!times.empty() && times.back() > time) times.pop_back();
    if (!(progress[i] >= 0)) continue;
    // A robot that turns back keeps its times.
    const auto passed = static_cast<std::size_t>(std::min(progress[i] / distance_, most_marks));
    while (times.size() < passed) {
      const double mark = static_cast<double>(distance_) * static_cast<double>(times.size() + 1);
      const double way = static_cast<double>(progress[i]) - static_cast<double>(before_[i]);
      const double share = way > 0 ? std::clamp((mark - static_cast<double>(before_[i])) / way, 0.0, 1.0) : 1;
      times.push_back(first ? unknown : time_ + share * (time - time_));
    }
  }
  before_.assign(progress.begin(), progress.end());
  time_ = time;
}

std::size_t MarkTimes::farthest(std::size_t step) const {
  std::size_t most = 0;
  for (const std::vector<double>& times : times_) most = std::max(most, times.size());
  return most / step * step;
}

std::vector<MarkTimes::Passing> MarkTimes::at(std::size_t mark) const {
  std::vector<Passing> passings;
  for (std::size_t i = 0; i < times_.size() && mark > 0; ++i)
    if (times_[i].size() >= mark && times_[i][mark - 1] != unknown) passings.push_back({i, times_[i][mark - 1]});
  std::ranges::stable_sort(passings, {}, &Passing::time);
  return passings;
}

std::size_t marks_per_line(float distance, float length) {
  constexpr float most_lines = 10;
  if (!(length > most_lines * distance)) return 1;
  // Multiples of a round distance that are round themselves, from the next power of ten on.
  const float power = std::pow(10.0f, std::ceil(std::log10(distance) - 1e-4f));
  for (float decade = power; decade < 1e30f; decade *= 10)
    for (const float factor : {1.0f, 2.0f, 5.0f})
      if (length <= most_lines * factor * decade)
        return static_cast<std::size_t>(std::lround(factor * decade / distance));
  return 1;
}

void Course::add(const Vector3& from, const Vector3& to, render::Color color) {
  points_.push_back({from.x, from.y, from.z, to.x, to.y, to.z});
  lines_.push_back({.body = render::Path::no_body, .points = {}, .color = color, .fades = false});
}

void Course::draw(std::span<const Lane> lanes, const Vector3& along, float height, const MarkTimes& passings,
                  std::size_t step, render::Theme theme) {
  points_.clear();
  lines_.clear();
  numbers_.clear();
  if (lanes.empty()) return;
  const render::Color faint = theme == render::Theme::dark ? render::rgb(0x8fa3ad) : render::rgb(0x51626c);
  const render::Color bright = theme == render::Theme::dark ? render::rgb(0xf2f6f8) : render::rgb(0x16232c);
  const Vector3 across(-along.y, along.x, 0);
  // Places along and across the lanes.
  const auto at = [&](float forward, float sideways) {
    const Vector3 level = forward * along + sideways * across;
    return Vector3(level.x, level.y, height);
  };
  const float line = passings.distance() * static_cast<float>(step);
  float farthest = 0, low = 1e30f, high = -1e30f;
  const float start = lanes[0].start.dot(along);
  for (const Lane& lane : lanes) {
    farthest = std::max(farthest, lane.progress);
    low = std::min(low, lane.start.dot(across) - lane.half_width);
    high = std::max(high, lane.start.dot(across) + lane.half_width);
  }
  // Lanes are longer than the robots at their start.
  const auto count = static_cast<int>(std::max(farthest, 1.5f * lanes[0].half_width) / line) + 1;
  const float end = start + line * (static_cast<float>(count) + 0.25f);
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    const float middle = lanes[i].start.dot(across);
    for (const float side : {-1.0f, 1.0f})
      add(at(start, middle + side * lanes[i].half_width), at(end, middle + side * lanes[i].half_width), faint);
    add(at(start, middle), at(start + lanes[i].progress, middle), lanes[i].color);
  }
  // The start line is double.
  add(at(start, low), at(start, high), bright);
  add(at(start - 0.06f * line, low), at(start - 0.06f * line, high), bright);
  for (int mark = 0; mark <= count; ++mark) {
    const float meters = line * static_cast<float>(mark);
    if (mark > 0) add(at(start + meters, low), at(start + meters, high), faint);
    numbers_.push_back({.at = at(start + meters, low - 0.02f * (high - low)),
                        .text = mark == 0 ? "start" : fmt::format("{:g} m", meters),
                        .align_x = 0,
                        .align_y = 0.5f,
                        .size = 0.9f});
  }
  for (std::size_t i = 0; i < lines_.size(); ++i) lines_[i].points = points_[i];
}

std::string order_text(const MarkTimes& passings, std::size_t step, std::span<const std::string> names) {
  constexpr std::size_t most = 8;
  const std::size_t mark = passings.farthest(step);
  const std::vector<MarkTimes::Passing> order = passings.at(mark);
  if (order.empty()) return {};
  std::string text = fmt::format("order at {:g} m", passings.distance() * static_cast<float>(mark));
  for (std::size_t i = 0; i < std::min(most, order.size()); ++i)
    text += fmt::format("\n{}. {}, {:.1f} s", i + 1, names[order[i].robot], order[i].time);
  if (order.size() > most) text += fmt::format("\nand {} more", order.size() - most);
  return text;
}

}  // namespace mercury
