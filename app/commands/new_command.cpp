// SPDX-License-Identifier: Apache-2.0
// mercury new: robot files.
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "app/base/interrupt.h"
#include "app/commands/best_of.h"
#include "app/commands/commands.h"
#include "app/options/nn_options.h"
#include "app/options/option_values.h"
#include "app/options/robot_output.h"
#include "app/options/simulation_options.h"
#include "app/options/voxel_options.h"

namespace mercury {
namespace {

// What all kinds of new robots share.
struct NewOptions {
  RobotOutput output;
  std::uint64_t best_of = 0;  // 0 = no search
  double settle = 0;          // [s]
  SimulationOptions simulation;

  void add_to(CLI::App& command) {
    output.add_to(command);
    add_number(command, "--best-of", best_of, "Simulate so many, and keep the --count that get farthest", "N");
    add_number(command, "--settle", settle,
               "Of --best-of: distances count from this time on, when robots have fallen (default 0)", "S");
    simulation.add_to(command);
  }
};

int keep_best(const NewOptions& options, const MakeRobot& make) {
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
  output.prepare();
  const std::vector<Winner> winners = best_of(contest, make, output.seed(), output.count());
  if (interrupted()) {
    fmt::print(stderr, "mercury: stopped; nothing was written\n");
    return 1;
  }
  for (const Winner& winner : winners) {
    output.write(winner.robot);
    fmt::print(stderr, "mercury: {} got {:.3g} m far\n", winner.robot.name, winner.distance);
  }
  if (winners.size() < output.count())
    fmt::print(stderr, "mercury: only {} robots could be made and did not explode\n", winners.size());
  return winners.size() < output.count() ? 1 : 0;
}

// Robots that were tried, or made, for an environment say so in their origin.
std::string environment_for(const NewOptions& options) {
  if (options.best_of > 0) return std::string(name_of(options.simulation.configuration().environment));
  return options.simulation.chosen_environment();
}

int make_files(const NewOptions& options, const MakeRobot& make) {
  return options.best_of > 0 ? keep_best(options, make) : write_robots(options.output, make);
}

// One kind of robot; Options has add_to() and chosen(), `make` makes the index-th robot of a seed from what was chosen.
template <class Options, class Make>
void add_kind(CLI::App& family, const Choose& choose, const char* name, const char* description, const char* footer,
              Make make) {
  struct Chosen {
    NewOptions shared;
    Options kind;
  };
  auto options = std::make_shared<Chosen>();
  CLI::App* command = family.add_subcommand(name, description);
  options->kind.add_to(*command);
  options->shared.add_to(*command);
  command->footer(footer);
  command->callback([options, choose, make] {
    choose([options, make] {
      auto chosen = options->kind.chosen();
      chosen.environment = environment_for(options->shared);
      return make_files(options->shared,
                        [&](std::uint64_t seed, std::uint64_t index) { return make(chosen, seed, index); });
    });
  });
}

}  // namespace

void add_new_command(CLI::App& program, const Choose& choose) {
  CLI::App* command = program.add_subcommand("new", "Make robot files");
  command->require_subcommand(1);
  add_kind<VoxelOptions>(
      *command, choose, "voxel", "Random voxel robots",
      "The same seed and options give the same robots on every machine. The names of the files are printed.\n\n"
      "Examples:\n"
      "  mercury new voxel -o eel.json --seed 4 --voxels 12x2x3\n"
      "  mercury new voxel -o my-robots --count 100 --seed 1 --format cbor\n"
      "  mercury new voxel -o best/ --count 5 --best-of 1000 --environment land --seconds 10",
      random_voxel_robot);
  add_kind<NnRobotOptions>(
      *command, choose, "nn", "Robots grown by random neural networks",
      "The same seed and options give the same robots on every machine. The names of the files are printed. A file\n"
      "keeps the network, so that the robot can be changed and grown again.\n\n"
      "Examples:\n"
      "  mercury new nn -o blob.json --seed 4 --points 1000\n"
      "  mercury new nn -o my-robots --count 64 --seed 1\n"
      "  mercury new nn -o best/ --count 3 --best-of 500 --seconds 10",
      random_nn_robot);
}

}  // namespace mercury
