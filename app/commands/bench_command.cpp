// SPDX-License-Identifier: Apache-2.0
// mercury bench: springs evaluated per second, the measure that the paper uses.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/base/progress.h"
#include "app/base/standard_streams.h"
#include "app/commands/description.h"
#include "app/options/command.h"
#include "app/options/generator_options.h"
#include "app/options/option_values.h"
#include "app/options/output_options.h"
#include "app/options/simulation_options.h"
#include "app/recording/configuration_json.h"
#include "mercury/error.h"
#include "mercury/host_memory.h"
#include "mercury/random_voxel.h"
#include "mercury/real_body.h"
#include "mercury/simulation.h"
#include "mercury/stopwatch.h"

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
  GeneratorOptions bodies;
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

// Boxes without air, with a random material per voxel; of real bodies, per robot, so that they have as many springs.
// Throws Interrupted after Ctrl-C.
std::vector<std::shared_ptr<const Robot>> make_robots(const BenchOptions& options, std::size_t count) {
  constexpr std::size_t at_once = 128;
  const std::optional<RealMaterial> material = real_material_in(options.bodies.values());
  RandomVoxelOptions voxel;
  voxel.smallest = voxel.largest = {options.size[0], options.size[1], options.size[2]};
  voxel.air = 0;
  voxel.patch = material ? std::ranges::max(options.size) : 1;
  voxel.mirror = Mirror::none;
  voxel.frequencies = 5;
  std::vector<std::shared_ptr<const Robot>> robots;
  const WorkWatch watch = shown_work();
  while (robots.size() < count) {
    for (Robot& robot :
         random_voxel_robots(voxel, options.seed, std::min(at_once, count - robots.size()), robots.size()))
      robots.push_back(std::make_shared<const Robot>(material ? with_real_body(robot, *material) : std::move(robot)));
    watch("making robots", robots.size(), count);
  }
  return robots;
}

// What one robot of the batch takes of the host's memory [bytes].
std::size_t bytes_per_robot(const Robot& robot, bool on_cpu) {
  const auto content = static_cast<double>(content_bytes(robot));
  return on_cpu ? simulated_memory.per_robot + static_cast<std::size_t>(simulated_memory.per_content * content)
                : static_cast<std::size_t>(1.1 * content);
}

// What all need to know of the device before robots are made.
struct Probe {
  std::size_t count = 0;      // robots to measure without --sweep
  std::size_t per_robot = 0;  // [bytes]
  bool on_cpu = false;
};

// Chooses a number of robots that keeps the device busy: several times what it steps at once.
Probe probe(const BenchOptions& options, const Configuration& configuration) {
  const auto one = make_robots(options, 1).front();
  constexpr double springs_wanted = 7.5e6;
  const Simulation simulation(configuration, std::vector(512, one), shown_work());
  const std::size_t at_once = std::max<std::size_t>(1, simulation.robots_at_once());
  Probe result{.count = options.count, .on_cpu = simulation.device_name().starts_with("CPU")};
  result.per_robot = bytes_per_robot(*one, result.on_cpu);
  if (result.count > 0) return result;
  const double rounds = springs_wanted / static_cast<double>(one->springs.size() * at_once);
  result.count = result.on_cpu ? 4 * at_once : at_once * static_cast<std::size_t>(std::max(2.0, std::round(rounds)));
  return result;
}

// Makes this number of steps in calls of less than a second. Returns how many it made: fewer only after Ctrl-C.
std::int64_t advance(Simulation& simulation, std::int64_t steps, double seconds_per_step) {
  constexpr double longest = 0.2;  // [s]
  const auto portion = static_cast<std::int64_t>(std::clamp(longest / seconds_per_step, 1.0, 1e9));
  std::int64_t made = 0;
  for (; made < steps && !interrupted(); made += std::min(portion, steps - made))
    simulation.step(std::min(portion, steps - made));
  return made;
}

// Warms up, then steps until at least `least_seconds` of device time are measured, or until Ctrl-C. Throws Interrupted
// if nothing has been measured by then.
Measurement measure(const BenchOptions& options, const Configuration& configuration, std::size_t count) {
  Measurement result;
  double start = wall_now();
  const auto robots = make_robots(options, count);
  result.making = wall_now() - start;
  start = wall_now();
  Simulation simulation(configuration, robots, shown_work());
  simulation.step(1);
  result.loading = wall_now() - start;
  constexpr std::int64_t first_steps = 4;  // show how long a step takes
  double before = simulation.busy_seconds();
  simulation.step(first_steps);
  double seconds_per_step = (simulation.busy_seconds() - before) / first_steps;
  advance(simulation, steps_hashed - 1 - first_steps, seconds_per_step);
  throw_if_interrupted();
  result.hash = simulation.hash(0);
  result.robots = count;
  result.masses = simulation.mass_count();
  for (const auto& robot : robots) result.springs += robot->springs.size();
  result.limit = simulation.spring_limit();
  result.device = simulation.device_name();
  result.configuration = configuration;

  std::int64_t steps = options.sweep ? sweep_steps : 10;
  before = simulation.busy_seconds();
  Progress progress("measuring", "ms", static_cast<std::int64_t>(1000 * options.least_seconds));
  while (result.seconds < options.least_seconds && !interrupted()) {
    const std::int64_t made = advance(simulation, steps, seconds_per_step);
    const double after = simulation.busy_seconds();
    result.seconds += after - before;
    result.steps += made;
    result.longest_call = std::max(result.longest_call, steps);
    before = after;
    progress.update(static_cast<std::int64_t>(1000 * std::min(result.seconds, options.least_seconds)));
    seconds_per_step = result.seconds / static_cast<double>(std::max<std::int64_t>(1, result.steps));
    if (!options.sweep)
      steps = std::clamp(static_cast<std::int64_t>(0.5 * options.least_seconds / seconds_per_step), std::int64_t{1},
                         std::int64_t{1000000});
  }
  if (result.steps == 0) throw Interrupted();
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

// Takes measurements as they come: rows of CSV go out at once, so that they are there whatever happens later.
class Results {
 public:
  explicit Results(const BenchOptions& options)
      : options_(options), prints_rows_(is_standard_output(options.csv) || (options.sweep && !options.json)) {
    if (prints_rows_) print(csv_head);
  }

  void add(const Measurement& measurement) {
    all_.push_back(measurement);
    csv_ += csv_row(measurement);
    if (prints_rows_) print(csv_row(measurement));
    std::error_code ignored;
    const bool is_special =
        std::filesystem::exists(file_, ignored) && !std::filesystem::is_regular_file(file_, ignored);
    if (writes_file() && !is_special) write();
  }

  // Prints what the rows did not.
  void finish() {
    if (!prints_rows_ && options_.json) {
      nlohmann::ordered_json json = nlohmann::ordered_json::array();
      for (const Measurement& m : all_) json.push_back(json_of(m));
      print((options_.sweep ? json : json.front()).dump(2) + "\n");
    } else if (!prints_rows_) {
      print(table_of(all_.front()));
    }
    if (writes_file()) write();
  }

  bool empty() const { return all_.empty(); }
  bool renamed() const { return file_ != options_.csv; }  // since another program has taken the name

 private:
  static void print(const std::string& text) {
    fmt::print("{}", text);
    flush_results_so_far();
  }
  bool writes_file() const { return !file_.empty() && !is_standard_output(file_); }
  void write() {
    file_ = name_given(file_, [&] { write_results(file_, csv_); }).string();
  }

  const BenchOptions& options_;
  std::string file_ = options_.csv;
  bool prints_rows_;
  std::vector<Measurement> all_;
  std::string csv_ = csv_head;
};

// Measures 1, 2, 4, ... robots until the memory of the device is full (paper, figure 4), or a quarter of a CPU's.
void sweep(const BenchOptions& options, const Configuration& configuration, const Probe& probed, Results& results) {
  const std::size_t most = options.count > 0 ? options.count : std::size_t{1} << 20;
  const std::size_t usable = usable_host_memory() / (probed.on_cpu ? 4 : 1);
  for (std::size_t count = 1; count <= most && !interrupted(); count *= 2) try {
      if (!results.empty() && count * probed.per_robot > usable)
        throw DeviceError(memory_line(count * probed.per_robot, usable));
      const Measurement measured = measure(options, configuration, count);
      results.add(measured);
      say(fmt::format("{:>8} robots  {:.3e} springs/s", count, measured.springs_per_second()));
    } catch (const DeviceError& error) {
      if (results.empty()) throw;
      return warn(fmt::format("the sweep stops before {} robots: {}", count, error.what()));
    } catch (const Interrupted&) {
      return;
    }
}

int bench(const BenchOptions& options) {
  const Configuration configuration =
      options.simulation.configuration(real_material_in(options.bodies.values()) ? Physics::real : Physics::paper);
  constexpr double longest = 1e6;  // [s]
  if (!(options.least_seconds > 0 && options.least_seconds <= longest))
    throw InputError("--least-seconds", fmt::format("{} is not accepted; give a number above 0, at most {:.0f} s",
                                                    options.least_seconds, longest));
  OutputFiles outputs = options.output.files();
  if (!options.csv.empty()) outputs.add_stream("--csv", options.csv);
  outputs.check();
  outputs.make_folders();
  Results results(options);
  const Probe probed = probe(options, configuration);
  if (options.sweep) {
    sweep(options, configuration, probed, results);
  } else {
    const std::size_t usable = usable_host_memory(), needed = probed.count * probed.per_robot;
    if (needed > usable)
      throw InputError("--count", memory_line(needed, usable, fmt::format("up to {}", usable / probed.per_robot)));
    results.add(measure(options, configuration, probed.count));
  }
  if (results.empty()) throw_if_interrupted();
  results.finish();
  return interrupted() || results.renamed() ? 1 : 0;
}

}  // namespace

void add_bench_command(const Command& program, const Choose& choose) {
  auto options = std::make_shared<BenchOptions>();
  const Command command = program.add_command("bench", "Measure springs evaluated per second");
  add_value(command, "--size", options->size, "Size of a robot in voxels; each voxel has a random material", "XxYxZ",
            [](const std::string& name, const std::string& text) { return sizes_from(name, text, 3, "XxYxZ"); })
      .on_first_screen();
  add_number(command, "--count", options->count,
             "Number of robots (default: several times what the device steps at once)", "N")
      .on_first_screen();
  add_number(command, "--seed", options->seed, "Seed of the robots", "S");
  add_number(command, "--least-seconds", options->least_seconds, "Shortest time to measure, after a warm-up",
             "SECONDS");
  options->bodies.add_bodies_to(command);
  command.add_flag("--json", options->json, "Print JSON instead of a table").on_first_screen();
  command
      .add_flag("--sweep", options->sweep,
                "Measure 1, 2, 4, ... robots, until a GPU is full, a quarter of a CPU's memory, or --count is reached")
      .on_first_screen();
  add_text(command, "--csv", options->csv, "Also write the measurements to this file (bench/plot.py draws it)", "FILE")
      .on_first_screen();
  options->output.add_force_to(command);
  options->simulation.add_to(command);
  command.set_footer(
      "Springs per second = robots x springs x steps / time. The time covers whole steps (muscles, springs,\n"
      "environment, contact, integration) on the device. It does not cover the upload.\n\n"
      "Examples:\n"
      "  mercury bench --environment land --solver xpbd\n"
      "  mercury bench --size 5x5x5 --json\n"
      "  mercury bench --sweep --csv sweep.csv && bench/plot.py sweep.csv -o sweep.png");
  command.when_chosen([options, choose] { choose([options] { return bench(*options); }); });
}

}  // namespace mercury
