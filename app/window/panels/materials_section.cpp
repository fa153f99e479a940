// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/materials_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "app/window/panels/robot_commands.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

// The materials that the springs of a robot use.
std::vector<int> used_materials(const Robot& robot) {
  std::set<int> used;
  for (const Spring& spring : robot.springs) used.insert(spring.material);
  return {used.begin(), used.end()};
}

std::string name_of_material(const Robot& robot, int id) {
  const auto index = static_cast<std::size_t>(id);
  if (index < robot.material_names.size()) return robot.material_names[index];
  if (robot.materials.empty()) return default_material_name(static_cast<MaterialId>(id));
  return fmt::format("material {}", id);
}

}  // namespace

void MaterialsSection::draw(PanelContext& context) {
  heading("Materials");
  const std::vector<RobotId> robots = selected_or_all(context.scene);
  if (robots.empty()) {
    note("There are no robots.");
    return;
  }
  const std::size_t selected = context.scene.selection().size();
  note(fmt::format("of {}",
                   selected == 0
                       ? fmt::format("all {} robots; select some to change only those", robots.size())
                       : fmt::format("the {} selected", selected == 1 ? "robot" : fmt::format("{} robots", selected)))
           .c_str());
  draw_factors(context, robots);
  if (ImGui::Button("Reset materials", {-1, 0})) {
    scale_ = {};
    context.scene.reset_materials(robots);
    context.scene.end_edit();
  }
  context.log.item("materials.reset");
  tooltip("restore the materials of the robot files");
  draw_one(context, robots);
}

void MaterialsSection::draw_factors(PanelContext& context, const std::vector<RobotId>& robots) {
  bool changed = slider("all stiffness", "factor on the stiffness of all materials", scale_.stiffness, 1,
                        {0.1f, 10, "\xc3\x97 %.2f", true});
  context.log.item("materials.stiffness");
  changed |=
      slider("all amplitudes", "factor on how far muscles contract", scale_.amplitude, 1, {0, 3, "\xc3\x97 %.2f"});
  changed |= slider("all frequencies", "factor on how fast muscles beat", scale_.frequency, 1, {0, 5, "\xc3\x97 %.2f"});
  changed |= slider("all phases", "added to the phase of every muscle", scale_.phase, 0, {-pi, pi, "%.2f rad"});
  if (changed) context.scene.scale_materials(robots, scale_);
}

void MaterialsSection::draw_one(PanelContext& context, const std::vector<RobotId>& robots) {
  const RobotId shown = context.scene.current().value_or(robots.front());
  const DocumentRobot* document = context.scene.document().find(shown);
  if (!document || !ImGui::CollapsingHeader("One material")) return;
  const Robot& robot = *document->body.robot;
  const std::vector<int> used = used_materials(robot);
  if (used.empty()) return;
  if (std::find(used.begin(), used.end(), material_) == used.end()) material_ = used.front();
  row("material", fmt::format("the materials of {}", document->body.name).c_str());
  if (ImGui::BeginCombo("##material", name_of_material(robot, material_).c_str())) {
    for (const int id : used)
      if (ImGui::Selectable(fmt::format("{}##{}", name_of_material(robot, id), id).c_str(), id == material_))
        material_ = id;
    ImGui::EndCombo();
  }
  const std::span<const Material> table = context.scene.materials(shown);
  if (static_cast<std::size_t>(material_) >= table.size()) return;
  const auto id = static_cast<std::size_t>(material_);
  Material material = table[id];
  const Material original = materials_of(robot)[id];
  bool changed = slider("stiffness", "k of a spring", material.stiffness, original.stiffness, {0, 500, "%.1f N/m"});
  changed |= slider("amplitude", "relative change of length; 0 = passive", material.amplitude, original.amplitude,
                    {0, 0.6f, "%.3f"});
  changed |= slider("frequency", "omega", material.frequency, original.frequency, {0, 25, "%.2f rad/s"});
  changed |= slider("phase", "phi", material.phase, original.phase, {-pi, 2 * pi, "%.2f rad"});
  row("half wave", "only the negative half of the sine acts: the muscle shortens and comes back");
  changed |= ImGui::Checkbox("##half wave", &material.half_wave);
  context.log.item("materials.half_wave");
  if (changed && is_valid(material)) context.scene.set_material(robots, static_cast<MaterialId>(material_), material);
}

}  // namespace mercury::window
