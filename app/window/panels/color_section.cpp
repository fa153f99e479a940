// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/window/toolkit/key_map.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

bool draw_scale(ViewSettings& view, std::pair<float, float> shown, EventLog& log) {
  bool changed = false;
  bool fixed = view.scale.has_value();
  const bool clicked = ImGui::Checkbox("Fixed scale", &fixed);
  log.item("color.fixed");
  if (clicked) {
    view.scale = fixed ? std::optional(shown) : std::nullopt;
    changed = true;
  }
  tooltip("on: the scale stays as it is now; off: it fits the visible values (2nd to 98th percentile)");
  if (!view.scale) {
    ImGui::SameLine();
    changed |= ImGui::Checkbox("All robots", &view.scale_all);
    log.item("color.all");
    tooltip("on: the scale counts all robots; off: those in view");
  }
  if (view.scale) {
    float ends[2] = {view.scale->first, view.scale->second};
    row("from, to", "the values at the ends of the color map");
    if (ImGui::InputFloat2("##scale", ends, "%.4g") && std::isfinite(ends[0]) && std::isfinite(ends[1]) &&
        ends[0] < ends[1]) {
      view.scale = std::pair(ends[0], ends[1]);
      changed = true;
    }
  }
  return changed;
}

bool draw_map(ViewSettings& view, EventLog& log) {
  std::vector<const char*> names{"automatic"};
  for (int i = 0; i < render::colormap_count; ++i)
    names.push_back(render::name_of(static_cast<render::Colormap>(i)).data());  // literals
  int index = view.colormap ? 1 + static_cast<int>(*view.colormap) : 0;
  bool changed = combo("colors", "the color map; automatic: the one that suits the quantity", index, names);
  log.item("color.map");
  if (changed) view.colormap = index > 0 ? std::optional(static_cast<render::Colormap>(index - 1)) : std::nullopt;
  changed |= ImGui::Checkbox("Log scale", &view.log_scale);
  log.item("color.log");
  tooltip("spreads the colors by ratios of values rather than by differences");
  return changed;
}

std::string text_with_keys(const KeyMap& keys, const std::string& text, const ColorQuantity& quantity) {
  const auto colors_by_it = [&](const KeyBinding& binding) { return quantity_of(binding.action) == &quantity; };
  const auto binding = std::ranges::find_if(key_bindings(), colors_by_it);
  return binding == key_bindings().end() ? text : with_keys(keys, text, binding->action);
}

}  // namespace

bool draw_color_section(ViewSettings& view, std::pair<float, float> shown, const Environment& environment,
                        const KeyMap& keys, EventLog& log) {
  heading("Color by");
  bool changed = false;
  constexpr int columns = 3;
  const float gap = 0.4f * ImGui::GetStyle().ItemSpacing.x;
  const float width = (ImGui::GetContentRegionAvail().x - (columns - 1) * gap) / columns;
  int place = 0;
  for (const ColorQuantity& quantity : color_quantities()) {
    if (place++ % columns != 0) ImGui::SameLine(0, gap);
    const bool offered = quantity.exists_in(environment), on = view.color == &quantity;
    ImGui::BeginDisabled(!offered);
    if (on) ImGui::PushStyleColor(ImGuiCol_Button, palette().accent);
    if (on) ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32_WHITE);
    if (ImGui::Button(std::string(quantity.name).c_str(), {width, 0}) && !on) {
      color_by(view, quantity);
      changed = true;
    }
    if (on) ImGui::PopStyleColor(2);
    ImGui::EndDisabled();
    log.item(fmt::format("color.{}", quantity.key));
    std::string text(quantity.help);
    if (!offered) text += fmt::format("; only in: {}", environments_of(quantity));
    tooltip(text_with_keys(keys, text, quantity).c_str());
  }
  if (!view.color->has_values()) return changed;
  changed |= draw_map(view, log);
  changed |= draw_scale(view, shown, log);
  return changed;
}

void color_by(ViewSettings& view, const ColorQuantity& quantity) {
  view.color = &quantity;
  view.scale.reset();
  view.shown.legend = quantity.has_values();
}

const ColorQuantity* quantity_of(Action action) {
  if (action < Action::color_material || action > Action::color_power) return nullptr;
  return &color_quantities()[static_cast<std::size_t>(action) - static_cast<std::size_t>(Action::color_material)];
}

}  // namespace mercury::window
