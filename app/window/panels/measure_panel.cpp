// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/measure_panel.h"

#include <fmt/format.h>

#include <deque>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/window/panels/robot_commands.h"
#include "app/window/panels/saving.h"
#include "app/window/toolkit/plot.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

constexpr std::size_t max_lines = 10;  // the number of category colours

struct Curve {
  std::string name;
  Series series;
};

}  // namespace

void MeasurePanel::draw(PanelContext& context) {
  heading("Plots");
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    const MeasureName& name = measures()[i];
    if (i != 0) {
      ImGui::SameLine();
      if (ImGui::GetContentRegionAvail().x < ImGui::CalcTextSize(name.name).x + 1.5f * ImGui::GetFontSize())
        ImGui::NewLine();
    }
    if (toggle_button(name.name, shown_[i])) shown_[i] = !shown_[i];
    context.log.item(std::string("measure.") + name.name);
  }
  draw_plots(context);
  draw_exports(context);
}

void MeasurePanel::draw_plots(PanelContext& context) {
  std::vector<RobotId> robots = selected_or_all(context.scene);
  if (robots.size() > max_lines) {
    note(fmt::format("the first {} of {} robots; select others to see them", max_lines, robots.size()).c_str());
    robots.resize(max_lines);
  }
  std::deque<Curve> curves;
  for (const RobotId robot : robots)
    curves.push_back({name_of_robot(context.scene, robot), context.scene.series(robot)});
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    if (!shown_[i]) continue;
    const MeasureName& measure = measures()[i];
    std::vector<std::vector<double>> values(curves.size());
    std::vector<PlotLine> lines;
    for (std::size_t k = 0; k < curves.size(); ++k) {
      for (const Sample& sample : curves[k].series.samples)
        values[k].push_back(static_cast<double>(sample.of(measure.measure)));
      lines.push_back({curves[k].name, render::category_color(static_cast<int>(k)), curves[k].series.times, values[k]});
    }
    plot(measure.name, {.title = measure.name, .unit = measure.unit, .height = 9 * ImGui::GetFontSize()}, lines);
  }
  std::vector<PlotLine> names;
  for (std::size_t k = 0; k < curves.size(); ++k)
    names.push_back({curves[k].name, render::category_color(static_cast<int>(k)), {}, {}});
  plot_legend(names);
}

void MeasurePanel::draw_exports(PanelContext& context) {
  if (ImGui::Button("Save as CSV...", {-1, 0}))
    save_csv(context, "measurements", [&context] { return context.scene.csv(selected_or_all(context.scene)); });
  context.log.item("measure.csv");
  tooltip("all quantities over time, of the selected robots, or of all if none is selected");
}

}  // namespace mercury::window
