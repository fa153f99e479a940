// SPDX-License-Identifier: Apache-2.0
// The scene as a tree: its robots, and of each one its muscles, sensors, brain and attachments.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "app/window/panels/commands.h"
#include "app/window/panels/panel.h"
#include "app/window/panels/robot_list.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "mercury/brain.h"
#include "mercury/origin.h"

namespace mercury::window {

class TreePanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  // What is below a robot.
  struct Branch {
    std::string title;  // "muscles"; one without leaves says it all
    std::vector<std::string> leaves;
  };
  struct Body {
    std::shared_ptr<const Robot> robot;
    std::string kind;
    std::vector<Branch> branches;
  };
  // A line of the tree; the scene has no robot, a robot no branch, a branch no leaf.
  struct Row {
    const DocumentRobot* robot = nullptr;
    const Branch* branch = nullptr;
    const std::string* leaf = nullptr;
    bool can_open = false, is_open = false;
    std::string key() const;
  };
  const Body& body_of(const DocumentRobot& robot);
  std::vector<Branch> attachments_of(const SceneDocument& document, RobotId robot) const;
  void add_rows(const DocumentRobot& robot, std::vector<Row>& rows);
  void draw_row(PanelContext& context, const Row& row, int index);
  static std::string text_of(const PanelContext& context, const Row& row, std::size_t robots);

  std::string search_;
  std::set<std::string> open_{""};                      // keys of rows; the scene's is empty
  std::map<RobotId, Body> bodies_;                      // of robots that were looked into
  std::map<RobotId, std::vector<Branch>> attachments_;  // in this frame
  std::vector<RobotId> order_;
  RowSelection selection_;
};

std::string TreePanel::Row::key() const {
  if (!robot) return "";
  return fmt::format("{}/{}", robot->body.id, branch ? branch->title : "");
}

const TreePanel::Body& TreePanel::body_of(const DocumentRobot& robot) {
  Body& body = bodies_[robot.body.id];
  if (body.robot == robot.body.robot) return body;
  body = {.robot = robot.body.robot, .kind = kind_of(*robot.body.robot), .branches = {}};
  Branch muscles{.title = "muscles", .leaves = {}}, sensors{.title = "sensors", .leaves = {}};
  for (const Actuator& actuator : actuators_of(*body.robot)) muscles.leaves.push_back(label_of(actuator.name));
  for (const Sensor& sensor : body.robot->sensors) sensors.leaves.push_back(label_of(description_of(sensor.kind).name));
  for (Branch* branch : {&muscles, &sensors})
    if (!branch->leaves.empty()) body.branches.push_back(std::move(*branch));
  if (body.robot->brain) {
    const BrainLayout layout = brain_layout(*body.robot);
    body.branches.push_back(
        {.title = fmt::format("brain: {} neurons, {} weights", layout.neurons.size(), layout.weights), .leaves = {}});
  }
  return body;
}

std::vector<TreePanel::Branch> TreePanel::attachments_of(const SceneDocument& document, RobotId robot) const {
  Branch branch{.title = "attachments", .leaves = {}};
  for (const Attachment& one : document.attachments)
    if (one.spring.robot == robot)
      branch.leaves.push_back(fmt::format(
          "{} at mass {}", one.spring.kind == LivePerturbation::Kind::pin ? "pin" : "spring", one.spring.mass));
  if (branch.leaves.empty()) return {};
  return {std::move(branch)};
}

// The robot and what is open below it. With a search: the robot if it fits, and what fits below.
void TreePanel::add_rows(const DocumentRobot& robot, std::vector<Row>& rows) {
  const bool searching = !search_.empty();
  Row row{.robot = &robot, .branch = nullptr, .leaf = nullptr, .can_open = true};
  row.is_open = open_.contains(row.key());
  const std::size_t first = rows.size();
  bool fits = !searching || words_match(search_, robot.body.name);
  rows.push_back(row);
  if (searching || row.is_open) {
    const Body& body = body_of(robot);
    fits = fits || words_match(search_, body.kind);
    const auto add = [&](const Branch& branch) {
      Row below{.robot = &robot, .branch = &branch, .leaf = nullptr, .can_open = !branch.leaves.empty()};
      below.is_open = open_.contains(below.key());
      std::vector<Row> leaves;
      for (const std::string& leaf : branch.leaves)
        if (!searching ? below.is_open : words_match(search_, leaf) || words_match(search_, branch.title))
          leaves.push_back({.robot = &robot, .branch = &branch, .leaf = &leaf});
      const bool found = searching && (!leaves.empty() || words_match(search_, branch.title));
      if (!found && !row.is_open) return;
      below.is_open = below.is_open || !leaves.empty();
      fits = fits || found;
      if (found) rows[first].is_open = true;
      rows.push_back(below);
      rows.insert(rows.end(), leaves.begin(), leaves.end());
    };
    for (const Branch& branch : body.branches) add(branch);
    if (const auto found = attachments_.find(robot.body.id); found != attachments_.end())
      for (const Branch& branch : found->second) add(branch);
  }
  if (!fits) rows.resize(first);
}

void TreePanel::draw(PanelContext& context) {
  const SceneDocument& document = context.scene.document();
  std::erase_if(bodies_, [&](const auto& entry) { return !document.find(entry.first); });
  attachments_.clear();
  for (const Attachment& one : document.attachments)
    attachments_.try_emplace(one.spring.robot, attachments_of(document, one.spring.robot));
  ImGui::SetNextItemWidth(-1);
  text_field("##search", search_, "search robots, muscles, sensors");
  context.log.item("tree.search");
  std::vector<Row> rows{{.robot = nullptr, .branch = nullptr, .leaf = nullptr, .can_open = true}};
  rows.front().is_open = open_.contains("") || !search_.empty();
  order_.clear();
  for (const DocumentRobot& robot : document.robots) {
    const std::size_t before = rows.size();
    if (rows.front().is_open) add_rows(robot, rows);
    if (rows.size() > before) order_.push_back(robot.body.id);
  }
  if (ImGui::BeginChild("tree", {0, 0})) {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, 0});
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(rows.size()), 1.5f * ImGui::GetFontSize());
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
        draw_row(context, rows[static_cast<std::size_t>(i)], i);
    ImGui::PopStyleVar();
    if (rows.size() == 1 && !search_.empty()) note("Nothing fits.");
  }
  ImGui::EndChild();
}

std::string TreePanel::text_of(const PanelContext& context, const Row& row, std::size_t robots) {
  if (!row.robot)
    return fmt::format("{}: {} robot{}", name_of(context.scene.document().configuration.environment), robots,
                       robots == 1 ? "" : "s");
  if (row.leaf) return *row.leaf;
  if (row.branch)
    return row.branch->leaves.empty() ? row.branch->title
                                      : fmt::format("{}: {}", row.branch->title, row.branch->leaves.size());
  return row.robot->body.name;
}

void TreePanel::draw_row(PanelContext& context, const Row& row, int index) {
  LiveScene& scene = context.scene;
  const float text = ImGui::GetFontSize(), height = 1.5f * text;
  const float depth = row.leaf ? 3 : row.branch ? 2 : row.robot ? 1 : 0;
  const bool is_robot = row.robot && !row.branch;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float left = corner.x + 1.1f * text * depth, top = corner.y + (height - text) / 2;
  const float right = corner.x + ImGui::GetContentRegionAvail().x;
  ImGui::PushID(index);
  const bool clicked = ImGui::Selectable("##row", is_robot && scene.selection().contains(row.robot->body.id),
                                         ImGuiSelectableFlags_AllowDoubleClick, {0, height});
  if (index < 40) context.log.item(fmt::format("tree.{}", index));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (row.can_open) {
    const ImVec2 middle{left + 0.45f * text, corner.y + height / 2};
    const float r = 0.28f * text;
    if (row.is_open)
      list.AddTriangleFilled({middle.x - r, middle.y - 0.6f * r}, {middle.x + r, middle.y - 0.6f * r},
                             {middle.x, middle.y + 0.8f * r}, palette().faint);
    else
      list.AddTriangleFilled({middle.x - 0.6f * r, middle.y - r}, {middle.x + 0.8f * r, middle.y},
                             {middle.x - 0.6f * r, middle.y + r}, palette().faint);
  }
  const float begin = left + 1.1f * text;
  std::string figures;
  if (is_robot) figures = fmt::format("{} masses", row.robot->body.robot->masses.size());
  const float room = right - begin - ImGui::CalcTextSize(figures.c_str()).x - 0.8f * text;
  const bool strong = !row.robot || is_robot;
  list.AddText({begin, top}, strong ? ImGui::GetColorU32(ImGuiCol_Text) : palette().faint,
               shortened(text_of(context, row, scene.robots().count()), room).c_str());
  list.AddText({right - ImGui::CalcTextSize(figures.c_str()).x - 0.3f * text, top}, palette().faint, figures.c_str());
  if (is_robot) {
    const std::string kind = kind_of(*row.robot->body.robot);
    if (ImGui::IsItemHovered() && pointer_rests())
      tooltip(fmt::format("{}{}: click selects, double click frames", row.robot->body.name,
                          kind.empty() ? "" : fmt::format(", {} robot", kind))
                  .c_str());
    robot_menu_of_row(context, row.robot->body.id);
  }
  ImGui::PopID();
  if (!clicked) return;
  const bool on_arrow = ImGui::GetIO().MousePos.x < begin;
  if (row.can_open && (on_arrow || !is_robot)) {
    if (!open_.erase(row.key())) open_.insert(row.key());
  } else if (row.robot && ImGui::IsMouseDoubleClicked(0)) {
    frame_robots(context, {row.robot->body.id});
  } else if (row.robot) {
    selection_.click(scene, row.robot->body.id, order_);
  }
  context.log.write("tree", {{"row", text_of(context, row, scene.robots().count())}});
}

std::unique_ptr<Panel> make_tree_panel(PanelContext&) { return std::make_unique<TreePanel>(); }

}  // namespace mercury::window
