// SPDX-License-Identifier: Apache-2.0
// A slider per actuator of a robot, which drives it by hand until it is released.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/live/scene_parameters.h"
#include "app/live/scene_selection.h"
#include "app/scene/appearance.h"
#include "app/window/panels/panel.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "mercury/brain.h"

namespace mercury::window {

class ActuatorsPanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  // Of the robot that was shown last.
  struct Body {
    std::shared_ptr<const Robot> robot;
    std::vector<Actuator> actuators;
    std::vector<std::optional<std::size_t>> neurons;  // per actuator, in BrainActivity; none = it follows the sine
    std::vector<ImU32> colors;                        // per material
  };
  void show(const std::shared_ptr<const Robot>& robot);
  float drive_now(const LiveScene& scene, const LiveRobot& robot, std::size_t actuator) const;
  void draw_actuator(PanelContext& context, const LiveRobot& robot, std::size_t actuator,
                     const std::vector<RobotId>& robots);

  Body body_;
};

void ActuatorsPanel::show(const std::shared_ptr<const Robot>& robot) {
  if (body_.robot == robot) return;
  body_ = {.robot = robot, .actuators = actuators_of(*robot), .neurons = {}, .colors = {}};
  body_.neurons.resize(body_.actuators.size());
  for (const render::Color color : material_colors(materials_of(*robot), robot->materials.empty()))
    body_.colors.push_back(packed(color));
  if (!robot->brain) return;
  const BrainLayout layout = brain_layout(*robot);
  for (std::size_t i = 0; i < layout.driven.size(); ++i) body_.neurons[layout.driven[i]] = layout.outputs[i];
}

// What the sine or the brain says; NaN if it is not known.
float ActuatorsPanel::drive_now(const LiveScene& scene, const LiveRobot& robot, std::size_t actuator) const {
  const Snapshot& snapshot = scene.snapshot();
  if (const std::optional<std::size_t> neuron = body_.neurons[actuator]) {
    const bool known = snapshot.brain && snapshot.brain->robot == robot.id && *neuron < snapshot.brain->neurons.size();
    return known ? std::clamp(snapshot.brain->neurons[*neuron], -1.0f, 1.0f) : NAN;
  }
  const Material& material = materials_of(robot)[body_.actuators[actuator].materials.front()];
  const double angle = static_cast<double>(material.frequency) * snapshot.time + static_cast<double>(material.phase);
  const auto sine = static_cast<float>(std::sin(angle));
  return material.half_wave ? std::min(sine, 0.0f) : sine;
}

void ActuatorsPanel::draw(PanelContext& context) {
  LiveScene& scene = context.scene;
  const std::vector<DocumentRobot>& all = scene.document().robots;
  const DocumentRobot* shown =
      scene.selection().current() ? scene.document().find(*scene.selection().current()) : nullptr;
  if (!shown && !all.empty()) shown = &all.front();
  if (!shown) {
    note("There are no robots.");
    return;
  }
  LiveRobot robot = shown->body;
  const Snapshot& snapshot = scene.snapshot();
  if (const auto index = snapshot.robots->index_of(robot.id); index && snapshot.timeline.viewing)
    robot = snapshot.robots->robots[*index];  // as it was at the moment shown
  show(robot.robot);
  if (robot.robot->brain) scene.watch_brain(robot.id);
  std::vector<RobotId> robots = scene.selection().robots();
  if (robots.empty()) robots = {robot.id};
  heading(robot.name.c_str());
  if (body_.actuators.empty()) {
    note("This robot has no muscles.");
    return;
  }
  note(robots.size() > 1 ? fmt::format("A slider drives a muscle by hand, in all {} selected robots that have one of "
                                       "this name. -1: shortest, 1: longest.",
                                       robots.size())
                               .c_str()
                         : "A slider drives a muscle by hand. -1: shortest, 1: longest.");
  const bool any = std::ranges::any_of(robots, [&](RobotId id) {
    const DocumentRobot* one = scene.document().find(id);
    return one && one->body.by_hand &&
           !std::ranges::all_of(one->body.by_hand->drives, [](float u) { return std::isnan(u); });
  });
  ImGui::BeginDisabled(!any);
  if (ImGui::Button("Release all", {-1, 0})) scene.parameters().release_actuators(robots);
  ImGui::EndDisabled();
  context.log.item("actuators.release");
  tooltip("all muscles follow their sines and brains again");
  for (std::size_t i = 0; i < body_.actuators.size(); ++i) draw_actuator(context, robot, i, robots);
  // All changes until the mouse button is released are one undo step.
  if (ImGui::IsMouseReleased(0)) scene.end_edit();
}

void ActuatorsPanel::draw_actuator(PanelContext& context, const LiveRobot& robot, std::size_t index,
                                   const std::vector<RobotId>& robots) {
  const Actuator& actuator = body_.actuators[index];
  const bool any = robot.by_hand && index < robot.by_hand->drives.size();
  const float by_hand = any ? robot.by_hand->drives[index] : NAN, text = ImGui::GetFontSize();
  const bool held = !std::isnan(by_hand);
  const float now = held ? by_hand : drive_now(context.scene, robot, index);
  const MaterialId material = actuator.materials.front();
  ImGui::PushID(static_cast<int>(index));
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::GetWindowDrawList()->AddRectFilled(
      {corner.x, corner.y + (ImGui::GetFrameHeight() - 0.7f * text) / 2},
      {corner.x + 0.7f * text, corner.y + (ImGui::GetFrameHeight() + 0.7f * text) / 2},
      material < body_.colors.size() ? body_.colors[material] : palette().faint, 0.15f * text);
  ImGui::Indent(1.1f * text);
  const char* source = body_.neurons[index] ? "its brain" : "its sine";
  const bool released = row_with_reset(label_of(actuator.name).c_str(),
                                       fmt::format("{}: {}", actuator.name, held ? "driven by hand" : source).c_str(),
                                       held, fmt::format("release: {} drives it again", source).c_str());
  const std::string reset = fmt::format("actuator.{}.release", index);
  if (held) context.log.item(reset, ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  float drive = std::isnan(now) ? 0 : now;
  if (!held) ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  const bool moved = number_slider("##drive", drive, -1, 1, "%+.2f");
  if (!held) ImGui::PopStyleColor();
  if (index < 20) context.log.item(fmt::format("actuator.{}", index));
  tooltip("drag, or Ctrl-click to type");
  ImGui::Unindent(1.1f * text);
  ImGui::PopID();
  if (!moved && !released) return;
  context.scene.parameters().drive_actuator(robots, actuator.name, released ? std::nullopt : std::optional(drive));
  if (released) context.scene.end_edit();
  context.log.write("drive",
                    {{"actuator", actuator.name}, {"drive", released ? nlohmann::json() : nlohmann::json(drive)}});
}

std::unique_ptr<Panel> make_actuators_panel(PanelContext&) { return std::make_unique<ActuatorsPanel>(); }

}  // namespace mercury::window
