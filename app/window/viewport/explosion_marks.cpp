// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/explosion_marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "app/window/toolkit/theme.h"

namespace mercury::window {
namespace {

// The part of a spring in front of the camera, in window coordinates.
struct Line {
  ImVec2 a, b;
  bool sees_a = true, sees_b = true;  // whether the ends are in front of the camera
};

std::optional<Line> line_of(const CulpritSpring& spring, const ViewportArea& area, const render::Camera& camera) {
  const render::Vector3 forward = (camera.target - camera.eye).normalized();
  const auto depth = [&](const render::Vector3& p) { return forward.dot(p - camera.eye) - camera.near; };
  const float depth_a = depth(spring.at_a), depth_b = depth(spring.at_b);
  if (depth_a <= 0 && depth_b <= 0) return std::nullopt;
  const render::Vector3 along = spring.at_b - spring.at_a;
  const float crossing = depth_a / (depth_a - depth_b);
  const auto seen = [&](const render::Vector3& p) {
    const render::Vector3 at = camera.project(p, static_cast<int>(area.width()), static_cast<int>(area.height()));
    return ImVec2(area.low.x + at.x, area.low.y + at.y);
  };
  const auto end = [&](const render::Vector3& p, float d) {
    return seen(d > 0 ? p : render::Vector3(spring.at_a + (crossing + (depth_a > 0 ? -1e-3f : 1e-3f)) * along));
  };
  return Line{end(spring.at_a, depth_a), end(spring.at_b, depth_b), depth_a > 0, depth_b > 0};
}

bool inside(const ViewportArea& area, ImVec2 p) {
  return p.x >= area.low.x && p.x <= area.high.x && p.y >= area.low.y && p.y <= area.high.y;
}

// A bar and two rings with an outline, so that they stand out from any background.
void draw_mark(const Line& line, bool chosen) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float text = ImGui::GetFontSize(), bar = (chosen ? 0.22f : 0.12f) * text, ring = 0.42f * text,
              edge = 0.14f * text;
  const ImU32 mark = palette().mark, outline = palette().mark_outline;
  list.AddLine(line.a, line.b, outline, bar + 2 * edge);
  for (const auto& [at, sees] : {std::pair{line.a, line.sees_a}, {line.b, line.sees_b}})
    if (sees) list.AddCircle(at, ring, outline, 0, bar + 2 * edge);
  list.AddLine(line.a, line.b, mark, bar);
  for (const auto& [at, sees] : {std::pair{line.a, line.sees_a}, {line.b, line.sees_b}})
    if (sees) list.AddCircle(at, ring, mark, 0, bar);
}

std::string length_text(float meters) {
  return meters < 1 ? fmt::format("{:.3g} cm", 100 * meters) : fmt::format("{:.3g} m", meters);
}

std::vector<std::string> lines_of(const ExplodedRobot& robot, bool all) {
  const CulpritSpring& spring = *robot.spring;
  std::vector<std::string> lines{fmt::format("{}: spring {} exploded first", robot.name, spring.index)};
  if (!all) return lines;
  lines.push_back(fmt::format("masses {} and {}, {}", spring.a, spring.b, spring.figures.material_name));
  lines.push_back(
      fmt::format("{} long, {} at rest", length_text(spring.figures.length), length_text(spring.figures.rest_length)));
  return lines;
}

// Finds room for text beside the ends of the line, or above or below its middle. Returns nothing if all positions are
// taken.
std::optional<Box> place_of(const std::vector<std::string>& lines, const Line& line, const ViewportArea& area,
                            std::span<const Box> taken) {
  const float text = ImGui::GetFontSize(), margin = 0.5f * text, away = 0.9f * text;
  ImVec2 size{0, 1.2f * text * static_cast<float>(lines.size()) + margin};
  for (const std::string& one : lines) size.x = std::max(size.x, ImGui::CalcTextSize(one.c_str()).x + 2 * margin);
  const auto& [left, right] = line.a.x < line.b.x ? std::pair{line.a, line.b} : std::pair{line.b, line.a};
  const ImVec2 middle{(left.x + right.x) / 2 - size.x / 2, (left.y + right.y) / 2};
  const ImVec2 places[] = {{right.x + away, right.y - size.y / 2},
                           {left.x - away - size.x, left.y - size.y / 2},
                           {middle.x, std::min(left.y, right.y) - away - size.y},
                           {middle.x, std::max(left.y, right.y) + away},
                           {middle.x, middle.y - away - size.y},
                           {middle.x, middle.y + away}};
  for (const ImVec2 low : places) {
    const Box box{low, {low.x + size.x, low.y + size.y}};
    if (inside(area, box.low) && inside(area, box.high) &&
        std::ranges::none_of(taken, [&](const Box& other) { return box.meets(other); }))
      return box;
  }
  return std::nullopt;
}

void write(const std::vector<std::string>& lines, const Box& place) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float text = ImGui::GetFontSize(), margin = 0.5f * text;
  list.AddRectFilled(place.low, place.high, palette().on_picture, 0.35f * text);
  list.AddRect(place.low, place.high, palette().mark, 0.35f * text, 0, 0.08f * text);
  float y = place.low.y + margin / 2;
  for (std::size_t i = 0; i < lines.size(); ++i, y += 1.2f * text)
    list.AddText({place.low.x + margin, y}, i == 0 ? ImGui::GetColorU32(ImGuiCol_Text) : palette().faint,
                 lines[i].c_str());
}

}  // namespace

void draw_explosion_marks(std::span<const ExplodedRobot> robots, const ExplosionMarks& marks, EventLog& log,
                          const ViewportArea& area, const render::Camera& camera) {
  std::vector<std::pair<const ExplodedRobot*, Line>> drawn;
  for (const ExplodedRobot& robot : robots)
    if (const std::optional<Line> line = robot.spring ? line_of(*robot.spring, area, camera) : std::nullopt)
      drawn.emplace_back(&robot, *line);
  std::stable_partition(drawn.begin(), drawn.end(), [&](const auto& one) { return one.first->robot == marks.chosen; });
  ImGui::GetBackgroundDrawList()->PushClipRect(area.low, area.high);
  // The upper edge has the picture's caption.
  const Box caption{area.low, {area.high.x, area.low.y + 2.2f * ImGui::GetFontSize()}};
  std::vector<Box> taken{{marks.covered_low, marks.covered_high}, caption};
  const float end = 0.7f * ImGui::GetFontSize();
  for (const auto& [robot, line] : drawn) {
    draw_mark(line, robot->robot == marks.chosen);
    for (const ImVec2 at : {line.a, line.b}) taken.push_back({{at.x - end, at.y - end}, {at.x + end, at.y + end}});
  }
  for (const auto& [robot, line] : drawn) {
    const bool chosen = robot->robot == marks.chosen;
    if (chosen) {
      log.item("explosion.a", line.a, line.a);
      log.item("explosion.b", line.b, line.b);
    }
    const std::vector<std::string> lines = lines_of(*robot, chosen);
    const std::optional<Box> place = place_of(lines, line, area, taken);
    if (!place) continue;
    write(lines, *place);
    taken.push_back(*place);
  }
  ImGui::GetBackgroundDrawList()->PopClipRect();
}

}  // namespace mercury::window
