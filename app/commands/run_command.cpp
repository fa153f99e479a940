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
#include "app/base/progress.h"
#include "app/base/standard_streams.h"
#include "app/commands/description.h"
#include "app/commands/run_evaluation.h"
#include "app/options/command.h"
#include "app/options/option_values.h"
#include "app/options/output_options.h"
#include "app/options/parameter_options.h"
#include "app/options/robot_options.h"
#include "app/options/simulation_options.h"
#include "app/options/trial_start.h"
#include "app/recording/recorder.h"
#include "app/recording/repro.h"
#include "app/recording/trajectory_layout.h"
#include "mercury/cuda_devices.h"
#include "mercury/simulation.h"

namespace mercury {
namespace {

constexpr double recorded_rate = 30;      // frames per second of simulated time, without --every
constexpr double checkpoint_period = 60;  // [s], without --checkpoint-every

struct RunOptions {
  RobotOptions robots;
  SimulationOptions simulation;
  TrialSettings trials = one_trial();
  OutputOptions output;
  std::string csv, record, checkpoint;
  std::string resume;    // the checkpoint to go on from; empty = none
  bool goes_on = false;  // --resume
  std::optional<std::int64_t> every;
  std::optional<double> rate;  // --fps, instead of --every
  std::optional<double> checkpoint_every;
  bool compress = false;
  bool brains = false;  // in the recording, too
  bool json = false, strict = false;
  std::optional<Command> typed;  // the command line
};

void require_trajectory_name(const char* option, const std::string& name) {
  if (!is_trajectory_name(name))
    throw InputError(option, "\"" + name + "\" is not accepted; give a name that ends in .h5, .hdf5 or .h5md");
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  return std::filesystem::weakly_canonical(a, error) == std::filesystem::weakly_canonical(b, error);
}

// Throws InputError for files that cannot be written. Makes their folders. A resumed run may replace its own checkpoint
// and its recording (`continued`, may be empty).
void prepare_outputs(const RunOptions& options, const std::string& continued = {}) {
  OutputFiles outputs = options.output.files();
  for (const std::filesystem::path& file : options.robots.files()) outputs.add_input(file);
  if (!options.csv.empty()) outputs.add_stream("--csv", options.csv);
  if (!options.record.empty()) {
    require_trajectory_name("--record", options.record);
    if (continued.empty() || !is_same_file(options.record, continued)) outputs.add_file("--record", options.record);
  }
  if (!options.checkpoint.empty()) {
    require_trajectory_name("--checkpoint", options.checkpoint);
    if (options.resume.empty() || !is_same_file(options.checkpoint, options.resume))
      outputs.add_file("--checkpoint", options.checkpoint);
  }
  outputs.check();
  if (!options.output.dry_run()) outputs.make_folders();
}

// The first option that says how to record; nullptr = none was given.
const char* way_of_recording(const RunOptions& options) {
  return options.every      ? "--every"
         : options.rate     ? "--fps"
         : options.brains   ? "--brains"
         : options.compress ? "--compress"
                            : nullptr;
}

// Throws InputError for options that do not go together.
void validate_recording(const RunOptions& options) {
  if (options.every && *options.every < 1)
    throw InputError("--every", fmt::format("{} is not accepted; give a number of steps, 1 or more", *options.every));
  if (options.every && options.rate) throw InputError("--fps", "not together with --every, which counts steps");
  if (const char* option = way_of_recording(options); options.record.empty() && option)
    throw InputError(option, "goes with --record FILE.h5");
  if (options.checkpoint_every && options.checkpoint.empty())
    throw InputError("--checkpoint-every", "goes with --checkpoint FILE.h5");
  if (options.checkpoint_every && !(*options.checkpoint_every >= 0 && std::isfinite(*options.checkpoint_every)))
    throw InputError("--checkpoint-every",
                     fmt::format("{} is not accepted; give seconds, 0 or more", *options.checkpoint_every));
}

// Steps between two frames.
std::int64_t recorded_every(const RunOptions& options, const Configuration& configuration) {
  const double usual = std::clamp(1 / (recorded_rate * configuration.dt), 1.0, 1e15);
  return options.every.value_or(static_cast<std::int64_t>(usual + 0.5));
}

RecordingOptions recording_options(const RunOptions& options, const Configuration& configuration) {
  return {.every = recorded_every(options, configuration),
          .rate = options.rate,
          .last_step = std::llround(options.trials.seconds / configuration.dt),
          .seed = options.robots.seed(),
          .brains = options.brains,
          .deflate = options.compress ? 1 : 0};
}

// Null if none is wanted, or if the disk is full already.
std::unique_ptr<Recorder> open_recorder(const RunOptions& options, const Simulation& simulation) {
  if (options.record.empty()) return nullptr;
  try {
    return std::make_unique<Recorder>(simulation, options.record,
                                      recording_options(options, simulation.configuration()));
  } catch (const RecordingFailure& failure) {  // tables may go elsewhere
    warn_without_recording(failure);
    return nullptr;
  }
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
  if (const std::size_t undefined = report.count(Fate::undefined); undefined > 0)
    warn(fmt::format("the distance is not a finite number for {} of {} robots, which are not sound", undefined,
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
  const FramePlaces places = options.rate ? FramePlaces(0, *options.rate, configuration.dt)
                                          : FramePlaces(0, recorded_every(options, configuration));
  return print_dry_run(
      "run",
      {{"robots", robots},
       {"simulate", time_text(configuration, steps) +
                        (options.trials.trials > 1 ? fmt::format(", {} trials", options.trials.trials) : "")},
       {"in", environment_text(configuration)},
       {"by", solver_text(configuration)},
       {"on", device_text(configuration.device)},
       {"record", options.record.empty() ? ""
                                         : options.record + ": " + count_text(places.count(steps), "frame", "frames") +
                                               (options.brains ? ", with senses and neurons" : "")},
       {"checkpoint", options.checkpoint},
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
  if (!options.record.empty()) throw InputError("--record", "does not work with a repro; give robots");
  if (options.trials.settle != 0) throw InputError("--settle", "does not work with a repro; give robots");
  if (options.trials.trials != 1) throw InputError("--trials", "does not work with a repro; give robots");
  if (options.trials.jitter != 0) throw InputError("--jitter", "does not work with a repro; give robots");
  if (!options.checkpoint.empty()) throw InputError("--checkpoint", "does not work with a repro; give robots");
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

// What a checkpoint notes besides the robots' states.
CheckpointNotes notes_of(const RunOptions& options, const Configuration& configuration, const TrialSettings& trials,
                         std::span<const RobotIdentity> identities, std::span<const RobotResult> failed) {
  CheckpointNotes notes{.seconds = trials.seconds,
                        .settle = trials.settle,
                        .strain_limit = trials.strain_limit,
                        .folding = trials.folding,
                        .upright = trials.upright,
                        .seed = options.robots.seed()};
  for (const RobotIdentity& identity : identities) notes.robots.push_back(checkpoint_robot_of(identity));
  for (const RobotResult& robot : failed) notes.failed.push_back(checkpoint_robot_of(robot.identity, robot.failure));
  if (!options.record.empty())
    notes.recording = {.path = std::filesystem::absolute(options.record).string(),
                       .every = recorded_every(options, configuration),
                       .rate = options.rate,
                       .compressed = options.compress,
                       .brains = options.brains};
  return notes;
}

// Runs to the end, with a recording and checkpoints if they are wanted. `work` simulates.
template <class Work>
int run_watched(const RunOptions& options, std::unique_ptr<Recorder> recorder, std::optional<Checkpoints> checkpoints,
                std::vector<RobotResult> failed, const Work& work) {
  UnsavedResults results;
  results.begin();
  RunReport report;
  try {
    report = work(StepObservers{.recorder = recorder.get(), .checkpoints = checkpoints ? &*checkpoints : nullptr});
  } catch (const DeviceError&) {
    if (recorder && !recorder->failed()) {
      recorder->finish_without_device();
      warn(fmt::format("{} holds the {} frames so far", options.record, recorder->frames()));
    }
    throw;
  }
  add_failed(report, std::move(failed));
  // The recording first, so that it is kept whatever becomes of what is printed, and results are printed even if it
  // fails.
  std::exception_ptr problem;
  try {
    if (recorder && !recorder->failed()) recorder->finish();
  } catch (const RecordingFailure& failure) {
    warn(failure.what());
  } catch (const std::exception&) {
    problem = std::current_exception();
  }
  const int status = report_results(options, report);
  if (problem) std::rethrow_exception(problem);
  const bool recorded = options.record.empty() || (recorder && !recorder->failed());
  const bool incomplete = !recorded || (checkpoints && checkpoints->failed());
  return incomplete ? std::max(status, 1) : status;
}

std::optional<Checkpoints> checkpoints_of(const RunOptions& options, CheckpointNotes notes) {
  if (options.checkpoint.empty()) return {};
  return Checkpoints(options.checkpoint, options.checkpoint_every.value_or(checkpoint_period), std::move(notes));
}

// A recording and checkpoints need all robots in one simulation.
int run_in_one(const RunOptions& options, const RobotSequence& robots, const Configuration& configuration,
               const TrialSettings& trials, std::uint64_t seed) {
  GatheredRobots gathered = gather(robots);
  Simulation simulation(configuration, std::move(gathered.robots), shown_work());
  print_notes(simulation.notes());
  if (const TrialStart start{trials, seed}; start.is_elsewhere()) begin_at(simulation, start);
  std::optional<Checkpoints> checkpoints =
      checkpoints_of(options, notes_of(options, configuration, trials, gathered.identities, gathered.failed));
  return run_watched(options, open_recorder(options, simulation), std::move(checkpoints), std::move(gathered.failed),
                     [&](const StepObservers& observers) {
                       return simulate(simulation, std::move(gathered.identities), trials, observers);
                     });
}

// Throws InputError for options that a checkpoint has already.
void validate_resume(const RunOptions& options) {
  const Device device = options.simulation.configuration().device;
  if (!options.robots.empty())
    throw InputError("--resume", "goes on with the robots of " + options.resume + "; give no others");
  if (options.simulation.configuration() != Configuration{.device = device} || options.trials != one_trial() ||
      !options.simulation.chosen_environment().empty())
    throw InputError(
        "--resume", options.resume + " has its own configuration; give only --device, --threads and --seconds with it");
  if (const char* option = way_of_recording(options))
    throw InputError(option, "is that of " + options.resume + " in a resumed run; leave it out");
}

// The recording of a resumed run: what it had before the checkpoint, and what follows.
std::unique_ptr<Recorder> continue_recording(const RunOptions& options, const ResumedRun& run, std::int64_t last_step) {
  const std::optional<CheckpointRecording>& before = run.notes.recording;
  if (options.record.empty()) {
    if (before) warn(before->path + " is not continued; give --record to continue it");
    return nullptr;
  }
  const auto reader = recording_before(*before);
  return std::make_unique<Recorder>(run.simulation, options.record,
                                    RecordingOptions{.every = before->every,
                                                     .rate = before->rate,
                                                     .first_step = 0,
                                                     .last_step = last_step,
                                                     .seed = run.notes.seed,
                                                     .brains = before->brains,
                                                     .deflate = before->compressed ? 1 : 0},
                                    RecordingStart{*reader, before->frames});
}

int run_resumed(RunOptions options) {
  validate_resume(options);
  Checkpoint checkpoint = load_checkpoint(options.resume);
  const Configuration& configuration = checkpoint.configuration;
  if (!options.record.empty() && !checkpoint.notes.recording)
    throw InputError("--record", options.resume + " is from a run without a recording; leave it out");
  prepare_outputs(options, checkpoint.notes.recording ? checkpoint.notes.recording->path : "");
  TrialSettings trials = options.trials;
  trials.seconds = options.simulation.seconds(checkpoint.notes.seconds);
  trials.settle = checkpoint.notes.settle;
  trials.strain_limit = checkpoint.notes.strain_limit;
  trials.folding = checkpoint.notes.folding ||
                   std::ranges::any_of(checkpoint.notes.measures,  // of earlier versions
                                       [](const TrialMeasures::Sums& sums) { return std::isfinite(sums.overlap); });
  trials.upright = checkpoint.notes.upright;
  validate(trials);
  const double steps = std::round(trials.seconds / configuration.dt);
  if (!(steps <= 1e15) || steps < static_cast<double>(checkpoint.state.clock.step))
    throw InputError("--seconds", fmt::format("{} is not accepted; {} has come to {:.6g} s", trials.seconds,
                                              options.resume, time_of(checkpoint.state.clock)));
  if (options.output.dry_run()) {
    if (checkpoint.notes.recording) {
      options.every = checkpoint.notes.recording->every;
      options.rate = checkpoint.notes.recording->rate;
      options.brains = checkpoint.notes.recording->brains;
    }
    return describe_work(options, configuration, static_cast<std::int64_t>(steps), size_text(checkpoint.robots));
  }
  const Device device = options.simulation.configuration().device;
  ResumedRun run = resumed_run(std::move(checkpoint), options.resume, device);
  print_notes(run.simulation.notes());
  CheckpointNotes notes = run.notes;
  notes.seconds = trials.seconds;
  if (options.record.empty())
    notes.recording.reset();
  else
    notes.recording->path = std::filesystem::absolute(options.record).string();
  return run_watched(
      options, continue_recording(options, run, static_cast<std::int64_t>(steps)),
      checkpoints_of(options, std::move(notes)), std::move(run.failed), [&](const StepObservers& observers) {
        return resume(run.simulation, std::move(run.identities), trials, observers, std::move(run.progress));
      });
}

// Robots of a run are tried as there, unless the command line says otherwise: their hashes are those of lineage.csv. A
// recording or a checkpoint has the first trial.
void try_as_in(const RunSettings& run, RunOptions& options, bool in_one) {
  options.trials = trials_over(run.evolution.trials, *options.typed, options.trials);
  options.trials.seconds = options.simulation.seconds(options.trials.seconds);
  if (in_one) {
    if (options.trials.noise > 0 || options.trials.damage > 0)
      warn("the run's noise and damage are left out of a recording or checkpoint");
    options.trials.trials = 1;
    options.trials.noise = options.trials.damage = 0;
  }
  validate(options.trials);
}

int run(RunOptions& options) {  // its robots count what is left out
  if (options.resume.empty()) prepare_outputs(options);
  if (options.json && is_standard_output(options.csv))
    throw InputError("--csv", options.csv + " and --json both mean standard output; give --csv a file");
  validate_recording(options);
  if (!options.resume.empty()) return run_resumed(options);
  if (const auto file = options.robots.repro()) return run_repro(options, *file);
  options.simulation.check(options.robots.physics());  // errors in options come before those in files
  TrialSettings& trials = options.trials;
  trials.seconds = options.simulation.seconds();
  validate(trials);
  const bool in_one = !options.record.empty() || !options.checkpoint.empty();
  if (in_one && trials.trials != 1)
    throw InputError("--trials", fmt::format("{} trials have no {}; give one", trials.trials,
                                             options.record.empty() ? "checkpoint" : "recording"));
  const RobotSequence robots = options.robots.sequence();
  if (robots.run) try_as_in(*robots.run, options, in_one);
  const std::uint64_t seed =
      robots.run && !options.typed->is_given("--seed") ? robots.run->evolution.seed : options.robots.seed_or_default();
  std::vector<std::string> notes;
  const Configuration configuration = options.simulation.configuration_of(robots, notes);
  print_notes(notes);
  if (options.rate) require_frame_rate("--fps", *options.rate, configuration.dt);
  if (options.output.dry_run())
    return describe_work(options, configuration, std::llround(trials.seconds / configuration.dt), size_text(robots));
  prepare_cuda_for(static_cast<double>(robots.count) * trials.trials * trials.seconds / configuration.dt);
  if (in_one) return run_in_one(options, robots, configuration, trials, seed);
  UnsavedResults results;
  const RunReport report = evaluate(robots, configuration, trials, seed, results);
  print_notes(report.notes);
  return report_results(options, report);
}

}  // namespace

void add_run_command(const Command& program, const Choose& choose) {
  auto options = std::make_shared<RunOptions>();
  const Command command = program.add_command("run", "Simulate robots and print a table or JSON");
  options->robots.add_to(command);
  command.find_option("ROBOTS")->with_help(
      "Robot files (.json, .cbor), folders, samples (sample:eel), a run of mercury evolve, or an explosion that the "
      "window "
      "saved (.repro)");
  add_text(command, "--csv", options->csv,
           "Also write one line per robot to this file; - prints it instead of the table", "FILE")
      .on_first_screen();
  add_text(command, "--record", options->record, "Record positions and velocities of all masses (HDF5, H5MD 1.1)",
           "FILE.h5")
      .on_first_screen();
  add_number(command, "--every", options->every, "Steps between two recorded frames (default: 1/30 s)", "N");
  add_number(command, "--fps", options->rate,
             "Instead: frames per second, exactly; interpolated where they fall between two steps", "N");
  command.add_flag("--brains", options->brains, "Record also the senses and neurons of robots with brains");
  add_text(command, "--checkpoint", options->checkpoint,
           "Save the run now and then, so that --resume goes on with it after a crash", "FILE.h5");
  add_number(command, "--checkpoint-every", options->checkpoint_every, "Wall time between two checkpoints (default 60)",
             "S");
  command.add_flag("--resume", options->goes_on, "Go on with the run that --checkpoint has saved, bit for bit");
  options->output.add_to(command);
  command.add_flag("--compress", options->compress, "Compress the recording (smaller, but slower)");
  command.add_flag("--json", options->json, "Print JSON instead of a table").on_first_screen();
  command.add_flag("--strict", options->strict, "Exit with status 1 if a robot explodes");
  add_trial_options(command, options->trials);
  options->simulation.add_to(command);
  command.set_footer(
      "Distance is how far the center of mass got from where it was after --settle; on land along the ground, so a "
      "fall\n"
      "counts for nothing. Speed is the length of its path divided by the time; cruise is the distance per time after\n"
      "the first third. Figures of several --trials are medians. Strain is the largest of any spring;\n"
      "\"> 50\" is the largest share of springs that had more than 50 % at the same time. Speed, work, height and "
      "strain\n"
      "are sampled every 0.05 s. docs/formats.md describes all columns of CSV and JSON.\n\n"
      "Examples:\n"
      "  mercury run --random voxel:64 --seed 1 --seconds 2\n"
      "  mercury run eel.json --record eel.h5 --every 10\n"
      "  mercury run eel.json --record eel.h5 --fps 30\n"
      "  mercury run sample:hunter --target 2,3,0 --record hunt.h5 --brains\n"
      "  mercury run my-robots --seconds 3600 --checkpoint long.h5\n"
      "  mercury run --resume --checkpoint long.h5                (goes on after a crash)\n"
      "  mercury run swim --robot 57  (an individual of the run swim, tried as there)\n"
      "  mercury run eel.repro        (repeats an explosion that was seen in the window)\n"
      "  mercury run my-robots --environment land --solver xpbd --dt 0.005 --json > land.json");
  command.when_chosen([options, choose, command] {
    choose([options, command] {
      options->typed = command;
      complete_trials(command, options->trials);
      if (options->goes_on && options->checkpoint.empty())
        throw InputError("--resume", "goes on from the file of --checkpoint; give that, too");
      if (options->goes_on) options->resume = options->checkpoint;
      return options->robots.status(run(*options));
    });
  });
}

}  // namespace mercury
