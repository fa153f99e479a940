// SPDX-License-Identifier: Apache-2.0
// mercury grow: robots once more from their origins.
#include <memory>
#include <set>

#include "app/base/file_name.h"
#include "app/commands/description.h"
#include "app/commands/offspring.h"
#include "app/options/command.h"
#include "app/options/robot_inputs.h"
#include "app/options/robot_output.h"
#include "mercury/error.h"
#include "mercury/generator.h"

namespace mercury {
namespace {

struct GrowOptions {
  RobotInputs robots;
  RobotOutput output;
};

// Files are named by their robots: one of two with the same name would be lost.
std::set<std::string> names_of(const std::vector<Robot>& robots) {
  std::set<std::string> names;
  for (const Robot& robot : robots)
    if (!names.insert(file_name_of(robot.name)).second)
      throw InputError(robot.name, "two robots have this name; grow them into different folders");
  return names;
}

// Robots may be grown in place: they are read before they are written.
int grow(const GrowOptions& options) {
  const std::vector<Robot> robots = load_parents(options.robots, "grown");
  const std::set<std::string> names = names_of(robots);
  RobotFiles files =
      options.output.open(robots.size(), [&](std::string_view name) { return names.contains(std::string(name)); });
  if (options.output.dry_run())
    return print_dry_run("grow", {{"robots", size_text(robots)}, {"write", options.output.description()}});
  for (const Robot& robot : robots) files.write(generator_of(robot)->regrow(robot));
  return files.renamed() ? 1 : 0;
}

}  // namespace

void add_grow_command(const Command& program, const Choose& choose) {
  auto options = std::make_shared<GrowOptions>();
  const Command command = program.add_command("grow", "Grow robots again from their origin, which may be edited");
  options->robots.add_to(command);
  options->output.add_files_to(command);
  command.set_footer(
      "Masses, springs and faces are made again from the origin in the file: the voxels of a grid, the weights of a\n"
      "network, the numbers of a shell (docs/formats.md). Name, origin and the robot's own materials stay.\n"
      "An origin that nobody edited gives the same robot. The names of the files are printed.\n\n"
      "Examples:\n"
      "  mercury grow edited.json -o edited.json --force\n"
      "  mercury grow edited/ -o grown/");
  command.when_chosen([options, choose] { choose([options] { return options->robots.status(grow(*options)); }); });
}

}  // namespace mercury
