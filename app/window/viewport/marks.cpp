// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <string>
#include <vector>

#include "app/live/picking.h"
#include "app/live/scene_mouse.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_selection.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "render/cut.h"

namespace mercury::window {
namespace {

// on_screen() if it is in front of the camera.
std::optional<ImVec2> seen_at(const ViewportArea& area, const render::Camera& camera, const render::Vector3& point) {
  const render::Vector3 p = camera.project(point, static_cast<int>(area.width()), static_cast<int>(area.height()));
  return p.is_finite() && p.z >= camera.near ? std::optional(on_screen(area, camera, point)) : std::nullopt;
}

constexpr float shortest = 12;  // line on which the handle moves; below it the mouse moves it up and down [pixels]

std::span<const float> floats(std::span<const Vec3> points) {
  return {points.empty() ? nullptr : &points.front().x, 3 * points.size()};
}

// The index in the snapshot of the first selected robot, or of the first one that is visible, of those that `may`.
template <class May>
std::optional<std::size_t> robot_with_handle(LiveScene& scene, const May& may) {
  const Snapshot& snapshot = scene.snapshot();
  const auto shown = [&](RobotId id) {
    const auto index = snapshot.robots->index_of(id);
    const bool seen = index && *index < scene.drawn().offsets().size() && !snapshot.telemetry[*index].exploded;
    return seen && !scene.selection().is_hidden(id) && may(*snapshot.robots->robots[*index].robot) ? index
                                                                                                   : std::nullopt;
  };
  for (const RobotId id : scene.selection().robots())
    if (const auto index = shown(id)) return index;
  for (const DocumentRobot& robot : scene.document().robots)
    if (const auto index = shown(robot.body.id)) return index;
  return std::nullopt;
}

// An invisible button of that radius at a place of the view. Returns whether there is room for it.
bool handle_button(const char* id, ImVec2 at, float radius, const ViewportArea& area) {
  const float text = ImGui::GetFontSize();
  if (!(at.x > area.low.x + text && at.x < area.high.x - text && at.y > area.low.y + text && at.y < area.high.y - text))
    return false;
  ImGui::SetNextWindowPos({at.x - 1.5f * radius, at.y - 1.5f * radius});
  ImGui::SetNextWindowSize({3 * radius, 3 * radius});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::Begin(id, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoBringToFrontOnFocus |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoMove);
  ImGui::InvisibleButton("handle", {3 * radius, 3 * radius});
  return true;
}
void end_handle_button() {
  ImGui::End();
  ImGui::PopStyleVar(2);
}
void draw_handle(ImVec2 at, float radius, ImU32 color) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddCircleFilled(at, radius + 0.1f * ImGui::GetFontSize(), palette().on_view);
  list.AddCircleFilled(at, radius, color);
  list.AddCircle(at, radius, IM_COL32(0, 0, 0, 160));
}

// Where the mouse is on the line from `low` to `high`, in percent.
float percent_at(ImVec2 mouse, ImVec2 low, ImVec2 high, float before) {
  const ImVec2 line{high.x - low.x, high.y - low.y};
  const float squared = line.x * line.x + line.y * line.y;
  if (squared < shortest * shortest) return before - 0.5f * ImGui::GetIO().MouseDelta.y;
  return 100 * ((mouse.x - low.x) * line.x + (mouse.y - low.y) * line.y) / squared;
}

// The ends of a spring, in window coordinates.
struct Line {
  ImVec2 a, b;
};

// The edges of the robot's skin, or its springs if it has none. Of large bodies only every n-th.
void draw_body(const ExplodedRobot& robot, const ViewportArea& area, const render::Camera& camera) {
  constexpr std::size_t most = 4000;  // lines
  const Robot& body = *robot.body;
  std::vector<std::optional<ImVec2>> places;
  for (const Vec3 mass : body.masses) places.push_back(seen_at(area, camera, render::Vector3(mass) + robot.offset));
  std::vector<std::pair<std::uint16_t, std::uint16_t>> edges;
  for (const Face& face : body.faces)  // the skin is closed: each edge is in two faces, in both directions
    for (const auto& [a, b] : {std::pair{face.a, face.b}, {face.b, face.c}, {face.c, face.a}})
      if (a < b) edges.emplace_back(a, b);
  if (edges.empty())
    for (const Spring& spring : body.springs) edges.emplace_back(spring.a, spring.b);
  const std::size_t step = 1 + edges.size() / most;
  for (std::size_t i = 0; i < edges.size(); i += step) {
    const auto &a = places[edges[i].first], &b = places[edges[i].second];
    if (a && b) ImGui::GetBackgroundDrawList()->AddLine(*a, *b, palette().bad, 0.06f * ImGui::GetFontSize());
  }
}

// A bar and two rings with an outline, so that they stand out from any background.
void draw_mark(const Line& line) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float text = ImGui::GetFontSize(), bar = 0.22f * text, ring = 0.42f * text, edge = 0.14f * text;
  const ImU32 mark = palette().mark, outline = palette().mark_outline;
  list.AddLine(line.a, line.b, outline, bar + 2 * edge);
  for (const ImVec2 at : {line.a, line.b}) list.AddCircle(at, ring, outline, 0, bar + 2 * edge);
  list.AddLine(line.a, line.b, mark, bar);
  for (const ImVec2 at : {line.a, line.b}) list.AddCircle(at, ring, mark, 0, bar);
}

std::string length_text(float meters) {
  return meters < 1 ? fmt::format("{:.3g} cm", 100 * meters) : fmt::format("{:.3g} m", meters);
}

std::vector<std::string> lines_of(const ExplodedRobot& robot) {
  const CulpritSpring& spring = *robot.spring;
  std::vector<std::string> lines{fmt::format("spring {} exploded first", spring.index)};
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
    if (area.holds(box.low) && area.holds(box.high) &&
        std::ranges::none_of(taken, [&](const Box& other) { return box.meets(other); }))
      return box;
  }
  return std::nullopt;
}

void write(const std::vector<std::string>& lines, const Box& place) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float text = ImGui::GetFontSize(), margin = 0.5f * text;
  list.AddRectFilled(place.low, place.high, palette().on_view, 0.35f * text);
  list.AddRect(place.low, place.high, palette().mark, 0.35f * text, 0, 0.08f * text);
  float y = place.low.y + margin / 2;
  for (std::size_t i = 0; i < lines.size(); ++i, y += 1.2f * text)
    list.AddText({place.low.x + margin, y}, i == 0 ? ImGui::GetColorU32(ImGuiCol_Text) : palette().faint,
                 lines[i].c_str());
}

}  // namespace

std::optional<ImVec2> draw_hit_mark(LiveScene& scene, const Hit& hit, const ViewportArea& area,
                                    const render::Camera& camera) {
  const auto index = scene.mouse().pointed_snapshot().robots->index_of(hit.robot);
  const DrawnScene& drawn = scene.mouse().pointed_drawn();
  if (!index || *index >= drawn.offsets().size()) return std::nullopt;
  const Robot& robot = *scene.mouse().pointed_snapshot().robots->robots[*index].robot;
  const std::span<const Vec3> positions = drawn.positions_of(*index);
  const auto place = [&](std::uint16_t mass) {
    return seen_at(area, camera, render::Vector3(positions[mass]) + drawn.offsets()[*index]);
  };
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float text = ImGui::GetFontSize(), thick = 0.16f * text, edge = 0.09f * text;
  const ImU32 mark = palette().warning, outline = palette().mark_outline;
  list.PushClipRect(area.low, area.high);
  if (hit.spring && *hit.spring < robot.springs.size()) {
    const auto a = place(robot.springs[*hit.spring].a), b = place(robot.springs[*hit.spring].b);
    if (a && b) {
      list.AddLine(*a, *b, outline, thick + 2 * edge);
      list.AddLine(*a, *b, mark, thick);
    }
  }
  const auto at = hit.mass < positions.size() ? place(hit.mass) : std::nullopt;
  if (at) {
    list.AddCircleFilled(*at, 0.3f * text + edge, outline);
    list.AddCircleFilled(*at, 0.3f * text, mark);
  }
  list.PopClipRect();
  return at;
}

void write_figures(const LiveScene& scene, const Hit& hit) {
  const HitDetails figures = scene.mouse().describe(hit);
  ImGui::TextUnformatted(figures.robot.c_str());
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  const std::string speed = figures.mass.speed ? fmt::format("{:.3f} m/s", *figures.mass.speed) : "...";
  ImGui::Text("mass %d: %s, %zu springs", static_cast<int>(hit.mass), speed.c_str(), figures.mass.springs);
  ImGui::Text("at %.3f, %.3f, %.3f m", static_cast<double>(figures.mass.position.x),
              static_cast<double>(figures.mass.position.y), static_cast<double>(figures.mass.position.z));
  if (figures.spring) {
    ImGui::Text("spring: %s", figures.spring->material_name.c_str());
    ImGui::Text("strain %+.2f %%, force %+.2f N", 100 * static_cast<double>(figures.spring->strain),
                static_cast<double>(figures.spring->force));
    ImGui::Text("%.4f m, at rest %.4f m", static_cast<double>(figures.spring->length),
                static_cast<double>(figures.spring->rest_length));
  }
  ImGui::PopStyleColor();
}

float figures_height() { return 6 * ImGui::GetTextLineHeightWithSpacing(); }

bool CutHandle::draw(LiveScene& scene, const ViewportArea& area, const render::Camera& camera, ViewSettings& view,
                     EventLog& log) const {
  const std::optional<std::size_t> robot =
      view.cut ? robot_with_handle(scene, [](const Robot&) { return true; }) : std::nullopt;
  if (!robot) return false;
  const auto frame = render::cut_frame(view.cut->axis, floats(scene.snapshot().robots->robots[*robot].robot->masses),
                                       floats(scene.drawn().positions_of(*robot)));
  if (!frame) return false;
  const auto at = [&](float place) {
    return on_screen(
        area, camera,
        scene.drawn().offsets()[*robot] + frame->center + (place - frame->axis.dot(frame->center)) * frame->axis);
  };
  const ImVec2 low = at(frame->low), high = at(frame->high), handle = at(frame->place_of(*view.cut));
  const float text = ImGui::GetFontSize(), radius = 0.55f * text;
  if (!handle_button("##cut", handle, radius, area)) return false;
  log.item("cut.handle");
  const bool active = ImGui::IsItemActive(), dragged = item_dragged(), marked = active || ImGui::IsItemHovered();
  if (!active) tooltip("drag: where each robot is cut");
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.PushClipRect(area.low, area.high);
  const ImU32 color = marked ? palette().accent : ImGui::GetColorU32(ImGuiCol_Text);
  list.AddLine(low, high, palette().on_view, 0.32f * text);
  list.AddLine(low, high, color, 0.1f * text);
  for (const ImVec2 end : {low, high}) list.AddCircleFilled(end, 0.16f * text, color);
  draw_handle(handle, radius, color);
  list.PopClipRect();
  end_handle_button();
  const ImVec2 moved = ImGui::GetIO().MouseDelta;
  if (!dragged || (moved.x == 0 && moved.y == 0)) return false;
  // A place in meters becomes a share of this robot, and of all others.
  view.cut->shift = 0;
  view.cut->percent = std::clamp(percent_at(ImGui::GetIO().MousePos, low, high, view.cut->percent), 0.0f, 100.0f);
  return true;
}

void TargetHandle::draw(LiveScene& scene, const ViewportArea& area, const render::Camera& camera, EventLog& log) const {
  if (scene.view().layout == Layout::cells) return;
  const std::optional<std::size_t> robot = robot_with_handle(scene, seeks_target);
  if (!robot) return;
  const render::Vector3 offset = scene.drawn().offsets()[*robot];
  const render::Vector3 target = offset + render::Vector3(scene.document().configuration.environment.target);
  const std::optional<ImVec2> at = seen_at(area, camera, target);
  const float text = ImGui::GetFontSize(), radius = 0.5f * text;
  if (!at || !handle_button("##target", *at, radius, area)) return;
  log.item("target.handle");
  const bool active = ImGui::IsItemActive(), ended = ImGui::IsItemDeactivated();
  if (!active) tooltip("drag: the target moves, level with itself; with Shift up and down");
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.PushClipRect(area.low, area.high);
  draw_handle(*at, radius, active || ImGui::IsItemHovered() ? palette().accent : palette().warning);
  list.PopClipRect();
  end_handle_button();
  const ImGuiIO& io = ImGui::GetIO();
  if ((active || ended) && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0))
    move_to_mouse(scene, area, camera, target, offset);
  if (ended) scene.end_edit();
}

void TargetHandle::move_to_mouse(LiveScene& scene, const ViewportArea& area, const render::Camera& camera,
                                 const render::Vector3& target, const render::Vector3& offset) {
  const ImGuiIO& io = ImGui::GetIO();
  const render::Ray ray = camera.ray(io.MousePos.x - area.low.x, io.MousePos.y - area.low.y,
                                     static_cast<int>(area.width()), static_cast<int>(area.height()));
  // The plane in which it moves: level, or upright and facing the camera.
  const render::Vector3 back = camera.eye - target;
  const render::Vector3 normal = io.KeyShift ? render::Vector3(back.x, back.y, 0) : render::Vector3(0, 0, 1);
  const float along = normal.dot(target - ray.origin) / normal.dot(ray.direction);
  // Beyond some distance, a ray that is nearly level with the plane meets it too far away.
  if (!(along > 0) || along > 4 * back.norm()) return;
  const render::Vector3 wanted = ray.origin + along * ray.direction - offset;
  Configuration configuration = scene.document().configuration;
  Vec3& moved = configuration.environment.target;
  if (io.KeyShift)
    moved.z = wanted.z;
  else
    moved = {wanted.x, wanted.y, moved.z};
  scene.parameters().set_configuration(configuration);
}

std::vector<Box> draw_explosion_mark(const ExplodedRobot& robot, std::span<const Box> covered, EventLog& log,
                                     const ViewportArea& area, const render::Camera& camera) {
  if (!robot.spring) return {};  // the body is not torn
  std::vector<Box> drawn;
  ImGui::GetBackgroundDrawList()->PushClipRect(area.low, area.high);
  draw_body(robot, area, camera);
  const auto place = [&](std::uint16_t mass) {
    return seen_at(area, camera, render::Vector3(robot.body->masses[mass]) + robot.offset);
  };
  const auto a = place(robot.spring->a), b = place(robot.spring->b);
  if (a && b) {
    const Line line{*a, *b};
    draw_mark(line);
    log.item("explosion.a", line.a, line.a);
    log.item("explosion.b", line.b, line.b);
    // The upper edge has the view's caption.
    std::vector<Box> taken(covered.begin(), covered.end());
    taken.push_back({area.low, {area.high.x, area.low.y + 2.2f * ImGui::GetFontSize()}});
    const float end = 0.7f * ImGui::GetFontSize();
    for (const ImVec2 at : {line.a, line.b}) drawn.push_back({{at.x - end, at.y - end}, {at.x + end, at.y + end}});
    taken.insert(taken.end(), drawn.begin(), drawn.end());
    const std::vector<std::string> lines = lines_of(robot);
    if (const std::optional<Box> box = place_of(lines, line, area, taken)) {
      write(lines, *box);
      log.item("explosion.text", box->low, box->high);
      drawn.push_back(*box);
    }
  }
  ImGui::GetBackgroundDrawList()->PopClipRect();
  return drawn;
}

}  // namespace mercury::window
