// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/tune_panel.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <type_traits>

#include "app/window/panels/scene_commands.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

// "drag coefficient"
std::string label_of(std::string_view name) {
  std::string label(name);
  std::replace(label.begin(), label.end(), '_', ' ');
  return label;
}

// "kg/m3" with a raised 3.
std::string unit_text(std::string_view unit) {
  std::string text;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const bool is_power = i > 0 && std::isalpha(static_cast<unsigned char>(unit[i - 1]));
    text += is_power && unit[i] == '2' ? "\xc2\xb2" : is_power && unit[i] == '3' ? "\xc2\xb3" : std::string(1, unit[i]);
  }
  return text;
}

bool edit(const std::string& label, const std::string& hint, bool& value) {
  ImGui::PushID(label.c_str());
  row(label.c_str(), hint.c_str());
  const bool changed = ImGui::Checkbox("##on", &value);
  ImGui::PopID();
  return changed;
}

// A slider per parameter of an environment, or a box for a switch.
bool edit_parameters(Environment& environment) {
  bool changed = false;
  const Environment usual = environment_named(name_of(environment));
  for_each_parameter_pair(environment, usual, [&](const auto& parameter, auto& part, const auto& usual_part) {
    auto& value = part.*parameter.member;
    using Value = std::remove_cvref_t<decltype(value)>;
    const std::string label = label_of(parameter.name), unit = unit_text(parameter.unit);
    std::string hint(parameter.help);
    if constexpr (std::is_same_v<Value, bool>) {
      changed |= edit(label, hint, value);
    } else {
      const TypicalRange& range = parameter.typical;
      std::string format = range.high - range.low >= 500 && !range.logarithmic ? "%.0f" : "%.2f";
      if constexpr (std::is_same_v<Value, Vec3>)
        hint += unit.empty() ? "" : " [" + unit + "]";
      else
        format += unit.empty() ? "" : " " + unit;
      const bool is_disabled = parameter.enabled_by != nullptr && !(part.*parameter.enabled_by);
      ImGui::BeginDisabled(is_disabled);
      changed |= slider(label.c_str(), hint.c_str(), value, usual_part.*parameter.member,
                        {range.low, range.high, format.c_str(), range.logarithmic});
      ImGui::EndDisabled();
    }
  });
  return changed;
}

bool solver_section(Configuration& configuration, EventLog& log) {
  heading("Solver");
  bool changed = false;
  int solver = static_cast<int>(configuration.solver);
  if (combo("method", "force: Hooke's law, explicit. XPBD: positions, stable at large steps", solver,
            {"force", "XPBD"})) {
    configuration.solver = static_cast<Solver>(solver);
    changed = true;
  }
  log.item("tune.solver");
  static const Configuration standard;
  auto dt = static_cast<float>(1000 * configuration.dt);
  if (slider("time step", "smaller is more exact and more stable, and slower", dt,
             static_cast<float>(1000 * standard.dt), {0.01f, 20, "%.3g ms", true}) &&
      dt > 0) {
    configuration.dt = static_cast<double>(dt) / 1000;
    changed = true;
  }
  log.item("tune.dt");
  auto damping = static_cast<float>(configuration.damping);
  if (slider("damping", "velocities shrink by exp(-damping dt) per step", damping, static_cast<float>(standard.damping),
             {0, 5, "%.2f 1/s"}) &&
      damping >= 0) {
    configuration.damping = static_cast<double>(damping);
    changed = true;
  }
  log.item("tune.damping");
  return changed;
}

bool environment_section(PanelContext& context, EnvironmentChoice& choice, Configuration& configuration) {
  heading("Environment");
  bool changed = choice.draw(context, configuration);
  changed |= edit_parameters(configuration.environment);
  return changed;
}

// Returns true when the configuration changed. It stays one that validate() accepts.
bool draw_physics_sliders(PanelContext& context, EnvironmentChoice& choice, Configuration& configuration) {
  Configuration edited = configuration;
  bool changed = false;
  if (ImGui::Button("Reset all")) {
    const Device device = edited.device;
    edited = Configuration{};
    edited.device = device;
    edited.environment = environment_named(name_of(configuration.environment));  // robots stay where they are
    changed = true;
  }
  context.log.item("tune.reset");
  tooltip("solver and environment have their defaults again");
  ImGui::SameLine();
  if (ImGui::Button("Copy as command")) copy_as_command(context, "view");
  context.log.item("tune.copy");
  tooltip("copy the command line that makes this scene");
  changed |= solver_section(edited, context.log);
  changed |= environment_section(context, choice, edited);
  if (!changed) return false;
  try {
    validate(edited);
  } catch (const std::exception&) {
    return false;  // the user typed a value that is not allowed
  }
  configuration = edited;
  return true;
}

}  // namespace

void TunePanel::draw(PanelContext& context) {
  Configuration configuration = context.scene.configuration();
  if (draw_physics_sliders(context, environment_, configuration)) context.scene.set_configuration(configuration);
  materials_.draw(context);
  // All changes until the mouse button is released are one undo step.
  if (ImGui::IsMouseReleased(0)) context.scene.end_edit();
}

}  // namespace mercury::window
