#include "app/window/explosion_card.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "app/window/theme.h"
#include "app/window/widgets.h"

namespace mercury::window {
namespace {

std::string spring_text(const DocumentRobot& robot, std::uint32_t spring) {
  if (spring == no_spring || spring >= robot.body.robot->springs.size()) return "no spring is to blame";
  const Spring& bad = robot.body.robot->springs[spring];
  return fmt::format("first bad spring: {} (masses {} and {}, material {})", spring, bad.a, bad.b, bad.material);
}

}  // namespace

void ExplosionCard::follow(Desk& desk) {
  desk.scene.pause_on_explosion(desk.preferences.pause_on_explosion);
  for (const Explosion& explosion : desk.scene.take_explosions()) {
    explosions_.push_back(explosion);
    desk.observations.tell("exploded", {{"robot", explosion.robot}, {"time", explosion.time}});
  }
  if (explosions_.empty()) return;
  // Gone with the robot, or healed by a reset.
  std::erase_if(explosions_, [&](const Explosion& explosion) {
    for (const RobotEntry& entry : desk.scene.entries())
      if (entry.id == explosion.robot) return desk.scene.moment().time < explosion.time;
    return true;
  });
}

void ExplosionCard::draw(Desk& desk, ImVec2 low, ImVec2 high, float aspect) {
  if (explosions_.empty()) return;
  const Explosion explosion = explosions_.front();
  const DocumentRobot* robot = desk.scene.document().find(explosion.robot);
  if (!robot) return;
  const float text = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({low.x + text, high.y - 5 * text}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowSize({std::min(26 * text, high.x - low.x - 2 * text), 0});
  ImGui::PushStyleColor(ImGuiCol_Border, palette().bad);
  ImGui::Begin("##explosion", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PopStyleColor();
  ImGui::PushStyleColor(ImGuiCol_Text, palette().bad);
  ImGui::TextWrapped("%s exploded at %.4g s%s", robot->body.name.c_str(), explosion.time,
                     explosions_.size() > 1 ? fmt::format(", and {} more", explosions_.size() - 1).c_str() : "");
  ImGui::PopStyleColor();
  note(spring_text(*robot, explosion.first_bad_spring).c_str());
  note("It stays frozen, the others go on. A smaller time step, or XPBD, may help.");
  if (ImGui::Button("Show")) {
    desk.scene.select(explosion.robot);
    frame_robots(desk, {explosion.robot}, aspect);
  }
  ImGui::SameLine();
  if (ImGui::Button("Save repro...")) {
    desk.dialogs.ask_text("Save what explodes", "Folder for the robot and its configuration, for mercury run:",
                          desk.preferences.save_folder.empty() ? "repro" : desk.preferences.save_folder, "Save",
                          [&desk, id = explosion.robot](const std::string& folder) {
                            if (!folder.empty())
                              save_with_care(desk, "repro", [&desk, id, folder](bool overwrite) { return desk.scene.save_repro(id, folder, overwrite); });
                          });
  }
  desk.observations.item("explosion.repro");
  ImGui::SameLine();
  if (ImGui::Button("Reset")) desk.scene.reset();
  ImGui::SameLine();
  if (ImGui::Button("Dismiss")) explosions_.clear();
  desk.observations.item("explosion.dismiss");
  ImGui::Checkbox("Pause when something explodes", &desk.preferences.pause_on_explosion);
  ImGui::End();
}

}  // namespace mercury::window
