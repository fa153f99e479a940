// SPDX-License-Identifier: Apache-2.0
// mercury new: robot files.
#include <fmt/format.h>

#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "app/base/messages.h"
#include "app/commands/best_of.h"
#include "app/commands/description.h"
#include "app/options/command.h"
#include "app/options/generator_options.h"
#include "app/options/option_values.h"
#include "app/options/parameter_options.h"
#include "app/options/robot_options.h"
#include "app/options/robot_output.h"
#include "app/options/simulation_options.h"
#include "mercury/lively.h"
#include "mercury/objective.h"
#include "mercury/real_body.h"

namespace mercury {
namespace {

// Options that all kinds of robots share.
struct NewOptions {
  RobotOutput output;
  std::uint64_t best_of = 0;  // 0 = no search
  std::string csv;            // of the candidates; empty = none
  bool lively = false;
  TrialSettings trials = search_trials();
  SimulationOptions simulation;
  Physics physics = Physics::paper;  // of the robots' bodies

  void add_to(const Command& command) {
    output.add_to(command);
    add_number(command, "--best-of", best_of, "Simulate N robots and keep the --count that get farthest", "N");
    command.add_flag("--lively", lively, lively_help);
    add_text(command, "--csv", csv, "With --best-of: write a line per candidate to this file, in their order", "FILE");
    add_trial_options(command, trials);
    simulation.add_to(command);
  }
};

// See Generator::make.
RobotNames names_of(const std::string& kind, std::uint64_t seed, std::uint64_t count) {
  return numbered_names([=](std::uint64_t index) { return fmt::format("{}-{}-{}", kind, seed, index); }, count);
}

int describe_work(const NewOptions& options, const std::string& kind) {
  const RobotOutput& output = options.output;
  const bool search = options.best_of > 0;
  return print_dry_run(
      "new " + kind,
      {{"make", fmt::format("{} of seed {}", search ? options.best_of : output.count(), output.seed())},
       {"simulate", search ? time_text(options.simulation.configuration(options.physics), options.simulation.steps()) +
                                 fmt::format(", {} trials", options.trials.trials)
                           : ""},
       {"on", search ? device_text(options.simulation.configuration(options.physics).device) : ""},
       {"keep", search ? fmt::format("the {} that get farthest", output.count()) : ""},
       {"write", output.description()},
       {"results", options.csv}});
}

// Throws InputError for options that do not go together.
TrialSettings trials_of(const NewOptions& options) {
  if (options.best_of < options.output.count())
    throw InputError("--best-of", fmt::format("{} is not accepted; give at least --count, {}", options.best_of,
                                              options.output.count()));
  TrialSettings trials = options.trials;
  trials.seconds = options.simulation.seconds();
  validate(trials);
  return trials;
}

void require_no_search_options(const NewOptions& options) {
  if (!options.csv.empty()) throw InputError("--csv", "goes with --best-of N");
  constexpr TrialSettings usual = search_trials();
  for_each_parameter(options.trials, [&](const auto& parameter, const auto& value) {
    if (value != usual.*parameter.member) throw InputError(option_of(parameter.name), "goes with --best-of N");
  });
}

// "312 exploded, 4 overstretched"
std::string fates_text(const ContestResult& found) {
  std::string text;
  for (const auto& [fate, number] : found.fates)
    if (fate != Fate::sound) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", number, name_of(fate));
  return text;
}

// " (quartiles of 3 trials: 0.51 and 0.55)"
std::string quartiles_text(const RobotResult& result) {
  if (result.trials == 1) return "";
  return fmt::format(" (quartiles of {} trials: {:.3g} and {:.3g})", result.trials, result.lower_quartile,
                     result.upper_quartile);
}

void report(const ContestResult& found, const NewOptions& options) {
  for (const Winner& winner : found.winners)
    say(fmt::format("{} got {:.3g} m far{}", winner.robot->name, winner.result.distance,
                    quartiles_text(winner.result)));
  if (found.interrupted)
    warn(fmt::format("stopped after {} of {} candidates; {}", found.tried(), options.best_of,
                     found.winners.empty() ? "no robot was written" : "the best of these are written"));
  else if (found.winners.size() < options.output.count())
    warn(fmt::format("only {} of {} candidates are sound: {}", found.winners.size(), options.best_of,
                     fates_text(found)));
}

// A search may take hours. So everything is attempted that can save a part of its result: first what is printed, then
// each file, even if the one before could not be written.
void publish(const ContestResult& found, const NewOptions& options, RobotFiles& files, const std::string& csv) {
  std::exception_ptr problem;
  const auto attempt = [&](const auto& write) {
    try {
      write();
    } catch (...) {
      if (!problem) problem = std::current_exception();
    }
  };
  report(found, options);
  if (!options.csv.empty()) attempt([&] { write_results(options.csv, csv); });
  for (const Winner& winner : found.winners) attempt([&] { files.write(*winner.robot); });
  if (problem) std::rethrow_exception(problem);
}

int keep_best(const NewOptions& options, const std::string& kind, const MakeRobot& make) {
  std::string csv = csv_heading();
  Contest contest{.kind = kind,
                  .seed = options.output.seed(),
                  .candidates = options.best_of,
                  .configuration = options.simulation.configuration(options.physics),
                  .trials = trials_of(options)};
  if (!options.csv.empty()) {
    if (is_standard_output(options.csv))
      throw InputError("--csv", "the names of the robots' files go to standard output; give a file");
    OutputFiles outputs = options.output.other_outputs();
    outputs.add_stream("--csv", options.csv);
    outputs.check();
    if (!options.output.dry_run()) outputs.make_folders();
    contest.watch = [&csv](const RobotResult& robot) { csv += csv_line(robot); };
  }
  if (const std::string why = why_meaningless(Objective("distance"), contest.configuration.environment); !why.empty())
    throw InputError("--best-of", why);
  const RobotOutput& output = options.output;
  RobotFiles files = output.open(output.count(), names_of(kind, output.seed(), options.best_of));
  if (output.dry_run()) return describe_work(options, kind);
  UnsavedResults results;
  const ContestResult found = best_of(contest, make, options.output.count(), results);
  publish(found, options, files, csv);
  return found.interrupted || files.renamed() || found.winners.size() < options.output.count() ? 1 : 0;
}

// The environment that the robots are made for or tried in; their origin names it. Empty if the user named none.
std::string environment_for(const NewOptions& options) {
  if (options.best_of > 0) return std::string(name_of(options.simulation.configuration(options.physics).environment));
  return options.simulation.chosen_environment();
}

// Their number is that in the seed, not that in the folder.
int make_lively_files(const NewOptions& options, const std::string& kind, const ParameterValues& values,
                      const MakeRobot& make) {
  const RobotOutput& output = options.output;
  RobotFiles files = output.open(output.count(), names_of(kind, output.seed(), output.count() * tried_per_lively));
  if (output.dry_run()) return describe_work(options, kind);
  const RandomRobots request{.kind = kind,
                             .count = static_cast<std::size_t>(output.count()),
                             .seed = output.seed(),
                             .values = values,
                             .environment = environment_for(options)};
  const std::vector<RandomRobots> chosen =
      chosen_lively(request, lively_configuration(request, options.simulation.chosen_environment()));
  return write_robots(output, std::move(files),
                      [&](std::uint64_t seed, std::uint64_t index) { return make(seed, chosen[index].first); });
}

int make_files(const NewOptions& options, const std::string& kind, const ParameterValues& values,
               const MakeRobot& make) {
  if (options.best_of > 0 && options.lively) throw InputError("--lively and --best-of", "give one of them");
  if (options.best_of > 0) return keep_best(options, kind, make);
  require_no_search_options(options);
  if (options.lively) return make_lively_files(options, kind, values, make);
  const RobotOutput& output = options.output;
  RobotFiles files = output.open(output.count(), names_of(kind, output.seed(), output.count()));
  return output.dry_run() ? describe_work(options, kind) : write_robots(output, std::move(files), make);
}

std::string footer_of(const Generator& generator) {
  std::string text =
      "The same seed and options give the same robots on every machine. The names of the files are printed.";
  if (!generator.note.empty()) text += " " + generator.note;
  const Generator::Example& example = generator.example;
  text +=
      fmt::format("\n\nExamples:\n  mercury new {} -o {}.json --seed {}", generator.kind, example.name, example.seed);
  for (const auto& [parameter, value] : example.values) text += fmt::format(" {} {}", option_of(parameter), value);
  return text + fmt::format(
                    "\n  mercury new {0} -o my-robots --count 100 --seed 1 --format cbor\n"
                    "  mercury new {0} -o best/ --count 5 --best-of 1000 --environment land --seconds 10",
                    generator.kind);
}

// The command for one kind of robot.
void add_kind(const Command& family, const Choose& choose, const Generator& generator) {
  struct Options {
    NewOptions shared;
    GeneratorOptions shape;
  };
  auto options = std::make_shared<Options>();
  const Command command = family.add_command(generator.kind, generator.help);
  options->shape.add_to(command, generator);
  for (const GeneratorParameter& parameter : generator.parameters)
    if (!parameter.shared && !parameter.advanced) command.find_option(option_of(parameter.name))->on_first_screen();
  options->shared.add_to(command);
  command.set_footer(footer_of(generator));
  command.when_chosen([options, choose, &generator] {
    choose([options, &generator] {
      const ParameterValues& values = options->shape.values();
      generator.validate(values);
      options->shared.physics = real_material_in(values) ? Physics::real : Physics::paper;
      const std::string environment = environment_for(options->shared);
      return make_files(options->shared, generator.kind, values, [&](std::uint64_t seed, std::uint64_t index) {
        return generator.make(values, environment, seed, index);
      });
    });
  });
}

}  // namespace

void add_new_command(const Command& program, const Choose& choose) {
  const Command command = program.add_command("new", "Make robot files");
  command.require_command();
  for (const Generator& generator : generators()) add_kind(command, choose, generator);
}

}  // namespace mercury
