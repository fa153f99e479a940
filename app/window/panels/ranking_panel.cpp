// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/ranking_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/window/panels/robot_commands.h"
#include "app/window/panels/saving.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

// The columns after the name.
std::array<double, 5> numbers_of(const RankingRow& row) {
  return {row.distance, row.mean_speed, row.speed, row.kinetic_energy + row.elastic_energy, row.largest_strain};
}

}  // namespace

void RankingPanel::draw(PanelContext& context) {
  heading("Ranking");
  std::vector<Row> rows;
  for (const RankingRow& row : context.scene.ranking()) rows.push_back({name_of_robot(context.scene, row.robot), row});
  const auto flags = ImGuiTableFlags_Sortable | ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY |
                     ImGuiTableFlags_ScrollX | ImGuiTableFlags_Resizable | ImGuiTableFlags_BordersOuter;
  const float height = ImGui::GetContentRegionAvail().y - 3.4f * ImGui::GetFrameHeightWithSpacing();
  if (ImGui::BeginTable("ranking", 6, flags, {0, std::max(height, 6 * ImGui::GetFrameHeight())})) {
    draw_headings(context);
    read_sort_order();
    sort(rows);
    log_order(context, rows);
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(rows.size()));
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
        draw_row(context, i, rows[static_cast<std::size_t>(i)]);
    ImGui::EndTable();
  }
  const bool any_exploded = std::ranges::any_of(rows, [](const Row& row) { return row.values.exploded; });
  note(any_exploded ? "distance in m, speeds in m/s, energy in J; - = exploded; click a heading to sort"
                    : "distance in m, speeds in m/s, energy in J; click a heading to sort");
  if (ImGui::Button("Save as CSV...##ranking", {-1, 0}))
    save_csv(context, "ranking", [&context] { return context.scene.ranking_csv(); });
  context.log.item("ranking.csv");
}

void RankingPanel::draw_headings(PanelContext& context) {
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
}

void RankingPanel::read_sort_order() {
  ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs();
  if (!specs || specs->SpecsCount == 0) return;
  if (std::exchange(specs->SpecsDirty, false)) logged_ = false;
  column_ = specs->Specs[0].ColumnIndex;
  ascending_ = specs->Specs[0].SortDirection == ImGuiSortDirection_Ascending;
}

void RankingPanel::sort(std::vector<Row>& rows) const {
  std::stable_sort(rows.begin(), rows.end(), [&](const Row& a, const Row& b) {
    if (column_ == 0) return ascending_ ? a.name < b.name : b.name < a.name;
    const auto index = static_cast<std::size_t>(std::clamp(column_, 1, 5) - 1);
    return ranks_before(a.values, b.values, numbers_of(a.values)[index], numbers_of(b.values)[index], ascending_);
  });
}

void RankingPanel::log_order(PanelContext& context, const std::vector<Row>& rows) {
  if (std::exchange(logged_, true)) return;
  std::vector<std::string> names;
  for (const Row& row : rows) names.push_back(row.name);
  context.log.write("ranking",
                    {{"by", ImGui::TableGetColumnName(column_)}, {"ascending", ascending_}, {"names", names}});
}

void RankingPanel::draw_row(PanelContext& context, int index, const Row& row) {
  const RobotId robot = row.values.robot;
  ImGui::PushID(static_cast<int>(robot));
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  if (ImGui::Selectable(fmt::format("{}. {}", index + 1, row.name).c_str(), context.scene.is_selected(robot),
                        ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowDoubleClick)) {
    context.scene.select(robot, !ImGui::GetIO().KeyCtrl && !ImGui::GetIO().KeyShift);
    if (ImGui::IsMouseDoubleClicked(0)) frame_robots(context, {robot});
  }
  if (index < 20) context.log.item(fmt::format("ranking.{}", index));
  for (const double number : numbers_of(row.values)) {
    ImGui::TableNextColumn();
    right_aligned(row.values.counts() ? fmt::format("{:.3g}", number) : "-");
  }
  ImGui::PopID();
}

}  // namespace mercury::window
