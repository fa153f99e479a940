// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/view_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

// As on the command line, the legend comes with numbers.
void color(ViewSettings& view, const ColorQuantity& quantity) {
  view.color = &quantity;
  view.scale.reset();
  view.shown.legend = quantity.has_values();
}

bool is_ocean(const Environment& environment) { return std::holds_alternative<Ocean>(environment); }
bool is_land(const Environment& environment) { return std::holds_alternative<Land>(environment); }
bool has_gravity(const Environment& environment) {
  const Vec3 g = gravity_of(environment);
  return g.x != 0 || g.y != 0 || g.z != 0;
}

bool color_section(ViewSettings& view, const Environment& environment, EventLog& log) {
  heading("Colour by");
  bool changed = false;
  const float gap = 0.4f * ImGui::GetStyle().ItemSpacing.x, width = (ImGui::GetContentRegionAvail().x - 3 * gap) / 4;
  int number = 0;
  for (const ColorQuantity& quantity : color_quantities()) {
    if (number++ % 4 != 0) ImGui::SameLine(0, gap);
    const bool offered = quantity.exists_in(environment), on = view.color == &quantity;
    ImGui::BeginDisabled(!offered);
    if (on) ImGui::PushStyleColor(ImGuiCol_Button, palette().accent);
    if (on) ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32_WHITE);
    if (ImGui::Button(std::string(quantity.name).c_str(), {width, 0}) && !on) {
      color(view, quantity);
      changed = true;
    }
    if (on) ImGui::PopStyleColor(2);
    ImGui::EndDisabled();
    log.item(fmt::format("color.{}", quantity.key));
    std::string text(quantity.help);
    if (number <= 9) text += fmt::format(" (key {})", number);
    if (!offered) text += fmt::format("; only in: {}", environments_of(quantity));
    tooltip(text.c_str());
  }
  if (!view.color->has_values()) return changed;
  bool fixed = view.scale.has_value();
  if (ImGui::Checkbox("Fixed scale", &fixed)) {
    view.scale = fixed ? std::optional(std::pair(0.0f, 1.0f)) : std::nullopt;
    changed = true;
  }
  tooltip("otherwise the scale grows with what was seen so far");
  if (view.scale) {
    float ends[2] = {view.scale->first, view.scale->second};
    row("from, to", "values at the ends of the colours");
    if (ImGui::InputFloat2("##scale", ends, "%.4g") && std::isfinite(ends[0]) && std::isfinite(ends[1]) &&
        ends[0] < ends[1]) {
      view.scale = std::pair(ends[0], ends[1]);
      changed = true;
    }
  }
  return changed;
}

bool check(const char* text, const char* explanation, bool& value, const char* name, EventLog& log) {
  const bool changed = ImGui::Checkbox(text, &value);
  log.item(std::string("show.") + name);
  tooltip(explanation);
  return changed;
}

bool show_section(ViewSettings& view, const Environment& environment, EventLog& log) {
  Shown& shown = view.shown;
  bool changed = false;
  heading("Show");
  if (ImGui::BeginTable("show", 2, ImGuiTableFlags_SizingStretchSame)) {
    ImGui::TableNextColumn();
    changed |= check("Skin", "the faces", shown.skin, "skin", log);
    changed |= check("Springs", "every spring as a rod (key S)", shown.springs, "springs", log);
    changed |= check("Masses", "every mass as a ball", shown.masses, "masses", log);
    changed |= check("Rounded skin", "skin smoothed over its edges", view.smooth, "smooth", log);
    changed |= check("Path", "way of each centre of mass", shown.path, "path", log);
    ImGui::TableNextColumn();
    changed |= check("Names", "name, distance and rank above each robot (key L)", shown.labels, "labels", log);
    changed |= check("Legend", "what the colours mean (key K)", shown.legend, "legend", log);
    changed |= check("Clock", "simulated time, in videos and where the panels are hidden", shown.clock, "clock", log);
    changed |= check("Scale bar", "a length in metres", shown.scale_bar, "scale_bar", log);
    ImGui::EndTable();
  }
  heading("Arrows");
  if (ImGui::BeginTable("arrows", 2, ImGuiTableFlags_SizingStretchSame)) {
    const bool ocean = is_ocean(environment);
    ImGui::TableNextColumn();
    ImGui::BeginDisabled(!ocean && !shown.arrows.drag);
    changed |= check("Drag", "of the water on each face (key D); only in the ocean environment", shown.arrows.drag,
                     "drag", log);
    ImGui::EndDisabled();
    ImGui::BeginDisabled(!ocean && !shown.arrows.lift);
    changed |=
        check("Lift", "of the water on each face; only in the ocean environment", shown.arrows.lift, "lift", log);
    ImGui::EndDisabled();
    ImGui::TableNextColumn();
    changed |= check("Velocity", "of each centre of mass", shown.arrows.velocity, "velocity", log);
    ImGui::BeginDisabled(!has_gravity(environment) && !shown.arrows.gravity);
    changed |= check("Gravity", "at each centre of mass, where there is gravity", shown.arrows.gravity, "gravity", log);
    ImGui::EndDisabled();
    ImGui::BeginDisabled(!is_land(environment) && !shown.arrows.contact);
    changed |=
        check("Contact", "of the floor with each mass on it; only on land", shown.arrows.contact, "contact", log);
    ImGui::EndDisabled();
    ImGui::EndTable();
  }
  return changed;
}

bool cut_section(ViewSettings& view, EventLog& log) {
  heading("Cut");
  bool on = view.cut.has_value(), changed = false;
  if (ImGui::Checkbox("Cut the robots open", &on)) {
    view.cut = on ? std::optional(render::CutPlane{.normal = {0, -1, 0}, .offset = 0}) : std::nullopt;
    changed = true;
  }
  log.item("cut");
  if (!view.cut) return changed;
  int axis = 0;
  view.cut->normal.cwiseAbs().maxCoeff(&axis);
  bool other_side = view.cut->normal[axis] < 0;
  // The plane's place along the axis, whichever side is cut away.
  float place = other_side ? -view.cut->offset : view.cut->offset;
  bool moved = combo("across", "the axis that the plane stands across", axis, {"x", "y", "z"});
  moved |= slider("at", "place of the plane along the axis", place, 0, {-5, 5, "%.2f m"});
  moved |= ImGui::Checkbox("Other side", &other_side);
  if (moved) {
    view.cut->normal = Eigen::Vector3f::Zero();
    view.cut->normal[axis] = other_side ? -1.0f : 1.0f;
    view.cut->offset = other_side ? -place : place;
  }
  return changed || moved;
}

void camera_section(OrbitController& camera, EventLog& log) {
  heading("Camera");
  struct Mode {
    CameraMode mode;
    const char* name;
    const char* meaning;
  };
  static constexpr Mode modes[] = {
      {CameraMode::still, "Free", "stays where you put it"},
      {CameraMode::group, "Group", "keeps all robots in view"},
      {CameraMode::follow, "Follow", "goes along with the selected robot, or the group (key G)"},
      {CameraMode::turntable, "Circle", "circles the group (key T)"},
      {CameraMode::top, "Top", "looks straight down (key Z)"}};
  for (const Mode& mode : modes) {
    if (mode.mode != CameraMode::still) ImGui::SameLine(0, 0.3f * ImGui::GetFontSize());
    if (toggle_button(mode.name, camera.mode() == mode.mode)) camera.set_mode(mode.mode);
    log.item(std::string("camera.") + mode.name);
    tooltip(mode.meaning);
  }
  float degrees = camera.field_of_view * 57.29578f;
  if (slider("angle of view", "of the picture's height; small = like a telescope", degrees, 0.6f * 57.29578f,
             {5, 90, "%.0f\xc2\xb0"}))
    camera.field_of_view = degrees / 57.29578f;
}

bool appearance_section(ViewSettings& view, Preferences& preferences, int robots, EventLog& log) {
  heading("Layout and looks");
  bool changed = false;
  int layout = static_cast<int>(view.layout);
  if (combo("layout", "where the robots stand", layout, {"grid", "race: a lane each"})) {
    view.layout = static_cast<Layout>(layout);
    changed = true;
  }
  if (view.layout == Layout::grid) {
    int columns = view.grid ? static_cast<int>(view.grid->columns) : 0;
    row("columns", "of the grid; 0 = as suits the picture");
    if (ImGui::InputInt("##columns", &columns)) {
      columns = std::clamp(columns, 0, 1000);
      view.grid =
          columns > 0 ? std::optional(Grid{columns, std::max(1, (robots + columns - 1) / columns)}) : std::nullopt;
      changed = true;
    }
    log.item("columns");
  }
  int theme = view.theme == render::Theme::dark ? 0 : 1;
  if (combo("theme", "of the picture and the panels (key B)", theme, {"dark", "light"})) {
    view.theme = theme == 0 ? render::Theme::dark : render::Theme::light;
    changed = true;
  }
  log.item("theme");
  int quality = static_cast<int>(preferences.quality);
  if (combo("quality", "effort of drawing", quality, {"automatic", "low", "medium", "high"}))
    preferences.quality = static_cast<render::Quality>(quality);
  log.item("quality");
  row("text size", "of the panels");
  if (ImGui::Button("-##text", {1.8f * ImGui::GetFontSize(), 0}))
    preferences.text_scale = std::max(0.7f, preferences.text_scale - 0.1f);
  ImGui::SameLine();
  if (ImGui::Button("+##text", {1.8f * ImGui::GetFontSize(), 0}))
    preferences.text_scale = std::min(2.5f, preferences.text_scale + 0.1f);
  ImGui::SameLine();
  ImGui::Text("%.0f %%", 100 * static_cast<double>(preferences.text_scale));
  return changed;
}

}  // namespace

bool draw_view_panel(ViewSettings& view, OrbitController& camera, Preferences& preferences,
                     const Environment& environment, std::size_t robots, EventLog& log) {
  bool changed = color_section(view, environment, log);
  changed |= show_section(view, environment, log);
  camera_section(camera, log);
  changed |= appearance_section(view, preferences, static_cast<int>(robots), log);
  changed |= cut_section(view, log);
  return changed;
}

void toggle_drag_arrows(ViewSettings& view) { view.shown.arrows.drag = !view.shown.arrows.drag; }

bool color_by_number(ViewSettings& view, int number, const Environment& environment) {
  const auto quantities = color_quantities();
  if (number < 1 || number > static_cast<int>(quantities.size())) return false;
  const ColorQuantity& quantity = quantities[static_cast<std::size_t>(number - 1)];
  if (!quantity.exists_in(environment)) return false;
  color(view, quantity);
  return true;
}

}  // namespace mercury::window
