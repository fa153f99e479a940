// SPDX-License-Identifier: Apache-2.0
// mercury grow: robots once more from their origins.
#include <memory>

#include "app/commands/commands.h"
#include "app/commands/offspring.h"
#include "app/options/robot_output.h"
#include "mercury/generator.h"

namespace mercury {
namespace {

struct GrowOptions {
  std::vector<std::string> paths;
  RobotOutput output;
};

int grow(const GrowOptions& options) {
  const std::vector<Robot> robots = load_parents(options.paths, "grown");
  options.output.prepare(robots.size());
  for (const Robot& robot : robots) options.output.write(generator_of(robot)->regrow(robot));
  return 0;
}

}  // namespace

void add_grow_command(CLI::App& program, const Choose& choose) {
  auto options = std::make_shared<GrowOptions>();
  CLI::App* command = program.add_subcommand("grow", "Grow robots again from their origin, which may be edited");
  command->add_option("ROBOTS", options->paths, "Robot files (.json, .cbor) and folders of them")->type_name("PATH");
  options->output.add_files_to(*command);
  command->footer(
      "Masses, springs and faces are made again from the origin in the file: the voxels of a grid, the weights of a\n"
      "network, the numbers of a shell (docs/formats.md). Name, origin and the robot's own materials stay.\n"
      "An origin that nobody edited gives the same robot. The names of the files are printed.\n\n"
      "Examples:\n"
      "  mercury grow edited.json -o edited.json --force\n"
      "  mercury grow edited/ -o grown/");
  command->callback([options, choose] { choose([options] { return grow(*options); }); });
}

}  // namespace mercury
