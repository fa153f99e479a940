// SPDX-License-Identifier: Apache-2.0
// What a robot's brain feels and does: its senses, neurons and muscles as a graph with live values, and plots of them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "app/live/scene_comparison.h"
#include "app/live/scene_files.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_selection.h"
#include "app/window/panels/commands.h"
#include "app/window/panels/panel.h"
#include "app/window/toolkit/plot.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "mercury/brain.h"
#include "mercury/samples.h"

namespace mercury::window {

class BrainPanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  // A sense, a neuron or a muscle, by its number in all of them.
  struct Node {
    std::string name;
    ImVec2 at{0, 0};     // in the graph [0, 1]
    std::size_t column;  // of the graph
    std::string gates;   // for its tooltip, "gate input 2, keep forget 2" in a line of their own
  };
  struct Edge {
    std::size_t from, to;
    float weight;
    bool gates = false;  // `from` is the gate or the keep of `to`
  };
  // The graph of one brain.
  struct Graph {
    std::vector<Node> nodes;  // senses, then neurons, then driven actuators
    std::vector<Edge> edges;
    std::size_t senses = 0, neurons = 0, weights = 0;
    float largest = 0;  // |weight|
    std::vector<std::uint32_t> outputs;
  };
  static Graph graph_of(const Robot& robot);
  float value_of(const BrainActivity& now, std::size_t node) const;
  void follow(const Snapshot& snapshot, RobotId robot);
  void draw_graph(const BrainActivity& now, std::span<const float> held, EventLog& log);
  void draw_menu(PanelContext& context, const BrainActivity& now, std::span<const float> held);
  void draw_held(PanelContext& context, RobotId robot, std::span<const float> held);
  std::optional<std::size_t> neuron_of(std::size_t node) const;
  void draw_plots(PanelContext& context);

  std::shared_ptr<const Robot> body_;  // whose graph it is
  Graph graph_;
  std::set<std::size_t> plotted_;  // nodes
  std::size_t menu_of_ = 0;        // the neuron whose menu is open
  std::deque<std::pair<double, std::vector<float>>> history_;
  std::shared_ptr<const BrainHistory> recorded_;  // that history_ is from, or nothing
  PlotView view_;
};

namespace {

constexpr std::size_t max_history = 2000;  // samples
constexpr std::size_t max_edges = 800;     // in the graph; of larger brains, those of the node under the mouse
constexpr std::size_t max_plotted = 10;    // the number of category colors

// The first selected robot that has a brain, or the first of all.
std::optional<RobotId> thinking_robot(const LiveScene& scene) {
  const auto thinks = [&](RobotId id) {
    const DocumentRobot* robot = scene.document().find(id);
    return robot && robot->body.robot->brain;
  };
  for (const RobotId id : scene.selection().robots())
    if (thinks(id)) return id;
  for (const DocumentRobot& robot : scene.document().robots)
    if (robot.body.robot->brain) return robot.body.id;
  return std::nullopt;
}

// A column's nodes from top to bottom.
float height_of(std::size_t index, std::size_t count) {
  return (static_cast<float>(index) + 0.5f) / static_cast<float>(count);
}

}  // namespace

BrainPanel::Graph BrainPanel::graph_of(const Robot& robot) {
  const BrainLayout layout = brain_layout(robot);
  const std::vector<Actuator> actuators = actuators_of(robot);
  const Brain& brain = *robot.brain;
  const std::size_t copies = brain.per_actuator ? actuators.size() : 1;
  Graph graph{.senses = layout.senses.size(),
              .neurons = layout.neurons.size(),
              .weights = layout.weights,
              .outputs = layout.outputs};
  const std::size_t columns = brain.layers.size() + 2;
  const auto add = [&](const std::string& name, std::size_t column, std::size_t index, std::size_t count) {
    const float x = static_cast<float>(column) / static_cast<float>(columns - 1);
    graph.nodes.push_back({name, {x, height_of(index, count)}, column, ""});
  };
  for (std::size_t i = 0; i < layout.senses.size(); ++i) add(label_of(layout.senses[i]), 0, i, layout.senses.size());
  // Where a layer's neurons begin: all copies of a layer come before the next layer.
  std::vector<std::size_t> first;
  for (std::size_t l = 0, neuron = 0; l < brain.layers.size(); ++l) {
    first.push_back(neuron);
    const std::size_t count = brain.layers[l].neurons * copies;
    for (std::size_t i = 0; i < count; ++i) add(layout.neurons[neuron++], l + 1, i, count);
  }
  for (std::size_t i = 0; i < layout.driven.size(); ++i)
    add(label_of(actuators[layout.driven[i]].name), columns - 1, i, layout.driven.size());

  const std::size_t own_senses = layout.senses.size() / copies;
  const auto connect = [&](std::size_t l, std::size_t copy, const NeuronInput& input) {
    std::size_t from = copy * own_senses, width = own_senses;
    for (std::size_t k = 0; k < brain.layers.size(); ++k)
      if (brain.layers[k].name == input.from) {
        width = brain.layers[k].neurons;
        from = graph.senses + first[k] + copy * width;
      }
    const std::size_t to = graph.senses + first[l] + copy * brain.layers[l].neurons;
    for (const NeuronEdge& edge : input.edges) graph.edges.push_back({from + edge.from, to + edge.to, edge.weight});
    for (std::size_t i = 0; i < input.weights.size(); ++i)
      graph.edges.push_back({from + i % width, to + i / width, input.weights[i]});
  };
  for (std::size_t l = 0; l < brain.layers.size(); ++l)
    for (std::size_t copy = 0; copy < copies; ++copy)
      for (const NeuronInput& input : brain.layers[l].inputs) connect(l, copy, input);
  std::erase_if(graph.edges, [](const Edge& edge) { return edge.weight == 0; });
  for (const Edge& edge : graph.edges) graph.largest = std::max(graph.largest, std::abs(edge.weight));
  if (graph.largest == 0) graph.largest = 1;
  const auto gate = [&](std::size_t l, std::size_t copy, const std::string& name, const char* role) {
    for (std::size_t k = 0; k < brain.layers.size(); ++k)
      for (std::size_t i = 0; i < brain.layers[l].neurons && brain.layers[k].name == name; ++i) {
        const std::size_t within = copy * brain.layers[l].neurons + i, from = graph.senses + first[k] + within,
                          to = graph.senses + first[l] + within;
        graph.edges.push_back({from, to, graph.largest, true});
        std::string& gates = graph.nodes[to].gates;
        gates += fmt::format("{}{} {}", gates.empty() ? "\n" : ", ", role, graph.nodes[from].name);
      }
  };
  for (std::size_t l = 0; l < brain.layers.size(); ++l)
    for (std::size_t copy = 0; copy < copies; ++copy) {
      gate(l, copy, brain.layers[l].gate, "gate");
      gate(l, copy, brain.layers[l].keep_layer, "keep");
    }
  for (std::size_t i = 0; i < layout.outputs.size(); ++i)
    graph.edges.push_back({graph.senses + layout.outputs[i], graph.senses + graph.neurons + i, graph.largest});
  return graph;
}

float BrainPanel::value_of(const BrainActivity& now, std::size_t node) const {
  if (node < graph_.senses) return now.senses[node];
  if (node < graph_.senses + graph_.neurons) return now.neurons[node - graph_.senses];
  return std::clamp(now.neurons[graph_.outputs[node - graph_.senses - graph_.neurons]], -1.0f, 1.0f);
}

// Keeps the last values, from the moment the robot was chosen or time went back; of a recording, all.
void BrainPanel::follow(const Snapshot& snapshot, RobotId robot) {
  const std::shared_ptr<const Robot>& body = snapshot.robots->robots[*snapshot.robots->index_of(robot)].robot;
  if (body != body_) {
    body_ = body;
    graph_ = graph_of(*body);
    history_.clear();
    recorded_.reset();
    plotted_.clear();
    for (std::size_t i = 0; i < std::min<std::size_t>(graph_.outputs.size(), 3); ++i)
      plotted_.insert(graph_.senses + graph_.neurons + i);
  }
  const auto add = [&](double time, const BrainActivity& activity) {
    std::vector<float> values;
    for (std::size_t i = 0; i < graph_.nodes.size(); ++i) values.push_back(value_of(activity, i));
    history_.emplace_back(time, std::move(values));
  };
  if (const auto& recorded = snapshot.brain_history) {
    if (recorded == recorded_) return;
    recorded_ = recorded;
    history_.clear();
    for (std::size_t i = 0; i < recorded->times.size(); ++i) add(recorded->times[i], recorded->activity[i]);
    return;
  }
  recorded_.reset();
  while (!history_.empty() && history_.back().first > snapshot.time) history_.pop_back();
  if (!history_.empty() && history_.back().first == snapshot.time) return;
  add(snapshot.time, *snapshot.brain);
  if (history_.size() > max_history) history_.pop_front();
}

void BrainPanel::draw(PanelContext& context) {
  const std::optional<RobotId> robot = thinking_robot(context.scene);
  if (!robot) {
    note("No robot of the scene has a brain. sample:hunter has one: it seeks the target.");
    static const bool has_sample = std::ranges::count(sample_names(), "sample:hunter") > 0;
    if (has_sample && ImGui::Button("Open a hunter")) context.scene.files().open({sample_or_path("sample:hunter")});
    context.log.item("brain.sample");
    return;
  }
  context.scene.watch_brain(*robot);
  const Snapshot& snapshot = context.scene.snapshot();
  heading(name_of_robot(context.scene, *robot).c_str());
  if (!snapshot.brain || snapshot.brain->robot != *robot || !snapshot.robots->index_of(*robot)) {
    note(snapshot.timeline.recording ? "This recording has no senses and neurons: mercury run --brains records them."
                                     : "...");
    return;
  }
  follow(snapshot, *robot);
  note(fmt::format("thinks every {:.3g} ms: {} senses, {} neurons, {} weights",
                   1000 * static_cast<double>(body_->brain->period), graph_.senses, graph_.neurons, graph_.weights)
           .c_str());
  // As it is at the moment shown.
  const LiveRobot live = snapshot.robots->robots[*snapshot.robots->index_of(*robot)];
  const std::span<const float> held = held_neurons(live);
  draw_graph(*snapshot.brain, held, context.log);
  draw_menu(context, *snapshot.brain, held);
  draw_held(context, *robot, held);
  draw_plots(context);
}

std::optional<std::size_t> BrainPanel::neuron_of(std::size_t node) const {
  if (node < graph_.senses || node >= graph_.senses + graph_.neurons) return std::nullopt;
  return node - graph_.senses;
}

void BrainPanel::draw_graph(const BrainActivity& now, std::span<const float> held, EventLog& log) {
  const float text = ImGui::GetFontSize(), width = ImGui::GetContentRegionAvail().x;
  std::vector<std::size_t> counts(graph_.nodes.empty() ? 1 : graph_.nodes.back().column + 1);
  for (const Node& node : graph_.nodes) ++counts[node.column];
  const auto most = static_cast<float>(std::ranges::max(counts));
  const float height = std::clamp(1.3f * text * most, 10 * text, 24 * text);
  const float radius = std::clamp(0.4f * height / most, 0.12f * text, 0.42f * text), margin = 0.6f * text;
  const ImVec2 low = ImGui::GetCursorScreenPos();
  // The names of senses stand beside them, if there is room for their lines.
  float names = 0;
  const bool named = static_cast<float>(graph_.senses) * text <= height;
  for (std::size_t i = 0; named && i < graph_.senses; ++i)
    names = std::max(names, ImGui::CalcTextSize(graph_.nodes[i].name.c_str()).x + 0.4f * text);
  names = std::min(names, 0.45f * width);
  const auto place = [&](const Node& node) {
    return ImVec2(low.x + names + margin + node.at.x * (width - names - 2 * margin), low.y + node.at.y * height);
  };
  ImGui::InvisibleButton("graph", {width, height});
  log.item("brain.graph");
  const bool over = ImGui::IsItemHovered(), clicked = ImGui::IsItemClicked();
  std::optional<std::size_t> near;
  float nearest = 1.5f * text * 1.5f * text;
  for (std::size_t i = 0; over && i < graph_.nodes.size(); ++i) {
    const ImVec2 at = place(graph_.nodes[i]), mouse = ImGui::GetIO().MousePos;
    const float squared = (at.x - mouse.x) * (at.x - mouse.x) + (at.y - mouse.y) * (at.y - mouse.y);
    if (squared < nearest) nearest = squared, near = i;
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  // Lines carry what flows: weight times the value at its beginning.
  for (const Edge& edge : graph_.edges) {
    const bool marked = near && (edge.from == *near || edge.to == *near);
    if (!marked && (near || graph_.edges.size() > max_edges)) continue;
    // By the square root, so that small weights beside a large one are seen.
    const float share = std::copysign(std::sqrt(std::abs(edge.weight / graph_.largest)), edge.weight);
    const float flow = share * std::tanh(value_of(now, edge.from));
    const float opacity = std::clamp(0.15f + 0.8f * std::abs(flow), 0.0f, 1.0f);
    const ImVec2 from = place(graph_.nodes[edge.from]), to = place(graph_.nodes[edge.to]);
    if (edge.gates) {  // past the neurons between them, which stand at the same height
      const float rise = std::min(0.5f * std::abs(to.x - from.x), 3 * text);
      list.AddBezierQuadratic(from, {(from.x + to.x) / 2, (from.y + to.y) / 2 - rise}, to,
                              ImGui::GetColorU32(ImGuiCol_TextDisabled, opacity), 0.1f * text);
      continue;
    }
    list.AddLine(from, to, packed(render::color_at(render::Colormap::diverging, flow, -1, 1), opacity),
                 (0.05f + 0.1f * std::abs(share)) * text);
  }
  for (std::size_t i = 0; i < graph_.nodes.size(); ++i) {
    const ImVec2 at = place(graph_.nodes[i]);
    const float value = value_of(now, i);
    list.AddCircleFilled(at, radius, packed(render::color_at(render::Colormap::diverging, std::tanh(value), -1, 1)));
    if (named && i < graph_.senses)
      list.AddText({low.x, at.y - text / 2}, palette().faint,
                   shortened(graph_.nodes[i].name, names - 0.4f * text).c_str());
    if (plotted_.contains(i)) list.AddCircle(at, radius + 0.12f * text, palette().accent, 0, 0.12f * text);
    const std::optional<std::size_t> neuron = neuron_of(i);
    if (!neuron) continue;
    if (*neuron < 8)
      log.item(fmt::format("brain.neuron.{}", *neuron), {at.x - radius, at.y - radius}, {at.x + radius, at.y + radius});
    if (*neuron >= held.size() || std::isnan(held[*neuron])) continue;
    const float arm = 0.7f * radius + 0.15f * text;  // a cross over what is held
    list.AddLine({at.x - arm, at.y - arm}, {at.x + arm, at.y + arm}, ImGui::GetColorU32(ImGuiCol_Text), 0.14f * text);
    list.AddLine({at.x - arm, at.y + arm}, {at.x + arm, at.y - arm}, ImGui::GetColorU32(ImGuiCol_Text), 0.14f * text);
  }
  if (near) {
    const Node& node = graph_.nodes[*near];
    const std::optional<std::size_t> neuron = neuron_of(*near);
    tooltip_now(fmt::format("{}: {:.3g}{}\nclick: plot it{}", node.name, value_of(now, *near), node.gates,
                            neuron ? "\nright-click: silence or hold it" : ""));
    if (neuron && ImGui::IsMouseClicked(1)) {
      menu_of_ = *neuron;
      ImGui::OpenPopup("neuron");
    }
    if (clicked && !plotted_.erase(*near) && plotted_.size() < max_plotted) plotted_.insert(*near);
    if (clicked) log.write("brain", {{"node", node.name}, {"plotted", plotted_.size()}});
  }
  const bool has_gates = std::ranges::count(graph_.edges, true, &Edge::gates) > 0;
  note(has_gates
           ? "senses on the left, layers, muscles on the right; blue is negative, red positive, gray arcs are gates"
           : "senses on the left, layers, muscles on the right; blue is negative, red positive");
}

// Of the neuron that was right-clicked.
void BrainPanel::draw_menu(PanelContext& context, const BrainActivity& now, std::span<const float> held) {
  if (menu_of_ >= graph_.neurons || !ImGui::BeginPopup("neuron")) return;
  const std::string& name = graph_.nodes[graph_.senses + menu_of_].name;
  const bool is_held = menu_of_ < held.size() && !std::isnan(held[menu_of_]);
  std::optional<std::optional<float>> wanted;
  heading(name.c_str());
  if (ImGui::MenuItem("Silence", nullptr, is_held && held[menu_of_] == 0)) wanted = 0.0f;
  context.log.item("brain.silence");
  tooltip("its value is 0, as if it were cut out");
  float value = is_held ? held[menu_of_] : now.neurons[menu_of_];
  ImGui::SetNextItemWidth(10 * ImGui::GetFontSize());
  if (number_slider("##hold", value, -1, 1, "held at %+.2f")) wanted = value;
  context.log.item("brain.hold");
  ImGui::BeginDisabled(!is_held);
  if (ImGui::MenuItem("Release")) wanted.emplace(std::nullopt);
  ImGui::EndDisabled();
  context.log.item("brain.release");
  if (wanted) {
    context.scene.parameters().clamp_neuron(now.robot, menu_of_, *wanted);
    context.log.write("clamp", {{"neuron", name}, {"value", *wanted ? nlohmann::json(**wanted) : nlohmann::json()}});
  }
  // A whole drag of the slider is one undo step.
  if (ImGui::IsMouseReleased(0)) context.scene.end_edit();
  ImGui::EndPopup();
}

void BrainPanel::draw_held(PanelContext& context, RobotId robot, std::span<const float> held) {
  const auto count = std::ranges::count_if(held, [](float value) { return !std::isnan(value); });
  if (count == 0) return;
  note(fmt::format("{} held by hand", count == 1 ? "1 neuron is" : fmt::format("{} neurons are", count)).c_str());
  if (ImGui::Button("Release all")) context.scene.parameters().release_neurons(robot);
  context.log.item("brain.release_all");
  ImGui::SameLine();
  if (ImGui::Button("Compare")) context.scene.comparison().show_ghosts({robot});
  context.log.item("brain.compare");
  tooltip("a ghost shows the robot with its whole brain, from now on");
}

void BrainPanel::draw_plots(PanelContext& context) {
  if (plotted_.empty()) return;
  std::vector<double> times;
  for (const auto& [time, values] : history_) times.push_back(time);
  std::deque<std::vector<double>> columns;
  std::vector<PlotLine> lines;
  for (const std::size_t node : plotted_) {
    columns.emplace_back();
    for (const auto& [time, values] : history_) columns.back().push_back(static_cast<double>(values[node]));
    lines.push_back(
        {graph_.nodes[node].name, render::category_color(static_cast<int>(lines.size())), times, columns.back()});
  }
  view_.begin_frame();
  view_.mark = context.scene.drawn().scene().time;
  plot("brain", {.title = "activity", .height = 9 * ImGui::GetFontSize()}, lines, &view_);
  context.log.item("brain.plot");
  plot_legend(lines);
}

std::unique_ptr<Panel> make_brain_panel(PanelContext&) { return std::make_unique<BrainPanel>(); }

}  // namespace mercury::window
