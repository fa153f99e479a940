// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/run_sections.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/window/panels/commands.h"
#include "app/window/toolkit/plot.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "mercury/quantity.h"

namespace mercury::window {
namespace {

// A name and its value, in a table of two or four columns.
void entry(const std::string& name, const std::string& value) {
  ImGui::TableNextColumn();
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::TextUnformatted(name.c_str());
  ImGui::PopStyleColor();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(value.c_str());
}

std::string parents_of(const Individual& individual) {
  if (individual.parents.empty()) return "none";
  return fmt::format("{}", fmt::join(individual.parents, " and "));
}

std::string title_of(const MapAxis& axis) {
  const auto found = find_quantity(axis.quantity);
  return found ? window::title_of(quantities()[*found]) : label_of(axis.quantity);
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

struct Row {
  const Individual* individual;
  bool is_branch;  // a second parent; its child is in the row above
};

std::vector<Row> rows_of(const Family& family) {
  std::vector<Row> rows;
  for (const FamilyMember& member : family.line) {
    rows.push_back({&member.individual, false});
    if (member.other_parent) rows.push_back({&*member.other_parent, true});
  }
  return rows;
}

ScoreRange range_of(const std::vector<Row>& rows) {
  ScoreRange range;
  for (const Row& row : rows) range.add(row.individual->score());
  return range;
}

// The columns, from the left edge [pixels].
struct Columns {
  explicit Columns(float width) : text(ImGui::GetFontSize()), right(width - 0.3f * text) {}
  float text;
  float line = 0.7f * text, branch = 1.9f * text;         // middles of the dots
  float generation = 5.5f * text, picture = 5.9f * text;  // right, left
  float robot = 11.1f * text, bar = 12 * text;            // right, left
  float right;
  float number() const { return 3.6f * text; }  // room of the score
};

class Tree {
 public:
  Tree(const Family& family, float width) : rows_(rows_of(family)), range_(range_of(rows_)), columns_(width) {}

  const std::vector<Row>& rows() const { return rows_; }
  static float row_height() { return thumbnail_row_height(); }

  void draw_headings() const {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const auto heading = [&](float x, const char* words) {
      draw_text({corner.x + x, corner.y}, 1, palette().faint, words);
    };
    heading(columns_.generation, "generation");
    heading(columns_.robot, "robot");
    heading(columns_.right, "score");
    ImGui::Dummy({0, columns_.text});
  }

  void draw_row(std::size_t index, ImVec2 corner, ImTextureID thumbnail) const {
    const Row& row = rows_[index];
    const float height = row_height(), middle = corner.y + height / 2, top = middle - columns_.text / 2;
    draw_lines(index, corner.x, middle);
    const double score = row.individual->score();
    const ImU32 color = ImGui::GetColorU32(row.is_branch ? ImGuiCol_TextDisabled : ImGuiCol_Text);
    draw_text({corner.x + columns_.generation, top}, 1, color, std::to_string(row.individual->generation));
    const float left_edge = corner.x + columns_.picture;
    draw_thumbnail(thumbnail, {left_edge, corner.y + 1},
                   {left_edge + height * Thumbnails::width / Thumbnails::height, corner.y + height - 1});
    draw_text({corner.x + columns_.robot, top}, 1, color, std::to_string(row.individual->id));
    draw_text({corner.x + columns_.right, top}, 1, color, score_text(score));
    const float left = corner.x + columns_.bar, most = columns_.right - columns_.number() - columns_.bar;
    if (most > columns_.text) draw_bar(left, most, middle, score);
  }

 private:
  // From 0 to the score.
  void draw_bar(float left, float most, float middle, double score) const {
    ScoreRange range = range_;
    range.add(0);
    const auto [from, to] = std::minmax({range.share(0), range.share(score)});
    ImGui::GetWindowDrawList()->AddRectFilled({left + most * from, middle - 0.22f * columns_.text},
                                              {left + std::max(2.0f, most * to), middle + 0.22f * columns_.text},
                                              range_.color(score), 0.12f * columns_.text);
  }
  void draw_lines(std::size_t index, float left, float middle) const {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const Row& row = rows_[index];
    const float half = row_height() / 2, x = left + columns_.line, branch = left + columns_.branch;
    const float thickness = 0.11f * columns_.text;
    const bool first = index == 0;
    const bool last = std::none_of(rows_.begin() + static_cast<std::ptrdiff_t>(index) + 1, rows_.end(),
                                   [](const Row& other) { return !other.is_branch; });
    if (!first && !(row.is_branch && last)) list.AddLine({x, middle - half}, {x, middle}, palette().faint, thickness);
    if (!last) list.AddLine({x, middle}, {x, middle + half}, palette().faint, thickness);
    if (row.is_branch)
      list.AddBezierCubic({x, middle - 2 * half}, {x, middle - half}, {branch, middle - 1.2f * half}, {branch, middle},
                          palette().faint, thickness);
    const ImVec2 dot{row.is_branch ? branch : x, middle};
    const float radius = (row.is_branch ? 0.26f : 0.36f) * columns_.text;
    list.AddCircleFilled(dot, radius + 0.1f * columns_.text, palette().panel);
    list.AddCircleFilled(dot, radius, range_.color(row.individual->score()));
  }

  std::vector<Row> rows_;
  ScoreRange range_;
  Columns columns_;
};

}  // namespace

std::string title_of(const Quantity& quantity) {
  return quantity.unit.empty() ? label_of(quantity.name)
                               : fmt::format("{} [{}]", label_of(quantity.name), unit_text(quantity.unit));
}

std::string objective_label(const std::string& objective) {
  const auto quantity = find_quantity(objective);
  return quantity ? title_of(quantities()[*quantity]) : objective;
}

std::string score_text(double score) { return std::isfinite(score) ? short_number(score) : "-"; }

void ScoreRange::add(double score) {
  if (!std::isfinite(score)) return;
  low_ = std::min(low_, score);
  high_ = std::max(high_, score);
}

float ScoreRange::share(double score) const {
  if (!std::isfinite(score)) return 0;
  return high_ > low_ ? static_cast<float>(std::clamp((score - low_) / (high_ - low_), 0.0, 1.0)) : 1;
}

ImU32 ScoreRange::color(double score) const {
  if (!std::isfinite(score)) return palette().grid;
  return packed(render::color_at(render::Colormap::viridis, 0.15f + 0.85f * share(score)));
}

void show_individual(PanelContext& context, const Individual& individual, const EvolutionSettings& settings,
                     const char* hint) {
  const Assessment& assessment = individual.assessment;
  const float text = ImGui::GetFontSize();
  // Beside the panel, so that it covers none of its rows.
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowSize().x + text;
  const float y = ImGui::GetIO().MousePos.y, share = std::clamp(y / ImGui::GetIO().DisplaySize.y, 0.0f, 1.0f);
  ImGui::SetNextWindowPos({right, y}, ImGuiCond_Always, {0, share});
  ImGui::BeginTooltip();
  const ImVec2 corner = ImGui::GetCursorScreenPos(),
               size{12 * text, 12 * text * Thumbnails::height / Thumbnails::width};
  draw_thumbnail(thumbnail_of_individual(context, individual.id), corner, {corner.x + size.x, corner.y + size.y});
  ImGui::Dummy(size);
  ImGui::SameLine();
  ImGui::BeginGroup();
  ImGui::TextUnformatted(fmt::format("Robot {}", individual.id).c_str());
  if (ImGui::BeginTable("origin", 2, ImGuiTableFlags_SizingFixedFit)) {
    entry("born in generation", std::to_string(individual.generation));
    entry(individual.parents.size() > 1 ? "parents" : "parent", parents_of(individual));
    if (assessment.fate != Fate::sound) entry("trial", std::string(name_of(assessment.fate)));
    for (std::size_t i = 0; i < assessment.scores.size() && i < settings.objectives.size(); ++i)
      entry(objective_label(settings.objectives[i]), score_text(assessment.scores[i]));
    ImGui::EndTable();
  }
  ImGui::EndGroup();
  if (!assessment.values.empty() && ImGui::BeginTable("quantities", 4, ImGuiTableFlags_SizingFixedFit)) {
    for (std::size_t i = 0; i < assessment.values.size() && i < quantities().size(); ++i) {
      const Quantity& quantity = quantities()[i];
      if (!counts(quantity, assessment.fate) || !std::isfinite(assessment.values[i])) continue;
      const bool is_score = std::ranges::find(settings.objectives, quantity.name) != settings.objectives.end();
      if (!is_score)
        entry(label_of(quantity.name),
              fmt::format("{} {}", score_text(assessment.values[i]), unit_text(quantity.unit)));
    }
    ImGui::EndTable();
  }
  if (!assessment.problem.empty()) {
    ImGui::PushTextWrapPos(24 * text);
    ImGui::TextUnformatted(brief(assessment.problem, 2000).c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::TextUnformatted(hint);
  ImGui::PopStyleColor();
  ImGui::EndTooltip();
}

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
      show_individual(context, *map.cells[index], settings, "click: into the scene, and its family");
      if (clicked) chosen = map.cells[index]->id;
    }
  }
  ImGui::SetCursorScreenPos({corner.x, grid.high.y + 1.5f * text});
  draw_scale(range);
  return chosen;
}

bool draw_family(PanelContext& context, const Family& family, const EvolutionSettings& settings, float height,
                 std::uint64_t& id) {
  const Tree tree(family, ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize);
  tree.draw_headings();
  bool chosen = false;
  const ImVec2 spacing = ImGui::GetStyle().ItemSpacing;
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, 0});
  if (ImGui::BeginChild("family", {0, height})) {
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(tree.rows().size()), tree.row_height());
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        const auto index = static_cast<std::size_t>(i);
        const Individual& individual = *tree.rows()[index].individual;
        ImGui::PushID(i);
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        const bool clicked =
            ImGui::Selectable("##row", false, ImGuiSelectableFlags_AllowDoubleClick, {0, tree.row_height()});
        if (i < 20) context.log.item(fmt::format("family.{}", i));
        if (ImGui::IsItemHovered() && pointer_rests()) {
          ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, spacing);
          show_individual(context, individual, settings, "click: into the scene; double click: its family");
          ImGui::PopStyleVar();
        }
        tree.draw_row(index, corner, thumbnail_of_individual(context, individual.id));
        ImGui::PopID();
        if (clicked && ImGui::IsMouseDoubleClicked(0)) {
          chosen = true;
          id = individual.id;
        } else if (clicked) {
          add_individual(context, individual.id);
        }
      }
  }
  ImGui::EndChild();
  ImGui::PopStyleVar();
  return chosen;
}

}  // namespace mercury::window
