// SPDX-License-Identifier: Apache-2.0
// An evolution: its scores over time, champions, map of elites and the family of one individual.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include "app/live/scene_robots.h"
#include "app/window/panels/commands.h"
#include "app/window/panels/panel.h"
#include "app/window/panels/run_sections.h"
#include "app/window/toolkit/key_map.h"
#include "app/window/toolkit/plot.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "mercury/number_text.h"
#include "mercury/quantity.h"

namespace mercury::window {

class EvolutionPanel : public Panel {
 public:
  void draw(PanelContext& context) override;
  // Follows the run while the tab is closed, too.
  void work(PanelContext& context) override;

 private:
  void choose(PanelContext& context, std::uint64_t id);
  void draw_run(PanelContext& context, const RunView& view);
  void draw_champions(PanelContext& context, const RunView& view);
  void read_sort_order();
  void sort(const RunView& view);
  void draw_family_section(PanelContext& context, const RunView& view);

  void add_champion(PanelContext& context);

  std::filesystem::path evolved_;        // the run that the window evolves or has evolved, until its champion is there
  std::shared_ptr<const RunView> view_;  // of the last frame; shows whether there is a newer one
  std::optional<std::uint64_t> chosen_;  // whose family is shown; none = that of the best champion
  std::vector<std::size_t> order_;       // of the champions in the table
  int column_ = 1;                       // to sort by
  bool ascending_ = false;
};

namespace {

using Activity = LiveRun::Activity;

constexpr std::size_t most_scores = 8;  // columns of the table

void draw_problem(const std::string& problem) {
  if (problem.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, palette().bad);
  ImGui::TextWrapped("%s", problem.c_str());
  ImGui::PopStyleColor();
}

void draw_commands(PanelContext& context) {
  const float width = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  if (ImGui::Button("Open a run...", {width, 0})) choose_run(context);
  context.log.item("evolution.open");
  tooltip("open the folder of an evolution, running or finished; or drop it on the window");
  ImGui::SameLine();
  ImGui::BeginDisabled(context.scene.robots().count() == 0);
  if (primary_button("Evolve...", {width, 0})) evolve_selected(context);
  context.log.item("evolution.evolve");
  tooltip(
      with_keys(context.keys, "start an evolution from the selected robots, or all, in the background", Action::evolve)
          .c_str());
  ImGui::EndDisabled();
}

void draw_empty(PanelContext& context) {
  draw_problem(context.run.problem());
  note(
      "An evolution makes children of robots, tries them, and keeps the best, generation after generation. It "
      "begins with the selected robots, or all. You can also open the folder of an earlier one.");
  draw_commands(context);
}

// The window's own evolution, if another run is open.
void draw_other_run(PanelContext& context) {
  LiveRun& run = context.run;
  if (run.activity() == Activity::none || run.evolving() == run.folder()) return;
  note(fmt::format("{} evolves in the background", run.evolving().filename().string()).c_str());
  if (ImGui::Button("Stop it")) run.stop();
  ImGui::SameLine();
  if (ImGui::Button("Show it")) run.open(std::filesystem::path(run.evolving()));
}

// The button that stops or resumes the open run.
void draw_button(PanelContext& context, float width) {
  LiveRun& run = context.run;
  const std::shared_ptr<const RunView> view = run.view();
  const bool own = run.activity() != Activity::none && run.evolving() == run.folder();
  if (own) {
    ImGui::BeginDisabled(run.activity() != Activity::running);
    if (ImGui::Button(run.activity() == Activity::stopping ? "stopping" : "Stop", {width, 0})) run.stop();
    context.log.item("evolution.stop");
    ImGui::EndDisabled();
    tooltip("stop in an orderly way; the run can go on later");
  } else if (view && !view->is_over()) {
    ImGui::BeginDisabled(run.activity() != Activity::none || !run.problem().empty());
    if (ImGui::Button("Go on", {width, 0})) run.resume(context.scene.document().configuration.device);
    context.log.item("evolution.resume");
    ImGui::EndDisabled();
    tooltip("continue this run in the background, as if it had never stopped");
  }
}

// Goes on with a run that is finished.
void ask_for_generations(PanelContext& context, int generation) {
  const auto go_on = [&context, generation](const std::string& text) {
    const int more = parse_number<int>(text).value_or(0);
    if (more < 1 || more > 1'000'000)
      context.toasts.show(Tone::warning, "\"" + text + "\" is not accepted; give 1 to 1000000 generations");
    else
      context.run.resume(context.scene.document().configuration.device, generation + more);
  };
  context.dialogs.ask_text("Go on", "How many generations more?", "50", "Go on", go_on);
}

std::string progress_of(const LiveRun& run, const RunView& view) {
  if (view.generations.empty()) return run.activity() == Activity::none ? "no generation" : "first generation";
  return fmt::format("generation {} of {}", view.generation(), view.settings.generations);
}

void draw_progress(PanelContext& context, const RunView& view) {
  if (view.is_over() && context.run.activity() == Activity::none) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(fmt::format("finished: {} generations", view.generation()).c_str());
    ImGui::SameLine(ImGui::GetContentRegionAvail().x - 5 * ImGui::GetFontSize());
    if (ImGui::Button("More...", {5 * ImGui::GetFontSize(), 0})) ask_for_generations(context, view.generation());
    context.log.item("evolution.more");
    tooltip("add generations to this run");
    return;
  }
  const float button = 5 * ImGui::GetFontSize();
  const float width = ImGui::GetContentRegionAvail().x - button - ImGui::GetStyle().ItemSpacing.x;
  const float share = static_cast<float>(view.generation() + 1) / static_cast<float>(view.settings.generations + 1);
  ImGui::ProgressBar(share, {width, 0}, progress_of(context.run, view).c_str());
  ImGui::SameLine();
  draw_button(context, button);
}

// What the run is about, and how many robots were of no use.
void draw_summary(const RunView& view) {
  const EvolutionSettings& settings = view.settings;
  std::string objectives;
  for (const std::string& objective : settings.objectives)
    objectives += (objectives.empty() ? "" : "; ") + objective_label(objective);
  note(fmt::format("{}, {} robots, {:.3g} s in {}\n{}", settings.algorithm.name, settings.algorithm.population,
                   settings.trials.seconds, name_of(settings.configuration.environment), objectives)
           .c_str());
  tooltip(fmt::format("{}: {}", settings.algorithm.name, algorithm_named(settings.algorithm.name).help).c_str());
  std::size_t born = 0;
  FateCounts fates;
  for (const GenerationSummary& generation : view.generations) {
    born += generation.born;
    fates += generation.fates;
  }
  if (born == 0) return;
  std::string text = fmt::format("{} robots were tried", born), meaning;
  const auto add = [&](Fate fate, const char* what, const std::string& explanation) {
    if (fates[fate] == 0) return;
    text += fmt::format(", {} {}", fates[fate], what);
    meaning += fmt::format("{}{}: {}", meaning.empty() ? "" : "\n", what, explanation);
  };
  add(Fate::exploded, "exploded", "the simulation of the robot failed; a smaller time step may help");
  add(Fate::overstretched, "overstretched",
      fmt::format("a spring was stretched or compressed by more than {:.3g} % of its length",
                  100 * settings.trials.strain_limit));
  add(Fate::too_small, "too small", "fewer masses than robots of this run must have");
  add(Fate::undefined, "without a score", "the formula of the objective has no value for the robot");
  add(Fate::failed, "failed", "the robot could not be made or tried");
  note(text.c_str());
  if (!meaning.empty()) tooltip((meaning + "\nthey rank after all others").c_str());
}

void draw_scores(const RunView& view) {
  std::vector<double> number, best, median;
  for (const GenerationSummary& generation : view.generations) {
    number.push_back(generation.number);
    best.push_back(generation.scores.empty() ? NAN : generation.scores.front().highest);
    median.push_back(generation.scores.empty() ? NAN : generation.scores.front().median);
  }
  const PlotLine lines[] = {{"best", render::category_color(0), number, best},
                            {"median", render::category_color(1), number, median}};
  const float text = ImGui::GetFontSize();
  const std::string title = shortened("score: " + objective_label(view.settings.objectives.front()),
                                      ImGui::GetContentRegionAvail().x - 9 * text);
  plot("scores",
       {.title = title, .unit = "", .x_title = "generation", .x_unit = "", .height = 10 * text, .x_whole = true},
       lines);
  plot_legend(lines);
}

// The columns of the table besides robot and generation: scores, then quantities.
double number_of(const Individual& individual, std::size_t column, std::size_t objectives) {
  const auto& numbers = column < objectives ? individual.assessment.scores : individual.assessment.values;
  const std::size_t index = column < objectives ? column : column - objectives;
  return index < numbers.size() ? numbers[index] : worst_score;
}

// The quantities that stand in the table unless the user chooses others.
bool is_usual(std::string_view name, const std::vector<std::string>& objectives) {
  if (std::ranges::find(objectives, name) != objectives.end()) return false;
  const auto named = [&](const std::string& formula) { return formula.find(name) != std::string::npos; };
  return name == "distance" || name == "masses" || name == "strain" || std::ranges::any_of(objectives, named);
}

}  // namespace

// A run of the window that has come to its end brings its best robot into the scene.
void EvolutionPanel::add_champion(PanelContext& context) {
  const LiveRun& run = context.run;
  const std::shared_ptr<const RunView> view = run.view();
  if (run.activity() != Activity::none) evolved_ = run.evolving();
  if (run.activity() != Activity::none || evolved_.empty() || evolved_ != run.folder()) return;
  if (!view || !view->is_over()) return;  // it was stopped, or its last generation has not been read yet
  evolved_.clear();
  if (!view->best.empty()) add_individual(context, view->best.front());
}

void EvolutionPanel::work(PanelContext& context) {
  add_champion(context);
  const std::shared_ptr<const RunView> view = context.run.view();
  if (view == view_) return;
  if (!view || !view_ || view->folder != view_->folder || view->opening != view_->opening) chosen_.reset();
  view_ = view;
  if (!view) return;
  if (chosen_ || !view->best.empty())
    context.run.read_family(chosen_.value_or(view->best.empty() ? 0 : view->best.front()));
  context.log.write("run", {{"folder", view->folder.string()},
                            {"generation", view->generation()},
                            {"generations", view->settings.generations},
                            {"champions", view->champions.size()}});
}

void EvolutionPanel::choose(PanelContext& context, std::uint64_t id) {
  chosen_ = id;
  context.run.read_family(id);
}

void EvolutionPanel::draw(PanelContext& context) {
  LiveRun& run = context.run;
  if (!run.is_open()) {
    draw_empty(context);
    draw_other_run(context);
    return;
  }
  heading(shortened(run.name(), ImGui::GetContentRegionAvail().x, true).c_str());
  tooltip(run.folder().string().c_str());
  draw_problem(run.problem());
  if (const auto view = run.view()) {
    draw_run(context, *view);
  } else if (run.problem().empty()) {
    note(run.activity() == Activity::none ? "reading the run" : "the evolution is starting");
    draw_button(context, 5 * ImGui::GetFontSize());
  }
  draw_other_run(context);
  draw_commands(context);
}

void EvolutionPanel::draw_run(PanelContext& context, const RunView& view) {
  draw_progress(context, view);
  draw_summary(view);
  if (view.generations.empty()) {
    note("The run has no generation yet.");
    return;
  }
  draw_scores(view);
  if (!view.map.axes.empty()) {
    heading(fmt::format("Map of elites: {} of {} cells", view.map.filled(), view.map.cells.size()).c_str());
    if (const auto id = draw_elite_map(context, view.map, view.settings)) {
      choose(context, *id);
      add_individual(context, *id);
    }
  }
  draw_champions(context, view);
  draw_family_section(context, view);
}

void EvolutionPanel::draw_champions(PanelContext& context, const RunView& view) {
  heading(fmt::format("Champions: {}", view.champions.size()).c_str());
  const std::size_t objectives = std::min(most_scores, view.settings.objectives.size());
  const int columns = 2 + static_cast<int>(objectives + quantities().size());
  const float padding = 2 * ImGui::GetStyle().CellPadding.y;
  const float height =
      std::clamp(static_cast<float>(view.champions.size()), 1.0f, 3.6f) * (thumbnail_row_height() + padding) +
      ImGui::GetTextLineHeight() + padding + ImGui::GetStyle().ScrollbarSize + 2;
  const auto flags = ImGuiTableFlags_Sortable | ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY |
                     ImGuiTableFlags_ScrollX | ImGuiTableFlags_Resizable | ImGuiTableFlags_Hideable |
                     ImGuiTableFlags_BordersOuter | ImGuiTableFlags_NoSavedSettings;
  if (!ImGui::BeginTable("champions", columns, flags, {0, height})) return;
  ImGui::TableSetupScrollFreeze(1, 1);
  ImGui::TableSetupColumn(
      "robot",
      ImGuiTableColumnFlags_NoHide | ImGuiTableColumnFlags_PreferSortDescending | ImGuiTableColumnFlags_WidthFixed,
      5.6f * ImGui::GetFontSize());
  for (std::size_t i = 0; i < objectives; ++i)
    ImGui::TableSetupColumn(
        objectives == 1 ? "score" : objective_label(view.settings.objectives[i]).c_str(),
        ImGuiTableColumnFlags_PreferSortDescending | (i == 0 ? ImGuiTableColumnFlags_DefaultSort : 0));
  ImGui::TableSetupColumn("since", ImGuiTableColumnFlags_PreferSortDescending);
  for (const Quantity& quantity : quantities())
    ImGui::TableSetupColumn(
        title_of(quantity).c_str(),
        ImGuiTableColumnFlags_PreferSortDescending |
            (is_usual(quantity.name, view.settings.objectives) ? 0 : ImGuiTableColumnFlags_DefaultHide));
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (int column = 0; column < columns; ++column) {
    if (!ImGui::TableSetColumnIndex(column)) continue;
    ImGui::PushID(column);
    ImGui::TableHeader(ImGui::TableGetColumnName(column));
    context.log.item(std::string("champions.by.") + ImGui::TableGetColumnName(column));
    if (column == 1 + static_cast<int>(objectives)) tooltip("the first generation whose best it was");
    ImGui::PopID();
  }
  read_sort_order();
  sort(view);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(order_.size()));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const Champion& champion = view.champions[order_[static_cast<std::size_t>(i)]];
      const Individual& individual = champion.individual;
      const bool shown = context.run.family() && context.run.family()->line.front().individual.id == individual.id;
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      if (thumbnail_row(fmt::format("##{}", individual.id).c_str(), thumbnail_of_individual(context, individual.id),
                        std::to_string(individual.id), shown, ImGuiSelectableFlags_SpanAllColumns)) {
        choose(context, individual.id);
        add_individual(context, individual.id);
      }
      if (i < 20) context.log.item(fmt::format("champion.{}", i));
      if (ImGui::IsItemHovered() && pointer_rests())
        show_individual(context, individual, view.settings, "click: into the scene, and its family");
      for (std::size_t column = 0; column < objectives + quantities().size(); ++column) {
        if (column == objectives && ImGui::TableNextColumn()) thumbnail_row_cell(std::to_string(champion.since));
        if (ImGui::TableNextColumn()) thumbnail_row_cell(score_text(number_of(individual, column, objectives)));
      }
    }
  ImGui::EndTable();
}

void EvolutionPanel::read_sort_order() {
  ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs();
  if (!specs || specs->SpecsCount == 0) return;
  column_ = specs->Specs[0].ColumnIndex;
  ascending_ = specs->Specs[0].SortDirection == ImGuiSortDirection_Ascending;
}

void EvolutionPanel::sort(const RunView& view) {
  order_.resize(view.champions.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  const auto key = [&](std::size_t index) {
    const Champion& champion = view.champions[index];
    const auto column = static_cast<std::size_t>(column_);
    const std::size_t objectives = std::min(most_scores, view.settings.objectives.size());
    if (column == 0) return static_cast<double>(champion.individual.id);
    if (column == 1 + objectives) return static_cast<double>(champion.since);
    return number_of(champion.individual, column <= objectives ? column - 1 : column - 2, objectives);
  };
  std::ranges::stable_sort(
      order_, [&](std::size_t a, std::size_t b) { return ascending_ ? key(a) < key(b) : key(b) < key(a); });
}

void EvolutionPanel::draw_family_section(PanelContext& context, const RunView& view) {
  const Family* family = context.run.family();
  if (!family || family->line.empty()) {
    heading("Family");
    note("Click a champion to see its ancestors.");
    return;
  }
  const Individual& self = family->line.front().individual;
  heading(fmt::format("Family of robot {}", self.id).c_str());
  const auto crossings =
      std::ranges::count_if(family->line, [](const FamilyMember& member) { return member.other_parent.has_value(); });
  std::string text = fmt::format("{} ancestors since generation {}", family->line.size() - 1,
                                 family->line.back().individual.generation);
  if (crossings > 0) text += fmt::format(", {} crossover{}", crossings, crossings == 1 ? "" : "s");
  text += fmt::format("; {} {}", family->children, family->children == 1 ? "child" : "children");
  if (family->died) text += fmt::format("; gone after generation {}", *family->died);
  note(text.c_str());
  const float rest = ImGui::GetWindowHeight() - ImGui::GetCursorPosY() - 2.4f * ImGui::GetFrameHeightWithSpacing();
  std::uint64_t id = 0;
  if (draw_family(context, *family, view.settings, std::max(rest, 13 * ImGui::GetFontSize()), id)) choose(context, id);
}

std::unique_ptr<Panel> make_evolution_panel(PanelContext&) { return std::make_unique<EvolutionPanel>(); }

}  // namespace mercury::window
