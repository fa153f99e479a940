// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/tune_panel.h"

#include <cmath>
#include <string>

#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

bool edit(Ocean& ocean) {
  static const Ocean standard;
  bool changed =
      slider("density", "of the water, rho", ocean.density, standard.density, {0, 2000, "%.0f kg/m\xc2\xb3"});
  changed |= slider("drag coefficient", "C_D of a face across the flow", ocean.drag_coefficient,
                    standard.drag_coefficient, {0, 3, "%.2f"});
  changed |=
      slider("lift coefficient", "C_L of a face", ocean.lift_coefficient, standard.lift_coefficient, {0, 1, "%.2f"});
  changed |= slider("flow", "velocity of the water [m/s]", ocean.flow, standard.flow, {-2, 2, "%.2f"});
  return changed;
}

bool edit(OceanSimple& ocean) {
  static const OceanSimple standard;
  bool changed = slider("drag of a mass", "force over speed through the water", ocean.point_drag, standard.point_drag,
                        {0, 10, "%.2f N s/m"});
  changed |= slider("flow", "velocity of the water [m/s]", ocean.flow, standard.flow, {-2, 2, "%.2f"});
  return changed;
}

bool edit(Land& land) {
  static const Land standard;
  bool changed =
      slider("friction", "Coulomb coefficient of the floor", land.friction, standard.friction, {0, 2, "%.2f"});
  ImGui::PushID("collision");
  row("self-collision", "masses of one robot that no spring joins repel each other");
  changed |= ImGui::Checkbox("##on", &land.self_collision);
  ImGui::PopID();
  ImGui::BeginDisabled(!land.self_collision);
  changed |= slider("contact stiffness", "k_c of that repulsion, times the stiffness scale", land.contact_stiffness,
                    standard.contact_stiffness, {0, 1000, "%.0f N/m"});
  ImGui::EndDisabled();
  return changed;
}

template <class Kind>
bool edit_common(Kind& environment) {
  static const Kind standard;
  bool changed =
      slider("gravity", "acceleration [m/s\xc2\xb2]", environment.gravity, standard.gravity, {-20, 20, "%.2f"});
  changed |= slider("stiffness scale", "multiplies every spring's stiffness", environment.stiffness_scale,
                    standard.stiffness_scale, {0.01f, 1000, "\xc3\x97 %.2f", true});
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
  if (slider("damping", "velocities shrink by exp(-damping dt) a step", damping, static_cast<float>(standard.damping),
             {0, 5, "%.2f 1/s"}) &&
      damping >= 0) {
    configuration.damping = static_cast<double>(damping);
    changed = true;
  }
  log.item("tune.damping");
  return changed;
}

bool environment_section(Configuration& configuration, EventLog& log) {
  heading("Environment");
  bool changed = false;
  auto kind = static_cast<int>(configuration.environment.index());
  if (combo("where", "ocean: drag on the skin. Simple ocean: drag on each mass. Land: floor, friction, gravity", kind,
            {"ocean", "simple ocean", "land"})) {
    configuration.environment = kind == 0   ? Environment(Ocean{})
                                : kind == 1 ? Environment(OceanSimple{})
                                            : Environment(Land{});
    changed = true;
  }
  log.item("tune.environment");
  changed |= std::visit(
      [](auto& environment) {
        const bool own = edit(environment);
        return edit_common(environment) || own;
      },
      configuration.environment);
  return changed;
}

}  // namespace

bool draw_physics_sliders(Configuration& configuration, EventLog& log) {
  Configuration edited = configuration;
  bool changed = solver_section(edited, log);
  changed |= environment_section(edited, log);
  ImGui::Dummy({0, 0.2f * ImGui::GetFontSize()});
  if (ImGui::Button("Reset all to defaults")) {
    const Device device = edited.device;
    edited = Configuration{};
    edited.device = device;
    // Robots stay where they are: on land or in the water.
    if (std::holds_alternative<Land>(configuration.environment)) edited.environment = Land{};
    if (std::holds_alternative<OceanSimple>(configuration.environment)) edited.environment = OceanSimple{};
    changed = true;
  }
  log.item("tune.reset");
  if (!changed) return false;
  try {
    validate(edited);
  } catch (const std::exception&) {
    return false;  // typed in by hand, and out of what is accepted
  }
  configuration = edited;
  return true;
}

}  // namespace mercury::window
