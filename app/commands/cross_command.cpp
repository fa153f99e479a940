// SPDX-License-Identifier: Apache-2.0
// mercury cross: children of two robots.
#include <fmt/format.h>

#include <memory>

#include "app/commands/description.h"
#include "app/commands/offspring.h"
#include "app/options/command.h"
#include "app/options/option_values.h"
#include "app/options/robot_inputs.h"
#include "app/options/robot_output.h"
#include "mercury/generator.h"

namespace mercury {
namespace {

struct CrossOptions {
  RobotInputs robots;
  RobotOutput output;
  std::string name;
};

int cross(const CrossOptions& options) {
  const std::vector<Robot> parents = load_parents(options.robots, "crossed");
  if (parents.size() != 2)
    throw InputError("ROBOTS", fmt::format("{} robots are not accepted; give the files of two", parents.size()));
  const Robot &a = parents[0], &b = parents[1];
  cross_robots(a, b, options.output.seed(), "child");  // throws for two that are too different
  const auto name_of = [&](std::uint64_t index) {
    return (options.name.empty() ? a.name + "-x" : options.name + "-") + std::to_string(index);
  };
  const RobotOutput& output = options.output;
  RobotFiles files = output.open(output.count(), numbered_names(name_of, output.count()), options.robots.paths());
  if (output.dry_run())
    return print_dry_run(
        "cross", {{"parents", size_text(parents)},
                  {"make", fmt::format("{} of seed {}",
                                       count_text(static_cast<std::int64_t>(output.count()), "child", "children"),
                                       output.seed())},
                  {"write", output.description()}});
  const std::optional<std::string> file = output.file_stem();
  const MakeChild make = [&](std::uint64_t index, std::uint64_t seed) {
    return cross_robots(a, b, seed, file ? *file : name_of(index));
  };
  return write_children(output, std::move(files), output.count(), parents, make);
}

}  // namespace

void add_cross_command(const Command& program, const Choose& choose) {
  auto options = std::make_shared<CrossOptions>();
  const Command command = program.add_command("cross", "Make children of two robots of one kind");
  options->robots.add_to(command, "Two robot files (.json, .cbor)");
  options->output.add_to(command, "How many children (default 1)");
  add_text(command, "--name", options->name, "Children are named NAME-0, NAME-1, ... (default: FIRST-x0, ...)", "NAME")
      .on_first_screen();
  command.set_footer(
      "Body and muscles are mixed; size and environment are those of the first robot. A child differs from its "
      "parents\n"
      "and from the other children. The same files and seed give the same children on every machine. Their origin "
      "names\n"
      "both parents and the seed. The names of the files are printed.\n\n"
      "Examples:\n"
      "  mercury cross paddler.json wriggler.json -o child.json\n"
      "  mercury cross paddler.json wriggler.json -o children/ --count 20 --seed 3");
  command.when_chosen([options, choose] { choose([options] { return options->robots.status(cross(*options)); }); });
}

}  // namespace mercury
