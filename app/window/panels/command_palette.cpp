// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/command_palette.h"
#define GLFW_INCLUDE_NONE

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "app/scene/color_quantity.h"
#include "app/window/panels/commands.h"
#include "app/window/panels/panel.h"
#include "app/window/toolkit/key_bindings.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

// A switch of the view.
struct Switch {
  const char* name;
  bool& (*of)(ViewSettings& view);
};
constexpr Switch switches[] = {
    {"skin", [](ViewSettings& view) -> bool& { return view.shown.skin; }},
    {"springs", [](ViewSettings& view) -> bool& { return view.shown.springs; }},
    {"masses", [](ViewSettings& view) -> bool& { return view.shown.masses; }},
    {"rounded skin", [](ViewSettings& view) -> bool& { return view.smooth; }},
    {"path", [](ViewSettings& view) -> bool& { return view.shown.path; }},
    {"names", [](ViewSettings& view) -> bool& { return view.shown.labels; }},
    {"legend", [](ViewSettings& view) -> bool& { return view.shown.legend; }},
    {"clock", [](ViewSettings& view) -> bool& { return view.shown.clock; }},
    {"scale bar", [](ViewSettings& view) -> bool& { return view.shown.scale_bar; }},
    {"velocity arrows", [](ViewSettings& view) -> bool& { return view.shown.arrows.velocity; }},
    {"gravity arrows", [](ViewSettings& view) -> bool& { return view.shown.arrows.gravity; }},
};

void add_switches(PanelContext& context, std::vector<PaletteEntry>& entries) {
  ViewSettings view = context.scene.view();
  for (const Switch& one : switches)
    entries.push_back({fmt::format("show {}", one.name), "View", one.of(view) ? "on" : "off", [&context, &one] {
                         ViewSettings now = context.scene.view();
                         one.of(now) = !one.of(now);
                         context.scene.set_view(now);
                       }});
  for (const ColorQuantity& quantity : color_quantities())
    if (quantity.exists_in(context.scene.configuration().environment))
      entries.push_back({fmt::format("color by {}", quantity.name), "View", view.color == &quantity ? "on" : "",
                         [&context, &quantity] {
                           ViewSettings now = context.scene.view();
                           color_by(now, quantity);
                           context.scene.set_view(now);
                         }});
}

// Asks for a number and sets it. Every configuration that validate() refuses is reported.
void ask_number(PanelContext& context, const std::string& name, double now, const std::string& unit,
                const std::function<void(double)>& set) {
  context.dialogs.ask_text(name, unit.empty() ? "Value:" : fmt::format("Value in {}:", unit),
                           fmt::format("{:.6g}", now), "Set", [&context, set](const std::string& text) {
                             char* end = nullptr;
                             const double value = std::strtod(text.c_str(), &end);
                             if (text.empty() || *end != '\0' || !std::isfinite(value)) {
                               context.toasts.show(Tone::warning, fmt::format("\"{}\" is no number", text));
                               return;
                             }
                             context.scene.end_edit();
                             set(value);
                             context.scene.end_edit();
                           });
}

void add_number(PanelContext& context, std::vector<PaletteEntry>& entries, const std::string& name, double now,
                const std::string& unit, std::function<void(Configuration&, double)> set) {
  entries.push_back({name, "Tune", fmt::format("{:.4g}{}{}", now, unit.empty() ? "" : " ", unit),
                     [&context, name, now, unit, set = std::move(set)] {
                       ask_number(context, name, now, unit, [&context, set](double value) {
                         Configuration configuration = context.scene.configuration();
                         set(configuration, value);
                         context.scene.set_configuration(configuration);
                       });
                     }});
}

void add_parameters(PanelContext& context, std::vector<PaletteEntry>& entries) {
  const Configuration& configuration = context.scene.configuration();
  add_number(context, entries, "time step", 1000 * configuration.dt, "ms",
             [](Configuration& changed, double value) { changed.dt = value / 1000; });
  add_number(context, entries, "damping", configuration.damping, "1/s",
             [](Configuration& changed, double value) { changed.damping = value; });
  for (const Solver solver : {Solver::force, Solver::xpbd})
    entries.push_back({fmt::format("solver {}", name_of(solver)), "Tune", configuration.solver == solver ? "on" : "",
                       [&context, solver] {
                         Configuration changed = context.scene.configuration();
                         changed.solver = solver;
                         context.scene.end_edit();
                         context.scene.set_configuration(changed);
                         context.scene.end_edit();
                       }});
  for_each_parameter(configuration.environment, [&]<class Value>(const auto& parameter, const Value& value) {
    if constexpr (std::is_same_v<Value, float>) {
      std::string label(parameter.name);
      std::ranges::replace(label, '_', ' ');
      add_number(context, entries, label, static_cast<double>(value), std::string(parameter.unit),
                 [name = std::string(parameter.name)](Configuration& changed, double number) {
                   for_each_parameter(changed.environment, [&]<class Other>(const auto& other, Other& target) {
                     if constexpr (std::is_same_v<Other, float>)
                       if (other.name == name) target = static_cast<float>(number);
                   });
                 });
    }
  });
}

}  // namespace

void CommandPalette::open(std::function<std::vector<PaletteEntry>()> list) {
  entries_ = list();
  query_.clear();
  open_ = just_opened_ = true;
  accepted_ = false;
  moved_ = 0;
  search();
}

void CommandPalette::search() {
  std::vector<std::pair<int, std::size_t>> scores;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const auto score = fuzzy_match(query_, entries_[i].name);
    const auto in_group = fuzzy_match(query_, entries_[i].group + " " + entries_[i].name);
    // A letter found in the name counts more than one in the name of the group.
    if (score || in_group) scores.emplace_back(-std::max(score.value_or(-100'000), in_group.value_or(-100'000) - 8), i);
  }
  std::ranges::stable_sort(scores, {}, &std::pair<int, std::size_t>::first);
  found_.clear();
  for (const auto& [score, index] : scores) found_.push_back(index);
  mark_ = 0;
}

void CommandPalette::press(const KeyPress& press) {
  if (is_enter(press)) accepted_ = true;
  if (press.character != 0) return;
  if (press.key == GLFW_KEY_DOWN) ++moved_;
  if (press.key == GLFW_KEY_UP) --moved_;
  if (press.key == GLFW_KEY_PAGE_DOWN) moved_ += 8;
  if (press.key == GLFW_KEY_PAGE_UP) moved_ -= 8;
}

void CommandPalette::draw(PanelContext& context) {
  if (!open_) return;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float text = ImGui::GetFontSize(), top = 0.12f * screen.y;
  ImGui::SetNextWindowPos({screen.x / 2, top}, ImGuiCond_Always, {0.5f, 0});
  ImGui::SetNextWindowSize({std::min(0.94f * screen.x, 36 * text), std::min(0.8f * screen.y, 26 * text)});
  ImGui::SetNextWindowBgAlpha(1);
  ImGui::SetNextWindowFocus();
  ImGui::Begin("##palette", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav);
  context.log.item(
      "panel.Palette", ImGui::GetWindowPos(),
      {ImGui::GetWindowPos().x + ImGui::GetWindowWidth(), ImGui::GetWindowPos().y + ImGui::GetWindowHeight()});
  ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  const std::string before = query_;
  // Not in the first frame: the field has yet to receive what was typed before Enter.
  const bool accepted = std::exchange(accepted_, false) && !just_opened_;
  text_field("##query", query_, "a command, a robot or a setting");
  context.log.item("palette.query");
  if (query_ != before || std::exchange(just_opened_, false)) search();
  const int last = static_cast<int>(found_.size()) - 1;
  mark_ = std::clamp(mark_ + moved_, 0, std::max(0, last));
  std::optional<std::size_t> chosen;
  if (accepted && last >= 0) chosen = found_[static_cast<std::size_t>(mark_)];
  if (const auto clicked = draw_entries(context)) chosen = clicked;
  moved_ = 0;
  const bool left = ImGui::IsMouseClicked(0) && !ImGui::IsWindowHovered(ImGuiHoveredFlags_ChildWindows);
  ImGui::End();
  if (left) open_ = false;
  if (!chosen) return;
  open_ = false;
  context.log.write("palette", {{"name", entries_[*chosen].name}});
  const std::function<void()> act = entries_[*chosen].act;  // a copy, since it may open the palette again
  act();
}

std::optional<std::size_t> CommandPalette::draw_entries(PanelContext& context) {
  std::optional<std::size_t> clicked;
  if (ImGui::BeginChild("found", {0, 0})) {
    if (found_.empty()) note("nothing has these letters");
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(found_.size()), ImGui::GetTextLineHeightWithSpacing());
    if (moved_ != 0) {
      const float line = ImGui::GetTextLineHeightWithSpacing(), top = static_cast<float>(mark_) * line;
      if (top < ImGui::GetScrollY()) ImGui::SetScrollY(top);
      if (top + line > ImGui::GetScrollY() + ImGui::GetWindowHeight())
        ImGui::SetScrollY(top + line - ImGui::GetWindowHeight());
    }
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        const std::size_t index = found_[static_cast<std::size_t>(i)];
        const PaletteEntry& entry = entries_[index];
        const std::string right =
            entry.detail.empty() ? entry.group : fmt::format("{}   {}", entry.detail, entry.group);
        const float width = ImGui::GetContentRegionAvail().x, place = width - ImGui::CalcTextSize(right.c_str()).x;
        ImGui::PushID(i);
        if (ImGui::Selectable("##entry", i == mark_)) clicked = index;
        ImGui::PopID();
        if (i < 10) context.log.item(fmt::format("palette.{}", i));
        ImGui::SameLine(ImGui::GetStyle().ItemSpacing.x);
        ImGui::TextUnformatted(shortened(entry.name, place - 2 * ImGui::GetFontSize()).c_str());
        ImGui::SameLine(place);
        ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
        ImGui::TextUnformatted(right.c_str());
        ImGui::PopStyleColor();
      }
  }
  ImGui::EndChild();
  return clicked;
}

std::vector<PaletteEntry> settings_for_palette(PanelContext& context, const std::function<void(const char*)>& show) {
  std::vector<PaletteEntry> entries;
  for (const PanelEntry& panel : panel_table())
    entries.push_back({fmt::format("panel {}: {}", panel.title, panel.tooltip), "Panels", "",
                       [show, title = panel.title] { show(title); }});
  add_switches(context, entries);
  add_parameters(context, entries);
  for (const RobotEntry& robot : context.scene.entries())
    entries.push_back({robot.name, "Robots", fmt::format("{} springs", robot.springs), [&context, id = robot.id] {
                         context.scene.select(id);
                         frame_robots(context, {id});
                       }});
  return entries;
}

}  // namespace mercury::window
