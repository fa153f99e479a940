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

std::string clock_text(std::chrono::system_clock::time_point time) {
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
  for (Toast& toast : toasts_)
    if (toast.text == text) {
      toast.seconds_left = duration;
      ++toast.count;
      toast.logged = false;
      return;
    }
  // A second "picture saved: ..." replaces the first.
  const std::string kind = text.substr(0, text.find(": "));
  std::erase_if(toasts_, [&](const Toast& toast) {
    return tone == Tone::success && toast.tone == tone && toast.logged &&
           toast.text.substr(0, toast.text.find(": ")) == kind;
  });
  toasts_.push_back({tone, std::move(text), duration});
  if (toasts_.size() > max_count) toasts_.pop_front();
}

float Toasts::line_height() { return 1.5f * ImGui::GetFontSize() + 2 * ImGui::GetStyle().WindowPadding.y; }

void Toasts::draw(ImVec2 low, ImVec2 high, double dt, EventLog& log) {
  const float line = ImGui::GetFontSize();
  float y = low.y + 0.5f * line;
  int number = 0;
  places_.clear();
  for (Toast& toast : toasts_) {
    if (!toast.logged) log.write("message", {{"tone", name_of(toast.tone)}, {"text", toast.text}});
    toast.logged = true;
    const float width = std::min(high.x - low.x - 2 * line, 34 * line);
    const std::string text = brief(toast.text, longest) + (toast.count > 1 ? fmt::format("  (x{})", toast.count) : "");
    const float needed = ImGui::CalcTextSize(text.c_str(), nullptr, false, width).x + 2.4f * line;
    ImGui::SetNextWindowPos({(low.x + high.x) / 2, y}, ImGuiCond_Always, {0.5f, 0});
    ImGui::SetNextWindowSize({std::min(needed, width + 2.4f * line), 0});
    ImGui::SetNextWindowBgAlpha(0.94f * static_cast<float>(std::clamp(toast.seconds_left * 2, 0.0, 1.0)));
    ImGui::Begin(fmt::format("##toast{}", number++).c_str(), nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoMove);
    const ImVec2 corner = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.PushClipRect(corner, {corner.x + size.x, corner.y + size.y});  // contents are clipped to the padding
    list.AddRectFilled(corner, {corner.x + 0.3f * line, corner.y + size.y}, color_of(toast.tone),
                       ImGui::GetStyle().WindowRounding, ImDrawFlags_RoundCornersLeft);
    list.PopClipRect();
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    const bool hovered = ImGui::IsWindowHovered();
    if (hovered && (ImGui::IsMouseClicked(0) || ImGui::IsMouseClicked(1))) {
      clicked_ = clicked_ || ImGui::IsMouseClicked(0);
      toast.seconds_left = 0;
    }
    log.item(fmt::format("toast.{}", number - 1), corner, {corner.x + size.x, corner.y + size.y});
    places_.emplace_back(corner, ImVec2{corner.x + size.x, corner.y + size.y});
    y += size.y + 0.4f * line;
    ImGui::End();
    toast.seconds_left -= dt;
  }
  std::erase_if(toasts_, [](const Toast& toast) { return toast.seconds_left <= 0; });
}

}  // namespace mercury::window
