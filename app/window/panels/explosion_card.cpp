// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/explosion_card.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "app/live/picking.h"
#include "app/live/replay_log.h"
#include "app/live/scene_files.h"
#include "app/live/scene_selection.h"
#include "app/live/scene_time.h"
#include "app/window/panels/commands.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "app/window/viewport/marks.h"

namespace mercury::window {
namespace {

std::string advice_for(const ExplodedRobot& robot) {
  const std::string advice = "A smaller time step, or XPBD, may help.";
  if (!robot.spring) return "It is frozen; no single spring caused it. " + advice;
  return fmt::format("Spring {} exploded first (masses {} and {}, {}). The robot is frozen; the others go on. {}",
                     robot.spring->index, robot.spring->a, robot.spring->b, robot.spring->figures.material_name,
                     advice);
}

void ask_for_repro(PanelContext& context, const ExplodedRobot& robot) {
  context.dialogs.ask_files({.kind = FileRequest::Kind::folder,
                             .title = "Save the explosion into a folder",
                             .button = "Save here",
                             .extensions = {".repro"},
                             .folder = context.preferences.save_folder,
                             .name = "repro",
                             .formats = {}},
                            [&context, id = robot.robot](const FileChoice& answer) {
                              save_with_confirmation(context, "repro",
                                                     [&context, id, folder = answer.paths.front()](bool overwrite) {
                                                       return context.scene.files().save_repro(id, folder, overwrite);
                                                     });
                            });
}

}  // namespace

const ExplodedRobot* ExplosionCard::chosen() const {
  const auto found = std::ranges::find_if(robots_, [&](const ExplodedRobot& robot) { return robot.robot == chosen_; });
  return found == robots_.end() ? nullptr : &*found;
}

void ExplosionCard::choose(int steps) {
  const auto count = static_cast<int>(robots_.size());
  const auto index = static_cast<int>(chosen() - robots_.data());
  chosen_ = robots_[static_cast<std::size_t>((index + steps + count) % count)].robot;
}

void ExplosionCard::update(PanelContext& context, const ViewportArea& area, const render::Camera& camera) {
  context.scene.time().pause_on_explosion(context.preferences.pause_on_explosion);
  for (const Explosion& explosion : context.scene.take_explosions())
    context.log.write("exploded",
                      {{"robot", explosion.robot}, {"time", explosion.time}, {"spring", explosion.culprit_spring}});
  robots_ = context.scene.exploded();
  std::erase_if(dismissed_, [&](const auto& one) {
    return std::ranges::none_of(robots_, [&](const ExplodedRobot& robot) {
      return one == std::pair{robot.robot, robot.time};
    });
  });
  if (!chosen()) chosen_ = robots_.empty() ? std::nullopt : std::optional(robots_.front().robot);
  if (const auto selected = context.scene.selection().current(); std::exchange(selected_, selected) != selected)
    for (const ExplodedRobot& robot : robots_)
      if (robot.robot == selected) chosen_ = selected;
  const ExplodedRobot* const robot = chosen();
  marks_.clear();
  if (!robot || !(context.scene.selection().contains(robot->robot) || high_.x > low_.x)) return;
  const std::vector<Box> covered{box(), context.legend, context.first_steps, context.message};
  marks_ = draw_explosion_mark(*robot, covered, context.log, area, camera);
}

void ExplosionCard::draw(PanelContext& context, const ViewportArea& area) {
  low_ = high_ = {0, 0};
  const bool any_left = std::ranges::any_of(robots_, [&](const ExplodedRobot& robot) {
    return !dismissed_.contains({robot.robot, robot.time});
  });
  if (!any_left) return;
  const ExplodedRobot robot = *chosen();
  const float text = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({area.low.x + text, area.high.y - text}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowSize({std::min(27 * text, area.width() - 2 * text), 0});
  ImGui::PushStyleColor(ImGuiCol_Border, palette().bad);
  ImGui::Begin("##explosion", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PopStyleColor();
  draw_heading(context, robot);
  note(advice_for(robot).c_str());
  draw_buttons(context, robot, area);
  ImGui::Checkbox("Pause when something explodes", &context.preferences.pause_on_explosion);
  low_ = ImGui::GetWindowPos();
  high_ = {low_.x + ImGui::GetWindowWidth(), low_.y + ImGui::GetWindowHeight()};
  context.log.item("panel.Explosion", low_, high_);
  ImGui::End();
}

void ExplosionCard::draw_heading(PanelContext& context, const ExplodedRobot& robot) {
  const std::string place = fmt::format("{} of {}", chosen() - robots_.data() + 1, robots_.size());
  const float spacing = ImGui::GetStyle().ItemInnerSpacing.x, button = ImGui::GetFrameHeight();
  const float steppers =
      robots_.size() < 2 ? 0 : 2 * (button + spacing) + ImGui::CalcTextSize(place.c_str()).x + spacing;
  const float right = ImGui::GetWindowContentRegionMax().x;
  ImGui::AlignTextToFramePadding();
  ImGui::PushStyleColor(ImGuiCol_Text, palette().bad);
  const std::string when = fmt::format(" exploded at {:.4g} s", robot.time);
  const float room = right - ImGui::GetCursorPosX() - steppers - ImGui::CalcTextSize(when.c_str()).x;
  ImGui::TextUnformatted((shortened(robot.name, room) + when).c_str());
  ImGui::PopStyleColor();
  if (robots_.size() < 2) return;
  ImGui::SameLine(right - steppers + spacing);
  if (ImGui::ArrowButton("##earlier", ImGuiDir_Left)) choose(-1);
  ImGui::SameLine(0, spacing);
  ImGui::TextUnformatted(place.c_str());
  ImGui::SameLine(0, spacing);
  if (ImGui::ArrowButton("##later", ImGuiDir_Right)) choose(1);
  context.log.item("explosion.next");
}

void ExplosionCard::draw_buttons(PanelContext& context, const ExplodedRobot& robot, const ViewportArea& area) {
  if (ImGui::Button("Show it")) {
    context.scene.selection().select(robot.robot);
    context.camera.set_mode(CameraMode::still);
    context.camera.frame({&robot.box, 1}, area.aspect());
  }
  context.log.item("explosion.show");
  ImGui::SameLine();
  if (ImGui::Button("Save repro...")) ask_for_repro(context, robot);
  context.log.item("explosion.repro");
  ImGui::SameLine();
  if (ImGui::Button("Reset")) context.scene.time().reset();
  context.log.item("explosion.reset");
  ImGui::SameLine();
  if (ImGui::Button("Dismiss"))
    for (const ExplodedRobot& one : robots_) dismissed_.insert({one.robot, one.time});
  context.log.item("explosion.dismiss");
}

}  // namespace mercury::window
