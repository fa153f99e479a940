// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/play_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "app/window/panels/key_hint.h"
#include "app/window/panels/timeline_strip.h"
#include "app/window/toolkit/imgui_layer.h"
#include "app/window/toolkit/plot.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

enum class Icon { play, pause, step, step_back, reset };

// A button with a drawn icon, since the font has none.
bool icon_button(const char* id, Icon icon, const std::string& help, bool lit = false) {
  const float side = 1.15f * ImGui::GetFrameHeight();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  if (lit) ImGui::PushStyleColor(ImGuiCol_Button, palette().accent);
  const bool clicked = ImGui::Button(id, {side, side});
  if (lit) ImGui::PopStyleColor();
  tooltip(help.c_str());
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 color = lit ? IM_COL32_WHITE : ImGui::GetColorU32(ImGuiCol_Text);
  const ImVec2 c{corner.x + side / 2, corner.y + side / 2};
  const float r = 0.24f * side;
  switch (icon) {
    case Icon::play:
      list.AddTriangleFilled({c.x - 0.7f * r, c.y - r}, {c.x + 1.1f * r, c.y}, {c.x - 0.7f * r, c.y + r}, color);
      break;
    case Icon::pause:
      list.AddRectFilled({c.x - 0.8f * r, c.y - r}, {c.x - 0.2f * r, c.y + r}, color);
      list.AddRectFilled({c.x + 0.25f * r, c.y - r}, {c.x + 0.85f * r, c.y + r}, color);
      break;
    case Icon::step:
      list.AddRectFilled({c.x - 1.0f * r, c.y - r}, {c.x - 0.55f * r, c.y + r}, color);
      list.AddTriangleFilled({c.x - 0.3f * r, c.y - r}, {c.x + 1.1f * r, c.y}, {c.x - 0.3f * r, c.y + r}, color);
      break;
    case Icon::step_back:
      list.AddRectFilled({c.x + 0.55f * r, c.y - r}, {c.x + 1.0f * r, c.y + r}, color);
      list.AddTriangleFilled({c.x + 0.3f * r, c.y - r}, {c.x - 1.1f * r, c.y}, {c.x + 0.3f * r, c.y + r}, color);
      break;
    case Icon::reset:
      list.AddRectFilled({c.x - 1.0f * r, c.y - r}, {c.x - 0.55f * r, c.y + r}, color);
      list.AddTriangleFilled({c.x + 0.9f * r, c.y - r}, {c.x - 0.5f * r, c.y}, {c.x + 0.9f * r, c.y + r}, color);
      break;
  }
  return clicked;
}

std::string time_text(double seconds, int digits) {
  if (seconds < 60) return fmt::format("{:.{}f} s", seconds, digits);
  const auto minutes = static_cast<long>(seconds / 60);
  return fmt::format("{}:{:05.2f}", minutes, seconds - 60 * static_cast<double>(minutes));
}

std::string factor_text(double factor) {
  return factor >= 100 ? fmt::format("{:.0f}", factor) : fmt::format("{:.3g}", factor);
}

void draw_achieved_speed(const LiveScene& scene, bool unlimited) {
  const double achieved = scene.snapshot().achieved_speed;
  const bool late = scene.playing() && !unlimited && achieved > 0 && achieved < 0.9 * scene.speed();
  const std::string shown = scene.playing() ? "achieved \xc3\x97 " + factor_text(achieved) : "paused";
  // A narrow window has no room for all of it.
  if (ImGui::GetContentRegionAvail().x < ImGui::CalcTextSize(shown.c_str()).x) return;
  ImGui::PushStyleColor(ImGuiCol_Text, late ? palette().warning : palette().faint);
  ImGui::TextUnformatted(shown.c_str());
  ImGui::PopStyleColor();
  tooltip(late ? "the computer is too slow for this speed" : "the speed over the last second");
}

void draw_speed(PanelContext& context) {
  LiveScene& scene = context.scene;
  const float text = ImGui::GetFontSize();
  const bool unlimited = scene.speed() == unlimited_speed;
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Speed");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(9 * text);
  auto speed = static_cast<float>(unlimited ? 100 : scene.speed());
  const std::string shown = unlimited ? "-" : "\xc3\x97 " + factor_text(static_cast<double>(speed));
  ImGui::BeginDisabled(unlimited);
  if (number_slider("##speed", speed, 0.001f, 100, shown.c_str(), true) && std::isfinite(speed))
    scene.set_speed(static_cast<double>(speed));
  ImGui::EndDisabled();
  context.log.item("speed");
  tooltip(fmt::format("simulated seconds per second, 1/1000 to 100 (keys {} and {})",
                      context.keys.keys_of(Action::faster), context.keys.keys_of(Action::slower))
              .c_str());
  ImGui::SameLine();
  if (toggle_button("\xc3\x97"
                    "1",
                    scene.speed() == 1))
    scene.set_speed(1);
  context.log.item("speed.one");
  tooltip(with_keys(context.keys, "real time", Action::real_time).c_str());
  ImGui::SameLine();
  if (toggle_button("Fastest", unlimited)) scene.set_speed(unlimited ? 1 : unlimited_speed);
  context.log.item("speed.fastest");
  tooltip(with_keys(context.keys, "as fast as possible", Action::fastest).c_str());
  ImGui::SameLine();
  draw_achieved_speed(scene, unlimited);
}

void draw_buttons(PanelContext& context) {
  LiveScene& scene = context.scene;
  if (icon_button("##reset", Icon::reset, with_keys(context.keys, "reset to the start", Action::reset))) scene.reset();
  context.log.item("reset");
  ImGui::SameLine();
  if (icon_button("##step_back", Icon::step_back, with_keys(context.keys, "one time step back", Action::step_back)))
    scene.step_back();
  context.log.item("step_back");
  ImGui::SameLine();
  if (icon_button("##toggle", scene.playing() ? Icon::pause : Icon::play,
                  with_keys(context.keys, scene.playing() ? "pause" : "play", Action::play_pause), true))
    scene.toggle();
  context.log.item("play");
  ImGui::SameLine();
  if (icon_button("##step", Icon::step, with_keys(context.keys, "one time step", Action::step))) scene.step();
  context.log.item("step");
}

// `middle`: the height at which the text is centered.
void draw_time(const LiveScene& scene, float middle) {
  const Snapshot& snapshot = scene.snapshot();
  ImGui::PushFont(large_font());
  ImGui::SetCursorPosY(middle - ImGui::GetFontSize() / 2 - ImGui::GetStyle().FramePadding.y);  // ImGui adds the padding
  ImGui::TextUnformatted(time_text(snapshot.time, scene.speed() < 0.05 ? 3 : 2).c_str());
  ImGui::PopFont();
  tooltip(
      fmt::format("simulated time, {} steps of {:.4g} ms", snapshot.steps, 1000 * snapshot.configuration.dt).c_str());
}

// At the right end, if there is room.
void draw_rate(const LiveScene& scene) {
  const std::string rate = short_number(scene.snapshot().springs_per_second) + " springs/s";
  const std::string text =
      fmt::format("{}   {}", scene.playing() ? rate : "", name_of(scene.configuration().environment));
  const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
  if (room <= ImGui::GetFontSize()) return;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + room);
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
  tooltip(scene.device_name().c_str());
}

}  // namespace

float play_bar_height() {
  const ImGuiStyle& style = ImGui::GetStyle();
  return 2.15f * ImGui::GetFrameHeight() + style.ItemSpacing.y + 2 * style.WindowPadding.y;
}

void draw_play_bar(PanelContext& context, ImVec2 low, ImVec2 high) {
  ImGui::SetNextWindowPos(low);
  ImGui::SetNextWindowSize({high.x - low.x, high.y - low.y});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
  ImGui::Begin("##play", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  const float text = ImGui::GetFontSize();
  draw_timeline_strip(context);
  draw_buttons(context);
  ImGui::SameLine(0, 1.2f * text);
  // Center the line on the buttons.
  const float middle = ImGui::GetCursorPosY() + 1.15f * ImGui::GetFrameHeight() / 2;
  draw_time(context.scene, middle);
  ImGui::SameLine();
  ImGui::SetCursorPos({std::max(ImGui::GetCursorPosX(), (high.x - low.x < 45 * text ? 16 : 20) * text),
                       middle - ImGui::GetFrameHeight() / 2});
  draw_speed(context);
  ImGui::SameLine();
  draw_rate(context.scene);
  ImGui::End();
}

}  // namespace mercury::window
