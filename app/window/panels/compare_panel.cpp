// SPDX-License-Identifier: Apache-2.0
// Compares robots: two views of the same robots under different settings, and ghosts of robots before a change.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <string>

#include "app/live/scene_comparison.h"
#include "app/live/scene_selection.h"
#include "app/window/panels/commands.h"
#include "app/window/panels/panel.h"
#include "app/window/toolkit/widgets.h"
#include "app/window/viewport/second_view.h"
#include "mercury/error.h"

namespace mercury::window {

class ComparePanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  void draw_views(PanelContext& context);
  void draw_settings(PanelContext& context, const SideDifference& difference);
  void draw_text(PanelContext& context, const SideDifference& difference);
  void draw_ghosts(PanelContext& context);

  std::string text_, shown_text_;  // in the field, and of the second side when it was written there
  std::string problem_;            // with the text in the field
  int ghost_of_ = 0;               // a GhostOf
};

namespace {

void set_second(PanelContext& context, const std::optional<SideDifference>& difference) {
  context.scene.comparison().set_second(difference);
  if (difference) context.preferences.compared = difference->text();
  context.log.write("compare", {{"with", difference ? difference->text() : ""}});
}

// The other solver, and the environment that is the opposite.
SideDifference other_solver(const Configuration& configuration) {
  return SideDifference(configuration.solver == Solver::force ? "solver=xpbd" : "solver=force");
}
SideDifference other_environment(const Configuration& configuration) {
  // On land, springs of swimmers are stiff: the force solver would need very small steps.
  if (has_ground(configuration.environment)) return SideDifference("environment=ocean");
  return SideDifference(configuration.solver == Solver::xpbd ? "environment=land" : "environment=land,solver=xpbd");
}

// The second view begins with what it had last, if that still is something else than the first.
SideDifference usual_difference(const PanelContext& context) {
  const Configuration& first = context.scene.document().configuration;
  try {
    if (!context.preferences.compared.empty()) {
      const SideDifference last(context.preferences.compared);
      if (last.over(first) != first) return last;
    }
  } catch (const InputError&) {  // of settings that somebody edited
  }
  return other_solver(first);
}

}  // namespace

void toggle_second_view(PanelContext& context) {
  LiveScene& scene = context.scene;
  if (scene.comparison().second()) return set_second(context, std::nullopt);
  if (scene.snapshot().timeline.recording)
    context.toasts.show(Tone::info, "a recording has one side; go on simulating from a frame to compare");
  set_second(context, usual_difference(context));
}

void toggle_ghosts(PanelContext& context, GhostOf of) {
  LiveScene& scene = context.scene;
  if (!scene.comparison().ghosts().empty()) {
    scene.comparison().hide_ghosts();
    context.log.write("ghosts", {{"count", 0}});
    return;
  }
  const std::vector<RobotId> robots = scene.selection().robots();
  if (robots.empty()) {
    context.toasts.show(Tone::info, "select the robots that get a ghost first");
    return;
  }
  const std::size_t count = scene.comparison().show_ghosts(robots, of);
  context.log.write("ghosts", {{"count", count}});
  if (count == 0) {
    context.toasts.show(Tone::info, "the selected robots have no parent in the window");
  } else if (scene.snapshot().steps > 0) {
    context.toasts.show(
        Tone::info,
        fmt::format("ghosts from {:.2f} s on; a reset (R) starts robots and ghosts together", scene.snapshot().time));
  }
}

void ComparePanel::draw(PanelContext& context) {
  draw_views(context);
  draw_ghosts(context);
}

void ComparePanel::draw_views(PanelContext& context) {
  heading("Two views");
  const std::optional<SideDifference> now = context.scene.comparison().second();
  const Configuration& first = context.scene.document().configuration;
  const auto preset = [&](const char* name, const char* text, const char* help, const SideDifference& difference) {
    const bool on = now == difference;
    ImGui::PushID(name);
    if (toggle_button(text, on)) set_second(context, on ? std::nullopt : std::optional(difference));
    ImGui::PopID();
    context.log.item(std::string("compare.") + name);
    tooltip(help);
  };
  preset("solver", first.solver == Solver::force ? "force | XPBD" : "XPBD | force",
         "the same robots with the other solver", other_solver(first));
  ImGui::SameLine();
  const bool land = has_ground(first.environment);
  preset("environment", land ? "land | ocean" : "ocean | land", "the same robots in another environment",
         other_environment(first));
  if (!now) {
    note("The same robots from the moment shown on, beside each other under different settings (key I).");
    return;
  }
  draw_settings(context, *now);
  draw_text(context, *now);
  if (ImGui::Button("One view", {-1, 0})) set_second(context, std::nullopt);
  context.log.item("compare.off");
  if (context.scene.snapshot().timeline.recording)
    note("A recording has one side. Go on simulating from a frame to compare.");
}

// Lists for what differs most often.
void ComparePanel::draw_settings(PanelContext& context, const SideDifference& difference) {
  SideDifference edited = difference;
  const std::string solver = difference.value("solver"), kind = difference.value("environment");
  int solver_index = solver.empty() ? 0 : 1 + static_cast<int>(solver_named(solver));
  if (combo("solver", "of the right side", solver_index, {"as on the left", "force", "XPBD"}))
    edited.set("solver", solver_index == 0 ? "" : std::string(name_of(static_cast<Solver>(solver_index - 1))));
  context.log.item("compare.right_solver");
  std::vector<std::string> names{"as on the left"};
  for (const std::string_view name : environment_names()) names.emplace_back(name);
  std::vector<const char*> list;
  int kind_index = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    list.push_back(names[i].c_str());
    if (names[i] == kind) kind_index = static_cast<int>(i);
  }
  if (combo("environment", "of the right side", kind_index, list))
    edited.set("environment", kind_index == 0 ? "" : names[static_cast<std::size_t>(kind_index)]);
  context.log.item("compare.right_environment");
  if (edited != difference) set_second(context, edited);
}

// Any settings, as text.
void ComparePanel::draw_text(PanelContext& context, const SideDifference& difference) {
  if (shown_text_ != difference.text()) {
    text_ = shown_text_ = difference.text();
    problem_.clear();
  }
  row("settings",
      "what is different on the right side: solver, environment, dt, damping, or a parameter of the "
      "environment, as in solver=xpbd,dt=0.0005,density=800");
  if (text_field("##settings", text_, "dt=0.0005")) {
    try {
      const SideDifference given = text_.empty() ? SideDifference() : SideDifference(text_);
      problem_.clear();
      set_second(context, given);
    } catch (const ParameterError& error) {
      problem_ = error.problem();
    }
  }
  context.log.item("compare.settings");
  if (!problem_.empty()) note(problem_.c_str());
}

void ComparePanel::draw_ghosts(PanelContext& context) {
  LiveScene& scene = context.scene;
  heading("Ghosts");
  combo("of", "what the ghost of a robot is; automatic: its parent, or itself unchanged if it has none or was changed",
        ghost_of_, {"automatic", "itself unchanged", "its parent"});
  context.log.item("compare.ghost_of");
  const bool on = !scene.comparison().ghosts().empty();
  ImGui::BeginDisabled(!on && scene.selection().robots().empty());
  if (ImGui::Button(on ? "Hide the ghosts" : "Ghosts of the selected robots", {-1, 0}))
    toggle_ghosts(context, static_cast<GhostOf>(ghost_of_));
  ImGui::EndDisabled();
  context.log.item("compare.ghosts");
  tooltip("translucent copies that go on as they were, from the moment shown on (key A)");
  if (!on)
    note("A ghost shows a robot before it was tuned, edited or mutated. It counts nowhere and nothing pulls at it.");
  for (const GhostFigures& figures : scene.comparison().ghost_figures()) {
    ImGui::Bullet();
    std::string text = text_of(figures);
    std::ranges::replace(text, '\n', ' ');
    ImGui::TextWrapped("%s: %s", name_of_robot(scene, figures.robot).c_str(), text.c_str());
  }
}

std::unique_ptr<Panel> make_compare_panel(PanelContext&) { return std::make_unique<ComparePanel>(); }

}  // namespace mercury::window
