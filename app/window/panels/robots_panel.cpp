// SPDX-License-Identifier: Apache-2.0
// The robots of the scene: a list, commands on the selected robots, and new random robots.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/live/background.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "app/options/generator_options.h"
#include "app/window/panels/commands.h"
#include "app/window/panels/panel.h"
#include "app/window/panels/robot_list.h"
#include "app/window/toolkit/key_map.h"
#include "app/window/toolkit/widgets.h"
#include "mercury/error.h"

namespace mercury::window {

// The part of the Robots panel that makes random robots: the settings of a generator (mercury/generator.h), and a
// button.
class RandomSection {
 public:
  void draw(PanelContext& context);
  // Height of its rows [pixels].
  float height(const PanelContext& context) const;

 private:
  bool advanced_ = false;  // show the advanced settings, too
};

class RobotsPanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  void draw_commands(PanelContext& context);
  void draw_strengths(PanelContext& context);

  RobotList list_;
  RandomSection random_;
};

namespace {

bool whole_number(const char* name, const char* help, int& value, int low, int high, PanelContext& context,
                  const std::string& item) {
  ImGui::PushID(name);
  row(name, help);
  const bool changed = ImGui::InputInt("##value", &value, 1, 10);
  context.log.item(item);
  ImGui::PopID();
  value = std::clamp(value, low, high);
  return changed;
}

// The controls of one parameter, by the kind of its value. Each returns true when the value changed.
struct Control {
  const GeneratorParameter& parameter;
  PanelContext& context;

  std::string name() const {
    const bool named = parameter.unit.empty() || std::holds_alternative<float>(parameter.initial) ||
                       std::holds_alternative<double>(parameter.initial);  // a slider shows the unit
    return label_of(parameter.name) + (named ? "" : fmt::format(" [{}]", unit_text(parameter.unit)));
  }
  const char* help() const { return parameter.help.c_str(); }
  std::string item() const { return "generate." + parameter.name; }
  double lowest() const { return parameter.accepts.lowest + (parameter.accepts.above_lowest ? 1e-6 : 0); }
  double highest() const { return parameter.usual_highest.value_or(std::min(parameter.accepts.highest, 1e6)); }

  bool operator()(std::int64_t& value) const {
    auto number = static_cast<int>(value);
    const bool changed = whole_number(name().c_str(), help(), number, static_cast<int>(lowest()),
                                      static_cast<int>(highest()), context, item());
    value = number;
    return changed;
  }
  template <class Number>
  requires std::is_floating_point_v<Number>
  bool operator()(Number& value) const {
    const bool percent = parameter.unit.empty() && parameter.accepts.highest == 1;
    const double scale = percent ? 100 : 1;
    const std::string format = percent ? "%.0f %%" : "%.3g " + parameter.unit;
    auto shown = static_cast<float>(scale * static_cast<double>(value));
    const auto default_value = static_cast<float>(scale * static_cast<double>(std::get<Number>(parameter.initial)));
    const bool changed =
        slider(name().c_str(), help(), shown, default_value,
               {static_cast<float>(scale * lowest()), static_cast<float>(scale * highest()), format.c_str()});
    context.log.item(item());
    if (changed) value = static_cast<Number>(std::clamp(static_cast<double>(shown) / scale, lowest(), highest()));
    return changed;
  }
  bool operator()(std::string& word) const {
    std::vector<const char*> words;
    for (const std::string& one : parameter.words) words.push_back(one.c_str());
    auto index = static_cast<int>(std::ranges::find(parameter.words, word) - parameter.words.begin());
    const bool changed = combo(name().c_str(), help(), index, words);
    context.log.item(item());
    if (changed) word = parameter.words.at(static_cast<std::size_t>(index));
    return changed;
  }
  bool operator()(std::vector<int>& numbers) const {
    row(name().c_str(), help());
    std::string text = option_text(numbers);
    const bool entered = text_field(("##" + parameter.name).c_str(), text);
    context.log.item(item());
    if (!entered) return false;
    try {
      const ParameterValue value = parameter_value_from(parameter, parameter.name, text);
      check(parameter, value);
      numbers = std::get<std::vector<int>>(value);
    } catch (const InputError& error) {
      context.toasts.show(Tone::warning, error.what());
      return false;
    }
    return true;
  }
  bool operator()(SizeRange& sizes) const {
    row(fmt::format("smallest [{}]", parameter.unit).c_str(), "along x, y and z");
    bool changed = ImGui::InputInt3("##smallest", sizes.smallest.data());
    row(fmt::format("largest [{}]", parameter.unit).c_str(), "along x, y and z");
    changed = ImGui::InputInt3("##largest", sizes.largest.data()) || changed;
    for (std::size_t i = 0; i < 3; ++i) {
      sizes.smallest[i] = std::clamp(sizes.smallest[i], static_cast<int>(lowest()), static_cast<int>(highest()));
      sizes.largest[i] = std::clamp(sizes.largest[i], sizes.smallest[i], static_cast<int>(highest()));
    }
    return changed;
  }
};

int rows_of(const GeneratorParameter& parameter) {
  return std::holds_alternative<SizeRange>(parameter.initial) ? 2 : 1;
}

const Generator& generator_in(const RandomRobots& generation) {
  const Generator* generator = find_generator(generation.kind);
  return generator ? *generator : generators().front();
}

void draw_work(PanelContext& context) {
  for (const Work& work : context.scene.work()) {
    ImGui::PushID(static_cast<int>(work.id));
    const float share = work.total > 0 ? static_cast<float>(work.done) / static_cast<float>(work.total) : 0;
    ImGui::ProgressBar(share, {ImGui::GetContentRegionAvail().x - 5 * ImGui::GetFontSize(), 0}, work.name.c_str());
    ImGui::SameLine();
    if (ImGui::Button("Cancel")) context.scene.cancel_work(work.id);
    ImGui::PopID();
  }
}

}  // namespace

void RandomSection::draw(PanelContext& context) {
  RandomRobots& generation = context.creation.generation;
  heading("Random robots");
  std::vector<const char*> kinds;
  std::string help;
  for (const Generator& generator : generators()) {
    kinds.push_back(generator.kind.c_str());
    help += (help.empty() ? "" : "\n") + generator.kind + ": " + generator.help;
  }
  auto kind = static_cast<int>(&generator_in(generation) - generators().data());
  if (combo("kind", help.c_str(), kind, kinds)) generation.kind = kinds[static_cast<std::size_t>(kind)];
  context.log.item("generate.kind");
  auto count = static_cast<int>(generation.count), seed = 0;
  whole_number("count", "how many robots", count, 1, 4096, context, "generate.count");
  generation.count = static_cast<std::size_t>(count);
  // Above what few change, so that a low window shows it, too.
  if (primary_button("Generate", {-1, 0})) generate_robots(context);
  context.log.item("generate");
  tooltip(with_keys(context.keys, "make the robots, and increment the seed", Action::new_random).c_str());
  seed = static_cast<int>(generation.seed);
  whole_number("seed", "the same seed gives the same robots", seed, 0, 1'000'000'000, context, "generate.seed");
  generation.seed = static_cast<std::uint64_t>(seed);
  ImGui::Checkbox("Replace", &context.creation.replace);
  context.log.item("generate.replace");
  tooltip("the new robots replace those in the scene; otherwise they are added");
  ImGui::SameLine();
  ImGui::Checkbox("Lively", &context.creation.lively);
  context.log.item("generate.lively");
  tooltip("makes ten times as many robots, tries each for four seconds, and keeps those that get farthest");
  ImGui::SameLine();
  ImGui::Checkbox("Details", &advanced_);
  context.log.item("generate.more");
  tooltip("show all settings of these robots");
  for (const GeneratorParameter& parameter : generator_in(generation).parameters) {
    if (parameter.advanced && !advanced_) continue;
    ParameterValue value = value_of(generation.values, parameter);
    if (std::visit(Control{parameter, context}, value)) generation.values[parameter.name] = value;
  }
}

float RandomSection::height(const PanelContext& context) const {
  int rows = 5;  // kind, count, seed, switches, button
  for (const GeneratorParameter& parameter : generator_in(context.creation.generation).parameters)
    if (advanced_ || !parameter.advanced) rows += rows_of(parameter);
  return static_cast<float>(rows) * ImGui::GetFrameHeightWithSpacing() + 2.2f * ImGui::GetFontSize();
}

void RobotsPanel::draw(PanelContext& context) {
  // What stands below the list: four rows of commands, and the random robots.
  const float below =
      4 * ImGui::GetFrameHeightWithSpacing() + ImGui::GetStyle().ItemSpacing.y + random_.height(context);
  list_.draw(context, ImGui::GetWindowHeight() - ImGui::GetCursorPosY() - below);
  draw_work(context);
  draw_commands(context);
  random_.draw(context);
}

void RobotsPanel::draw_strengths(PanelContext& context) {
  MutationRequest& mutation = context.creation.mutation;
  auto body = static_cast<float>(mutation.strength), muscles = static_cast<float>(mutation.muscles);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("mutation");
  tooltip("how much mutants differ; 1 = a little");
  ImGui::SameLine();
  const float room = ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x;
  ImGui::SetNextItemWidth(0.44f * room);
  if (number_slider("##body", body, 0, 10, "body %.1f")) mutation.strength = std::max(0.0, static_cast<double>(body));
  context.log.item("mutation.strength");
  tooltip("of their bodies: drag, or Ctrl-click to type");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(0.56f * room);
  if (number_slider("##muscles", muscles, 0, 10, "muscles %.1f"))
    mutation.muscles = std::max(0.0, static_cast<double>(muscles));
  context.log.item("mutation.muscles");
  tooltip("of how their muscles move: drag, or Ctrl-click to type");
}

void RobotsPanel::draw_commands(PanelContext& context) {
  LiveScene& scene = context.scene;
  const std::vector<RobotId> selection = scene.selection().robots();
  const auto explain = [&](const char* text, Action action) { tooltip(with_keys(context.keys, text, action).c_str()); };
  const float width = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3;
  if (ImGui::Button("Open...", {width, 0})) open_robots(context);
  context.log.item("open");
  explain("open robot files, or drop files and folders on the window", Action::open);
  ImGui::SameLine();
  ImGui::BeginDisabled(scene.robots().count() == 0);
  if (primary_button(selection.empty() ? "Save all..." : "Save...", {width, 0})) save_robots(context);
  context.log.item("save");
  explain("save the selected robots, or all if none is selected", Action::save);
  ImGui::SameLine();
  if (ImGui::Button("Clear", {width, 0})) scene.robots().clear();
  context.log.item("clear");
  tooltip("remove all robots; undo brings them back");
  ImGui::EndDisabled();
  ImGui::BeginDisabled(selection.empty());
  if (ImGui::Button("Duplicate", {width, 0})) scene.robots().duplicate(selection);
  context.log.item("duplicate");
  explain("add a copy of each selected robot", Action::duplicate);
  ImGui::SameLine();
  if (ImGui::Button("Mutate", {width, 0})) mutate_selected(context);
  context.log.item("mutate");
  explain("add a changed copy of each selected robot", Action::mutate);
  ImGui::SameLine();
  if (ImGui::Button("Remove", {width, 0})) scene.robots().remove(selection);
  context.log.item("remove");
  explain("remove the selected robots", Action::remove);
  const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  ImGui::BeginDisabled(selection.size() != 2);
  if (ImGui::Button("Breed from two", {half, 0})) breed_selected(context);
  ImGui::EndDisabled();
  context.log.item("breed");
  explain("add a child of the two selected robots", Action::breed);
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(scene.robots().count() == 0);
  if (primary_button("Evolve...", {half, 0})) evolve_selected(context);
  context.log.item("evolve");
  explain("let the selected robots evolve, or all, in the background", Action::evolve);
  ImGui::EndDisabled();
  draw_strengths(context);
}

std::unique_ptr<Panel> make_robots_panel(PanelContext&) { return std::make_unique<RobotsPanel>(); }

}  // namespace mercury::window
