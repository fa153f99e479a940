// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/elite_map_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/window/panels/individual_details.h"
#include "app/window/toolkit/plot.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "mercury/quantity.h"

namespace mercury::window {
namespace {

std::string title_of(const MapAxis& axis) {
  const auto found = find_quantity(axis.quantity);
  const std::string_view unit = found ? quantities()[*found].unit : "";
  return unit.empty() ? axis.quantity : fmt::format("{} [{}]", axis.quantity, unit);
}

void draw_text(ImVec2 at, float align, ImU32 color, const std::string& words) {
  ImGui::GetWindowDrawList()->AddText({at.x - align * ImGui::CalcTextSize(words.c_str()).x, at.y}, color,
                                      words.c_str());
}

struct Grid {
  ImVec2 low, high;  // its corners on the screen
  ImVec2 cell;
};

// Titles and ends of both axes.
void draw_axes(const Grid& grid, const EliteMap& map) {
  const float text = ImGui::GetFontSize(), below = grid.high.y + 0.15f * text;
  const ImU32 color = ImGui::GetColorU32(ImGuiCol_Text);
  const MapAxis& x = map.axes[0];
  draw_text({grid.low.x, below}, 0, palette().faint, short_number(x.lowest));
  draw_text({(grid.low.x + grid.high.x) / 2, below}, 0.5f, color, title_of(x));
  draw_text({grid.high.x, below}, 1, palette().faint, short_number(x.highest));
  if (map.axes.size() < 2) return;
  const MapAxis& y = map.axes[1];
  draw_text({grid.low.x, grid.low.y - 1.25f * text}, 0, color, title_of(y));
  draw_text({grid.low.x - 0.3f * text, grid.low.y - 0.1f * text}, 1, palette().faint, short_number(y.highest));
  draw_text({grid.low.x - 0.3f * text, grid.high.y - 0.95f * text}, 1, palette().faint, short_number(y.lowest));
}

void draw_scale(const ScoreRange& range) {
  const float text = ImGui::GetFontSize(), width = ImGui::GetContentRegionAvail().x;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const std::string low = "score " + score_text(range.low()), high = score_text(range.high());
  const float left = corner.x + ImGui::CalcTextSize(low.c_str()).x + 0.5f * text;
  const float right = corner.x + width - ImGui::CalcTextSize(high.c_str()).x - 0.8f * text;
  draw_text(corner, 0, palette().faint, low);
  draw_text({corner.x + width - 0.3f * text, corner.y}, 1, palette().faint, high);
  constexpr int parts = 48;
  for (int i = 0; i < parts; ++i) {
    const auto at = [&](int k) { return left + (right - left) * static_cast<float>(k) / parts; };
    const double score = range.low() + (range.high() - range.low()) * (i + 0.5) / parts;
    ImGui::GetWindowDrawList()->AddRectFilled({at(i), corner.y + 0.3f * text}, {at(i + 1), corner.y + 0.75f * text},
                                              range.color(score));
  }
  ImGui::Dummy({width, text});
}

void draw_cells(const Grid& grid, const EliteMap& map, const ScoreRange& range) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(grid.low, grid.high, ImGui::GetColorU32(ImGuiCol_FrameBg));
  const float gap = std::min(1.0f, 0.1f * std::min(grid.cell.x, grid.cell.y));
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    if (!map.cells[i]) continue;
    const auto column = static_cast<float>(i % map.columns), row = static_cast<float>(i / map.columns);
    const ImVec2 corner{grid.low.x + column * grid.cell.x, grid.high.y - (row + 1) * grid.cell.y};
    list.AddRectFilled({corner.x + gap, corner.y + gap}, {corner.x + grid.cell.x - gap, corner.y + grid.cell.y - gap},
                       range.color(map.cells[i]->score()));
  }
}

// The index of the cell under the mouse.
std::size_t cell_under_mouse(const Grid& grid, const EliteMap& map) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const auto index = [](float distance, float size, std::size_t count) {
    return std::min(count - 1, static_cast<std::size_t>(std::max(0.0f, distance / size)));
  };
  return index(grid.high.y - mouse.y, grid.cell.y, map.rows) * map.columns +
         index(mouse.x - grid.low.x, grid.cell.x, map.columns);
}

}  // namespace

std::optional<std::uint64_t> draw_elite_map(PanelContext& context, const EliteMap& map,
                                            const EvolutionSettings& settings) {
  const float text = ImGui::GetFontSize(), margin = 3.2f * text,
              above = map.axes.size() > 1 ? 1.4f * text : 0.2f * text;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float width = std::max(6 * text, ImGui::GetContentRegionAvail().x - margin - 0.3f * text);
  Grid grid{
      .low = {corner.x + margin, corner.y + above}, .high = {}, .cell = {width / static_cast<float>(map.columns), 0}};
  grid.cell.y = std::min({grid.cell.x, 16 * text / static_cast<float>(map.rows), 2.5f * text});
  grid.high = {grid.low.x + width, grid.low.y + grid.cell.y * static_cast<float>(map.rows)};
  ScoreRange range;
  for (const auto& cell : map.cells)
    if (cell) range.add(cell->score());
  draw_cells(grid, map, range);
  draw_axes(grid, map);
  ImGui::SetCursorScreenPos(grid.low);
  const bool clicked = ImGui::InvisibleButton("map", {width, grid.high.y - grid.low.y});
  context.log.item("evolution.map");
  std::optional<std::uint64_t> chosen;
  if (ImGui::IsItemHovered()) {
    const std::size_t index = cell_under_mouse(grid, map);
    if (map.cells[index]) {
      const auto column = static_cast<float>(index % map.columns), row = static_cast<float>(index / map.columns);
      const ImVec2 cell{grid.low.x + column * grid.cell.x, grid.high.y - (row + 1) * grid.cell.y};
      ImGui::GetWindowDrawList()->AddRect(cell, {cell.x + grid.cell.x, cell.y + grid.cell.y}, palette().mark, 0, 0, 2);
      show_individual(*map.cells[index], settings, "click: into the scene, and its family");
      if (clicked) chosen = map.cells[index]->id;
    }
  }
  ImGui::SetCursorScreenPos({corner.x, grid.high.y + 1.5f * text});
  draw_scale(range);
  return chosen;
}

}  // namespace mercury::window
