// SPDX-License-Identifier: Apache-2.0
// mercury evolve: evolves robots, into a run folder.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/base/progress.h"
#include "app/commands/description.h"
#include "app/commands/evolution_progress.h"
#include "app/commands/evolve_sweep.h"
#include "app/commands/sweep.h"
#include "app/options/command.h"
#include "app/options/evolution_options.h"
#include "app/options/option_values.h"
#include "app/options/output_options.h"
#include "evolution/distribution/ranks.h"
#include "evolution/run_folder/champion_checks.h"
#include "evolution/run_folder/derived_files.h"
#include "evolution/run_folder/journal.h"
#include "mercury/cuda_devices.h"
#include "mercury/custom.h"
#include "mercury/error.h"
#include "mercury/quantity.h"
#include "mercury/run_folder.h"
#include "mercury/shards.h"
#include "mercury/stopwatch.h"

namespace mercury {
namespace {

struct EvolveOptions {
  std::string folder;
  std::string shard;  // "3/8"
  bool resume = false, prepare = false, merge = false;
  bool brief = false;  // a run of a sweep
  OutputOptions output;
  EvolutionOptions run;
  SweepOptions sweep;
};

double median_score(const Evolution& evolution) {
  std::vector<double> scores;
  for (const Individual& individual : evolution.living()) scores.push_back(individual.score());
  if (scores.empty()) return worst_score;
  const auto middle = scores.begin() + static_cast<std::ptrdiff_t>(scores.size() / 2);
  std::ranges::nth_element(scores, middle);
  return *middle;
}

void require_not_past(int generations, const EvolveOptions& options, const RunHistory& run) {
  const int last = static_cast<int>(run.generations().size()) - 1;
  if (generations < last)
    throw InputError("--generations",
                     fmt::format("{} is not accepted; {} has {} generations already, so give {} or more", generations,
                                 options.folder, last, last));
}

// Custom parts are in a program of the user's.
void require_no_custom_parts(const EvolveOptions& options, const RunSettings& run) {
  if (const std::string parts = custom_parts(run.evolution, run.space); !parts.empty())
    throw InputError(options.folder, fmt::format("has {} of a program in Python, which goes on with the run by "
                                                 "mercurysim.evolution.resume()",
                                                 parts));
}

// The number that the user gives, unless the run is past it.
void set_generations(const EvolveOptions& options, RunFolder& run) {
  const std::optional<int> given = options.run.generations();
  if (!given) return;
  require_not_past(*given, options, run.history());
  run.set_generations(*given);
}

// All generations, though some may be there already.
void prepare_cuda(const EvolutionSettings& settings) {
  const double robots = static_cast<double>(settings.algorithm.population) * (settings.generations + 1.0);
  prepare_cuda_for(robots * settings.trials.trials * settings.trials.seconds / settings.configuration.dt);
}

RunFolder open_folder(const EvolveOptions& options, const Command& command) {
  const std::filesystem::path folder = options.folder;
  if (options.resume) {
    options.run.require_only_what_may_change(command);
    RunFolder run = RunFolder::open(folder);
    require_no_custom_parts(options, run.history().settings());
    set_generations(options, run);
    return run;
  }
  if (!options.output.force() && is_run_folder(folder))
    throw InputError(folder.string(), "holds a run; --resume goes on with it, --force replaces it");
  std::vector<std::string> notes;
  const RunSettings settings = options.run.settings(notes);
  require_no_custom_parts(options, settings);
  for (const std::string& note : notes) warn(note);
  prepare_cuda(settings.evolution);
  // A device that is not there is noticed before a folder is made or replaced.
  if (const Device& device = settings.evolution.configuration.device; device.kind == DeviceKind::cuda)
    require_cuda_device(device.index);
  return RunFolder::create(folder, settings, options.output.force());
}

// Returns whether there were such robots.
bool warn_of_undefined(const Generation& generation) {
  const auto is_undefined = [](const Individual& one) { return one.assessment.fate == Fate::undefined; };
  const auto first = std::ranges::find_if(generation.born, is_undefined);
  if (first == generation.born.end()) return false;
  warn(fmt::format("{} for {} of {} robots of generation {}, which are not sound", first->assessment.problem,
                   std::ranges::count_if(generation.born, is_undefined), generation.born.size(), generation.number));
  return true;
}

// How many threads check champions beside the search.
int checking_threads(const Device& device) {
  const int threads = device.threads > 0 ? device.threads : static_cast<int>(std::thread::hardware_concurrency());
  return std::max(1, device.kind == DeviceKind::cpu ? threads / 4 : threads / 2);
}

// Runs generation after generation. Returns false if the user interrupted. `checks` may be null.
bool evolve(RunFolder& run, Evolution& evolution, Assessor& assessor, ChampionChecks* checks) {
  EvolutionProgress progress(evolution.next_generation(), evolution.settings().generations);
  const Watch watch = [&](std::size_t done, std::size_t all) {
    progress.update(done, all);
    return !interrupted();
  };
  bool has_warned = false;
  while (!evolution.is_over()) {
    const double start = wall_now();
    std::optional<Generation> generation = evolution.advance(assessor, watch);
    if (!generation) return false;
    const double seconds = wall_now() - start;
    if (!has_warned) has_warned = warn_of_undefined(*generation);
    const std::size_t born = generation->born.size();
    if (checks) checks->update();  // of the generations before, which are written
    run.append_later(*std::move(generation), {.seconds = seconds, .device = assessor.device_name()});
    progress.finish_generation(born * static_cast<std::size_t>(evolution.settings().trials.trials),
                               evolution.living().empty() ? worst_score : evolution.living().front().score(),
                               median_score(evolution));
  }
  return true;
}

// Waits for the checks of champions. Returns false if the user interrupted.
bool finish_checks(ChampionChecks& checks) {
  std::optional<Progress> progress;
  std::size_t all = 0;
  return checks.finish([&](std::size_t left) {
    if (!progress) progress.emplace("checking", "champions", static_cast<std::int64_t>(all = left));
    progress->update(static_cast<std::int64_t>(all - std::min(all, left)));
    return !interrupted();
  });
}

// The last champion that is confirmed, and how many are not.
void report_checks(const EvolveOptions& options, const RunHistory& run, const Checks& checks) {
  const auto champions = champions_of(run);
  const auto check_of = [&](std::uint64_t id) {
    const auto found = checks.find(id);
    return found == checks.end() ? nullptr : &found->second;
  };
  if (const Confirmation* best = champions.empty() ? nullptr : check_of(run.generations().back().best))
    fmt::print("its result {}\n", best->verdict == Verdict::confirmed
                                      ? "is confirmed"
                                      : fmt::format("is not confirmed: {}{}{}", name_of(best->verdict),
                                                    best->reason.empty() ? "" : ": ", best->reason));
  const bool has_map = algorithm_of(run.settings().evolution.algorithm).has_map;
  std::size_t confirmed = 0, checked = 0;
  for (const auto& [id, generation] : champions)
    if (const Confirmation* check = check_of(id)) {
      ++checked;
      confirmed += check->verdict == Verdict::confirmed;
    }
  const std::filesystem::path folder = options.folder;
  fmt::print("{} of {} champions are confirmed{}{}; {} lists all\n", confirmed, champions.size(),
             checked < champions.size() ? fmt::format(", {} not yet checked", champions.size() - checked) : "",
             confirmed > 0 && !has_map ? fmt::format(", in {}", (folder / champions_name).string()) : "",
             (folder / checks_name).string());
  if (has_map) fmt::print("{} holds the map\n", (folder / champions_name).string());
}

void report(const EvolveOptions& options, const RunFolder& run, const Evolution& evolution) {
  if (evolution.living().empty()) return;
  const Individual& best = evolution.living().front();
  const std::vector<std::string>& objectives = evolution.settings().objectives;
  fmt::print("{}: generation {}, {} robots\n", options.folder, evolution.next_generation() - 1,
             run.history().individuals().size());
  const Fate fate = best.assessment.fate;
  if (fate != Fate::sound && fate != Fate::stopped) {
    fmt::print("no robot is sound; the first one is {}\n", name_of(fate));
    return;
  }
  for (std::size_t i = 0; i < objectives.size(); ++i) {
    fmt::print("best: {} = {:.6g}", objectives[i], best.assessment.scores.at(i));
    if (i < best.assessment.lower_quartiles.size())
      fmt::print(" (quartiles of {} trials: {:.6g} to {:.6g})", evolution.settings().trials.trials,
                 best.assessment.lower_quartiles[i], best.assessment.upper_quartiles[i]);
    fmt::print("\n");
  }
  fmt::print("born in generation {} as number {}", best.generation, best.id);
  const std::filesystem::path champions = std::filesystem::path(options.folder) / champions_name;
  fmt::print("{}\n", run.history().settings().evolution.confirm ? "" : "; see " + champions.string());
}

// The settings of the run with the device that the user gave for this process.
EvolutionSettings settings_here(const EvolveOptions& options, const Command& command, const RunSettings& run) {
  EvolutionSettings settings = run.evolution;
  options.run.choose_device(command, settings.configuration);
  prepare_cuda(settings);
  return settings;
}

int evolve_in(const EvolveOptions& options, RunFolder& run, const EvolutionSettings& settings, Assessor& assessor) {
  Evolution evolution(settings, run.space());
  restore(run.history(), evolution);
  if (evolution.is_over())
    say(fmt::format("{} has all its {} generations; --generations raises their number", options.folder,
                    settings.generations));
  std::optional<ChampionChecks> checks;
  if (run.history().settings().evolution.confirm)
    checks.emplace(run, checking_threads(settings.configuration.device)).update();
  const bool done = evolve(run, evolution, assessor, checks ? &*checks : nullptr);
  if (checks) checks->update();  // while the files are written, the last champion is checked
  run.write_all();
  const bool all_checked = !checks || finish_checks(*checks);
  if (!options.brief) {
    report(options, run, evolution);
    if (checks) report_checks(options, run.history(), checks->checks());
  }
  if (!done)
    warn(fmt::format("stopped in generation {}, which is lost; mercury evolve {} --resume goes on",
                     evolution.next_generation(), options.folder));
  else if (!all_checked)
    warn(fmt::format("stopped while champions were checked; mercury evolve {} --resume goes on", options.folder));
  return done && all_checked ? 0 : 1;
}

int evolve_here(const EvolveOptions& options, const Command& command) {
  RunFolder run = open_folder(options, command);
  if (options.prepare) return 0;
  const EvolutionSettings settings = settings_here(options, command, run.history().settings());
  return evolve_in(options, run, settings, *make_assessor(settings));
}

// --- A sweep

void refuse_in_sweep(const EvolveOptions& options) {
  if (options.merge || !options.shard.empty())
    throw InputError(options.merge ? "--merge" : "--shard", "not for a sweep; give one of its runs");
  if (Ranks::launched()) throw InputError(options.folder, "a sweep is no work for several processes; give each a run");
}

// Makes the folders of all runs, so that from then on the sweep is its folder.
void make_sweep(const EvolveOptions& options, const Command& command) {
  const std::filesystem::path folder = options.folder;
  if (is_run_folder(folder)) throw InputError(folder.string(), "holds a run; give a new folder for a sweep");
  const std::vector<std::filesystem::path> old = runs_of_sweep(folder);
  if (!old.empty() && !options.output.force())
    throw InputError(folder.string(), "holds a sweep; --resume goes on with it, --force replaces its runs");
  std::vector<std::string> notes;
  const std::vector<SweepOptions::Run> runs = options.sweep.runs(command, notes);
  for (const std::string& note : notes) warn(note);
  for (const std::filesystem::path& run : old)
    if (std::ranges::none_of(runs, [&](const SweepOptions::Run& one) { return folder / one.place == run; }))
      throw InputError(run.string(), "is a run that this sweep does not have; remove it, or give a new folder");
  for (const SweepOptions::Run& run : runs) {
    std::filesystem::create_directories((folder / run.place).parent_path());
    RunFolder::create(folder / run.place, run.settings, options.output.force());
  }
}

// In the order of the seeds, so that a sweep that was stopped has as many of each variant.
std::vector<std::filesystem::path> runs_in_turn(const std::filesystem::path& folder) {
  std::vector<std::pair<std::uint64_t, std::filesystem::path>> runs;
  for (const std::filesystem::path& run : runs_of_sweep(folder))
    runs.emplace_back(RunHistory(run).settings().evolution.seed, run);
  std::ranges::stable_sort(runs, {}, [](const auto& run) { return run.first; });
  std::vector<std::filesystem::path> folders;
  for (auto& [seed, run] : runs) folders.push_back(std::move(run));
  return folders;
}

int evolve_sweep(const EvolveOptions& options, const Command& command) {
  refuse_in_sweep(options);
  if (options.resume)
    options.run.require_only_what_may_change(command);
  else
    make_sweep(options, command);
  if (options.prepare) return 0;
  const std::filesystem::path folder = options.folder;
  const std::vector<std::filesystem::path> runs = runs_in_turn(folder);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    EvolveOptions own = options;
    own.folder = runs[i].string();
    own.brief = true;
    RunFolder run = RunFolder::open(runs[i]);
    set_generations(own, run);
    const EvolutionSettings settings = settings_here(own, command, run.history().settings());
    say(fmt::format("run {} of {}: {}", i + 1, runs.size(), runs[i].lexically_relative(folder).string()));
    const int status = evolve_in(own, run, settings, *make_assessor(settings));
    const Sweep sweep = read_sweep(folder);
    write_results((folder / "sweep.csv").string(), sweep_csv(sweep));
    write_results((folder / "sweep.svg").string(), sweep_plot(sweep));
    if (status != 0) return status;
  }
  fmt::print("{}", sweep_table(read_sweep(folder)));
  return 0;
}

// --- By MPI

// Each rank on a host takes a GPU of its own, unless the user names one.
void choose_gpu_of_rank(const Ranks& ranks, Device& device) {
  const int gpus = device.kind == DeviceKind::automatic ? cuda_device_count() : 0;
  if (gpus > 0) device = {.kind = DeviceKind::cuda, .index = ranks.rank_on_host() % gpus, .threads = device.threads};
}

int evolve_as_rank_0(const EvolveOptions& options, const Command& command, Ranks& ranks) {
  std::optional<RunFolder> run;
  try {
    run = open_folder(options, command);
    ranks.share(run->history().settings());
  } catch (...) {
    if (!run) ranks.abandon();
    throw;
  }
  EvolutionSettings settings = settings_here(options, command, run->history().settings());
  choose_gpu_of_rank(ranks, settings.configuration.device);
  const std::unique_ptr<Assessor> local = make_assessor(settings);
  return evolve_in(options, *run, settings, *ranks.distribute(*local));
}

int evolve_as_other_rank(const EvolveOptions& options, const Command& command, Ranks& ranks) {
  const std::optional<RunSettings> run = ranks.receive_settings();
  // Rank 0 says why. Who ended before it did would make the launcher kill it.
  if (!run) throw InputError(options.folder, "rank 0 cannot use it");
  EvolutionSettings settings = settings_here(options, command, *run);
  choose_gpu_of_rank(ranks, settings.configuration.device);
  const std::unique_ptr<GenomeSpace> space = make_genome_space(run->space);
  if (ranks.serve([&] { return make_assessor(settings); }, *space, interrupted)) return 0;
  if (ranks.rank() == 1) warn(fmt::format("rank 0 no longer answers; {} is whole, --resume goes on", options.folder));
  return 1;
}

// --- In shards

// "3/8"
std::pair<std::size_t, std::size_t> shard_from(const std::string& text) {
  const std::vector<std::string_view> parts = split(text, '/');
  const auto number = [&](std::size_t i) { return number_from<std::uint64_t>("--shard", parts[i]); };
  if (parts.size() != 2 || number(0) < 1 || number(0) > number(1))
    throw InputError("--shard", fmt::format("\"{}\" is not accepted; give I/N, from 1/N to N/N", text));
  return {number(0), number(1)};
}

void require_more_generations(const EvolveOptions& options, const Evolution& evolution) {
  if (evolution.is_over())
    throw InputError(options.folder, fmt::format("has all its {} generations; mercury evolve {} --merge "
                                                 "--generations N raises their number",
                                                 evolution.settings().generations, options.folder));
}

int evolve_shard(const EvolveOptions& options, const Command& command) {
  const auto [shard, count] = shard_from(options.shard);
  options.run.require_only_what_may_change(command);
  const RunHistory history(options.folder);
  require_no_custom_parts(options, history.settings());
  const EvolutionSettings settings = settings_here(options, command, history.settings());
  Evolution evolution(settings, history.space());
  restore(history, evolution);
  require_more_generations(options, evolution);
  Progress progress(fmt::format("generation {}, shard {}/{}", evolution.next_generation(), shard, count), "robots",
                    static_cast<std::int64_t>(evolution.children().size() / count + 1));
  const std::optional<std::filesystem::path> file = assess_shard(options.folder, evolution, *make_assessor(settings),
                                                                 shard, count, [&](std::size_t done, std::size_t) {
                                                                   progress.update(static_cast<std::int64_t>(done));
                                                                   return !interrupted();
                                                                 });
  if (!file) {
    warn("stopped; the shard was not written");
    return 1;
  }
  fmt::print("{}\n", file->string());
  return 0;
}

int merge(const EvolveOptions& options, const Command& command) {
  options.run.require_only_what_may_change(command);
  RunFolder run = RunFolder::open(options.folder);
  require_no_custom_parts(options, run.history().settings());
  const auto finished = static_cast<int>(run.history().generations().size());
  const bool was_over = finished > run.history().settings().evolution.generations;
  set_generations(options, run);
  Evolution evolution(run.history().settings().evolution, run.space());
  restore(run.history(), evolution);
  require_more_generations(options, evolution);
  if (was_over) return 0;  // there is nothing to merge before more generations are wanted
  const Generation generation = merge_shards(options.folder, evolution);
  run.append(generation, {.seconds = 0, .device = "shards"});
  warn_of_undefined(generation);
  remove_shards(options.folder, evolution.next_generation());
  run.write_all();
  report(options, run, evolution);
  if (run.history().settings().evolution.confirm) {
    ChampionChecks checks(run, static_cast<int>(std::max(1u, std::thread::hardware_concurrency())));
    checks.update();
    if (!finish_checks(checks)) return 1;
    report_checks(options, run.history(), checks.checks());
  }
  return 0;
}

// --- Without doing it

int describe_more(const EvolveOptions& options, const Command& command) {
  options.run.require_only_what_may_change(command);
  if (!options.shard.empty()) shard_from(options.shard);
  const RunHistory history(options.folder);
  require_no_custom_parts(options, history.settings());
  if (options.run.generations()) require_not_past(*options.run.generations(), options, history);
  const EvolutionSettings settings = settings_here(options, command, history.settings());
  return print_dry_run("evolve",
                       {{"go on with", options.folder},
                        {"generations", fmt::format("{} of {} are there", history.generations().size(),
                                                    options.run.generations().value_or(settings.generations) + 1)},
                        {"do", options.merge           ? "merge the shards of the next one"
                               : options.shard.empty() ? "all that follow"
                                                       : "shard " + options.shard},
                        {"on", device_text(settings.configuration.device)}});
}

int describe_sweep(const EvolveOptions& options, const Command& command) {
  refuse_in_sweep(options);
  std::vector<std::string> notes;
  const std::size_t runs =
      options.resume ? runs_of_sweep(options.folder).size() : options.sweep.runs(command, notes).size();
  for (const std::string& note : notes) say(note);
  return print_dry_run("evolve", {{options.resume ? "go on with" : "write", options.folder},
                                  {"runs", fmt::format("{}, each in a folder of its own", runs)}});
}

int describe_work(const EvolveOptions& options, const Command& command) {
  if (options.resume || options.merge || !options.shard.empty()) return describe_more(options, command);
  require_new_folder(options.folder, options.output.force());
  OutputFiles outputs = options.output.files();
  outputs.add_folder("RUN", options.folder);
  outputs.check();
  std::vector<std::string> notes;
  const RunSettings run = options.run.settings(notes);
  require_no_custom_parts(options, run);
  const EvolutionSettings& settings = run.evolution;
  for (const std::string& note : notes) say(note);
  const std::size_t population = settings.algorithm.population;
  const std::size_t children = settings.children > 0 ? settings.children : population;
  const std::size_t robots = population + children * static_cast<std::size_t>(settings.generations);
  const Configuration& configuration = settings.configuration;
  return print_dry_run(
      "evolve",
      {{"algorithm", settings.algorithm.name},
       {"maximize", fmt::format("{}", fmt::join(settings.objectives, "; "))},
       {"robots", fmt::format("{}: {} at first, then {} in each of {} generations", robots, population, children,
                              settings.generations)},
       {"trials", fmt::format("{} per robot, each {}", settings.trials.trials,
                              time_text(configuration, std::llround(settings.trials.seconds / configuration.dt)))},
       {"in", environment_text(configuration)},
       {"on", device_text(configuration.device)},
       {"write", "the folder " + options.folder}});
}

int evolve(const EvolveOptions& options, const Command& command) {
  if (options.resume + options.prepare + options.merge + !options.shard.empty() > 1)
    throw InputError("--resume, --prepare, --shard and --merge", "give one of them");
  if (options.sweep.given() && options.resume)
    throw InputError("--seeds and --vary", "a sweep that goes on keeps its runs; give --resume alone");
  const bool is_sweep = options.sweep.given() || !runs_of_sweep(options.folder).empty();
  if (is_sweep && (options.sweep.given() || options.resume || options.merge || !options.shard.empty()))
    return options.output.dry_run() ? describe_sweep(options, command) : evolve_sweep(options, command);
  if (options.output.dry_run()) return rank_by_launcher() > 0 ? 0 : describe_work(options, command);
  if (!options.shard.empty()) return evolve_shard(options, command);
  const bool alone = options.merge || options.prepare;  // of several processes, only the first has something to do
  if (alone && rank_by_launcher() > 0) return 0;
  if (options.merge) return merge(options, command);
  if (alone || !Ranks::launched()) return evolve_here(options, command);
  Ranks ranks;
  return ranks.rank() == 0 ? evolve_as_rank_0(options, command, ranks) : evolve_as_other_rank(options, command, ranks);
}

}  // namespace

void add_evolve_command(const Command& program, const Choose& choose) {
  auto options = std::make_shared<EvolveOptions>();
  const Command command = program.add_command("evolve", "Evolve robots; every ancestor is kept, and a run can go on");
  add_text(command, "RUN", options->folder, "The folder of the run", "FOLDER").required();
  command.add_flag("--resume", options->resume, "Go on with the run in the folder").on_first_screen();
  command.add_flag("--prepare", options->prepare, "Make the folder of a run, for --shard").in_group("Several hosts");
  add_text(command, "--shard", options->shard, "Try part I of N of the next generation, into a file of the folder",
           "I/N")
      .in_group("Several hosts");
  command.add_flag("--merge", options->merge, "Select from the files of all parts").in_group("Several hosts");
  options->output.add_to(command);
  options->run.add_to(command);
  options->sweep.add_to(command);
  command.set_footer(
      fmt::format("Quantities of a trial, for formulas and axes: {}.\n\n", fmt::join(names_of_quantities(), ", ")) +
      "A run that was stopped, by Ctrl-C or by a power cut, goes on with --resume as if it had never stopped.\n"
      "docs/evolution.md explains algorithms, genomes and the files of the folder.\n\n"
      "Examples:\n"
      "  mercury evolve swim --from voxel:6x4x4 --population 64 --generations 50\n"
      "  mercury evolve crawl --from cppn:6x4x4 --environment land --settle 1 --objective \"distance - 0.01 * work\"\n"
      "  mercury evolve eels --from eel.json --genes muscles --seconds 20\n"
      "  mercury evolve map --from cppn:6x4x4 --axis masses:20:120 --axis muscle_share\n"
      "  mercury evolve swim --resume --generations 200\n"
      "  mercury evolve which --from voxel:6x4x4 --seeds 1..10 --vary algorithm=ga,afpo\n"
      "  mpirun -n 8 mercury evolve swim --from voxel:6x4x4 --population 4096");
  command.when_chosen([options, choose, command] {
    choose([options, command] { return options->run.status(evolve(*options, command)); });
  });
}

}  // namespace mercury
