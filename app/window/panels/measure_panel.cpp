// SPDX-License-Identifier: Apache-2.0
// Plots of speed, distance, energies and strain over time, for the selected robots or all.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "app/live/measurements.h"
#include "app/live/scene_comparison.h"
#include "app/scene/side_difference.h"
#include "app/window/panels/commands.h"
#include "app/window/panels/panel.h"
#include "app/window/toolkit/plot.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {

class MeasurePanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  void draw_window(PanelContext& context);
  void draw_plots(PanelContext& context, float height);
  void draw_buttons(PanelContext& context);
  void log_view(PanelContext& context);

  std::array<bool, 7> shown_{true, true};  // one per measure of measures()
  TimePlots plots_;
  bool large_ = false;  // in a window of their own
  std::optional<std::pair<double, double>> logged_;
};

namespace {

constexpr std::size_t max_lines = 10;  // the number of category colors

// A robot's series on the first side, on the second, and of its ghost.
struct Curve {
  std::string name;
  std::array<Series, 3> series;
};
constexpr std::array strokes{Stroke::solid, Stroke::dashed, Stroke::dotted};

// What the names of lines are followed by: "eel (XPBD)".
std::array<std::string, 3> suffixes_of(const Snapshot& snapshot) {
  std::array<std::string, 3> suffixes{"", "", " (ghost)"};
  if (!snapshot.second) return suffixes;
  const auto [first, second] = differences(snapshot.configuration, snapshot.second->configuration);
  suffixes[0] = first.empty() ? "" : fmt::format(" ({})", first);
  suffixes[1] = second.empty() ? " (right)" : fmt::format(" ({})", second);
  return suffixes;
}

// What the strokes mean, if there is more than one.
std::string stroke_text(const Snapshot& snapshot) {
  std::string text;
  if (snapshot.second) {
    auto [first, second] = differences(snapshot.configuration, snapshot.second->configuration);
    if (first.empty()) first = "left side", second = "right side";
    text = fmt::format("solid: {}; dashed: {}", first, second);
  }
  if (snapshot.ghosts) text += fmt::format("{}dotted: ghosts", text.empty() ? "" : "; ");
  return text;
}

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
    tooltip(name.help);
  }
  bool folding = false;
  for (std::size_t i = 0; i < shown_.size(); ++i) folding = folding || (shown_[i] && measures()[i].of_folding);
  if (ViewSettings view = context.scene.view(); view.folding != folding) {
    view.folding = folding;
    context.scene.set_view(view);
  }
  plots_.begin(context);
  if (!large_) draw_plots(context, 9 * ImGui::GetFontSize());
  draw_buttons(context);
  if (large_) draw_window(context);
  plots_.end(context);
  log_view(context);
}

// Plots with all the room that the view has.
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
  const LiveScene& scene = context.scene;
  const std::array<std::string, 3> suffixes = suffixes_of(scene.snapshot());
  std::deque<Curve> curves;
  for (const RobotId robot : robots)
    curves.push_back({name_of_robot(scene, robot),
                      {scene.measurements().series(robot), scene.comparison().second_series(robot),
                       scene.comparison().ghost_series(robot)}});
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    if (!shown_[i]) continue;
    const MeasureName& measure = measures()[i];
    std::deque<std::vector<double>> values;
    std::vector<PlotLine> lines;
    for (std::size_t k = 0; k < curves.size(); ++k)
      for (std::size_t side = 0; side < strokes.size(); ++side) {
        const Series& series = curves[k].series[side];
        if (side > 0 && series.times.empty()) continue;
        values.emplace_back();
        for (const Sample& sample : series.samples)
          values.back().push_back(static_cast<double>(sample.of(measure.measure)));
        lines.push_back({curves[k].name + suffixes[side], render::category_color(static_cast<int>(k)), series.times,
                         values.back(), strokes[side]});
      }
    plot(measure.name, {.title = measure.name, .unit = measure.unit, .height = height}, lines, &plots_.view);
    context.log.item(std::string("plot.") + measure.name);
  }
  std::vector<PlotLine> names;
  for (std::size_t k = 0; k < curves.size(); ++k)
    names.push_back({curves[k].name, render::category_color(static_cast<int>(k)), {}, {}});
  plot_legend(names);
  if (const std::string meaning = stroke_text(scene.snapshot()); !meaning.empty()) note(meaning.c_str());
}

void TimePlots::begin(const PanelContext& context) {
  view.cursor = context.cursor.time;
  view.next_cursor.reset();
  view.went_to.reset();
  view.mark = context.scene.drawn().scene().time;
}

void TimePlots::end(PanelContext& context) {
  if (view.next_cursor) context.cursor.next = view.next_cursor;
  if (!view.went_to) {
    if (std::exchange(scrubs, false)) end_scrub(context);
    return;
  }
  if (!std::exchange(scrubs, true)) begin_scrub(context);
  scrub_to(context, *view.went_to);
}

void MeasurePanel::draw_buttons(PanelContext& context) {
  const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  if (ImGui::Button(large_ ? "Smaller" : "Larger", {half, 0})) large_ = !large_;
  context.log.item("measure.large");
  tooltip(
      "plots in a window of their own; the wheel zooms in time, a drag moves, a double click shows everything; "
      "Ctrl and a click or drag show that moment");
  ImGui::SameLine();
  if (ImGui::Button("Save as CSV...", {half, 0}))
    save_csv(context, "measurements", [&context] {
      return series_csv(context.scene.document(), context.scene.measurements(), selected_or_all(context.scene));
    });
  context.log.item("measure.csv");
  tooltip("all quantities over time, of the selected robots, or of all if none is selected");
}

// For tests: the part of the time that is shown.
void MeasurePanel::log_view(PanelContext& context) {
  if (logged_ == plots_.view.range) return;
  logged_ = plots_.view.range;
  if (logged_)
    context.log.write("plot", {{"from", logged_->first}, {"to", logged_->second}});
  else
    context.log.write("plot", {{"from", nullptr}, {"to", nullptr}});
}

std::unique_ptr<Panel> make_measure_panel(PanelContext&) { return std::make_unique<MeasurePanel>(); }

}  // namespace mercury::window
