// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/commands.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>
#include <set>

#include "app/base/progress.h"
#include "app/live/robot_saving.h"
#include "app/live/scene_files.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "mercury/error.h"
#include "mercury/generator.h"
#include "mercury/origin.h"
#include "mercury/quantity.h"

namespace mercury::window {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string>& names_of_gene_sets() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> made;
    for (const Genes genes : all_gene_sets()) made.push_back(name_of(genes));
    return made;
  }();
  return names;
}

int index_in(const std::vector<const char*>& words, const std::string& word) {
  const auto found = std::ranges::find(words, word);
  return found == words.end() ? 0 : static_cast<int>(found - words.begin());
}

// A row for one parameter of a table.
template <class Struct>
void parameter_row(const char* name, const char* label, Struct& values, EventLog& log) {
  for_each_parameter(values, [&]<class Value>(const auto& parameter, Value& value) {
    if (parameter.name != name) return;
    ImGui::PushID(name);
    row(label, std::string(parameter.help).c_str());
    if constexpr (std::is_same_v<Value, double>) {
      ImGui::InputDouble("##value", &value, 1, 10, fmt::format("%.3g {}", parameter.unit).c_str());
    } else if constexpr (!std::is_same_v<Value, bool>) {
      int shown = static_cast<int>(value);
      ImGui::InputInt("##value", &shown, 1, 10);
      value = static_cast<Value>(std::clamp(shown, 1, 1'000'000));
    }
    log.item(std::string("evolve.") + name);
    ImGui::PopID();
  });
}

// What robots are often evolved for. Whoever wants something else writes a formula.
struct Aim {
  const char *words, *formula;
};
constexpr Aim aims[] = {
    {"to get far", "distance"},
    {"to be fast for long", "cruise_speed"},
    {"to be fast for its length", "cruise_lengths"},
    {"to get far with little work", "cruise_lengths * min(efficiency, 0.01)"},
    {"to get far along x", "speed_x"},
    {"to reach the target", "target_approach"},
};

// The words of a help text that say most: those before its colon, or after it if only an abbreviation is before it.
std::string_view gist_of(std::string_view help) {
  constexpr std::size_t abbreviation = 12;  // letters
  const std::size_t colon = std::min(help.find(':'), help.size());
  if (colon >= abbreviation || colon == help.size()) return help.substr(0, colon);
  help = help.substr(colon + 2);
  return help.substr(0, help.find(';'));
}

class EvolveForm {
 public:
  EvolveForm(PanelContext& context, std::vector<LiveRobot> founders);

  // Returns whether the values can be used.
  bool draw(EventLog& log);
  void accept();

 private:
  void draw_objective(EventLog& log);
  std::string duration_of(double trials, const EvolveRequest& request) const;
  EvolveRequest request() const;
  std::string problem_of(const EvolveRequest& request) const;
  std::string problem_of_founders(const std::string& genes) const;

  PanelContext& context_;
  std::vector<LiveRobot> founders_;
  EvolveRequest values_;  // but the folder
  std::string name_, folder_;
  bool own_formula_ = false;
  std::vector<std::string> checked_;  // the request that problem_ is about, as words
  std::string problem_ = "?";
};

EvolveForm::EvolveForm(PanelContext& context, std::vector<LiveRobot> founders)
    : context_(context), founders_(std::move(founders)), values_(context.evolve) {
  const fs::path folder =
      context.preferences.save_folder.empty() ? fs::current_path() : fs::path(context.preferences.save_folder);
  folder_ = folder.string();
  name_ = unused_name(folder / file_name_of(founders_.front().name + "-evolution")).filename().string();
  if (!problem_of_founders(values_.genes).empty()) values_.genes = "muscles";
  own_formula_ =
      std::ranges::none_of(aims, [&](const Aim& aim) { return values_.settings.objectives.front() == aim.formula; });
}

EvolveRequest EvolveForm::request() const {
  EvolveRequest request = values_;
  request.settings.configuration = context_.scene.document().configuration;
  request.folder = name_.empty() ? fs::path() : (fs::path(folder_) / name_).lexically_normal();
  return request;
}

std::string EvolveForm::problem_of_founders(const std::string& genes) const {
  const auto has_brain = [](const LiveRobot& robot) { return robot.robot->brain.has_value(); };
  if (genes_named(genes) == Genes::brain && !std::ranges::all_of(founders_, has_brain))
    return "a robot has no brain: only brains together with muscles or bodies can evolve";
  if (!contains(genes_named(genes), Genes::body)) return {};
  std::set<std::string> kinds;
  for (const LiveRobot& robot : founders_) kinds.insert(kind_of(*robot.robot));
  if (kinds.size() > 1) return "the robots are of several kinds: only their muscles and brains can evolve together";
  if (!find_generator(*kinds.begin()))
    return "nothing is known of how these bodies were made: only their muscles and brains can evolve";
  return {};
}

// Asks the library, which knows its rules best.
std::string EvolveForm::problem_of(const EvolveRequest& request) const {
  std::error_code unknown;
  if (request.folder.empty()) return "give the run a name";
  if (fs::exists(request.folder, unknown) &&
      !(fs::is_directory(request.folder, unknown) && fs::is_empty(request.folder, unknown)))
    return request.folder.filename().string() + " exists already; give another name";
  if (std::string problem = problem_of_founders(request.genes); !problem.empty()) return problem;
  EvolutionSettings settings = request.settings;
  if (algorithm_named(settings.algorithm.name).of_behavior)
    settings.algorithm.axes = {{.quantity = std::string(quantities().front().name)}};
  try {
    validate(settings);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

void EvolveForm::draw_objective(EventLog& log) {
  std::string& formula = values_.settings.objectives.front();
  std::vector<const char*> words;
  for (const Aim& aim : aims) words.push_back(aim.words);
  words.push_back("a formula");
  const auto custom = static_cast<int>(std::size(aims));
  int chosen =
      static_cast<int>(std::ranges::find_if(aims, [&](const Aim& aim) { return formula == aim.formula; }) - aims);
  if (own_formula_) chosen = custom;
  if (combo("objective", "what counts: the best in it have children", chosen, words) && chosen < custom)
    formula = aims[chosen].formula;
  log.item("evolve.aim");
  own_formula_ = chosen == custom;
  if (!own_formula_) return;
  row("formula", "of quantities; more is better, as in \"distance - 0.1 * strain\"");
  text_field("##objective", formula);
  log.item("evolve.objective");
}

// How long it takes at the speed with which this scene is simulated; empty while that is unknown.
std::string EvolveForm::duration_of(double trials, const EvolveRequest& request) const {
  const double rate = context_.scene.snapshot().springs_per_second;
  if (!(rate > 0)) return "";
  double springs = 0;
  for (const LiveRobot& robot : founders_) springs += static_cast<double>(robot.robot->springs.size());
  springs /= static_cast<double>(founders_.size());
  const double steps = request.settings.trials.seconds / request.settings.configuration.dt;
  const double seconds = trials * steps * springs / rate;
  const double unit = seconds < 90 ? 1 : 60;  // an estimate
  return "; about " + duration_text(unit * std::max(1.0, std::round(seconds / unit))) +
         " at the current speed of the scene";
}

bool EvolveForm::draw(EventLog& log) {
  row("name", "of the new folder");
  text_field("##name", name_);
  log.item("evolve.name");
  row("folder", "in which the new one is made");
  text_field("##folder", folder_);
  log.item("evolve.folder");
  std::vector<const char*> names, titles, all_genes;
  std::deque<std::string> texts;
  for (const std::string& genes : names_of_gene_sets()) all_genes.push_back(genes.c_str());
  std::string help;
  for (const AlgorithmDescription& algorithm : algorithms()) {
    names.push_back(algorithm.name.data());
    texts.push_back(shortened(fmt::format("{}   {}", algorithm.name, gist_of(algorithm.help)),
                              0.5f * ImGui::GetContentRegionAvail().x));
    titles.push_back(texts.back().c_str());
    help += fmt::format("{}{}: {}", help.empty() ? "" : "\n", algorithm.name, algorithm.help);
  }
  int algorithm = index_in(names, values_.settings.algorithm.name), genes = index_in(all_genes, values_.genes);
  combo("algorithm", help.c_str(), algorithm, titles);
  log.item("evolve.algorithm");
  values_.settings.algorithm.name = names[static_cast<std::size_t>(algorithm)];
  note(std::string(algorithms()[static_cast<std::size_t>(algorithm)].help).c_str());
  combo("what changes",
        "the bodies, how the muscles move (amplitude, frequency, phase), both of that, or the weights of brains", genes,
        all_genes);
  log.item("evolve.genes");
  values_.genes = all_genes[static_cast<std::size_t>(genes)];
  draw_objective(log);
  parameter_row("population", "population [robots]", values_.settings.algorithm, log);
  parameter_row("generations", "generations", values_.settings, log);
  parameter_row("seconds", "length of a trial", values_.settings.trials, log);
  parameter_row("trials", "trials per robot", values_.settings.trials, log);
  const EvolveRequest now = request();
  if (std::vector<std::string> words = evolve_arguments(now, {}); problem_ == "?" || words != checked_) {
    problem_ = problem_of(now);
    checked_ = std::move(words);
  }
  const auto trials = static_cast<double>(now.settings.algorithm.population) * (now.settings.generations + 1.0) *
                      now.settings.trials.trials;
  if (problem_.empty()) {
    note(fmt::format("{:.0f} trials of {:.3g} s, with the parameters of this scene{}", trials,
                     now.settings.trials.seconds, duration_of(trials, now))
             .c_str());
  } else {
    ImGui::PushStyleColor(ImGuiCol_Text, palette().bad);
    ImGui::TextWrapped("%s", problem_.c_str());
    ImGui::PopStyleColor();
  }
  return problem_.empty();
}

void EvolveForm::accept() {
  const EvolveRequest chosen = request();
  context_.evolve = values_;
  context_.preferences.save_folder = folder_;
  context_.preferences.panels = true;
  context_.preferences.left_panel = "Evolution";
  context_.log.write("evolving", {{"folder", chosen.folder.string()}, {"robots", founders_.size()}});
  context_.run.evolve(chosen, founders_);
}

std::optional<fs::path> run_of(const fs::path& path) {
  if (is_run_folder(path)) return path;
  if (path.filename() == "run.toml" && is_run_folder(path.parent_path())) return path.parent_path();
  return std::nullopt;
}

void show_panel(PanelContext& context) {
  context.preferences.panels = true;
  context.preferences.left_panel = "Evolution";
}

}  // namespace

void ask_evolve(PanelContext& context) {
  std::vector<LiveRobot> founders;
  for (const RobotId id : selected_or_all(context.scene))
    if (const DocumentRobot* robot = context.scene.document().find(id)) founders.push_back(robot->body);
  if (founders.empty()) return;
  const std::string what = founders.size() == 1 ? founders.front().name : fmt::format("{} robots", founders.size());
  const auto form = std::make_shared<EvolveForm>(context, std::move(founders));
  context.dialogs.ask({.title = "Evolve " + what,
                       .text = "Their children compete, generation after generation, in the background. The folder "
                               "keeps all of them.",
                       .button = "Evolve",
                       .on_accept = [form] { form->accept(); },
                       .form = [form](EventLog& log) { return form->draw(log); }});
}

void open_paths(PanelContext& context, const std::vector<fs::path>& paths) {
  std::vector<fs::path> robots;
  std::optional<fs::path> run;
  for (const fs::path& path : paths) {
    const std::optional<fs::path> found = run_of(path);
    if (!found)
      robots.push_back(path);
    else if (run)
      context.toasts.show(Tone::warning, found->string() + ": the window shows one run at a time");
    else
      run = found;
  }
  if (run) open_run(context, *run);
  context.scene.files().open(robots);
}

void open_run(PanelContext& context, const fs::path& folder) {
  show_panel(context);
  context.run.open(folder, [&context](std::vector<Robot> robots, const RunView& view) {
    context.scene.robots().show(std::move(robots), view.settings.configuration, "open " + context.run.name());
  });
}

void open_first_run(PanelContext& context, const fs::path& folder) {
  show_panel(context);
  context.run.open(folder, [&context](std::vector<Robot> robots, const RunView&) {
    context.scene.robots().add(std::move(robots), false);
  });
}

void choose_run(PanelContext& context) {
  context.dialogs.ask_files({.kind = FileRequest::Kind::folder,
                             .title = "Open a run: the folder of an evolution",
                             .button = "Open",
                             .extensions = {".toml"},
                             .folder = context.preferences.open_folder,
                             .name = "",
                             .formats = {}},
                            [&context](const FileChoice& answer) {
                              const fs::path folder = answer.paths.front();
                              context.preferences.open_folder = folder.parent_path().string();
                              if (is_run_folder(folder))
                                open_run(context, folder);
                              else
                                context.toasts.show(Tone::error, folder.string() + ": is no run, it has no run.toml");
                            });
}

void add_individual(PanelContext& context, std::uint64_t id) {
  context.run.grow(id, [&context](const Robot& robot) {
    const auto& robots = context.scene.document().robots;
    const auto same = std::ranges::find_if(robots, [&](const DocumentRobot& other) {
      return other.body.name == robot.name && *other.body.robot == robot;
    });
    if (same == robots.end()) {
      const std::vector<RobotId> added = context.scene.robots().add({robot}, false);
      if (!added.empty()) context.scene.selection().select(added.front());
      return;
    }
    context.scene.selection().select(same->body.id);
  });
}

ImTextureID thumbnail_of_individual(PanelContext& context, std::uint64_t id) {
  const std::shared_ptr<const RunView> view = context.run.view();
  if (!view) return {};
  return context.thumbnails.find(fmt::format("{}#{}#{}", view->folder.string(), view->opening, id),
                                 [&run = context.run, id] { return run.body_of(id); });
}

void evolve_selected(PanelContext& context) {
  if (context.scene.robots().count() == 0)
    context.toasts.show(Tone::info, "there are no robots to evolve");
  else if (context.run.activity() != LiveRun::Activity::none)
    context.toasts.show(Tone::info, "an evolution is running already; stop it in the Evolution panel first");
  else
    ask_evolve(context);
}

}  // namespace mercury::window
