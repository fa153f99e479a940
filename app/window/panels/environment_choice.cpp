// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/environment_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "app/window/toolkit/widgets.h"
#include "mercury/origin.h"

namespace mercury::window {
namespace {

bool is_dry(const Environment& environment) { return has_ground(environment) && !has_water(environment); }

// On land every spring is 200 times as stiff. Of the 12 swimmers in robots/library, 7 explode there within 3 ms with
// the force solver at 1 ms, 7 at 0.5 ms, 4 at 0.2 ms and none at 0.1 ms; with XPBD none does at 0.5 to 5 ms (10 s
// each).
constexpr double safe_dt = 1e-4;  // of the force solver [s]

void use_xpbd(Configuration& configuration) { configuration.solver = Solver::xpbd; }
void use_small_step(Configuration& configuration) {
  configuration.solver = Solver::force;
  configuration.dt = std::min(configuration.dt, safe_dt);
}
bool is_safe(const Configuration& configuration) {
  return configuration.solver == Solver::xpbd || configuration.dt <= 1.01 * safe_dt;
}

}  // namespace

void EnvironmentChoice::count(const LiveScene& scene) {
  const LiveRobots& robots = *scene.snapshot().robots;
  if (robots.revision == made_.revision) return;
  made_ = {.revision = robots.revision};
  for (const LiveRobot& robot : robots.robots) {
    const std::string name = environment_of(*robot.robot);
    if (!is_environment(name)) continue;
    const Environment environment = environment_named(name);
    if (is_dry(environment)) ++made_.for_land;
    if (has_water(environment)) ++made_.for_water;
  }
}

bool EnvironmentChoice::draw(PanelContext& context, Configuration& configuration) {
  count(context.scene);
  bool changed = draw_list(context, configuration);
  changed |= draw_parts(context, configuration.environment);
  changed |= draw_hint(context, configuration);
  return changed;
}

// What may be added to any preset.
bool EnvironmentChoice::draw_parts(PanelContext& context, Environment& environment) {
  bool ground = has_ground(environment), contacts = environment.contacts.has_value(), changed = false;
  if (ImGui::Checkbox("ground", &ground)) {
    environment.ground = {};
    if (ground) environment.ground = Plane{};
    changed = true;
  }
  context.log.item("tune.ground");
  tooltip("a floor at z = 0 with friction");
  ImGui::SameLine();
  if (ImGui::Checkbox("contacts", &contacts)) {
    environment.contacts.reset();
    if (contacts) environment.contacts.emplace();
    changed = true;
  }
  context.log.item("tune.contacts");
  tooltip("masses of a robot that no spring joins repel each other");
  return changed;
}

bool EnvironmentChoice::draw_list(PanelContext& context, Configuration& configuration) const {
  bool changed = false;
  std::string help;
  for (const EnvironmentPreset& preset : environment_presets)
    help.append(help.empty() ? "" : ". ").append(preset.name).append(": ").append(preset.help);
  row("where", help.c_str());
  const std::string now(name_of(configuration.environment));
  const bool open = ImGui::BeginCombo("##environment", now.c_str());
  if (!open) context.log.item("tune.environment");
  if (!open) return false;
  const bool unsafe = made_.for_water > 0 && !is_dry(configuration.environment) && !is_safe(configuration);
  for (const EnvironmentPreset& preset : environment_presets) {
    const std::string name(preset.name);
    const auto choose = [&](const std::string& label, const char* item, void (*adjust)(Configuration&)) {
      const bool chosen = ImGui::Selectable(label.c_str(), adjust == nullptr && name == now);
      context.log.item(item);
      if (!chosen || (name == now && !adjust)) return;
      configuration.environment = preset.environment;
      if (adjust) adjust(configuration);
      changed = true;
    };
    choose(name, ("tune.environment." + name).c_str(), nullptr);
    if (!unsafe || !is_dry(preset.environment)) continue;
    choose(fmt::format("   {} with XPBD", name), "tune.environment.xpbd", use_xpbd);
    tooltip("the force solver would tear robots apart that are made for water; XPBD keeps them whole");
    choose(fmt::format("   {} with a time step of 0.1 ms", name), "tune.environment.small", use_small_step);
    tooltip("the force solver keeps robots whole that are made for water; ten times as much work");
  }
  ImGui::EndCombo();
  return changed;
}

// For robots that are made for another environment.
bool EnvironmentChoice::draw_hint(PanelContext& context, Configuration& configuration) const {
  const bool land = is_dry(configuration.environment);
  const std::size_t strangers = land ? made_.for_water : made_.for_land;
  if (strangers == 0) return false;
  const std::string who = fmt::format("{} of {} robots {} made for {}", strangers, context.scene.robot_count(),
                                      strangers == 1 ? "is" : "are", land ? "water" : "land");
  if (!land) {
    note(fmt::format("{}: without weight and floor, their gaits move them little", who).c_str());
    context.log.item("tune.hint");
    return false;
  }
  const bool safe = is_safe(configuration);
  note(safe ? fmt::format("{}; they crawl here at best", who).c_str()
            : fmt::format("{}. The force solver tears such robots apart at this time step:", who).c_str());
  context.log.item("tune.hint");
  if (safe) return false;
  bool changed = false;
  if (ImGui::Button("Use XPBD")) {
    use_xpbd(configuration);
    changed = true;
  }
  context.log.item("tune.use_xpbd");
  ImGui::SameLine();
  if (ImGui::Button("Step of 0.1 ms")) {
    use_small_step(configuration);
    changed = true;
  }
  context.log.item("tune.use_small");
  return changed;
}

}  // namespace mercury::window
