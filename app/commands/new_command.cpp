// SPDX-License-Identifier: Apache-2.0
// mercury new: robot files.
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/commands/best_of.h"
#include "app/commands/commands.h"
#include "app/commands/dry_run.h"
#include "app/options/generator_options.h"
#include "app/options/option_values.h"
#include "app/options/robot_output.h"
#include "app/options/simulation_options.h"

namespace mercury {
namespace {

// Options that all kinds of robots share.
struct NewOptions {
  RobotOutput output;
  std::uint64_t best_of = 0;  // 0 = no search
  double settle = 0;          // [s]
  SimulationOptions simulation;

  void add_to(CLI::App& command) {
    output.add_to(command);
    add_number(command, "--best-of", best_of, "Simulate N robots and keep the --count that get farthest", "N");
    add_number(command, "--settle", settle,
               "With --best-of: count distances from this time on, after robots have fallen (default 0)", "S");
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
       {"simulate", search ? time_text(options.simulation.configuration(), options.simulation.steps()) : ""},
       {"on", search ? device_text(options.simulation.configuration().device) : ""},
       {"keep", search ? fmt::format("the {} that get farthest", output.count()) : ""},
       {"write", output.description()}});
}

int keep_best(const NewOptions& options, const std::string& kind, const MakeRobot& make) {
  const RobotOutput& output = options.output;
  if (options.best_of < output.count())
    throw InputError("--best-of",
                     fmt::format("{} is not accepted; give at least --count, {}", options.best_of, output.count()));
  if (!(options.settle >= 0 && options.settle <= options.simulation.seconds()))
    throw InputError("--settle", fmt::format("{} is not accepted; give 0 to --seconds, {} s", options.settle,
                                             options.simulation.seconds()));
  const Contest contest{.candidates = options.best_of,
                        .configuration = options.simulation.configuration(),
                        .steps = options.simulation.steps(),
                        .settling = std::llround(options.settle / options.simulation.configuration().dt)};
  RobotFiles files = output.open(output.count(), names_of(kind, output.seed(), options.best_of));
  if (output.dry_run()) return describe_work(options, kind);
  const std::vector<Winner> winners = best_of(contest, make, output.seed(), output.count());
  if (interrupted()) {
    say("stopped; nothing was written");
    return 1;
  }
  for (const Winner& winner : winners) {
    files.write(*winner.robot);
    say(fmt::format("{} got {:.3g} m far", winner.robot->name, winner.distance));
  }
  if (winners.size() < output.count())
    warn(fmt::format("only {} robots could be made and did not explode", winners.size()));
  return winners.size() < output.count() ? 1 : 0;
}

// The environment that the robots are made for or tried in; their origin names it. Empty if the user named none.
std::string environment_for(const NewOptions& options) {
  if (options.best_of > 0) return std::string(name_of(options.simulation.configuration().environment));
  return options.simulation.chosen_environment();
}

int make_files(const NewOptions& options, const std::string& kind, const MakeRobot& make) {
  if (options.best_of > 0) return keep_best(options, kind, make);
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
void add_kind(CLI::App& family, const Choose& choose, const Generator& generator) {
  struct Options {
    NewOptions shared;
    GeneratorOptions shape;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = family.add_subcommand(generator.kind, generator.help);
  options->shape.add_to(*command, generator);
  options->shared.add_to(*command);
  command->footer(footer_of(generator));
  command->callback([options, choose, &generator] {
    choose([options, &generator] {
      const ParameterValues& values = options->shape.values();
      generator.validate(values);
      const std::string environment = environment_for(options->shared);
      return make_files(options->shared, generator.kind, [&](std::uint64_t seed, std::uint64_t index) {
        return generator.make(values, environment, seed, index);
      });
    });
  });
}

}  // namespace

void add_new_command(CLI::App& program, const Choose& choose) {
  CLI::App* command = program.add_subcommand("new", "Make robot files");
  command->require_subcommand(1);
  for (const Generator& generator : generators()) add_kind(*command, choose, generator);
}

}  // namespace mercury
