// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/commands.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "app/live/scene_time.h"
#include "app/window/toolkit/imgui_layer.h"
#include "app/window/toolkit/key_map.h"
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

// Says how fast time passes where it is not as chosen.
void draw_achieved_speed(const LiveScene& scene, bool unlimited) {
  constexpr double near = 0.03;
  const double achieved = scene.snapshot().achieved_speed;
  if (scene.time().playing() && !(achieved > 0)) return;  // not known yet
  const bool late = scene.time().playing() && !unlimited && achieved > 0 && achieved < 0.9 * scene.time().speed();
  if (scene.time().playing() && !unlimited && std::abs(achieved - scene.time().speed()) <= near * scene.time().speed())
    return;
  const std::string shown = !scene.time().playing() ? "paused"
                            : unlimited             ? "\xc3\x97 " + factor_text(achieved)
                                                    : "reaches \xc3\x97 " + factor_text(achieved);
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
  const bool unlimited = scene.time().speed() == unlimited_speed;
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Speed");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(9 * text);
  auto speed = static_cast<float>(unlimited ? 100 : scene.time().speed());
  const std::string shown = unlimited ? "-" : "\xc3\x97 " + factor_text(static_cast<double>(speed));
  ImGui::BeginDisabled(unlimited);
  if (number_slider("##speed", speed, 0.001f, 100, shown.c_str(), true) && std::isfinite(speed))
    scene.time().set_speed(static_cast<double>(speed));
  ImGui::EndDisabled();
  context.log.item("speed");
  tooltip(fmt::format("simulated seconds per second, 1/1000 to 100 (keys {} and {})",
                      context.keys.keys_of(Action::faster), context.keys.keys_of(Action::slower))
              .c_str());
  ImGui::SameLine();
  if (toggle_button("\xc3\x97"
                    "1",
                    scene.time().speed() == 1))
    scene.time().set_speed(1);
  context.log.item("speed.one");
  tooltip(with_keys(context.keys, "real time", Action::real_time).c_str());
  ImGui::SameLine();
  if (toggle_button("Fastest", unlimited)) scene.time().set_speed(unlimited ? 1 : unlimited_speed);
  context.log.item("speed.fastest");
  tooltip(with_keys(context.keys, "as fast as possible", Action::fastest).c_str());
  ImGui::SameLine();
  draw_achieved_speed(scene, unlimited);
}

void draw_buttons(PanelContext& context) {
  LiveScene& scene = context.scene;
  if (icon_button("##reset", Icon::reset, with_keys(context.keys, "reset to the start", Action::reset)))
    scene.time().reset();
  context.log.item("reset");
  ImGui::SameLine();
  if (icon_button("##step_back", Icon::step_back, with_keys(context.keys, "one time step back", Action::step_back)))
    scene.time().step_back();
  context.log.item("step_back");
  ImGui::SameLine();
  if (icon_button("##toggle", scene.time().playing() ? Icon::pause : Icon::play,
                  with_keys(context.keys, scene.time().playing() ? "pause" : "play", Action::play_pause), true))
    scene.time().toggle();
  context.log.item("play");
  ImGui::SameLine();
  if (icon_button("##step", Icon::step, with_keys(context.keys, "one time step", Action::step))) scene.time().step();
  context.log.item("step");
}

// `middle`: the height at which the text is centered.
void draw_time(const LiveScene& scene, float middle) {
  const Snapshot& snapshot = scene.snapshot();
  ImGui::PushFont(large_font());
  ImGui::SetCursorPosY(middle - ImGui::GetFontSize() / 2 - ImGui::GetStyle().FramePadding.y);  // ImGui adds the padding
  ImGui::TextUnformatted(time_text(snapshot.time, scene.time().speed() < 0.05 ? 3 : 2).c_str());
  ImGui::PopFont();
  tooltip(
      fmt::format("simulated time, {} steps of {:.4g} ms", snapshot.steps, 1000 * snapshot.configuration.dt).c_str());
}

// At the right end, if there is room.
void draw_rate(const LiveScene& scene) {
  const double per_second = scene.time().playing() ? scene.snapshot().springs_per_second : 0;
  const std::string text = fmt::format("{}   {}", per_second > 0 ? short_number(per_second) + " springs/s" : "",
                                       name_of(scene.document().configuration.environment));
  const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
  if (room <= ImGui::GetFontSize()) return;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + room);
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
  tooltip(scene.device_name().c_str());
}

constexpr double megabyte = 1024.0 * 1024.0;

// Where moments are on the screen.
struct Track {
  ImVec2 low, high;
  double begin, end;  // [s]
  float x(double time) const {
    const double share = end > begin ? std::clamp((time - begin) / (end - begin), 0.0, 1.0) : 1;
    return low.x + static_cast<float>(share) * (high.x - low.x);
  }
  double time(float x) const {
    const float share = high.x > low.x ? std::clamp((x - low.x) / (high.x - low.x), 0.0f, 1.0f) : 1.0f;
    return begin + static_cast<double>(share) * (end - begin);
  }
};

std::string moment_text(double seconds) { return fmt::format("{:.2f} s", seconds); }

std::string memory_text(const TimelineState& timeline) {
  const double used = static_cast<double>(timeline.bytes) / megabyte;
  return fmt::format("memory {:.{}f} of {:.0f} MB", used, used < 10 ? 1 : 0,
                     static_cast<double>(timeline.budget) / megabyte);
}

// A drag shows the moment under the mouse.
void drag(PanelContext& context, const Track& track) {
  const double time = track.time(ImGui::GetIO().MousePos.x);
  if (ImGui::IsItemActivated()) begin_scrub(context);
  if (item_dragged()) scrub_to(context, time);
  if (ImGui::IsItemDeactivated()) end_scrub(context);
  if (ImGui::IsItemHovered()) context.cursor.next = time;
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) ImGui::SetTooltip("%s", moment_text(time).c_str());
}

// A thin line at the moment under the mouse, also if that is over a plot.
void draw_cursor(PanelContext& context, const Track& track) {
  if (!context.cursor.time || *context.cursor.time < track.begin || *context.cursor.time > track.end) return;
  const float x = track.x(*context.cursor.time);
  ImGui::GetWindowDrawList()->AddLine({x, track.low.y}, {x, track.high.y}, ImGui::GetColorU32(ImGuiCol_Text));
  context.log.item("timeline.cursor", {x - 0.5f, track.low.y}, {x + 0.5f, track.high.y});
}

void draw_track(const LiveScene& scene, const TimelineState& timeline, const Track& track) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float middle = (track.low.y + track.high.y) / 2, thick = std::max(3.0f, 0.16f * (track.high.y - track.low.y));
  const double now = timeline.seeking ? timeline.target : scene.snapshot().time;
  const auto bar = [&](double from, double to, float half, ImU32 color) {
    list.AddRectFilled({track.x(from), middle - half}, {std::max(track.x(to), track.x(from) + 1), middle + half}, color,
                       half);
  };
  bar(track.begin, track.end, thick, palette().grid);
  if (timeline.looping) bar(timeline.loop_begin, timeline.loop_end, 2.4f * thick, packed({90, 170, 230, 255}, 0.35f));
  bar(track.begin, now, thick, palette().accent);
  if (const auto begin = scene.time().loop_begin()) bar(*begin, *begin, 2.2f * thick, palette().warning);
  for (const double mark : scene.time().bookmarks()) {
    const float x = track.x(mark), size = 1.8f * thick;
    list.AddTriangleFilled({x - size, track.low.y}, {x + size, track.low.y}, {x, track.low.y + 2 * size},
                           palette().warning);
  }
  list.AddCircleFilled({track.x(now), middle}, 2.4f * thick, ImGui::GetColorU32(ImGuiCol_Text));
  if (timeline.seeking) list.AddCircle({track.x(scene.snapshot().time), middle}, 1.8f * thick, palette().faint);
}

// Memory of the timeline; a click sets its budget.
void draw_memory(PanelContext& context, const TimelineState& timeline, float width) {
  const std::string text = timeline.recording ? "recording" : memory_text(timeline);
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::PushStyleColor(ImGuiCol_Button, IM_COL32_BLACK_TRANS);
  if (ImGui::Button((text + "##timeline-memory").c_str(), {width, 0}) && !timeline.recording)
    ImGui::OpenPopup("timeline memory");
  ImGui::PopStyleColor(2);
  context.log.item("timeline.memory");
  tooltip(
      timeline.recording
          ? "a recording: its frames, and straight lines between them"
          : fmt::format("memory of the timeline: {} states of the last minutes; the moments between them are computed "
                        "again, to the bit. Click to set how much memory they may take",
                        timeline.keyframes)
                .c_str());
  if (!ImGui::BeginPopup("timeline memory")) return;
  int& megabytes = context.preferences.timeline_megabytes;
  ImGui::SetNextItemWidth(14 * ImGui::GetFontSize());
  ImGui::SliderInt("##budget", &megabytes, Preferences::least_timeline, Preferences::most_timeline, "%d MB",
                   ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  context.log.item("timeline.budget");
  ImGui::EndPopup();
}

bool strip_button(PanelContext& context, const char* text, const char* name, const std::string& help, bool lit) {
  ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
  const bool clicked = toggle_button(text, lit);
  context.log.item(name);
  tooltip(help.c_str());
  return clicked;
}

float button_width(const char* text) {
  return ImGui::CalcTextSize(text).x + 2 * ImGui::GetStyle().FramePadding.x + ImGui::GetStyle().ItemInnerSpacing.x;
}

void draw_actions(PanelContext& context, const TimelineState& timeline) {
  // They are always there: the track must not change its length under the mouse.
  ImGui::BeginDisabled(!timeline.viewing);
  if (strip_button(context, "Go on", "timeline.go_on",
                   with_keys(context.keys, "go on from this moment; forget what came after it", Action::go_on), false))
    go_on(context);
  ImGui::EndDisabled();
  if (strip_button(context, "Fork", "timeline.fork",
                   with_keys(context.keys, "go on from this moment, with copies of the selected robots", Action::fork),
                   false))
    fork(context);
  if (strip_button(context, "Loop", "timeline.loop",
                   with_keys(context.keys, "begin a loop here, close it here, end it", Action::loop),
                   timeline.looping || context.scene.time().loop_begin()))
    mark_loop(context);
  if (strip_button(context, "Mark", "timeline.mark",
                   with_keys(context.keys, "set or remove a bookmark here", Action::bookmark), false))
    toggle_bookmark(context);
}

float actions_width() {
  return button_width("Go on") + button_width("Fork") + button_width("Loop") + button_width("Mark");
}

}  // namespace

float play_bar_height() {
  const ImGuiStyle& style = ImGui::GetStyle();
  return 2.15f * ImGui::GetFrameHeight() + style.ItemSpacing.y + 2 * style.WindowPadding.y;
}

void draw_play_bar(PanelContext& context, ImVec2 low, ImVec2 high) {
  ImGui::SetNextWindowPos(low);
  ImGui::SetNextWindowSize({high.x - low.x, high.y - low.y});
  ImGui::SetNextWindowBgAlpha(0);  // see panel_background()
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

void draw_timeline_strip(PanelContext& context) {
  LiveScene& scene = context.scene;
  const TimelineState timeline = scene.snapshot().timeline;
  const std::size_t budget = static_cast<std::size_t>(context.preferences.timeline_megabytes) << 20;
  if (timeline.budget != budget) scene.time().set_timeline_budget(budget);
  const float memory = ImGui::CalcTextSize("memory 8888 of 8888 MB").x, height = ImGui::GetFrameHeight();
  const float width =
      ImGui::GetContentRegionAvail().x - actions_width() - memory - ImGui::GetStyle().ItemInnerSpacing.x;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float inset = 0.4f * height;
  ImGui::InvisibleButton("##timeline", {std::max(width, 2 * height), height});
  const Track track{{corner.x + inset, corner.y},
                    {corner.x + std::max(width, 2 * height) - inset, corner.y + height},
                    timeline.begin,
                    timeline.head};
  context.log.item("timeline", track.low, track.high);
  drag(context, track);
  draw_track(scene, timeline, track);
  draw_cursor(context, track);
  draw_actions(context, timeline);
  ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
  draw_memory(context, timeline, memory);
}

void begin_scrub(PanelContext& context) {
  context.scrub.plays_on = context.scene.time().playing();
  context.scene.time().pause();
  context.scrub.time = std::nan("");
}

void scrub_to(PanelContext& context, double time) {
  if (time != context.scrub.time) context.scene.time().seek(time);
  context.scrub.time = time;
}

void end_scrub(PanelContext& context) {
  if (std::exchange(context.scrub.plays_on, false)) context.scene.time().play();
}

void fork(PanelContext& context) {
  LiveScene& scene = context.scene;
  const std::vector<RobotId> selected = scene.selection().robots();
  if (selected.empty()) {
    context.toasts.show(Tone::info, "select the robots to fork first");
    return;
  }
  const std::vector<RobotId> copies = scene.robots().fork(selected);
  scene.selection().clear();
  for (const RobotId id : copies) scene.selection().select(id, false);
  // Those that part are seen together.
  std::vector<RobotId> both = selected;
  both.insert(both.end(), copies.begin(), copies.end());
  if (context.camera.mode() == CameraMode::still) context.to_frame = both;
  context.toasts.show(Tone::info, fmt::format("{} forked at {}",
                                              copies.size() == 1 ? "1 robot" : fmt::format("{} robots", copies.size()),
                                              moment_text(scene.snapshot().time)));
}

void mark_loop(PanelContext& context) {
  const std::string now = moment_text(context.scene.snapshot().time);
  switch (context.scene.time().mark_loop()) {
    case LoopMark::begun:
      context.toasts.show(Tone::info, "a loop begins at " + now + "; go to its end and press again");
      break;
    case LoopMark::closed:
      context.toasts.show(Tone::info, "the loop ends at " + now);
      break;
    case LoopMark::ended:
      context.toasts.show(Tone::info, "no loop any more");
      break;
  }
}

void toggle_bookmark(PanelContext& context) {
  LiveScene& scene = context.scene;
  context.toasts.show(Tone::info, (scene.time().toggle_bookmark() ? "bookmark at " : "no bookmark any more at ") +
                                      moment_text(scene.snapshot().time));
}

void go_on(PanelContext& context) {
  if (!context.scene.snapshot().timeline.viewing) return;
  context.scene.time().go_on();
  context.toasts.show(Tone::info, "goes on from " + moment_text(context.scene.snapshot().time));
}

}  // namespace mercury::window
