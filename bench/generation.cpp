// SPDX-License-Identifier: Apache-2.0
// Measures what users wait for when they evolve robots: robots are made, loaded, stepped for ten seconds and read, once
// each. Prints a table; a row per batch, with the parts and how busy the device was.
//
//     bench_generation [--device cuda] [--environment land] [--rows voxel,lattice] [--scale 0.01] [--stream 200000] ...
//
// Each row runs in a process of its own, so "whole" is what a program takes from its start to its end, including the
// start of CUDA. Parts overlap: while some robots are stepped, others are made. Busy is the share of the whole time
// during which the device stepped robots, averaged over devices. springs/s are those while it did. A row "in one call"
// shows what the device reaches with the same robots: they are all loaded before, and no sample is taken.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "mercury/error.h"
#include "mercury/evaluator.h"
#include "mercury/generator.h"
#include "mercury/parallel.h"
#include "mercury/random_voxel.h"
#include "mercury/simulation.h"
#include "mercury/stopwatch.h"

namespace mercury {
namespace {

struct Row {
  const char* name;
  const char* title;
  const char* kind;  // of the generator
  ParameterValues values;
  std::size_t robots;
  bool streams = false;        // --stream says how many robots
  bool all_devices = false;    // on cuda:all
  bool to_first_step = false;  // in one simulation, for one step
  bool in_one_call = false;    // in one simulation, all steps
};

const std::vector<Row>& rows() {
  const ParameterValues lattice{{"voxels", SizeRange{{10, 10, 10}, {10, 10, 10}}}, {"air", 0.3}};
  // Without spacing every point is a mass, as in the numbers of docs/performance.md.
  const ParameterValues network{{"points", std::int64_t{512}}, {"spacing", 0.f}};
  static const std::vector<Row> all{
      {"voxel", "random voxel robots", "voxel", {}, 4000},
      {"voxel-one-call", "the same in one call", "voxel", {}, 4000, false, false, false, true},
      {"lattice", "of 10x10x10 voxels, 30 % air", "voxel", lattice, 4000},
      {"network-1000", "network robots, 512 points", "nn", network, 1000},
      {"network", "network robots, 512 points", "nn", network, 4000},
      {"load", "of 1,331 masses, to the first step", "", {}, 50000, false, false, true},
      {"stream", "random voxel robots, a stream", "voxel", {}, 0, true},
      {"stream-all", "the same on all devices", "voxel", {}, 0, true, true}};
  return all;
}

struct Options {
  std::string device = "auto", environment, row;  // environment: empty = the default
  std::vector<std::string> rows;                  // empty = all
  double scale = 1, seconds = 10;
  std::size_t stream = 200000, portion = 0;
  int workers = 0, threads = 0;
};

struct Result {
  std::size_t robots = 0, devices = 1;
  double start = 0, grow = 0, check = 0, schedule = 0, upload = 0, step = 0, read = 0;  // [s]
  double busy = 0;                                                                      // [s], mean over devices
  double evaluated = 0;                                                                 // springs times steps
};

void print(const Result& r) {
  std::printf("%zu %zu %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", r.robots, r.devices, r.start, r.grow, r.check,
              r.schedule, r.upload, r.step, r.read, r.busy, r.evaluated);
}

bool scan(std::FILE* from, Result& r) {
  return std::fscanf(from, "%zu %zu %lf %lf %lf %lf %lf %lf %lf %lf %lf", &r.robots, &r.devices, &r.start, &r.grow,
                     &r.check, &r.schedule, &r.upload, &r.step, &r.read, &r.busy, &r.evaluated) == 11;
}

Configuration configuration_of(const Options& options, const Row& row) {
  Configuration configuration;
  configuration.device = device_named(row.all_devices ? "cuda:all" : options.device);
  configuration.device.threads = options.threads;
  if (!options.environment.empty()) configuration.environment = environment_named(options.environment);
  return configuration;
}

std::size_t count_of(const Options& options, const Row& row) {
  const double robots = static_cast<double>(row.streams ? options.stream : row.robots);
  return std::max<std::size_t>(1, static_cast<std::size_t>(options.scale * robots));
}

// As `mercury run`: telemetry every 0.1 s, hashes at the end.
Result evaluate(const Options& options, const Row& row) {
  const Configuration configuration = configuration_of(options, row);
  const Generator& generator = generator_named(row.kind);
  Evaluator evaluator(
      {.configuration = configuration,
       .steps = std::llround(options.seconds / configuration.dt),
       .sample_every = std::llround(0.1 / configuration.dt),
       .hashes = true,
       .portion = options.portion,
       .workers = options.workers},
      [&](std::size_t i) { return std::make_shared<Robot>(generator.make(row.values, "", 1, i)); },
      count_of(options, row));
  Result result;
  std::size_t exploded = 0;
  for (; const std::optional<Evaluation> robot = evaluator.next(); ++result.robots) {
    exploded += robot->end.exploded;
    if (robot->robot)
      result.evaluated += static_cast<double>(robot->robot->springs.size()) * static_cast<double>(robot->steps);
  }
  if (exploded > 0) std::fprintf(stderr, "%zu robots exploded\n", exploded);
  const EvaluationProgress progress = evaluator.progress();
  result.devices = progress.devices.size();
  result.start = progress.starting;
  result.grow = progress.making;
  result.check = progress.load.check;
  result.schedule = progress.load.schedule;
  result.upload = progress.load.upload;
  result.step = progress.stepping;
  result.read = progress.reading;
  for (const auto& device : progress.devices)
    result.busy += device.busy_seconds / static_cast<double>(progress.devices.size());
  return result;
}

// Boxes without air, with a random material per voxel: one topology. All of them are in one simulation.
Result load(const Options& options, const Row& row) {
  RandomVoxelOptions voxel;
  voxel.smallest = voxel.largest = {10, 10, 10};
  voxel.air = 0;
  voxel.patch = 1;
  voxel.mirror = Mirror::none;
  voxel.frequencies = 5;
  Result result{.robots = count_of(options, row)};
  auto starting = std::async(std::launch::async, [&] {
    const Stopwatch stopwatch(result.start);
    return Simulation(configuration_of(options, row));
  });
  const std::size_t portion = options.portion > 0 ? options.portion : result.robots;
  const auto grow = [&](std::size_t first) {
    const Stopwatch stopwatch(result.grow);
    std::vector<std::shared_ptr<const Robot>> robots;
    for (Robot& robot : random_voxel_robots(voxel, 1, std::min(portion, result.robots - first), first))
      robots.push_back(std::make_shared<const Robot>(std::move(robot)));
    return robots;
  };
  std::vector<std::shared_ptr<const Robot>> robots = grow(0);
  Simulation simulation = starting.get();
  for (std::size_t first = robots.size(); !robots.empty(); first += robots.size()) {
    auto next = std::async(std::launch::async, [&, first] { return grow(first); });
    simulation.add(robots);
    robots = next.get();
  }
  {
    const Stopwatch stopwatch(result.step);
    simulation.step(1);
  }
  const LoadTimes times = simulation.load_times();
  result.check = times.check;
  result.schedule = times.schedule;
  result.upload = times.upload;
  result.busy = simulation.busy_seconds();
  return result;
}

Result one_call(const Options& options, const Row& row) {
  const Configuration configuration = configuration_of(options, row);
  const Generator& generator = generator_named(row.kind);
  Result result{.robots = count_of(options, row)};
  std::vector<std::shared_ptr<const Robot>> robots(result.robots);
  {
    const Stopwatch stopwatch(result.grow);
    parallel_for(0, robots.size(),
                 [&](std::size_t i) { robots[i] = std::make_shared<Robot>(generator.make(row.values, "", 1, i)); });
  }
  Simulation simulation(configuration, robots);
  simulation.step(1);  // groups of the CPU are formed at the first step
  const double before = simulation.busy_seconds();
  const std::int64_t steps = std::llround(options.seconds / configuration.dt);
  {
    const Stopwatch stopwatch(result.step);
    simulation.step(steps);
  }
  result.busy = simulation.busy_seconds() - before;
  for (const auto& robot : robots)
    result.evaluated += static_cast<double>(robot->springs.size()) * static_cast<double>(steps);
  const LoadTimes times = simulation.load_times();
  result.check = times.check;
  result.schedule = times.schedule;
  result.upload = times.upload;
  return result;
}

// --- The parent: a process per row

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

void run_row(const Row& row, std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--row", row.name});
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const double start = wall_now();
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDOUT_FILENO);
    close(ends[0]);
    close(ends[1]);
    execv("/proc/self/exe", pointers.data());
    _exit(127);
  }
  close(ends[1]);
  std::FILE* const output = fdopen(ends[0], "r");
  Result r;
  const bool is_complete = scan(output, r);
  std::fclose(output);
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  const double whole = wall_now() - start;
  if (status != 0 || !is_complete) {
    std::printf("%-44s failed\n", row.title);
    return;
  }
  const double cpu = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  std::printf("%7zu %-36s %8.2f %8.1f | %6.2f %6.2f %6.2f %6.2f %6.2f %6.2f %6.2f | %4.0f %% of %zu  %.3g\n", r.robots,
              row.title, whole, cpu, r.start, r.grow, r.check, r.schedule, r.upload, r.step, r.read,
              100 * r.busy / whole, r.devices, r.busy > 0 ? r.evaluated / r.busy : 0);
  std::fflush(stdout);
}

Options options_from(int argc, char** argv) {
  Options options;
  const std::map<std::string, std::function<void(const std::string&)>> setters{
      {"--device", [&](const std::string& text) { options.device = text; }},
      {"--rows",
       [&](const std::string& text) {
         std::stringstream names(text);
         for (std::string name; std::getline(names, name, ',');) options.rows.push_back(name);
       }},
      {"--environment", [&](const std::string& text) { options.environment = text; }},
      {"--row", [&](const std::string& text) { options.row = text; }},
      {"--scale", [&](const std::string& text) { options.scale = std::stod(text); }},
      {"--seconds", [&](const std::string& text) { options.seconds = std::stod(text); }},
      {"--stream", [&](const std::string& text) { options.stream = std::stoul(text); }},
      {"--portion", [&](const std::string& text) { options.portion = std::stoul(text); }},
      {"--workers", [&](const std::string& text) { options.workers = std::stoi(text); }},
      {"--threads", [&](const std::string& text) { options.threads = std::stoi(text); }}};
  for (int i = 1; i < argc; i += 2) {
    const auto setter = setters.find(argv[i]);
    if (setter == setters.end() || i + 1 == argc) throw InputError(argv[i], "is not an option with a value");
    setter->second(argv[i + 1]);
  }
  return options;
}

int bench(const Options& options, const std::vector<std::string>& arguments) {
  for (const Row& row : rows())
    if (row.name == options.row) {
      print(row.in_one_call ? one_call(options, row) : row.to_first_step ? load(options, row) : evaluate(options, row));
      return 0;
    }
  std::printf(
      "seconds                                          whole      CPU |  start   grow  check  sched upload   step   "
      "read |  busy, springs/s\n");
  for (const Row& row : rows()) {
    const bool is_wanted = std::ranges::find(options.rows, row.name) != options.rows.end();
    // Without --rows, several devices are used only if CUDA was asked for.
    if (options.rows.empty() ? !row.all_devices || options.device.starts_with("cuda") : is_wanted)
      run_row(row, arguments);
  }
  return 0;
}

}  // namespace
}  // namespace mercury

int main(int argc, char** argv) {
  try {
    return mercury::bench(mercury::options_from(argc, argv), {argv, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_generation: %s\n", error.what());
    return 1;
  }
}
