// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/measure_panel.h"

#include <fmt/format.h>

#include <algorithm>
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
  view_.begin_frame();
  view_.mark = context.scene.picture().scene().time;
  if (!large_) draw_plots(context, 9 * ImGui::GetFontSize());
  draw_buttons(context);
  if (large_) draw_window(context);
  log_view(context);
}

// Plots with all the room that the picture has.
void MeasurePanel::draw_window(PanelContext& context) {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float text = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0.5f * screen.x, 0.46f * screen.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({0.8f * screen.x, 0.8f * screen.y}, ImGuiCond_Appearing);
  ImGui::SetNextWindowSizeConstraints({12 * text, 10 * text}, screen);
  if (ImGui::Begin("Plots###Plots", &large_, ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings)) {
    context.log.item(
        "panel.Plots", ImGui::GetWindowPos(),
        {ImGui::GetWindowPos().x + ImGui::GetWindowWidth(), ImGui::GetWindowPos().y + ImGui::GetWindowHeight()});
    const auto count = static_cast<float>(std::max<std::ptrdiff_t>(1, std::ranges::count(shown_, true)));
    const float legend = 2 * ImGui::GetTextLineHeightWithSpacing();
    draw_plots(context, (ImGui::GetContentRegionAvail().y - legend) / count - ImGui::GetStyle().ItemSpacing.y);
  }
  ImGui::End();
}

void MeasurePanel::draw_plots(PanelContext& context, float height) {
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
    plot(measure.name, {.title = measure.name, .unit = measure.unit, .height = height}, lines, &view_);
    context.log.item(std::string("plot.") + measure.name);
  }
  std::vector<PlotLine> names;
  for (std::size_t k = 0; k < curves.size(); ++k)
    names.push_back({curves[k].name, render::category_color(static_cast<int>(k)), {}, {}});
  plot_legend(names);
}

void MeasurePanel::draw_buttons(PanelContext& context) {
  const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  if (ImGui::Button(large_ ? "Smaller" : "Larger", {half, 0})) large_ = !large_;
  context.log.item("measure.large");
  tooltip("plots in a window of their own; the wheel zooms in time, a drag moves, a double click shows everything");
  ImGui::SameLine();
  if (ImGui::Button("Save as CSV...", {half, 0}))
    save_csv(context, "measurements", [&context] { return context.scene.csv(selected_or_all(context.scene)); });
  context.log.item("measure.csv");
  tooltip("all quantities over time, of the selected robots, or of all if none is selected");
}

// For tests: the part of the time that is shown.
void MeasurePanel::log_view(PanelContext& context) {
  if (logged_ == view_.range) return;
  logged_ = view_.range;
  if (logged_)
    context.log.write("plot", {{"from", logged_->first}, {"to", logged_->second}});
  else
    context.log.write("plot", {{"from", nullptr}, {"to", nullptr}});
}

}  // namespace mercury::window
