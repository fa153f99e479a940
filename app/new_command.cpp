// mercury new: robot files.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/nn_options.h"
#include "app/option_values.h"
#include "app/progress.h"
#include "app/robot_output.h"
#include "app/voxel_options.h"

namespace mercury {
namespace {

struct NewVoxelOptions {
  RobotOutput output;
  VoxelOptions voxel;
};

int make_voxels(const NewVoxelOptions& options) {
  const RandomVoxelOptions voxel = options.voxel.chosen();
  return write_robots(options.output, [&](std::uint64_t seed, std::uint64_t index) {
    return random_voxel_robot(voxel, seed, index);
  });
}

void add_voxel(CLI::App& family, const Choose& choose) {
  auto options = std::make_shared<NewVoxelOptions>();
  CLI::App* command = family.add_subcommand("voxel", "Random voxel robots");
  options->output.add_to(*command);
  options->voxel.add_to(*command);
  command->footer(
      "The same seed and options give the same robots on every machine. The names of the files are printed.\n\n"
      "Examples:\n"
      "  mercury new voxel -o eel.json --seed 4 --voxels 12x2x3\n"
      "  mercury new voxel -o robots/ --count 100 --seed 1 --format cbor");
  command->callback([options, choose] { choose([options] { return make_voxels(*options); }); });
}

struct NewNnOptions {
  RobotOutput output;
  NnRobotOptions nn;
};

int make_networks(const NewNnOptions& options) {
  const NnOptions nn = options.nn.chosen();
  return write_robots(options.output,
                      [&](std::uint64_t seed, std::uint64_t index) { return random_nn_robot(nn, seed, index); });
}

void add_nn(CLI::App& family, const Choose& choose) {
  auto options = std::make_shared<NewNnOptions>();
  CLI::App* command = family.add_subcommand("nn", "Random robots grown by a neural network");
  options->output.add_to(*command);
  options->nn.add_to(*command);
  command->footer(
      "The same seed and options give the same robots on every machine. The names of the files are printed. A file\n"
      "keeps the network, so that the robot can be changed and grown again.\n\n"
      "Examples:\n"
      "  mercury new nn -o robots/ --count 64 --seed 1\n"
      "  mercury new nn -o fine.json --points 4000");
  command->callback([options, choose] { choose([options] { return make_networks(*options); }); });
}

}  // namespace

void add_new_command(CLI::App& program, const Choose& choose) {
  CLI::App* command = program.add_subcommand("new", "Make robot files");
  command->require_subcommand(1);
  add_voxel(*command, choose);
  add_nn(*command, choose);
}

}  // namespace mercury
