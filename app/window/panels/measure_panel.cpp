// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/measure_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "app/window/panels/file_commands.h"
#include "app/window/toolkit/plot.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

constexpr std::size_t most_lines = 10;  // as many as there are colours

struct Curve {
  std::string name;
  Series series;
};

std::string name_of_robot(const LiveScene& scene, RobotId robot) {
  const DocumentRobot* found = scene.document().find(robot);
  return found ? found->body.name : "?";
}

}  // namespace

void MeasurePanel::draw(PanelContext& context) {
  heading("Plots");
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    const QuantityName& name = quantities()[i];
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
  if (robots.size() > most_lines) {
    note(fmt::format("the first {} of {} robots; select others to see them", most_lines, robots.size()).c_str());
    robots.resize(most_lines);
  }
  std::deque<Curve> curves;
  for (const RobotId robot : robots)
    curves.push_back({name_of_robot(context.scene, robot), context.scene.series(robot)});
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    if (!shown_[i]) continue;
    const QuantityName& quantity = quantities()[i];
    std::vector<std::vector<double>> values(curves.size());
    std::vector<PlotLine> lines;
    for (std::size_t k = 0; k < curves.size(); ++k) {
      for (const Sample& sample : curves[k].series.samples)
        values[k].push_back(static_cast<double>(sample.of(quantity.quantity)));
      lines.push_back({curves[k].name, render::category_color(static_cast<int>(k)), curves[k].series.times, values[k]});
    }
    plot(quantity.name, {.title = quantity.name, .unit = quantity.unit, .height = 9 * ImGui::GetFontSize()}, lines);
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
  tooltip("all quantities over time, of the selected robots, or of all");
}

void RankingPanel::draw(PanelContext& context, float aspect) {
  heading("Ranking");
  struct Named {
    std::string name;
    RankingRow row;
  };
  std::vector<Named> rows;
  for (const RankingRow& row : context.scene.ranking()) rows.push_back({name_of_robot(context.scene, row.robot), row});
  const auto flags = ImGuiTableFlags_Sortable | ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY |
                     ImGuiTableFlags_ScrollX | ImGuiTableFlags_Resizable | ImGuiTableFlags_BordersOuter;
  const float height = ImGui::GetContentRegionAvail().y - 3.4f * ImGui::GetFrameHeightWithSpacing();
  if (ImGui::BeginTable("ranking", 6, flags, {0, std::max(height, 6 * ImGui::GetFrameHeight())})) {
    ImGui::TableSetupScrollFreeze(1, 1);
    ImGui::TableSetupColumn("robot", ImGuiTableColumnFlags_WidthFixed, 6 * ImGui::GetFontSize());
    ImGui::TableSetupColumn("distance", ImGuiTableColumnFlags_DefaultSort | ImGuiTableColumnFlags_PreferSortDescending);
    ImGui::TableSetupColumn("mean speed", ImGuiTableColumnFlags_PreferSortDescending);
    ImGui::TableSetupColumn("speed", ImGuiTableColumnFlags_PreferSortDescending);
    ImGui::TableSetupColumn("energy", ImGuiTableColumnFlags_PreferSortDescending);
    ImGui::TableSetupColumn("largest strain", ImGuiTableColumnFlags_PreferSortDescending);
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    for (int column = 0; column < ImGui::TableGetColumnCount(); ++column) {
      if (!ImGui::TableSetColumnIndex(column)) continue;
      ImGui::TableHeader(ImGui::TableGetColumnName(column));
      context.log.item(std::string("ranking.by.") + ImGui::TableGetColumnName(column));
    }
    if (ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs(); specs && specs->SpecsCount > 0) {
      if (std::exchange(specs->SpecsDirty, false)) sorted_ = false;
      column_ = specs->Specs[0].ColumnIndex;
      ascending_ = specs->Specs[0].SortDirection == ImGuiSortDirection_Ascending;
    }
    const auto key = [&](const Named& named) {
      const RankingRow& r = named.row;
      const double keys[] = {
          0, r.distance, r.mean_speed, r.speed, r.kinetic_energy + r.elastic_energy, r.largest_strain};
      return keys[std::clamp(column_, 0, 5)];
    };
    std::stable_sort(rows.begin(), rows.end(), [&](const Named& a, const Named& b) {
      if (column_ == 0) return ascending_ ? a.name < b.name : b.name < a.name;
      return ascending_ ? key(a) < key(b) : key(b) < key(a);
    });
    if (std::exchange(sorted_, true) == false) {
      std::vector<std::string> names;
      for (const Named& named : rows) names.push_back(named.name);
      context.log.write("ranking",
                        {{"by", ImGui::TableGetColumnName(column_)}, {"ascending", ascending_}, {"names", names}});
    }
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(rows.size()));
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        const auto& [name, row] = rows[static_cast<std::size_t>(i)];
        ImGui::PushID(static_cast<int>(row.robot));
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        if (ImGui::Selectable(fmt::format("{}. {}", i + 1, name).c_str(), context.scene.is_selected(row.robot),
                              ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowDoubleClick)) {
          context.scene.select(row.robot, !ImGui::GetIO().KeyCtrl && !ImGui::GetIO().KeyShift);
          if (ImGui::IsMouseDoubleClicked(0)) frame_robots(context, {row.robot}, aspect);
        }
        if (i < 20) context.log.item(fmt::format("ranking.{}", i));
        const double numbers[] = {row.distance, row.mean_speed, row.speed, row.kinetic_energy + row.elastic_energy,
                                  row.largest_strain};
        for (const double number : numbers) {
          ImGui::TableNextColumn();
          right_aligned(fmt::format("{:.3g}", number));
        }
        ImGui::PopID();
      }
    ImGui::EndTable();
  }
  note("distance in m, speeds in m/s, energy in J; a click on a heading sorts");
  if (ImGui::Button("Save as CSV...##ranking", {-1, 0}))
    save_csv(context, "ranking", [&context] { return context.scene.ranking_csv(); });
  context.log.item("ranking.csv");
}

}  // namespace mercury::window
