// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/family_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "app/window/panels/evolution_commands.h"
#include "app/window/panels/individual_details.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

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
  float line = 0.7f * text, branch = 1.9f * text;                       // middles of the dots
  float generation = 5.6f * text, robot = 9 * text, bar = 9.8f * text;  // right, right, left
  float right;
  float number() const { return 3.6f * text; }  // room of the score
};

void draw_text(ImVec2 at, float align, ImU32 color, const std::string& words) {
  ImGui::GetWindowDrawList()->AddText({at.x - align * ImGui::CalcTextSize(words.c_str()).x, at.y}, color,
                                      words.c_str());
}

class Tree {
 public:
  Tree(const Family& family, float width) : rows_(rows_of(family)), range_(range_of(rows_)), columns_(width) {}

  const std::vector<Row>& rows() const { return rows_; }
  float row_height() const { return 1.45f * columns_.text; }

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

  void draw_row(std::size_t index, ImVec2 corner) const {
    const Row& row = rows_[index];
    const float height = row_height(), middle = corner.y + height / 2, top = middle - columns_.text / 2;
    draw_lines(index, corner.x, middle);
    const double score = row.individual->score();
    const ImU32 color = ImGui::GetColorU32(row.is_branch ? ImGuiCol_TextDisabled : ImGuiCol_Text);
    draw_text({corner.x + columns_.generation, top}, 1, color, std::to_string(row.individual->generation));
    draw_text({corner.x + columns_.robot, top}, 1, color, std::to_string(row.individual->id));
    draw_text({corner.x + columns_.right, top}, 1, color, score_text(score));
    const float left = corner.x + columns_.bar, most = columns_.right - columns_.number() - columns_.bar;
    if (most > columns_.text)
      ImGui::GetWindowDrawList()->AddRectFilled(
          {left, middle - 0.22f * columns_.text},
          {left + std::max(2.0f, most * range_.share(score)), middle + 0.22f * columns_.text}, range_.color(score),
          0.12f * columns_.text);
  }

 private:
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
          show_individual(individual, settings, "click: into the scene; double click: its family");
          ImGui::PopStyleVar();
        }
        tree.draw_row(index, corner);
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
