// SPDX-License-Identifier: Apache-2.0
// mercury bench: springs evaluated per second, the measure that the paper uses.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/base/messages.h"
#include "app/commands/commands.h"
#include "app/commands/results_file.h"
#include "app/options/option_values.h"
#include "app/options/output_options.h"
#include "app/options/simulation_options.h"
#include "app/recording/configuration_json.h"
#include "mercury/random_voxel.h"
#include "mercury/simulation.h"

namespace mercury {
namespace {

struct BenchOptions {
  SimulationOptions simulation;
  OutputOptions output;
  std::vector<int> size{10, 10, 10};
  std::size_t count = 0;  // 0 = chosen by choose_count()
  std::uint64_t seed = 1;
  double least_seconds = 1;  // of device time to measure
  bool json = false, sweep = false;
  std::string csv;
};

struct Measurement {
  std::size_t robots = 0, masses = 0, springs = 0;  // of the whole batch
  std::int64_t steps = 0;
  double seconds = 0;              // on the device
  double making = 0, loading = 0;  // time to make the robots; to load the batch and make its first step [s]
  double limit = 0;                // springs per second that the device can reach at most, 0 = unknown
  std::uint64_t hash = 0;          // of the first robot, after `steps_hashed` steps
  std::string device;
  Configuration configuration;

  std::int64_t longest_call = 0;  // steps

  double evaluated() const { return static_cast<double>(springs) * static_cast<double>(steps); }
  double springs_per_second() const { return evaluated() / seconds; }
};

constexpr std::int64_t steps_hashed = 100;
constexpr std::int64_t sweep_steps = 1000;  // per call in a sweep

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// Boxes without air, with a random material per voxel.
std::vector<std::shared_ptr<const Robot>> make_robots(const BenchOptions& options, std::size_t count) {
  RandomVoxelOptions voxel;
  voxel.smallest = voxel.largest = {options.size[0], options.size[1], options.size[2]};
  voxel.air = 0;
  voxel.patch = 1;
  voxel.mirror = Mirror::none;
  voxel.frequencies = 5;
  std::vector<std::shared_ptr<const Robot>> robots;
  for (Robot& robot : random_voxel_robots(voxel, options.seed, count))
    robots.push_back(std::make_shared<const Robot>(std::move(robot)));
  return robots;
}

// Chooses a number of robots that keeps the device busy: several times what it steps at once.
std::size_t choose_count(const BenchOptions& options, const Configuration& configuration) {
  if (options.count > 0) return options.count;
  const auto one = make_robots(options, 1).front();
  constexpr double springs_wanted = 7.5e6;
  const Simulation probe(configuration, std::vector(512, one));
  const std::size_t at_once = std::max<std::size_t>(1, probe.robots_at_once());
  if (configuration.device.kind == DeviceKind::cpu || probe.spring_limit() == 0) return 4 * at_once;
  const double rounds = springs_wanted / static_cast<double>(one->springs.size() * at_once);
  return at_once * static_cast<std::size_t>(std::max(2.0, std::round(rounds)));
}

// Warms up, then steps until at least `least_seconds` of device time are measured.
Measurement measure(const BenchOptions& options, const Configuration& configuration, std::size_t count) {
  Measurement result;
  double start = now();
  const auto robots = make_robots(options, count);
  result.making = now() - start;
  start = now();
  Simulation simulation(configuration, robots);
  simulation.step(1);
  result.loading = now() - start;
  simulation.step(steps_hashed - 1);
  result.hash = simulation.hash(0);
  result.robots = count;
  result.masses = simulation.mass_count();
  for (const auto& robot : robots) result.springs += robot->springs.size();
  result.limit = simulation.spring_limit();
  result.device = simulation.device_name();
  result.configuration = configuration;

  std::int64_t steps = options.sweep ? sweep_steps : 10;
  double before = simulation.busy_seconds();
  while (result.seconds < options.least_seconds) {
    simulation.step(steps);
    const double after = simulation.busy_seconds();
    result.seconds += after - before;
    result.steps += steps;
    result.longest_call = std::max(result.longest_call, steps);
    before = after;
    if (options.sweep) continue;
    const double seconds_per_step = result.seconds / static_cast<double>(result.steps);
    steps = std::clamp(static_cast<std::int64_t>(0.5 * options.least_seconds / seconds_per_step), std::int64_t{1},
                       std::int64_t{1000000});
  }
  return result;
}

std::string share_of_limit(const Measurement& m) {
  return m.limit > 0 ? fmt::format("{:.0f} %", 100 * m.springs_per_second() / m.limit) : "unknown";
}

std::string table_of(const Measurement& m) {
  std::string text;
  const auto row = [&](const char* name, const std::string& value) { text += fmt::format("{:<22}{}\n", name, value); };
  row("device", m.device);
  row("solver, environment",
      fmt::format("{}, {}", name_of(m.configuration.solver), name_of(m.configuration.environment)));
  row("robots", fmt::format("{} of {} masses, {} springs", m.robots, m.masses / m.robots, m.springs / m.robots));
  row("steps", fmt::format("{} in {:.3f} s on the device", m.steps, m.seconds));
  row("springs per second", fmt::format("{:.3e}", m.springs_per_second()));
  row("share of the limit", share_of_limit(m));
  row("robots made, loaded", fmt::format("{:.2f} s, {:.2f} s", m.making, m.loading));
  row("state hash", fmt::format("{:016x} (robot 0 after {} steps)", m.hash, steps_hashed));
  return text;
}

nlohmann::ordered_json json_of(const Measurement& m) {
  nlohmann::ordered_json json{{"device", m.device},
                              {"configuration", json_of(m.configuration)},
                              {"robots", m.robots},
                              {"masses_per_robot", m.masses / m.robots},
                              {"springs_per_robot", m.springs / m.robots},
                              {"steps", m.steps},
                              {"device_seconds", m.seconds},
                              {"springs_per_second", m.springs_per_second()},
                              {"making_seconds", m.making},
                              {"loading_seconds", m.loading},
                              {"hash", fmt::format("{:016x}", m.hash)},
                              {"hash_steps", steps_hashed}};
  json["limit_springs_per_second"] = m.limit > 0 ? nlohmann::ordered_json(m.limit) : nlohmann::ordered_json();
  return json;
}

// springs_evaluated: in one call of step(), which makes 1000 steps in a sweep.
constexpr const char* csv_head =
    "device,solver,environment,robots,masses_per_robot,springs_per_robot,steps,device_seconds,springs_evaluated,"
    "springs_per_second\n";

std::string csv_row(const Measurement& m) {
  return fmt::format("\"{}\",{},{},{},{},{},{},{:.6g},{:.6g},{:.6g}\n", m.device, name_of(m.configuration.solver),
                     name_of(m.configuration.environment), m.robots, m.masses / m.robots, m.springs / m.robots, m.steps,
                     m.seconds, static_cast<double>(m.springs) * static_cast<double>(m.longest_call),
                     m.springs_per_second());
}

// Measures 1, 2, 4, ... robots until the memory of the device is full (paper, figure 4).
std::vector<Measurement> sweep(const BenchOptions& options, const Configuration& configuration) {
  std::vector<Measurement> all;
  const std::size_t most = options.count > 0 ? options.count : std::size_t{1} << 20;
  for (std::size_t count = 1; count <= most; count *= 2) {
    try {
      all.push_back(measure(options, configuration, count));
    } catch (const DeviceError& error) {
      if (all.empty()) throw;
      warn(fmt::format("the sweep stops before {} robots: {}", count, error.what()));
      break;
    }
    say(fmt::format("{:>8} robots  {:.3e} springs/s", count, all.back().springs_per_second()));
  }
  return all;
}

int bench(const BenchOptions& options) {
  const Configuration configuration = options.simulation.configuration();
  require_positive("--least-seconds", options.least_seconds, "s");
  OutputFiles outputs = options.output.files();
  if (!options.csv.empty()) outputs.add_stream("--csv", options.csv);
  outputs.check();
  outputs.make_folders();
  const std::vector<Measurement> all =
      options.sweep ? sweep(options, configuration)
                    : std::vector{measure(options, configuration, choose_count(options, configuration))};
  std::string csv = csv_head;
  for (const Measurement& m : all) csv += csv_row(m);
  if (is_standard_output(options.csv)) {
    fmt::print("{}", csv);
  } else if (options.json) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const Measurement& m : all) json.push_back(json_of(m));
    fmt::print("{}\n", (options.sweep ? json : json.front()).dump(2));
  } else if (options.sweep) {
    fmt::print("{}", csv);
  } else {
    fmt::print("{}", table_of(all.front()));
  }
  if (!options.csv.empty() && !is_standard_output(options.csv)) write_results(options.csv, csv);
  return 0;
}

}  // namespace

void add_bench_command(CLI::App& program, const Choose& choose) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* command = program.add_subcommand("bench", "Measure springs evaluated per second");
  add_value(*command, "--size", options->size, "Size of a robot in voxels; each voxel has a random material", "XxYxZ",
            [](const std::string& name, const std::string& text) { return sizes_from(name, text, 3, "XxYxZ"); });
  add_number(*command, "--count", options->count,
             "Number of robots (default: several times what the device steps at once)", "N");
  add_number(*command, "--seed", options->seed, "Seed of the robots", "S");
  add_number(*command, "--least-seconds", options->least_seconds, "Shortest time to measure, after a warm-up",
             "SECONDS");
  command->add_flag("--json", options->json, "Print JSON instead of a table");
  command->add_flag("--sweep", options->sweep,
                    "Measure 1, 2, 4, ... robots, until the memory is full or --count is reached");
  add_text(*command, "--csv", options->csv, "Also write the measurements to this file (bench/plot.py draws it)",
           "FILE");
  options->output.add_force_to(*command);
  options->simulation.add_to(*command);
  command->footer(
      "Springs per second = robots x springs x steps / time. The time covers whole steps (muscles, springs,\n"
      "environment, contact, integration) on the device. It does not cover the upload.\n\n"
      "Examples:\n"
      "  mercury bench --environment land --solver xpbd\n"
      "  mercury bench --size 5x5x5 --json\n"
      "  mercury bench --sweep --csv sweep.csv && bench/plot.py sweep.csv -o sweep.png");
  command->callback([options, choose] { choose([options] { return bench(*options); }); });
}

}  // namespace mercury
