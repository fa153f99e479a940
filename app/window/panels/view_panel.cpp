// SPDX-License-Identifier: Apache-2.0
// What the view shows and how: colors, arrows, camera, appearance.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "app/live/scene_robots.h"
#include "app/window/panels/commands.h"
#include "app/window/panels/panel.h"
#include "app/window/toolkit/key_map.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {

// A row with two buttons. The panel grows with its text, so a click would move them away from under the mouse: until
// the mouse leaves, the buttons stay where they were, above the panel.
class TextSizeRow {
 public:
  void draw(PanelContext& context);

 private:
  struct Pinned {
    ImVec2 low, high;  // of the buttons
    float font = 0;    // size of the text then [pixels]
  };
  void draw_buttons(PanelContext& context, float width, float height);
  void draw_pinned(PanelContext& context);

  std::optional<Pinned> pinned_;
};

class ViewPanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  TextSizeRow text_size_;
};

namespace {

bool has_gravity(const Environment& environment) {
  const Vec3 g = gravity_of(environment);
  return g.x != 0 || g.y != 0 || g.z != 0;
}

bool check(const char* text, const std::string& help, bool& value, const char* name, EventLog& log) {
  const bool changed = ImGui::Checkbox(text, &value);
  log.item(std::string("show.") + name);
  tooltip(help.c_str());
  return changed;
}

bool draw_show_section(ViewSettings& view, const KeyMap& keys, EventLog& log) {
  Shown& shown = view.shown;
  bool changed = false;
  heading("Show");
  if (ImGui::BeginTable("show", 2, ImGuiTableFlags_SizingStretchSame)) {
    ImGui::TableNextColumn();
    changed |= check("Skin", "the faces", shown.skin, "skin", log);
    changed |=
        check("Springs", with_keys(keys, "each spring as a rod", Action::springs), shown.springs, "springs", log);
    changed |= check("Masses", "each mass as a ball", shown.masses, "masses", log);
    changed |= check("Faceted skin", "edged skins, which show each voxel; those of many robots always are",
                     view.faceted, "faceted", log);
    changed |= check("Path", "the path of each center of mass", shown.path, "path", log);
    changed |=
        check("Footprints", "in the sand on land, at medium and high quality", view.footprints, "footprints", log);
    ImGui::TableNextColumn();
    changed |= check("Names", with_keys(keys, "name, distance and rank above each robot", Action::labels), shown.labels,
                     "labels", log);
    changed |= check("Legend", with_keys(keys, "what the colors mean", Action::legend), shown.legend, "legend", log);
    changed |= check("Clock", "simulated time, in videos and while the panels are hidden", shown.clock, "clock", log);
    changed |= check("Scale bar", "a length in meters", shown.scale_bar, "scale_bar", log);
    ImGui::EndTable();
  }
  return changed;
}

bool draw_arrow_section(ViewSettings& view, const Environment& environment, const KeyMap& keys, EventLog& log) {
  Shown& shown = view.shown;
  bool changed = false;
  heading("Arrows");
  if (ImGui::BeginTable("arrows", 2, ImGuiTableFlags_SizingStretchSame)) {
    const bool ocean = has_face_forces(environment);
    ImGui::TableNextColumn();
    ImGui::BeginDisabled(!ocean && !shown.arrows.drag);
    changed |= check(
        "Drag", with_keys(keys, "drag of the water on each face; only in the ocean environment", Action::drag_arrows),
        shown.arrows.drag, "drag", log);
    ImGui::EndDisabled();
    ImGui::BeginDisabled(!ocean && !shown.arrows.lift);
    changed |=
        check("Lift", "lift of the water on each face; only in the ocean environment", shown.arrows.lift, "lift", log);
    ImGui::EndDisabled();
    changed |= check("Force", with_keys(keys, "net force on each mass", Action::force_arrows), shown.arrows.force,
                     "force", log);
    ImGui::TableNextColumn();
    changed |= check("Velocity", "velocity of each center of mass", shown.arrows.velocity, "velocity", log);
    ImGui::BeginDisabled(!has_gravity(environment) && !shown.arrows.gravity);
    changed |= check("Gravity", "at each center of mass, if there is gravity", shown.arrows.gravity, "gravity", log);
    ImGui::EndDisabled();
    ImGui::BeginDisabled(!has_ground(environment) && !shown.arrows.contact);
    changed |= check("Contact",
                     with_keys(keys, "force of the ground on each mass, if there is ground", Action::contact_arrows),
                     shown.arrows.contact, "contact", log);
    ImGui::EndDisabled();
    ImGui::EndTable();
  }
  if (!shown.arrows.any()) return changed;
  changed |= slider("length", "a factor", shown.arrows.length, 1, {0.1f, 10, "\xc3\x97 %.2f", true});
  log.item("arrows.length");
  float density = 100 * shown.arrows.density, threshold = 100 * shown.arrows.threshold;
  if (slider("density", "how many of the arrows are drawn", density, 100, {1, 100, "%.0f %%", true})) {
    shown.arrows.density = std::clamp(density / 100, 0.001f, 1.0f);
    changed = true;
  }
  log.item("arrows.density");
  if (slider("threshold", "arrows weaker than this share of the strongest are left out", threshold, 0,
             {0, 100, "%.0f %%"})) {
    shown.arrows.threshold = std::clamp(threshold / 100, 0.0f, 1.0f);
    changed = true;
  }
  log.item("arrows.threshold");
  return changed;
}

bool draw_cut_section(ViewSettings& view, EventLog& log) {
  heading("Cut");
  bool on = view.cut.has_value(), changed = false;
  if (ImGui::Checkbox("Cut the robots open", &on)) {
    view.cut = on ? std::optional(render::Cut{.below = true}) : std::nullopt;
    changed = true;
  }
  log.item("cut");
  tooltip("each robot across its own middle; drag the handle in the view to move the planes");
  if (!view.cut) return changed;
  changed |= combo("across", "the axis perpendicular to the plane, of each robot as it was at rest", view.cut->axis,
                   {"x", "y", "z"});
  log.item("cut.axis");
  if (slider("at", "from the robot's lowest point on the axis to its highest", view.cut->percent, 50,
             {0, 100, "%.0f %%"})) {
    view.cut->shift = 0;
    changed = true;
  }
  log.item("cut.at");
  changed |= ImGui::Checkbox("Other side", &view.cut->below);
  log.item("cut.side");
  return changed;
}

// Each bookmark: a click goes to it, or sets it if it is not set; with Shift it is set again.
void draw_bookmarks(PanelContext& context) {
  row("bookmarks", "of the camera, kept in the scene's file (keys F5 to F8)");
  for (std::size_t i = 0; i < most_bookmarks; ++i) {
    if (i > 0) ImGui::SameLine(0, 0.3f * ImGui::GetFontSize());
    const bool is_set = context.scene.view().bookmarks[i].has_value();
    ImGui::PushID(static_cast<int>(i));
    if (toggle_button(std::to_string(i + 1).c_str(), is_set))
      is_set && !ImGui::GetIO().KeyShift ? go_to_bookmark(context, i) : set_bookmark(context, i);
    ImGui::PopID();
    context.log.item("camera.bookmark." + std::to_string(i + 1));
    tooltip(is_set ? "go there; with Shift: set it to the current camera" : "set it to the current camera");
  }
}

void draw_camera_section(OrbitController& camera, const KeyMap& keys, EventLog& log) {
  heading("Camera");
  struct Mode {
    CameraMode mode;
    const char* name;
    const char* meaning;
    std::optional<Action> action;
  };
  static constexpr Mode modes[] = {
      {CameraMode::still, "Free", "the mouse moves the camera", {}},
      {CameraMode::group, "Group", "keeps all robots in view", {}},
      {CameraMode::follow, "Follow", "follows the selected robot, or the group", Action::follow},
      {CameraMode::turntable, "Circle", "circles the group", Action::turntable},
      {CameraMode::top, "Top", "looks straight down", Action::top_view}};
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0.25f * ImGui::GetFontSize(), ImGui::GetStyle().FramePadding.y});
  for (const Mode& mode : modes) {
    if (mode.mode != CameraMode::still) ImGui::SameLine(0, 0.3f * ImGui::GetFontSize());
    if (toggle_button(mode.name, camera.mode() == mode.mode)) camera.set_mode(mode.mode);
    log.item(std::string("camera.") + mode.name);
    tooltip((mode.action ? with_keys(keys, mode.meaning, *mode.action) : mode.meaning).c_str());
  }
  ImGui::PopStyleVar();
  float degrees = camera.field_of_view * 57.29578f;
  if (slider("field of view", "vertical; a small angle acts like a telescope", degrees, 0.6f * 57.29578f,
             {5, 90, "%.0f\xc2\xb0"}))
    camera.field_of_view = degrees / 57.29578f;
}

bool draw_layout(ViewSettings& view, int robots, EventLog& log) {
  bool changed = false;
  static constexpr Layout layouts[] = {Layout::cells, Layout::grid, Layout::race};
  int layout = static_cast<int>(std::ranges::find(layouts, view.layout) - layouts);
  if (combo("layout", "how the robots are arranged", layout,
            {"cells: they stay", "grid: they travel", "race: one lane each"})) {
    set_layout(view, layouts[layout]);
    changed = true;
  }
  log.item("layout");
  if (view.layout != Layout::race) {
    int columns = view.grid ? static_cast<int>(view.grid->columns) : 0;
    row("columns", "of the grid");
    if (number_slider("##columns", columns, 0, std::clamp(robots, 1, 1000), columns > 0 ? "%d" : "automatic")) {
      columns = std::clamp(columns, 0, 1000);
      view.grid =
          columns > 0 ? std::optional(Grid{columns, std::max(1, (robots + columns - 1) / columns)}) : std::nullopt;
      changed = true;
    }
    log.item("columns");
  }
  return changed;
}

bool draw_appearance_section(PanelContext& context, ViewSettings& view, TextSizeRow& text_size) {
  heading("Layout and appearance");
  EventLog& log = context.log;
  Preferences& preferences = context.preferences;
  bool changed = draw_layout(view, static_cast<int>(context.scene.robots().entries().size()), log);
  int theme = view.theme == render::Theme::dark ? 0 : 1;
  if (combo("theme", with_keys(context.keys, "of the view and the panels", Action::theme).c_str(), theme,
            {"dark", "light"})) {
    view.theme = theme == 0 ? render::Theme::dark : render::Theme::light;
    changed = true;
  }
  log.item("theme");
  int quality = static_cast<int>(preferences.quality);
  if (combo("quality", "of the frames; higher is slower", quality, {"automatic", "low", "medium", "high"}))
    preferences.quality = static_cast<render::Quality>(quality);
  log.item("quality");
  text_size.draw(context);
  return changed;
}

}  // namespace

void change_text_size(PanelContext& context, int tenths) {
  const float wanted = std::round(10 * context.preferences.text_scale + static_cast<float>(tenths)) / 10;
  context.preferences.text_scale = std::clamp(wanted, Preferences::least_text, Preferences::most_text);
}

void TextSizeRow::draw(PanelContext& context) {
  row("text size", fmt::format("of the panels (keys {} and {})", context.keys.keys_of(Action::larger_text),
                               context.keys.keys_of(Action::smaller_text))
                       .c_str());
  const float font = ImGui::GetFontSize(), width = 1.8f * font, height = ImGui::GetFrameHeight();
  const ImVec2 low = ImGui::GetCursorScreenPos();
  if (pinned_) {
    ImGui::Dummy({width, height});
    draw_pinned(context);
    return;
  }
  const float before = context.preferences.text_scale;
  draw_buttons(context, width, height);
  if (context.preferences.text_scale == before) return;
  pinned_ = {low, {low.x + 2 * width + ImGui::GetStyle().ItemSpacing.x, low.y + height}, font};
  draw_pinned(context);  // at once, so that the next click finds it
}

void TextSizeRow::draw_buttons(PanelContext& context, float width, float height) {
  if (ImGui::Button("-##text", {width, height})) change_text_size(context, -1);
  context.log.item("text.smaller");
  ImGui::SameLine();
  if (ImGui::Button("+##text", {width, height})) change_text_size(context, 1);
  context.log.item("text.larger");
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  ImGui::Text("%.0f %%", 100 * static_cast<double>(context.preferences.text_scale));
}

void TextSizeRow::draw_pinned(PanelContext& context) {
  const Pinned pinned = *pinned_;
  const float scale = pinned.font / ImGui::GetFontSize(), height = pinned.high.y - pinned.low.y;
  const float spacing = 0.5f * pinned.font, width = (pinned.high.x - pinned.low.x - spacing) / 2;
  ImGui::SetNextWindowPos(pinned.low);
  ImGui::SetNextWindowSize({pinned.high.x - pinned.low.x + 4 * pinned.font, height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {spacing, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, 0});
  ImGui::Begin("##textsize", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav);
  ImGui::SetWindowFontScale(scale);
  draw_buttons(context, width, height);
  ImGui::End();
  ImGui::PopStyleVar(4);
  const float margin = 0.6f * pinned.font;
  const ImVec2 low{pinned.low.x - margin, pinned.low.y - margin}, high{pinned.high.x + margin, pinned.high.y + margin};
  if (!ImGui::IsMouseHoveringRect(low, high, false)) pinned_.reset();
}

void ViewPanel::draw(PanelContext& context) {
  ViewSettings view = context.scene.view();
  const Environment& environment = context.scene.document().configuration.environment;
  const auto& scale = context.scene.drawn().scene().scale;
  bool changed = draw_color_section(view, {scale.low, scale.high}, environment, context.keys, context.log);
  changed |= draw_show_section(view, context.keys, context.log);
  changed |= draw_arrow_section(view, environment, context.keys, context.log);
  draw_camera_section(context.camera, context.keys, context.log);
  draw_bookmarks(context);
  changed |= draw_appearance_section(context, view, text_size_);
  changed |= draw_cut_section(view, context.log);
  if (changed) context.scene.set_view(view);
}

std::unique_ptr<Panel> make_view_panel(PanelContext&) { return std::make_unique<ViewPanel>(); }

}  // namespace mercury::window
