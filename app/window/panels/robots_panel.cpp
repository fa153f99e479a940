// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/robots_panel.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/window/panels/evolution_commands.h"
#include "app/window/panels/file_commands.h"
#include "app/window/panels/key_hint.h"
#include "app/window/panels/robot_commands.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

void draw_work(PanelContext& context) {
  for (const Work& work : context.scene.work()) {
    ImGui::PushID(static_cast<int>(work.id));
    const float share = work.total > 0 ? static_cast<float>(work.done) / static_cast<float>(work.total) : 0;
    ImGui::ProgressBar(share, {ImGui::GetContentRegionAvail().x - 5 * ImGui::GetFontSize(), 0}, work.name.c_str());
    ImGui::SameLine();
    if (ImGui::Button("Cancel")) context.scene.cancel_work(work.id);
    ImGui::PopID();
  }
}

}  // namespace

void RobotsPanel::draw(PanelContext& context) {
  // What stands below the list: six rows of commands, and the random robots.
  const float below =
      6 * ImGui::GetFrameHeightWithSpacing() + ImGui::GetStyle().ItemSpacing.y + random_.height(context);
  list_.draw(context, ImGui::GetWindowHeight() - ImGui::GetCursorPosY() - below);
  draw_work(context);
  draw_commands(context);
  random_.draw(context);
}

void RobotsPanel::draw_strengths(PanelContext& context) {
  MutationRequest& mutation = context.creation.mutation;
  auto body = static_cast<float>(mutation.strength), muscles = static_cast<float>(mutation.muscles);
  if (slider("mutation", "how much mutants differ in their bodies; 1 = a little", body, 1, {0, 10, "%.1f"}))
    mutation.strength = std::max(0.0, static_cast<double>(body));
  context.log.item("mutation.strength");
  if (slider("of muscles", "how much mutants differ in their muscles", muscles, 0, {0, 10, "%.1f"}))
    mutation.muscles = std::max(0.0, static_cast<double>(muscles));
}

void RobotsPanel::draw_commands(PanelContext& context) {
  LiveScene& scene = context.scene;
  const std::vector<RobotId> selection = scene.selection();
  const auto explain = [&](const char* text, Action action) { tooltip(with_keys(context.keys, text, action).c_str()); };
  const float width = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3;
  ImGui::BeginDisabled(selection.empty());
  if (ImGui::Button("Duplicate", {width, 0})) scene.duplicate(selection);
  context.log.item("duplicate");
  explain("add a copy of each selected robot", Action::duplicate);
  ImGui::SameLine();
  if (ImGui::Button("Mutate", {width, 0})) mutate_selected(context);
  context.log.item("mutate");
  explain("add a changed copy of each selected robot", Action::mutate);
  ImGui::SameLine();
  if (ImGui::Button("Remove", {width, 0})) scene.remove(selection);
  context.log.item("remove");
  explain("remove the selected robots", Action::remove);
  const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  ImGui::BeginDisabled(selection.size() != 2);
  if (ImGui::Button("Breed from two", {half, 0})) breed_selected(context);
  ImGui::EndDisabled();
  context.log.item("breed");
  explain("add a child of the two selected robots", Action::breed);
  ImGui::SameLine();
  if (ImGui::Button("Evolve these...", {half, 0})) evolve_selected(context);
  context.log.item("evolve");
  explain("let the selected robots evolve, in the background", Action::evolve);
  ImGui::EndDisabled();
  draw_strengths(context);
  if (ImGui::Button("Open...", {width, 0})) open_robots(context);
  context.log.item("open");
  explain("open robot files, or drop files and folders on the window", Action::open);
  ImGui::SameLine();
  ImGui::BeginDisabled(scene.robot_count() == 0);
  if (ImGui::Button(selection.empty() ? "Save all..." : "Save...", {width, 0})) save_robots(context);
  context.log.item("save");
  explain("save the selected robots, or all if none is selected", Action::save);
  ImGui::SameLine();
  if (ImGui::Button("Clear", {width, 0})) scene.clear();
  context.log.item("clear");
  tooltip("remove all robots; undo brings them back");
  ImGui::EndDisabled();
}

}  // namespace mercury::window
