// SPDX-License-Identifier: Apache-2.0
// A table of all robots, sorted by distance, age, speed, energy or strain.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "app/live/measurements.h"
#include "app/live/scene_selection.h"
#include "app/window/panels/commands.h"
#include "app/window/panels/panel.h"
#include "app/window/panels/robot_list.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {

class RankingPanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  struct Row {
    std::string name;
    RankingRow values;
  };
  void draw_headings(PanelContext& context);
  void read_sort_order();
  void arrange(std::vector<Row>& rows);
  void sort(std::vector<Row>& rows) const;
  void log_order(PanelContext& context, const std::vector<Row>& rows);
  void draw_row(PanelContext& context, int index, const Row& row);
  void draw_notes(PanelContext& context, const std::vector<Row>& rows);

  int column_ = 1;  // to sort by
  bool ascending_ = false;
  bool logged_ = false;  // the current sort order is in the event log
  bool held_ = false;    // the mouse is over the table, so rows stay where they are
  std::vector<RobotId> order_;
  RowSelection selection_;
};

namespace {

struct Column {
  const char* name;
  const char* unit;
  int decimals;
  const char* help;
  double (*figure)(const RankingRow& row);
};

// The columns after the name.
constexpr std::array columns{
    Column{"distance", "m", 3, "of the center of mass since birth: since the robot was added, or the last reset",
           [](const RankingRow& row) { return row.distance; }},
    Column{"speed", "m/s", 3, "the mean: distance divided by age",
           [](const RankingRow& row) { return row.mean_speed; }},
    Column{"age", "s", 1, "time since birth: since the robot was added, or the last reset",
           [](const RankingRow& row) { return row.age; }},
    Column{"at equal age", "m", 3, "distance when it was as old as the youngest robot is now: fair to young robots",
           [](const RankingRow& row) { return row.distance_at_equal_age; }},
    Column{"speed now", "m/s", 3, "of the center of mass", [](const RankingRow& row) { return row.speed; }},
    Column{"energy", "J", 2, "kinetic and elastic, now",
           [](const RankingRow& row) { return row.kinetic_energy + row.elastic_energy; }},
    Column{"largest strain", "%", 1, "of any spring, so far",
           [](const RankingRow& row) { return 100 * row.largest_strain; }}};

// Of a column of the table.
const char* name_of_column(int column) {
  return column == 0 ? "robot" : columns[std::min(static_cast<std::size_t>(column), columns.size()) - 1].name;
}

constexpr const char* help_of_robot = "its place in this order, and its name";

}  // namespace

void RankingPanel::draw(PanelContext& context) {
  std::vector<Row> rows;
  for (const RankingRow& row : context.scene.measurements().ranking())
    rows.push_back({name_of_robot(context.scene, row.robot), row});
  const auto flags = ImGuiTableFlags_Sortable | ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY |
                     ImGuiTableFlags_ScrollX | ImGuiTableFlags_Resizable | ImGuiTableFlags_BordersOuter;
  const float height = ImGui::GetContentRegionAvail().y - 3.4f * ImGui::GetFrameHeightWithSpacing();
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const ImVec2 size{0, std::max(height, 6 * ImGui::GetFrameHeight())};
  held_ = ImGui::IsWindowHovered(ImGuiHoveredFlags_ChildWindows | ImGuiHoveredFlags_AllowWhenBlockedByActiveItem) &&
          ImGui::IsMouseHoveringRect(low, {low.x + ImGui::GetContentRegionAvail().x, low.y + size.y});
  if (ImGui::BeginTable("ranking", 1 + static_cast<int>(columns.size()), flags, size)) {
    draw_headings(context);
    read_sort_order();
    arrange(rows);
    log_order(context, rows);
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(rows.size()));
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
        draw_row(context, i, rows[static_cast<std::size_t>(i)]);
    ImGui::EndTable();
  }
  draw_notes(context, rows);
}

void RankingPanel::draw_notes(PanelContext& context, const std::vector<Row>& rows) {
  const bool any_exploded = std::ranges::any_of(rows, [](const Row& row) { return row.values.exploded; });
  note(held_          ? "the order stays as it is while the mouse is over the table"
       : any_exploded ? "-: exploded; click a heading to sort"
                      : "click a heading to sort");
  const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  ImGui::BeginDisabled(order_.size() < 2);
  if (ImGui::Button("Keep the best...", {half, 0})) ask_for_best(context, order_);
  context.log.item("ranking.keep");
  tooltip("remove all but the first robots of this order");
  ImGui::EndDisabled();
  ImGui::SameLine();
  if (ImGui::Button("Save as CSV...##ranking", {half, 0}))
    save_csv(context, "ranking",
             [&context] { return ranking_csv(context.scene.document(), context.scene.measurements()); });
  context.log.item("ranking.csv");
}

void RankingPanel::draw_headings(PanelContext& context) {
  ImGui::TableSetupScrollFreeze(1, 1);
  // The rest of the width that the first two figures leave in a column of default width.
  ImGui::TableSetupColumn("robot", ImGuiTableColumnFlags_WidthFixed, 6.7f * ImGui::GetFontSize());
  for (const Column& column : columns)
    ImGui::TableSetupColumn(fmt::format("{}\n[{}]", column.name, column.unit).c_str(),
                            ImGuiTableColumnFlags_PreferSortDescending |
                                (&column == columns.data() ? ImGuiTableColumnFlags_DefaultSort : 0));
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (int column = 0; column < ImGui::TableGetColumnCount(); ++column) {
    if (!ImGui::TableSetColumnIndex(column)) continue;
    ImGui::TableHeader(ImGui::TableGetColumnName(column));
    context.log.item(std::string("ranking.by.") + name_of_column(column));
    tooltip(column == 0 ? help_of_robot : columns[static_cast<std::size_t>(column) - 1].help);
  }
}

void RankingPanel::read_sort_order() {
  ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs();
  if (!specs || specs->SpecsCount == 0) return;
  if (std::exchange(specs->SpecsDirty, false)) {
    logged_ = false;
    order_.clear();  // a click on a heading sorts, wherever the mouse is
  }
  column_ = specs->Specs[0].ColumnIndex;
  ascending_ = specs->Specs[0].SortDirection == ImGuiSortDirection_Ascending;
}

// Sorts, or keeps the order under the mouse; robots that came meanwhile follow at the end.
void RankingPanel::arrange(std::vector<Row>& rows) {
  if (!held_ || order_.empty()) {
    sort(rows);
  } else {
    std::unordered_map<RobotId, std::size_t> places;
    for (const RobotId robot : order_) places.emplace(robot, places.size());
    const auto place = [&](const Row& row) {
      const auto found = places.find(row.values.robot);
      return found == places.end() ? places.size() : found->second;
    };
    std::ranges::stable_sort(rows, {}, place);
  }
  order_.clear();
  for (const Row& row : rows) order_.push_back(row.values.robot);
}

void RankingPanel::sort(std::vector<Row>& rows) const {
  std::stable_sort(rows.begin(), rows.end(), [&](const Row& a, const Row& b) {
    if (column_ == 0) return ascending_ ? a.name < b.name : b.name < a.name;
    const auto& figure = columns[std::min(static_cast<std::size_t>(column_), columns.size()) - 1].figure;
    return ranks_before(a.values, b.values, figure(a.values), figure(b.values), ascending_);
  });
}

void RankingPanel::log_order(PanelContext& context, const std::vector<Row>& rows) {
  if (std::exchange(logged_, true)) return;
  std::vector<std::string> names;
  for (const Row& row : rows) names.push_back(row.name);
  context.log.write("ranking", {{"by", name_of_column(column_)}, {"ascending", ascending_}, {"names", names}});
}

void RankingPanel::draw_row(PanelContext& context, int index, const Row& row) {
  const RobotId robot = row.values.robot;
  ImGui::PushID(static_cast<int>(robot));
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  if (thumbnail_row("##row", thumbnail_of_robot(context, robot), fmt::format("{}.\n{}", index + 1, row.name),
                    context.scene.selection().contains(robot),
                    ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowDoubleClick)) {
    if (ImGui::IsMouseDoubleClicked(0))
      frame_robots(context, {robot});
    else
      selection_.click(context.scene, robot, order_);
    context.log.write("row",
                      {{"robot", row.name}, {"place", index}, {"selected", context.scene.selection().robots().size()}});
  }
  // The row is as wide as the table, of which a part may show.
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  if (index < 20)
    context.log.item(fmt::format("ranking.{}", index), low,
                     {std::min(high.x, ImGui::GetWindowPos().x + ImGui::GetWindowWidth()), high.y});
  robot_menu_of_row(context, robot);
  for (const Column& column : columns) {
    ImGui::TableNextColumn();
    thumbnail_row_cell(row.values.counts() ? fmt::format("{:.{}f}", column.figure(row.values), column.decimals) : "-");
  }
  ImGui::PopID();
}

std::unique_ptr<Panel> make_ranking_panel(PanelContext&) { return std::make_unique<RankingPanel>(); }

}  // namespace mercury::window
