// SPDX-License-Identifier: Apache-2.0
#include "app/options/evolution_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>

#include "app/base/version.h"
#include "app/options/option_values.h"
#include "app/options/parameter_options.h"
#include "mercury/error.h"
#include "mercury/objective.h"
#include "mercury/origin.h"
#include "mercury/quantity.h"
#include "mercury/real_body.h"
#include "mercury/samples.h"
#include "mercury/simulation.h"

namespace mercury {
namespace {

constexpr const char* search_group = "Search";
constexpr double most_noise = 1;

std::vector<std::string> names_of_algorithms() {
  std::vector<std::string> names;
  for (const AlgorithmDescription& algorithm : algorithms()) names.emplace_back(algorithm.name);
  return names;
}

// What --from may begin with, beside paths.
std::vector<std::string> words_of_from() {
  std::vector<std::string> words = names_of_kinds();
  std::ranges::copy(sample_names(), std::back_inserter(words));
  return words;
}

// "masses", "masses:20:120" or "masses:20:120:8"
MapAxis axis_from(const std::string& text) {
  const std::vector<std::string_view> parts = split(text, ':');
  std::optional<MapAxis> usual = usual_axis(parts.front());
  if (!usual)
    throw InputError("--axis", fmt::format("\"{}\" is not a quantity; give {}", parts.front(),
                                           fmt::join(names_of_quantities(), ", ")));
  MapAxis& axis = *usual;
  if (parts.size() == 2 || parts.size() > 4)
    throw InputError("--axis",
                     fmt::format("\"{}\" is not accepted; give NAME, NAME:LOW:HIGH or NAME:LOW:HIGH:CELLS", text));
  if (parts.size() > 2) {
    axis.lowest = number_from<double>("--axis", parts[1]);
    axis.highest = number_from<double>("--axis", parts[2]);
  }
  if (parts.size() > 3) axis.cells = number_from<int>("--axis", parts[3]);
  return axis;
}

}  // namespace

void EvolutionOptions::add_to(const Command& command) {
  command_ = command;
  const auto repeated = [&](const char* name, std::vector<std::string>& values, const std::string& help,
                            const char* form) {
    return command.add_list(name, values, help).one_value_each().with_form(form).in_group(search_group);
  };
  command
      .add_list("--from", from_,
                fmt::format("What evolves: a kind of robot ({}) and its size, or robot files and folders "
                            "to start from (default voxel)",
                            generator_kinds()))
      .offering(words_of_from())
      .with_form("KIND[:SIZE]|PATH...")
      .in_group(search_group)
      .on_first_screen();
  founder_files_.add_options_to(command);
  std::vector<std::string> gene_sets;
  for (const Genes genes : all_gene_sets()) gene_sets.push_back(name_of(genes));
  add_text(command, "--genes", genes_,
           "What changes: body, muscles, brain, or several of them; both = body,muscles (default body)", "GENE,...")
      .offering(gene_sets)
      .in_group(search_group);
  add_value(command, "--algorithm", algorithm_,
            "Algorithm (default afpo; nsga2 with several objectives, map-elites with --axis)",
            fmt::format("{}", fmt::join(names_of_algorithms(), "|")),
            [](const std::string&, const std::string& text) { return text; })
      .in_group(search_group)
      .on_first_screen();
  repeated(
      "--objective", objectives_,
      "Formula of quantities to maximize, as in \"distance - 0.01 * work\" (default distance); several give a front",
      "FORMULA")
      .offering(names_of_quantities())
      .on_first_screen();
  repeated("--axis", axes_,
           "Quantity that makes robots different for map-elites, novelty and cma-me; may be given several times",
           "NAME[:LOW:HIGH[:CELLS]]")
      .offering(names_of_quantities());
  add_parameters(command, given_.algorithm, search_group);
  given_.confirm = true;
  add_parameters(command, given_, search_group);
  add_parameters(command, muscles_, search_group);
  add_parameters(command, growth_, search_group);
  for (const char* name : {"--population", "--generations"}) command.find_option(name)->on_first_screen();
  add_trial_options(command, given_.trials);
  add_evolution_trial_options(command, given_.trials);
  simulation_.add_to(command);
  generators_.add_to(command);
}

void EvolutionOptions::set_size(GenomeSpaceRequest& space, const std::string& size) const {
  const GeneratorParameter& parameter = generator_named(space.kind).parameters.front();
  space.values[parameter.name] = parameter_value_from(parameter, "--from", size);
}

// Paths are what is not a kind of robot.
GenomeSpaceRequest EvolutionOptions::space(std::vector<std::string>& paths) const {
  GenomeSpaceRequest space{
      .values = generators_.values(), .genes = genes_named(genes_), .muscles = muscles_, .growth = growth_};
  bool has_kind = false;
  for (const std::string& from : from_) {
    const std::string kind = from.substr(0, from.find(':'));
    if (!find_generator(kind)) {
      paths.push_back(from);
      continue;
    }
    if (has_kind) throw InputError("--from", "give one kind of robot");
    has_kind = true;
    space.kind = kind;
    if (kind.size() < from.size()) set_size(space, from.substr(kind.size() + 1));
  }
  if (has_kind && !paths.empty())
    throw InputError("--from", fmt::format("\"{}\" is not a kind of robot ({}); give either one kind, or paths",
                                           paths.front(), generator_kinds()));
  return space;
}

std::vector<Robot> EvolutionOptions::founders(const std::vector<std::string>& paths) const {
  std::vector<std::filesystem::path> files;
  for (const std::string& given : paths) {
    const std::filesystem::path path = sample_or_path(given);
    if (path != standard_input && !std::filesystem::exists(path))
      throw InputError("--from", fmt::format("\"{}\" is neither a file or folder nor a kind of robot ({})",
                                             path.string(), generator_kinds()));
    files.push_back(path);
  }
  std::vector<Robot> founders = robots_of(founder_files_.load(files));
  if (founders.empty() && !files.empty()) throw InputError("--from", "no robot is left: none of the files can be used");
  return founders;
}

std::optional<int> EvolutionOptions::generations() const {
  return command_->is_given("--generations") ? std::optional(given_.generations) : std::nullopt;
}

AlgorithmSettings EvolutionOptions::algorithm() const {
  AlgorithmSettings algorithm = given_.algorithm;
  for (const std::string& axis : axes_) algorithm.axes.push_back(axis_from(axis));
  algorithm.name = algorithm_.value_or("");
  complete_algorithm(algorithm, algorithm_.has_value(), objectives_.size());
  if (!algorithm.axes.empty() && !algorithm_named(algorithm.name).of_behavior)
    throw InputError("--axis", "goes with --algorithm map-elites, novelty or cma-me");
  if (algorithm_named(algorithm.name).of_numbers)
    for (const char* option :
         {"--tournament", "--elites", "--crossover", "--children", "--muscle-adaptation", "--muscle-tail"})
      if (command_->is_given(option))
        throw InputError(option, fmt::format("does not go with --algorithm {}", algorithm.name));
  return algorithm;
}

RunSettings EvolutionOptions::settings(std::vector<std::string>& notes) const {
  RunSettings settings{.evolution = given_, .program = std::string(program_version)};
  std::vector<std::string> paths;
  settings.space = space(paths);
  EvolutionSettings& evolution = settings.evolution;
  evolution.algorithm = algorithm();
  if (!objectives_.empty()) evolution.objectives = objectives_;
  evolution.trials.seconds = simulation_.seconds();
  // Runs of earlier versions may have more.
  if (evolution.trials.noise > most_noise)
    throw InputError("--noise",
                     fmt::format("{:g} is not accepted; give 0 to {:g}", evolution.trials.noise, most_noise));
  if (evolution.trials.racing && !command_->is_given("--trials")) evolution.trials.trials = 1;
  Physics physics = real_material_in(settings.space.values) ? Physics::real : Physics::paper;
  evolution.configuration = simulation_.configuration(physics);
  validate(evolution);
  settings.space.founders = founders(paths);
  if (!settings.space.founders.empty() && physics == Physics::paper) physics = physics_of(settings.space.founders);
  std::vector<std::string> environments;
  for (const Robot& robot : settings.space.founders) environments.push_back(environment_of(robot));
  if (environments.empty()) environments.push_back(generator_named(settings.space.kind).environment);
  evolution.configuration = simulation_.configuration(environments, notes, physics);
  for (const std::string& formula : evolution.objectives)
    if (const std::string why = why_meaningless(Objective(formula), evolution.configuration.environment); !why.empty())
      throw InputError("--objective",
                       fmt::format("\"{}\": {}; give another --environment or --objective", formula, why));
  settings.space.environment = name_of(evolution.configuration.environment);
  const std::unique_ptr<GenomeSpace> space = make_genome_space(settings.space);  // throws if it cannot be used
  validate(evolution, *space);
  if (!command_->is_given("--population"))
    evolution.algorithm.population = usual_population(evolution.algorithm.name, *space, evolution.seed);
  try {
    Configuration one = evolution.configuration;
    one.device = {.kind = DeviceKind::cpu, .threads = 1};
    const Robot first = space->random(evolution.seed, 0)->grow("the first robot");
    for (std::string& note : Simulation(one, {&first, 1}).notes()) notes.push_back(std::move(note));
  } catch (const InputError&) {  // there is no such robot: the evaluation says so
  }
  return settings;
}

void EvolutionOptions::require_only_what_may_change(const Command& command) const {
  const std::set<std::string> allowed{"RUN",       "--resume", "--generations", "--device", "--threads", "--quiet",
                                      "--verbose", "--config", "--shard",       "--merge",  "--dry-run"};
  for (const Option& option : command.options()) {
    const std::string name = option.name();
    if (!option.is_given() || allowed.contains(name) || allowed.contains("--" + name)) continue;
    throw InputError("--" + name,
                     "a run that goes on keeps its settings; only --generations, --device and --threads may change");
  }
}

void EvolutionOptions::choose_device(const Command& command, Configuration& configuration) const {
  const Device& given = simulation_.configuration().device;
  if (command.is_given("--device")) {
    configuration.device.kind = given.kind;
    configuration.device.index = given.index;
  }
  if (command.is_given("--threads")) configuration.device.threads = given.threads;
}

}  // namespace mercury
