// SPDX-License-Identifier: Apache-2.0
// mercury run: simulates without pictures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "app/base/messages.h"
#include "app/base/standard_streams.h"
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
#include "app/options/trial_options.h"
#include "app/recording/recorder.h"
#include "app/recording/repro.h"
#include "app/recording/trajectory_layout.h"
#include "mercury/simulation.h"

namespace mercury {
namespace {

constexpr double recorded_rate = 30;  // frames per second of simulated time, without --every

struct RunOptions {
  RobotOptions robots;
  SimulationOptions simulation;
  TrialSettings trials;
  OutputOptions output;
  std::string csv, record;
  std::optional<std::int64_t> every;
  bool compress = false;
  bool json = false, strict = false;
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

std::unique_ptr<Recorder> open_recorder(const RunOptions& options, const Simulation& simulation) {
  return std::make_unique<Recorder>(simulation, options.record,
                                    RecordingOptions{.every = recorded_every(options, simulation.configuration()),
                                                     .last_step = options.simulation.steps(),
                                                     .seed = options.robots.seed(),
                                                     .deflate = options.compress ? 1 : 0});
}

// Prints the results and writes the file, each even if the other fails: the simulation may have taken hours.
void publish(const RunOptions& options, const RunReport& report) {
  // A reader who leaves must not end the program before the file is written.
  std::optional<NoBrokenPipeSignal> no_signal;
  if (!options.csv.empty() && !is_standard_output(options.csv)) no_signal.emplace();
  std::exception_ptr problem;
  try {
    const std::string text = options.json ? json_of(report) : table_of(report);
    if (!is_standard_output(options.csv)) std::fwrite(text.data(), 1, text.size(), stdout);
    flush_standard_output();
  } catch (const std::exception&) {
    problem = std::current_exception();
  }
  if (!options.csv.empty()) write_results(options.csv, csv_of(report));
  if (problem) std::rethrow_exception(problem);
}

int report_results(const RunOptions& options, const RunReport& report) {
  publish(options, report);
  const std::size_t exploded = report.count(Fate::exploded), failed = report.count(Fate::failed);
  if (exploded > 0)
    warn(fmt::format("{} of {} robots exploded; a smaller --dt or --solver xpbd helps", exploded,
                     report.robots.size() - failed));
  if (report.interrupted) {
    warn(report.problem.empty() ? fmt::format("stopped at {:.6g} s", report.seconds) : report.problem);
    if (report.missing > 0)
      warn(fmt::format("{} robots did not come so far and are not in the report", report.missing));
    return 1;
  }
  return failed > 0 || (options.strict && exploded > 0) ? 1 : 0;
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
  if (options.trials.settle != 0) throw InputError("--settle", "does not work with a repro; give robots");
  const Repro repro = load_repro(file);
  Simulation simulation = start_of(repro, device);
  if (simulation.device_name() != repro.device_name)
    warn(fmt::format("the explosion of {} was seen on {}; this device, {}, may give another result", file.string(),
                     repro.device_name, simulation.device_name()));
  TrialSettings trials = options.trials;
  trials.seconds = options.simulation.seconds(0);
  if (trials.seconds == 0)
    trials.seconds = static_cast<double>(repro.last_step - simulation.steps()) * repro.configuration.dt;
  if (options.output.dry_run())
    return describe_work(options, repro.configuration, std::llround(trials.seconds / repro.configuration.dt),
                         file.string());
  ReproChanges changes(repro);
  return report_results(options, simulate(simulation, {{.index = 0, .name = repro.robot.name, .file = file.string()}},
                                          trials, {.changes = &changes}));
}

void print_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) warn(note);
}

// A recording needs all robots in one simulation.
int run_recorded(const RunOptions& options, const RobotSequence& robots, const Configuration& configuration,
                 const TrialSettings& trials) {
  GatheredRobots gathered = gather(robots);
  Simulation simulation(configuration, std::move(gathered.robots), shown_work());
  print_notes(simulation.notes());
  const std::unique_ptr<Recorder> recorder = open_recorder(options, simulation);
  RunReport report;
  try {
    report = simulate(simulation, std::move(gathered.identities), trials, {.recorder = recorder.get()});
  } catch (const DeviceError&) {
    recorder->finish_without_device();
    warn(fmt::format("{} holds the {} frames so far", options.record, recorder->frames()));
    throw;
  }
  add_failed(report, std::move(gathered.failed));
  const int status = report_results(options, report);
  recorder->finish();  // it may fail, so it comes last
  return status;
}

int run(const RunOptions& options) {
  prepare_outputs(options);
  if (options.json && is_standard_output(options.csv))
    throw InputError("--csv", options.csv + " and --json both mean standard output; give --csv a file");
  validate_recording(options);
  if (const auto file = options.robots.repro()) return run_repro(options, *file);
  options.simulation.configuration();  // errors in options come before those in files
  TrialSettings trials = options.trials;
  trials.seconds = options.simulation.seconds();
  validate(trials);
  const RobotSequence robots = options.robots.sequence();
  std::vector<std::string> notes;
  const Configuration configuration = options.simulation.configuration(robots.environments, notes);
  print_notes(notes);
  if (options.output.dry_run())
    return describe_work(options, configuration, options.simulation.steps(), size_text(robots));
  if (!options.record.empty()) return run_recorded(options, robots, configuration, trials);
  const RunReport report = evaluate(robots, configuration, trials);
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
  add_trial_options(*command, options->trials);
  options->simulation.add_to(*command);
  command->footer(
      "Distance is how far the centre of mass got from where it was after --settle; on land along the ground, so a "
      "fall\n"
      "counts for nothing. Speed is the length of its path divided by the time. Strain is the largest of any spring;\n"
      "\"> 50\" is the largest share of springs that had more than 50 % at the same time. Speed, work, height and "
      "strain\n"
      "are sampled every 0.05 s. docs/formats.md describes all columns of CSV and JSON.\n\n"
      "Examples:\n"
      "  mercury run --random voxel:64 --seed 1 --seconds 2\n"
      "  mercury run eel.json --record eel.h5 --every 10\n"
      "  mercury run eel.repro        (repeats an explosion that was seen in the window)\n"
      "  mercury run my-robots --environment land --solver xpbd --dt 0.005 --json > land.json");
  command->callback([options, choose] { choose([options] { return options->robots.status(run(*options)); }); });
}

}  // namespace mercury
