// SPDX-License-Identifier: Apache-2.0
// Compares the algorithms of evolution at equal numbers of tried robots: voxel grids, painted grids and networks, in
// the ocean and on land. Prints a table: median and quartiles over the seeds of the best distance. --csv writes the
// best score after each generation; bench/plot_evolution.py plots it.
//
//     bench_evolution [--seeds 10] [--evaluations 1280] [--kinds voxel,cppn,nn] [--environments ocean,land] ...
//
//     bench_evolution --throughput 1 --device cuda [--physics real --environments water,land] [--population 16384]
//
// measures what a user waits for instead: robots per minute of a whole pipelined run with its folder, from the start of
// a process to its end, with the start of CUDA, the share of that time during which the device stepped, and the springs
// that it then stepped per second, beside those that one call steps per second, as the mean over ten generations of
// the run, since robots change while they evolve.
//
// All algorithms start from the same random robots, those of the seed. Runs are spread over the cores, whole runs at a
// time. nsga2 has two objectives, distance and distance per work; the table shows its best distance. map-elites has a
// map of size and share of muscles; novelty is of where they end.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "bench/timing.h"
#include "mercury/error.h"
#include "mercury/evolution.h"
#include "mercury/parallel.h"
#include "mercury/quantity.h"
#include "mercury/run_folder.h"
#include "mercury/simulation.h"
#include "mercury/stopwatch.h"

namespace mercury {
namespace {

struct Options {
  std::vector<std::string> algorithms{"random", "ga", "afpo", "alps", "nsga2", "map-elites", "novelty"};
  std::vector<std::string> kinds{"voxel", "cppn", "nn"}, environments{"ocean", "land"};
  std::uint64_t seeds = 10, first_seed = 1;
  std::size_t evaluations = 1280;
  std::size_t population = 0;  // 0 = 64; with --throughput, as usual for the kind
  SizeRange voxels{{4, 3, 3}, {4, 3, 3}};
  std::int64_t points = 64;
  struct Place {
    double seconds, dt;
  };
  Place ocean{10, 4e-3}, land{5, 1e-3};  // [s]; land is stiffer
  Genes genes = Genes::both;
  MuscleMutation muscles;
  EvolutionSettings settings;  // their defaults, and what the options say
  std::string device = "cpu", csv;
  double throughput = 0;          // instead of the table: the share of the usual number of generations
  std::string physics = "paper";  // with --throughput
  int jobs = 0;                   // runs at a time; 0 = one per core
};

std::vector<std::string> words_of(const std::string& list) {
  std::vector<std::string> words;
  std::stringstream stream(list);
  for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
  return words;
}

SizeRange voxels_of(const std::string& text) {
  SizeRange range;
  if (std::sscanf(text.c_str(), "%dx%dx%d", &range.largest[0], &range.largest[1], &range.largest[2]) != 3)
    throw InputError("--voxels", text + " is not accepted; give sizes such as 4x3x3");
  range.smallest = range.largest;
  return range;
}

Options options_from(int argc, char** argv) {
  Options options;
  AlgorithmSettings& algorithm = options.settings.algorithm;
  const auto words = [](std::vector<std::string>& to) { return [&to](const std::string& v) { to = words_of(v); }; };
  const auto number = [](auto& to) {
    return [&to](const std::string& v) { to = static_cast<std::remove_reference_t<decltype(to)>>(std::stod(v)); };
  };
  const auto text = [](std::string& to) { return [&to](const std::string& v) { to = v; }; };
  const std::map<std::string, std::function<void(const std::string&)>> setters{
      {"--algorithms", words(options.algorithms)},
      {"--kinds", words(options.kinds)},
      {"--environments", words(options.environments)},
      {"--seeds", number(options.seeds)},
      {"--first-seed", number(options.first_seed)},
      {"--evaluations", number(options.evaluations)},
      {"--population", number(options.population)},
      {"--voxels", [&](const std::string& v) { options.voxels = voxels_of(v); }},
      {"--points", number(options.points)},
      {"--ocean-seconds", number(options.ocean.seconds)},
      {"--ocean-dt", number(options.ocean.dt)},
      {"--land-seconds", number(options.land.seconds)},
      {"--land-dt", number(options.land.dt)},
      {"--genes", [&](const std::string& v) { options.genes = genes_named(v); }},
      {"--mutation", number(options.settings.mutation)},
      {"--crossover", number(algorithm.crossover)},
      {"--tournament", number(algorithm.tournament)},
      {"--elites", number(algorithm.elites)},
      {"--islands", number(algorithm.islands)},
      {"--migration-interval", number(algorithm.migration_interval)},
      {"--migrants", number(algorithm.migrants)},
      {"--muscle-adaptation", number(options.muscles.muscle_adaptation)},
      {"--muscle-tail", number(options.muscles.muscle_tail)},
      {"--trials", number(options.settings.trials.trials)},
      {"--device", text(options.device)},
      {"--jobs", number(options.jobs)},
      {"--throughput", number(options.throughput)},
      {"--physics", text(options.physics)},
      {"--csv", text(options.csv)}};
  for (int i = 1; i < argc; i += 2) {
    const auto setter = setters.find(argv[i]);
    if (setter == setters.end() || i + 1 == argc) throw InputError(argv[i], "is not an option with a value");
    setter->second(argv[i + 1]);
  }
  if (options.throughput > 0) return options;
  if (options.population == 0) options.population = 64;
  if (options.seeds == 0 || options.evaluations < options.population) throw InputError("give at least one generation");
  return options;
}

// One run of one algorithm.
struct Task {
  std::string kind, environment, algorithm;
  std::uint64_t seed = 1;
  struct Point {
    std::size_t evaluations;
    double best;
  };
  std::vector<Point> course;
  std::size_t failed = 0, exploded = 0, overstretched = 0;
};

EvolutionSettings settings_of(const Task& task, const Options& options) {
  EvolutionSettings settings = options.settings;
  settings.algorithm.name = task.algorithm;
  settings.algorithm.population = options.population;
  const double volume = 1e-3 * options.voxels.largest[0] * options.voxels.largest[1] * options.voxels.largest[2];
  settings.algorithm.axes = {{.quantity = "size", .lowest = 0, .highest = volume, .cells = 8},
                             {.quantity = "muscle_share", .lowest = 0, .highest = 1, .cells = 8}};
  if (task.algorithm == "novelty")  // where robots end
    settings.algorithm.axes = {{.quantity = "speed_x", .lowest = -0.1, .highest = 0.1},
                               {.quantity = "speed_y", .lowest = -0.1, .highest = 0.1}};
  if (task.algorithm == "nsga2") settings.objectives = {"distance", "efficiency"};
  settings.configuration.environment = environment_named(task.environment);
  settings.configuration.device = device_named(options.device);
  const bool on_land = has_ground(settings.configuration.environment);
  settings.configuration.dt = on_land ? options.land.dt : options.ocean.dt;
  settings.trials.seconds = on_land ? options.land.seconds : options.ocean.seconds;
  settings.generations = static_cast<int>(options.evaluations / options.population) - 1;
  settings.seed = task.seed;
  return settings;
}

void perform(Task& task, const Options& options) {
  const GenomeSpaceRequest request{
      .kind = task.kind,
      .values = {{"voxels", options.voxels}, {"canvas", options.voxels}, {"points", options.points}},
      .environment = task.environment,
      .genes = options.genes,
      .muscles = options.muscles};
  const std::unique_ptr<GenomeSpace> space = make_genome_space(request);
  const EvolutionSettings settings = settings_of(task, options);
  const std::unique_ptr<Assessor> assessor = make_assessor(settings);
  Evolution evolution(settings, *space);
  std::size_t evaluations = 0;
  double best = worst_score;
  while (const std::optional<Generation> generation = evolution.advance(*assessor)) {
    evaluations += generation->born.size();
    for (const Individual& child : generation->born) {
      best = std::max(best, child.score());
      task.failed += child.assessment.fate == Fate::failed;
      task.exploded += child.assessment.fate == Fate::exploded;
      task.overstretched += child.assessment.fate == Fate::overstretched;
    }
    task.course.push_back({evaluations, best});
  }
}

// Performs all on as many threads as asked for.
void perform_all(std::vector<Task>& tasks, const Options& options) {
  std::atomic<std::size_t> next = 0, done = 0;
  const auto work = [&] {
    for (std::size_t i; (i = next++) < tasks.size();) {
      perform(tasks[i], options);
      std::fprintf(stderr, "\r%zu of %zu runs", ++done, tasks.size());
    }
  };
  const unsigned jobs = options.jobs > 0 ? static_cast<unsigned>(options.jobs) : std::thread::hardware_concurrency();
  std::vector<std::thread> threads;
  for (unsigned j = 0; j < jobs; ++j) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  std::fprintf(stderr, "\n");
}

// Quantile of numbers, interpolated between neighbors.
double quantile(std::vector<double> numbers, double share) {
  std::ranges::sort(numbers);
  const double place = share * static_cast<double>(numbers.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, numbers.size() - 1);
  return numbers[below] + (place - static_cast<double>(below)) * (numbers[above] - numbers[below]);
}

void print_table(const std::vector<Task>& tasks, const Options& options) {
  std::printf("%-6s %-6s %-10s %9s %9s %9s  %9s %6s\n", "kind", "where", "algorithm", "quartile", "median", "quartile",
              "first gen", "bad");
  for (const std::string& kind : options.kinds)
    for (const std::string& environment : options.environments)
      for (const std::string& algorithm : options.algorithms) {
        std::vector<double> best, first;
        std::size_t bad = 0;
        for (const Task& task : tasks) {
          if (task.kind != kind || task.environment != environment || task.algorithm != algorithm) continue;
          best.push_back(task.course.back().best);
          first.push_back(task.course.front().best);
          bad += task.failed + task.exploded + task.overstretched;
        }
        std::printf("%-6s %-6s %-10s %7.3f m %7.3f m %7.3f m  %7.3f m %6zu\n", kind.c_str(), environment.c_str(),
                    algorithm.c_str(), quantile(best, 0.25), quantile(best, 0.5), quantile(best, 0.75),
                    quantile(first, 0.5), bad);
      }
}

void write_csv(const std::vector<Task>& tasks, const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (!file) throw InputError(path, "cannot be written");
  std::fprintf(file, "kind,environment,algorithm,seed,evaluations,best\n");
  for (const Task& task : tasks)
    for (const Task::Point& point : task.course)
      std::fprintf(file, "%s,%s,%s,%llu,%zu,%.9g\n", task.kind.c_str(), task.environment.c_str(),
                   task.algorithm.c_str(), static_cast<unsigned long long>(task.seed), point.evaluations, point.best);
  std::fclose(file);
}

// --- Throughput

struct Search {
  const char* title;
  GenomeSpaceRequest space;
  std::size_t population;
  int generations;
};

const std::vector<Search>& searches() {
  static const std::vector<Search> all{
      {"voxel robots", {.kind = "voxel"}, 4096, 100},
      {"network robots", {.kind = "nn", .values = {{"points", std::int64_t{64}}}}, 1024, 150}};
  return all;
}

double springs_of(const Individual& individual) {
  static const std::size_t quantity = find_quantity("springs").value();
  const std::vector<double>& values = individual.assessment.values;
  return values.empty() ? 0 : values[quantity];  // none = it could not be made
}

struct Stepped {
  double springs = 0, seconds = 0;
};

// The faster of two times.
Stepped step_in_one_call(const Configuration& configuration, std::span<const GenomePointer> genomes,
                         std::int64_t steps) {
  std::vector<std::shared_ptr<const Robot>> robots(genomes.size());
  parallel_for(0, genomes.size(), [&](std::size_t i) {
    try {
      robots[i] = std::make_shared<const Robot>(genomes[i]->grow_for_trial("robot"));
    } catch (const InputError&) {  // a genome without a robot
    }
  });
  std::erase(robots, nullptr);
  double springs = 0;
  for (const auto& robot : robots) springs += static_cast<double>(robot->springs.size());
  Simulation simulation(configuration, robots);
  double least = std::numeric_limits<double>::infinity();
  for (int turn = 0; turn < 2; ++turn) {
    simulation.reset();
    least = std::min(least, seconds_of([&] { simulation.step(steps); }));
  }
  return {springs, least};
}

// What `mercury evolve RUN --pipelined --trials 1 --jitter 0 --no-confirm` does.
void search(const Search& one, const std::string& environment, const Options& options,
            const std::filesystem::path& folder) {
  const std::chrono::duration<double> before = std::chrono::steady_clock::now().time_since_epoch();
  EvolutionSettings settings = options.settings;
  settings.algorithm.population = options.population > 0 ? options.population : one.population;
  settings.generations = std::max(1, static_cast<int>(options.throughput * one.generations));
  GenomeSpaceRequest space = one.space;
  space.values.emplace("physics", options.physics);
  space.environment = environment;
  settings.configuration = default_configuration(physics_of(space), environment);
  settings.configuration.device = device_named(options.device);
  settings.trials.trials = 1;
  settings.trials.jitter = 0;
  settings.pipelined = true;
  double busy = 0, springs = 0;
  std::size_t robots = 0;
  const int every = (settings.generations + 9) / 10;
  std::vector<std::vector<GenomePointer>> sampled;  // ten generations
  {
    RunFolder run = RunFolder::create(folder, {.evolution = settings, .space = space});
    const std::unique_ptr<Assessor> assessor = make_assessor(settings);
    Evolution evolution(settings, run.space());
    while (std::optional<Generation> generation = evolution.advance(*assessor)) {
      robots += generation->born.size();
      for (const Individual& individual : generation->born) springs += springs_of(individual);
      if (generation->number % every == every / 2) {
        sampled.emplace_back();
        for (const Individual& individual : generation->born) sampled.back().push_back(individual.genome);
      }
      run.append_later(*std::move(generation), {.seconds = 0, .device = assessor->device_name()});
    }
    run.write_all();
    busy = assessor->busy_seconds();
  }
  const std::chrono::duration<double> after = std::chrono::steady_clock::now().time_since_epoch();
  const double seconds = (after - before).count();
  const std::int64_t steps = std::llround(settings.trials.seconds / settings.configuration.dt);
  const double speed = springs * static_cast<double>(steps) / busy;
  Stepped alone;
  for (const std::vector<GenomePointer>& generation : sampled) {
    const Stepped one_call = step_in_one_call(settings.configuration, generation, steps);
    alone.springs += one_call.springs;
    alone.seconds += one_call.seconds;
  }
  const double of_one_call = alone.springs * static_cast<double>(steps) / alone.seconds;
  std::printf(
      "%zu %s, %s, in %.1f s: %.3g per minute, device busy %.0f %%, %.3g springs/s, %.0f %% of one call's %.3g\n",
      robots, one.title, environment.c_str(), seconds, 60 * static_cast<double>(robots) / seconds, 100 * busy / seconds,
      speed, 100 * speed / of_one_call, of_one_call);
}

// Each in a process of its own, so that each starts CUDA.
void measure_throughput(const Options& options) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("bench_evolution-" + std::to_string(getpid()));
  for (const Search& one : searches()) {
    if (std::ranges::find(options.kinds, one.space.kind) == options.kinds.end()) continue;
    for (const std::string& environment : options.environments) {
      const pid_t child = fork();
      if (child == 0) {
        search(one, environment, options, folder);
        std::fflush(stdout);
        _exit(0);
      }
      int status = 0;
      waitpid(child, &status, 0);
      std::filesystem::remove_all(folder);
      if (status != 0) throw std::runtime_error(std::string(one.title) + " failed");
    }
  }
}

void bench(const Options& options) {
  if (options.throughput > 0) return measure_throughput(options);
  std::vector<Task> tasks;
  for (std::uint64_t s = 0; s < options.seeds; ++s)
    for (const std::string& kind : options.kinds)
      for (const std::string& environment : options.environments)
        for (const std::string& algorithm : options.algorithms)
          tasks.push_back({.kind = kind,
                           .environment = environment,
                           .algorithm = algorithm,
                           .seed = options.first_seed + s,
                           .course = {}});
  double seconds = 0;
  {
    const Stopwatch watch(seconds);
    perform_all(tasks, options);
  }
  print_table(tasks, options);
  std::printf("%zu runs of %zu robots each, %.0f s\n", tasks.size(), options.evaluations, seconds);
  if (!options.csv.empty()) write_csv(tasks, options.csv);
}

}  // namespace
}  // namespace mercury

int main(int argc, char** argv) {
  try {
    mercury::bench(mercury::options_from(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_evolution: %s\n", error.what());
    return 2;
  }
}
