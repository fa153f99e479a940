// SPDX-License-Identifier: Apache-2.0
// Solver, environment and materials, as sliders that act at once.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "app/live/scene_parameters.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "app/window/panels/commands.h"
#include "app/window/panels/panel.h"
#include "app/window/toolkit/widgets.h"
#include "mercury/origin.h"

namespace mercury::window {

// The part of the Tune panel that changes the materials of the selected robots, or of all.
class MaterialsSection {
 public:
  void draw(PanelContext& context);

 private:
  void draw_factors(PanelContext& context, const std::vector<RobotId>& robots);
  void draw_one(PanelContext& context, const std::vector<RobotId>& robots);

  MaterialScale scale_;
  int material_ = 1;
};

// The list of environments in the Tune panel, and what it says about robots that are made for another one.
class EnvironmentChoice {
 public:
  // Returns true when the user chose another environment, or a solver that suits it.
  bool draw(PanelContext& context, Configuration& configuration);

 private:
  // How many robots of the scene are made for land, and for water.
  struct Made {
    std::uint64_t revision = ~std::uint64_t{0};  // of the list of robots
    std::size_t for_land = 0, for_water = 0;
  };
  void count(const LiveScene& scene);
  bool draw_list(PanelContext& context, Configuration& configuration) const;
  static bool draw_parts(PanelContext& context, Environment& environment);
  bool draw_hint(PanelContext& context, Configuration& configuration) const;

  Made made_;
};

class TunePanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  EnvironmentChoice environment_;
  MaterialsSection materials_;
};

namespace {

constexpr float pi = std::numbers::pi_v<float>;

// The materials that the springs of a robot use.
std::vector<int> used_materials(const Robot& robot) {
  std::set<int> used;
  for (const Spring& spring : robot.springs) used.insert(spring.material);
  return {used.begin(), used.end()};
}

bool is_dry(const Environment& environment) { return has_ground(environment) && !has_water(environment); }

// On land every spring is 200 times as stiff. Of the 12 swimmers in robots/library/paper, 7 explode there within 3 ms
// with the force solver at 1 ms, 7 at 0.5 ms, 4 at 0.2 ms and none at 0.1 ms; with XPBD none does at 0.5 to 5 ms (10 s
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
    std::string label = label_of(parameter.name);
    const std::string hint(parameter.help), unit = unit_text(parameter.unit);
    if constexpr (std::is_same_v<Value, bool>) {
      changed |= edit(label, hint, value);
    } else {
      const TypicalRange& range = parameter.typical;
      std::string format = range.high - range.low >= 500 && !range.logarithmic ? "%.0f" : "%.2f";
      // Long units, and those of three numbers, have no room on a slider.
      constexpr std::size_t longest = 3;
      if (parameter.unit.size() > longest || (std::is_same_v<Value, Vec3> && !unit.empty()))
        label += " [" + unit + "]";
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

// Where robots begin. It changes the scene itself.
void start_section(PanelContext& context) {
  heading("Start");
  TrialStart edited = context.scene.document().start;
  constexpr TrialSettings usual = one_trial();
  bool changed = false;
  for_each_parameter(edited.trials, [&](const auto& parameter, auto& value) {
    if (!is_of_start(parameter.name)) return;
    const std::string label = label_of(parameter.name),
                      help = fmt::format("{}; acts when robots begin", parameter.help);
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, bool>) {
      changed |= edit(label, help, value);
    } else if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, double>) {
      auto number = static_cast<float>(value);
      const std::string format = parameter.unit.empty() ? "%.2f" : fmt::format("%.2f {}", unit_text(parameter.unit));
      if (slider(label.c_str(), help.c_str(), number, static_cast<float>(usual.*parameter.member),
                 {parameter.typical.low, parameter.typical.high, format.c_str()})) {
        value = static_cast<double>(number);
        changed = true;
      }
    }
    context.log.item(fmt::format("tune.{}", parameter.name));
  });
  if (edited.is_elsewhere()) {
    auto seed = static_cast<int>(edited.seed);
    row("seed", "of the direction and the distance, and of the turn: that of mercury run");
    if (ImGui::InputInt("##seed", &seed) && seed >= 0) {
      edited.seed = static_cast<std::uint64_t>(seed);
      changed = true;
    }
    context.log.item("tune.start_seed");
  }
  if (changed) context.scene.parameters().set_start(edited);
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

void MaterialsSection::draw(PanelContext& context) {
  heading("Materials");
  const std::vector<RobotId> robots = selected_or_all(context.scene);
  if (robots.empty()) {
    note("There are no robots.");
    return;
  }
  const std::size_t selected = context.scene.selection().robots().size();
  note(fmt::format("of {}",
                   selected == 0
                       ? fmt::format("all {} robots; select some to change only those", robots.size())
                       : fmt::format("the {} selected", selected == 1 ? "robot" : fmt::format("{} robots", selected)))
           .c_str());
  draw_factors(context, robots);
  if (ImGui::Button("Reset materials", {-1, 0})) {
    scale_ = {};
    context.scene.parameters().reset_materials(robots);
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
  if (changed) context.scene.parameters().scale_materials(robots, scale_);
}

void MaterialsSection::draw_one(PanelContext& context, const std::vector<RobotId>& robots) {
  const RobotId shown = context.scene.selection().current().value_or(robots.front());
  const DocumentRobot* document = context.scene.document().find(shown);
  if (!document || !ImGui::CollapsingHeader("One material")) return;
  const Robot& robot = *document->body.robot;
  const std::vector<int> used = used_materials(robot);
  if (used.empty()) return;
  if (std::find(used.begin(), used.end(), material_) == used.end()) material_ = used.front();
  row("material", fmt::format("the materials of {}", document->body.name).c_str());
  if (ImGui::BeginCombo("##material", name_of_material(robot, static_cast<MaterialId>(material_)).c_str())) {
    for (const int id : used)
      if (ImGui::Selectable(fmt::format("{}##{}", name_of_material(robot, static_cast<MaterialId>(id)), id).c_str(),
                            id == material_))
        material_ = id;
    ImGui::EndCombo();
  }
  const std::span<const Material> table = context.scene.parameters().materials(shown);
  if (static_cast<std::size_t>(material_) >= table.size()) return;
  const auto id = static_cast<std::size_t>(material_);
  Material material = table[id];
  const Material original = materials_of(robot)[id];
  bool changed = slider("stiffness", "k of a spring", material.stiffness, original.stiffness, {0, 500, "%.1f N/m"});
  changed |= slider("amplitude", "relative change of length; 0 = passive", material.amplitude, original.amplitude,
                    {0, 0.6f, "%.3f"});
  changed |= slider("frequency", "omega", material.frequency, original.frequency, {0, 25, "%.2f rad/s"});
  changed |= slider("phase", "phi", material.phase, original.phase, {-pi, 2 * pi, "%.2f rad"});
  changed |= slider("relaxation time", "tau: how much the spring resists its rate of length", material.relaxation_time,
                    original.relaxation_time, {0, 0.1f, "%.4f s"});
  row("half wave", "only the negative half of the sine acts: the muscle shortens and comes back");
  changed |= ImGui::Checkbox("##half wave", &material.half_wave);
  context.log.item("materials.half_wave");
  if (changed && is_valid(material))
    context.scene.parameters().set_material(robots, static_cast<MaterialId>(material_), material);
}

std::vector<EnvironmentOffer> environment_offers(const Configuration& configuration, bool made_for_water) {
  const bool unsafe = made_for_water && !is_dry(configuration.environment) && !is_safe(configuration);
  std::vector<EnvironmentOffer> offers;
  for (const EnvironmentPreset& preset : environment_presets) {
    const std::string name(preset.name);
    offers.push_back({preset.name, name, "tune.environment." + name, "", nullptr});
    if (!unsafe || !is_dry(preset.environment)) continue;
    offers.push_back({preset.name, name + " with XPBD", "tune.environment.xpbd",
                      "the force solver would tear robots apart that are made for water; XPBD keeps them whole",
                      use_xpbd});
    offers.push_back({preset.name, name + " with a time step of 0.1 ms", "tune.environment.small",
                      "the force solver keeps robots whole that are made for water; ten times as much work",
                      use_small_step});
  }
  return offers;
}

bool has_water_robots(const LiveScene& scene) {
  return std::ranges::any_of(scene.snapshot().robots->robots, [](const LiveRobot& robot) {
    const std::string name = environment_of(*robot.robot);
    return is_environment(name) && has_water(environment_named(name));
  });
}

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
  row("environment", help.c_str());
  const std::string now(name_of(configuration.environment));
  const bool open = ImGui::BeginCombo("##environment", now.c_str());
  if (!open) context.log.item("tune.environment");
  if (!open) return false;
  for (const EnvironmentOffer& offer : environment_offers(configuration, made_.for_water > 0)) {
    const bool is_now = !offer.adjust && offer.environment == now;
    const bool chosen = ImGui::Selectable(((offer.adjust ? "   " : "") + offer.name).c_str(), is_now);
    context.log.item(offer.item);
    if (!offer.help.empty()) tooltip(offer.help.c_str());
    if (!chosen || is_now) continue;
    configuration.environment = environment_named(offer.environment);
    if (offer.adjust) offer.adjust(configuration);
    changed = true;
  }
  ImGui::EndCombo();
  return changed;
}

// For robots that are made for another environment.
bool EnvironmentChoice::draw_hint(PanelContext& context, Configuration& configuration) const {
  const bool land = is_dry(configuration.environment);
  const std::size_t strangers = land ? made_.for_water : made_.for_land;
  if (strangers == 0) return false;
  const std::string who = fmt::format("{} of {} robots {} made for {}", strangers, context.scene.robots().count(),
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

void TunePanel::draw(PanelContext& context) {
  Configuration configuration = context.scene.document().configuration;
  if (draw_physics_sliders(context, environment_, configuration))
    context.scene.parameters().set_configuration(configuration);
  start_section(context);
  materials_.draw(context);
  // All changes until the mouse button is released are one undo step.
  if (ImGui::IsMouseReleased(0)) context.scene.end_edit();
}

std::unique_ptr<Panel> make_tune_panel(PanelContext&) { return std::make_unique<TunePanel>(); }

}  // namespace mercury::window
