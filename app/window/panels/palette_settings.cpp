// SPDX-License-Identifier: Apache-2.0
// The settings and robots that the command palette finds.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "app/scene/color_quantity.h"
#include "app/window/panels/color_section.h"
#include "app/window/panels/command_palette.h"
#include "app/window/panels/panel.h"
#include "app/window/panels/robot_commands.h"

namespace mercury::window {
namespace {

// A switch of the picture.
struct Switch {
  const char* name;
  bool& (*of)(ViewSettings& view);
};
constexpr Switch switches[] = {
    {"skin", [](ViewSettings& view) -> bool& { return view.shown.skin; }},
    {"springs", [](ViewSettings& view) -> bool& { return view.shown.springs; }},
    {"masses", [](ViewSettings& view) -> bool& { return view.shown.masses; }},
    {"rounded skin", [](ViewSettings& view) -> bool& { return view.smooth; }},
    {"path", [](ViewSettings& view) -> bool& { return view.shown.path; }},
    {"names", [](ViewSettings& view) -> bool& { return view.shown.labels; }},
    {"legend", [](ViewSettings& view) -> bool& { return view.shown.legend; }},
    {"clock", [](ViewSettings& view) -> bool& { return view.shown.clock; }},
    {"scale bar", [](ViewSettings& view) -> bool& { return view.shown.scale_bar; }},
    {"velocity arrows", [](ViewSettings& view) -> bool& { return view.shown.arrows.velocity; }},
    {"gravity arrows", [](ViewSettings& view) -> bool& { return view.shown.arrows.gravity; }},
};

void add_switches(PanelContext& context, std::vector<PaletteEntry>& entries) {
  ViewSettings view = context.scene.view();
  for (const Switch& one : switches)
    entries.push_back({fmt::format("show {}", one.name), "View", one.of(view) ? "on" : "off", [&context, &one] {
                         ViewSettings now = context.scene.view();
                         one.of(now) = !one.of(now);
                         context.scene.set_view(now);
                       }});
  for (const ColorQuantity& quantity : color_quantities())
    if (quantity.exists_in(context.scene.configuration().environment))
      entries.push_back({fmt::format("color by {}", quantity.name), "View", view.color == &quantity ? "on" : "",
                         [&context, &quantity] {
                           ViewSettings now = context.scene.view();
                           color_by(now, quantity);
                           context.scene.set_view(now);
                         }});
}

// Asks for a number and sets it. Every configuration that validate() refuses is reported.
void ask_number(PanelContext& context, const std::string& name, double now, const std::string& unit,
                const std::function<void(double)>& set) {
  context.dialogs.ask_text(name, unit.empty() ? "Value:" : fmt::format("Value in {}:", unit),
                           fmt::format("{:.6g}", now), "Set", [&context, set](const std::string& text) {
                             char* end = nullptr;
                             const double value = std::strtod(text.c_str(), &end);
                             if (text.empty() || *end != '\0' || !std::isfinite(value)) {
                               context.toasts.show(Tone::warning, fmt::format("\"{}\" is no number", text));
                               return;
                             }
                             context.scene.end_edit();
                             set(value);
                             context.scene.end_edit();
                           });
}

void add_number(PanelContext& context, std::vector<PaletteEntry>& entries, const std::string& name, double now,
                const std::string& unit, std::function<void(Configuration&, double)> set) {
  entries.push_back({name, "Tune", fmt::format("{:.4g}{}{}", now, unit.empty() ? "" : " ", unit),
                     [&context, name, now, unit, set = std::move(set)] {
                       ask_number(context, name, now, unit, [&context, set](double value) {
                         Configuration configuration = context.scene.configuration();
                         set(configuration, value);
                         context.scene.set_configuration(configuration);
                       });
                     }});
}

void add_parameters(PanelContext& context, std::vector<PaletteEntry>& entries) {
  const Configuration& configuration = context.scene.configuration();
  add_number(context, entries, "time step", 1000 * configuration.dt, "ms",
             [](Configuration& changed, double value) { changed.dt = value / 1000; });
  add_number(context, entries, "damping", configuration.damping, "1/s",
             [](Configuration& changed, double value) { changed.damping = value; });
  for (const Solver solver : {Solver::force, Solver::xpbd})
    entries.push_back({fmt::format("solver {}", name_of(solver)), "Tune", configuration.solver == solver ? "on" : "",
                       [&context, solver] {
                         Configuration changed = context.scene.configuration();
                         changed.solver = solver;
                         context.scene.end_edit();
                         context.scene.set_configuration(changed);
                         context.scene.end_edit();
                       }});
  for_each_parameter(configuration.environment, [&]<class Value>(const auto& parameter, const Value& value) {
    if constexpr (std::is_same_v<Value, float>) {
      std::string label(parameter.name);
      std::ranges::replace(label, '_', ' ');
      add_number(context, entries, label, static_cast<double>(value), std::string(parameter.unit),
                 [name = std::string(parameter.name)](Configuration& changed, double number) {
                   for_each_parameter(changed.environment, [&]<class Other>(const auto& other, Other& target) {
                     if constexpr (std::is_same_v<Other, float>)
                       if (other.name == name) target = static_cast<float>(number);
                   });
                 });
    }
  });
}

}  // namespace

std::vector<PaletteEntry> settings_for_palette(PanelContext& context, const std::function<void(const char*)>& show) {
  std::vector<PaletteEntry> entries;
  for (const PanelEntry& panel : panel_table())
    entries.push_back({fmt::format("panel {}: {}", panel.title, panel.tooltip), "Panels", "",
                       [show, title = panel.title] { show(title); }});
  add_switches(context, entries);
  add_parameters(context, entries);
  for (const RobotEntry& robot : context.scene.entries())
    entries.push_back({robot.name, "Robots", fmt::format("{} springs", robot.springs), [&context, id = robot.id] {
                         context.scene.select(id);
                         frame_robots(context, {id});
                       }});
  return entries;
}

}  // namespace mercury::window
