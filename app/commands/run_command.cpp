// SPDX-License-Identifier: Apache-2.0
// mercury run: simulates without pictures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/base/messages.h"
#include "app/base/progress.h"
#include "app/base/stepping.h"
#include "app/base/work_progress.h"
#include "app/commands/commands.h"
#include "app/commands/description.h"
#include "app/commands/dry_run.h"
#include "app/commands/results_file.h"
#include "app/commands/run_evaluation.h"
#include "app/options/option_values.h"
#include "app/options/output_options.h"
#include "app/options/robot_options.h"
#include "app/options/simulation_options.h"
#include "app/recording/recorder.h"
#include "app/recording/report.h"
#include "app/recording/repro.h"
#include "app/recording/trajectory_layout.h"
#include "mercury/simulation.h"

namespace mercury {
namespace {

constexpr double recorded_rate = 30;  // frames per second of simulated time, without --every

struct RunOptions {
  RobotOptions robots;
  SimulationOptions simulation;
  OutputOptions output;
  std::string csv, record;
  std::optional<std::int64_t> every;
  bool compress = false;
  bool json = false, strict = false;
};

double distance(Vec3 a, Vec3 b) { return length(a - b); }

// Samples the telemetry: the length of each robot's path, its largest strain, its largest share of strained springs.
class Observer {
 public:
  explicit Observer(const Simulation& simulation)
      : simulation_(simulation), start_(simulation.telemetry()), last_(start_), path_(start_.size(), 0.0),
        strain_(start_.size(), 0.0), strained_(start_.size(), 0.0) {
    observe(start_);
  }

  void observe() { observe(simulation_.telemetry()); }

  std::vector<RobotResult> results() const {
    std::vector<RobotResult> results;
    for (std::size_t i = 0; i < last_.size(); ++i) {
      const Robot& robot = simulation_.robot(i);
      const Telemetry& now = last_[i];
      results.push_back({.name = robot.name,
                         .masses = robot.masses.size(),
                         .springs = robot.springs.size(),
                         .displacement = distance(now.center_of_mass, start_[i].center_of_mass),
                         .mean_speed = simulation_.time() > 0 ? path_[i] / simulation_.time() : 0,
                         .largest_strain = strain_[i],
                         .strained_share = strained_[i],
                         .exploded = now.exploded,
                         .exploded_at = now.exploded_at,
                         .culprit_spring = now.culprit_spring,
                         .hash = simulation_.hash(i)});
    }
    return results;
  }

 private:
  void observe(const std::vector<Telemetry>& now) {
    for (std::size_t i = 0; i < now.size(); ++i) {
      path_[i] += distance(now[i].center_of_mass, last_[i].center_of_mass);
      strain_[i] = std::max(strain_[i], static_cast<double>(now[i].largest_strain));
      strained_[i] = std::max(strained_[i], static_cast<double>(now[i].strained_share));
    }
    last_ = now;
  }

  const Simulation& simulation_;
  std::vector<Telemetry> start_, last_;
  std::vector<double> path_, strain_, strained_;
};

// Throws InputError for files that cannot be written. Makes their folders.
void prepare_outputs(const RunOptions& options) {
  OutputFiles outputs = options.output.files();
  for (const std::filesystem::path& file : options.robots.files()) outputs.add_input(file);
  if (!options.csv.empty()) outputs.add_stream("--csv", options.csv);
  if (!options.record.empty()) {
    if (!is_trajectory_name(options.record))
      throw InputError("--record",
                       "\"" + options.record + "\" is not accepted; give a name that ends in .h5, .hdf5 or .h5md");
    outputs.add_file("--record", options.record);
  }
  outputs.check();
  if (!options.output.dry_run()) outputs.make_folders();
}

// Throws InputError for options that do not go together.
void validate_recording(const RunOptions& options) {
  if (options.every && *options.every < 1)
    throw InputError("--every", fmt::format("{} is not accepted; give a number of steps, 1 or more", *options.every));
  if (options.record.empty() && (options.every || options.compress))
    throw InputError(options.every ? "--every" : "--compress", "goes with --record FILE.h5");
}

// Steps between two frames.
std::int64_t recorded_every(const RunOptions& options, const Configuration& configuration) {
  const double usual = std::clamp(1 / (recorded_rate * configuration.dt), 1.0, 1e15);
  return options.every.value_or(static_cast<std::int64_t>(usual + 0.5));
}

std::unique_ptr<Recorder> open_recorder(const RunOptions& options, const Simulation& simulation, std::int64_t steps) {
  return std::make_unique<Recorder>(simulation, options.record,
                                    RecordingOptions{.every = recorded_every(options, simulation.configuration()),
                                                     .last_step = steps,
                                                     .seed = options.robots.seed(),
                                                     .deflate = options.compress ? 1 : 0});
}

RunReport simulate(Simulation& simulation, std::int64_t steps, Recorder* recorder, ReproChanges* changes = nullptr) {
  Stepper stepper(simulation);
  Observer observer(simulation);
  const std::int64_t first = simulation.steps();
  Progress progress("simulating", "steps", steps - first);
  const std::int64_t period = std::max<std::int64_t>(1, std::llround(sample_period / simulation.configuration().dt));
  bool on = true;
  while (on && simulation.steps() < steps) {
    if (changes) changes->apply(simulation);
    const std::int64_t sample = std::min(steps, (simulation.steps() / period + 1) * period);
    const std::int64_t stop = changes ? std::min(sample, changes->next_step()) : sample;
    on = stepper.advance_to(recorder ? std::min(stop, recorder->next_step()) : stop);
    if (recorder && on) recorder->observe();
    if (simulation.steps() == sample || !on) observer.observe();
    progress.update(simulation.steps() - first);
  }
  return {.configuration = simulation.configuration(),
          .device = simulation.device_name(),
          .steps = simulation.steps(),
          .seconds = simulation.time(),
          .wall_seconds = stepper.wall_seconds(),
          .interrupted = !on,
          .notes = simulation.notes(),
          .robots = observer.results()};
}

int report_results(const RunOptions& options, const RunReport& report) {
  // What can be printed is printed, even if the file then cannot be written.
  if (!is_standard_output(options.csv)) fmt::print("{}", options.json ? json_of(report) : table_of(report));
  if (!options.csv.empty()) write_results(options.csv, csv_of(report));

  const auto exploded = std::count_if(report.robots.begin(), report.robots.end(), [](auto& r) { return r.exploded; });
  if (exploded > 0)
    warn(
        fmt::format("{} of {} robots exploded; a smaller --dt or --solver xpbd helps", exploded, report.robots.size()));
  if (report.interrupted) {
    say(fmt::format("stopped at {:.6g} s", report.seconds));
    if (report.missing > 0)
      warn(fmt::format("{} robots did not come so far and are not in the report", report.missing));
    return 1;
  }
  return options.strict && exploded > 0 ? 1 : 0;
}

// Robots, or a repro, whose configuration and length are its own.
int describe_work(const RunOptions& options, const Configuration& configuration, std::int64_t steps,
                  const std::string& robots) {
  const std::int64_t every = recorded_every(options, configuration);
  return print_dry_run(
      "run", {{"robots", robots},
              {"simulate", time_text(configuration, steps)},
              {"in", environment_text(configuration)},
              {"by", solver_text(configuration)},
              {"on", device_text(configuration.device)},
              {"record",
               options.record.empty() ? "" : options.record + ": " + count_text(steps / every + 1, "frame", "frames")},
              {"write", options.csv},
              {"print", is_standard_output(options.csv) ? "CSV"
                        : options.json                  ? "JSON"
                                                        : "a table"}});
}

// Runs until the robot has exploded, or for --seconds from the start of the repro.
int run_repro(const RunOptions& options, const std::filesystem::path& file) {
  const Device device = options.simulation.configuration().device;
  if (options.simulation.configuration() != Configuration{.device = device})
    throw InputError(file.string(), "has its own configuration; give only --device, --threads and --seconds with it");
  if (!options.record.empty() || options.every) throw InputError("--record", "does not work with a repro; give robots");
  const Repro repro = load_repro(file);
  Simulation simulation = start_of(repro, device);
  if (simulation.device_name() != repro.device_name)
    warn(fmt::format("the explosion of {} was seen on {}; this device, {}, may give another result", file.string(),
                     repro.device_name, simulation.device_name()));
  const double seconds = options.simulation.seconds(0);
  const std::int64_t last =
      seconds > 0 ? simulation.steps() + std::llround(seconds / repro.configuration.dt) : repro.last_step;
  if (options.output.dry_run())
    return describe_work(options, repro.configuration, last - simulation.steps(), file.string());
  ReproChanges changes(repro);
  return report_results(options, simulate(simulation, last, nullptr, &changes));
}

void print_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) warn(note);
}

// A recording needs all robots in one simulation.
int run_recorded(const RunOptions& options, std::int64_t steps) {
  const LoadedRobots loaded = options.robots.load(recorded_memory);
  std::vector<std::string> notes;
  Simulation simulation(options.simulation.configuration(loaded.environments, notes), loaded.robots, shown_work());
  print_notes(notes);
  print_notes(simulation.notes());
  const std::unique_ptr<Recorder> recorder = open_recorder(options, simulation, steps);
  const RunReport report = simulate(simulation, steps, recorder.get());
  recorder->finish();
  return report_results(options, report);
}

int run(const RunOptions& options) {
  prepare_outputs(options);
  if (const auto file = options.robots.repro()) return run_repro(options, *file);
  options.simulation.configuration();  // errors in options come before those in files
  const std::int64_t steps = options.simulation.steps();
  validate_recording(options);
  if (!options.record.empty() && !options.output.dry_run()) return run_recorded(options, steps);
  const RobotSequence robots = options.robots.sequence();
  std::vector<std::string> notes;
  const Configuration configuration = options.simulation.configuration(robots.environments, notes);
  print_notes(notes);
  if (options.output.dry_run()) return describe_work(options, configuration, steps, size_text(robots));
  const RunReport report = evaluate(robots, configuration, steps);
  print_notes(report.notes);
  return report_results(options, report);
}

}  // namespace

void add_run_command(CLI::App& program, const Choose& choose) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = program.add_subcommand("run", "Simulate robots and print a table or JSON");
  options->robots.add_to(*command);
  command->get_option("ROBOTS")->description(
      "Robot files (.json, .cbor) and folders of them, or an explosion that the window saved (.repro)");
  add_text(*command, "--csv", options->csv,
           "Also write one line per robot to this file; - prints it instead of the table", "FILE");
  add_text(*command, "--record", options->record, "Record positions and velocities of all masses (HDF5, H5MD 1.1)",
           "FILE.h5");
  add_number(*command, "--every", options->every, "Steps between two recorded frames (default: 1/30 s)", "N");
  options->output.add_to(*command);
  command->add_flag("--compress", options->compress, "Compress the recording (smaller, but slower)");
  command->add_flag("--json", options->json, "Print JSON instead of a table");
  command->add_flag("--strict", options->strict, "Exit with status 1 if a robot explodes");
  options->simulation.add_to(*command);
  command->footer(
      "Displacement is the distance of the centre of mass from its start. Speed is the length of its path divided by\n"
      "the time. Strain is the largest of any spring; \"> 50\" is the largest share of springs that had more than 50 "
      "%\n"
      "at the same time. Speed and strain are sampled every 0.1 s.\n\n"
      "Examples:\n"
      "  mercury run --random voxel:64 --seed 1 --seconds 2\n"
      "  mercury run eel.json --record eel.h5 --every 10\n"
      "  mercury run eel.repro        (repeats an explosion that was seen in the window)\n"
      "  mercury run my-robots --environment land --solver xpbd --dt 0.005 --json > land.json");
  command->callback([options, choose] { choose([options] { return options->robots.status(run(*options)); }); });
}

}  // namespace mercury
