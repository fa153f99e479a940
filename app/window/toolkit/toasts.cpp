// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/toasts.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

constexpr std::size_t max_count = 5, max_history = 1000;
constexpr std::size_t longest = 400;  // of what is drawn [letters]; the history has the rest

}  // namespace

const char* name_of(Tone tone) {
  switch (tone) {
    case Tone::info:
      return "news";
    case Tone::success:
      return "success";
    case Tone::warning:
      return "warning";
    case Tone::error:
      return "error";
  }
  return "";
}

ImU32 color_of(Tone tone) {
  switch (tone) {
    case Tone::success:
      return palette().good;
    case Tone::warning:
      return palette().warning;
    case Tone::error:
      return palette().bad;
    default:
      return palette().accent;
  }
}

std::string time_of_day(std::chrono::system_clock::time_point time) {
  return fmt::format("{:%H:%M:%S}", fmt::localtime(std::chrono::system_clock::to_time_t(time)));
}

void Toasts::remember(Tone tone, const std::string& text) {
  const auto now = std::chrono::system_clock::now();
  if (!history_.empty() && history_.back().text == text && history_.back().tone == tone) {
    history_.back().time = now;
    ++history_.back().count;
    return;
  }
  history_.push_back({now, tone, text});
  if (history_.size() > max_history) history_.pop_front();
}

void Toasts::show(Tone tone, std::string text) {
  remember(tone, text);
  const double duration = (tone == Tone::error ? 10 : 4) + 0.03 * static_cast<double>(std::min(text.size(), longest));
  // Warnings and errors stay below a newer message.
  int count = 1;
  std::erase_if(toasts_, [&](const Toast& toast) {
    if (toast.text == text) count += toast.count;
    return toast.text == text || (toast.logged && (toast.tone == Tone::info || toast.tone == Tone::success));
  });
  toasts_.push_back({tone, std::move(text), duration, count});
  if (toasts_.size() > max_count) toasts_.pop_front();
}

float Toasts::line_height() { return 1.5f * ImGui::GetFontSize() + 2 * ImGui::GetStyle().WindowPadding.y; }

void Toasts::draw(ImVec2 left, float right, EventLog& log) {
  for (Toast& toast : toasts_)
    if (!std::exchange(toast.logged, true)) log.write("message", {{"tone", name_of(toast.tone)}, {"text", toast.text}});
  if (toasts_.empty()) return;
  const Toast& newest = toasts_.back();
  const float line = ImGui::GetFontSize(), side = 0.8f * line, above = 0.25f * line;
  std::string more = newest.count > 1 ? fmt::format("  (x{})", newest.count) : "";
  if (toasts_.size() > 1) more += fmt::format("  ({} more)", toasts_.size() - 1);
  std::string text = brief(newest.text, longest);
  std::ranges::replace(text, '\n', ' ');
  const std::string fitting = shortened(text, right - left.x - 2 * side - ImGui::CalcTextSize(more.c_str()).x);
  const bool whole = fitting == newest.text && toasts_.size() == 1;
  text = fitting + more;
  const float width = ImGui::CalcTextSize(text.c_str()).x;
  const float x = std::max(left.x + side, std::round((left.x + right - width) / 2));
  const ImVec2 low{x - side, left.y - above}, high{x + width + side, left.y + line + above};
  ImGui::SetCursorScreenPos(low);
  ImGui::InvisibleButton("##message", {high.x - low.x, high.y - low.y},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  const bool hovered = ImGui::IsItemHovered(), clicked = ImGui::IsItemClicked(0);
  const bool dismissed = clicked || ImGui::IsItemClicked(1);
  clicked_ = clicked_ || clicked;
  log.item("toast", low, high);
  ImGui::PushStyleVar(ImGuiStyleVar_Alpha, static_cast<float>(std::clamp(newest.seconds_left * 2, 0.0, 1.0)));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(low, high, ImGui::GetColorU32(ImGuiCol_FrameBg), 0.3f * line);
  list.AddRectFilled(low, {low.x + 0.3f * line, high.y}, ImGui::GetColorU32(color_of(newest.tone)), 0.3f * line,
                     ImDrawFlags_RoundCornersLeft);
  list.AddText({x, left.y}, ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
  ImGui::PopStyleVar();
  if (hovered && !whole) {
    std::string all;
    for (const Toast& toast : toasts_) all += (all.empty() ? "" : "\n\n") + brief(toast.text, longest);
    tooltip_now(all);
  }
  // A message that is being read stays.
  const double spent = hovered ? 0 : std::min(0.5, static_cast<double>(ImGui::GetIO().DeltaTime));
  for (Toast& toast : toasts_) toast.seconds_left -= spent;
  if (dismissed) toasts_.pop_back();
  std::erase_if(toasts_, [](const Toast& toast) { return toast.seconds_left <= 0; });
}

}  // namespace mercury::window
