// SPDX-License-Identifier: Apache-2.0
// mercury mutate: changed copies of robots.
#include <fmt/format.h>

#include <limits>
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

struct MutateOptions {
  RobotInputs robots;
  RobotOutput output;
  MutationRequest mutation;
  std::string name;
};

int mutate(const MutateOptions& options) {
  validate(options.mutation);
  if (options.mutation.strength == 0 && options.mutation.muscles == 0)
    throw InputError("--strength, --muscles", "both are 0, which changes nothing; give one of them above 0");
  const std::vector<Robot> parents = load_parents_of(
      options.robots, [&](const Robot& parent) { mutate_robot(parent, options.mutation, parent.name); });
  const std::uint64_t each = options.output.count();
  if (each > std::numeric_limits<std::uint64_t>::max() / parents.size())
    throw InputError("--count", fmt::format("{} is not accepted; give fewer", each));
  const auto name_of = [&](std::uint64_t index) {
    const Robot& parent = parents[static_cast<std::size_t>(index / each)];
    return (options.name.empty() ? parent.name + "-m" : options.name + "-") + std::to_string(index);
  };
  const std::uint64_t count = each * parents.size();
  RobotFiles files = options.output.open(count, numbered_names(name_of, count), options.robots.paths());
  if (options.output.dry_run())
    return print_dry_run(
        "mutate",
        {{"parents", size_text(parents)},
         {"make", fmt::format("{} of seed {}", count_text(static_cast<std::int64_t>(count), "mutant", "mutants"),
                              options.output.seed())},
         {"write", options.output.description()}});
  const std::optional<std::string> file = options.output.file_stem();
  return write_children(options.output, std::move(files), count, parents, [&](std::uint64_t index, std::uint64_t seed) {
    MutationRequest own = options.mutation;
    own.seed = seed;
    return mutate_robot(parents[static_cast<std::size_t>(index / each)], own, file ? *file : name_of(index));
  });
}

}  // namespace

void add_mutate_command(const Command& program, const Choose& choose) {
  auto options = std::make_shared<MutateOptions>();
  const Command command = program.add_command("mutate", "Make changed copies of robots");
  options->robots.add_to(command);
  options->output.add_to(command, "Children of each robot (default 1)");
  add_number(command, "--strength", options->mutation.strength,
             "How much bodies change: 1 = a little, as in a search (default 1); 0 = not at all", "X")
      .on_first_screen();
  add_number(command, "--muscles", options->mutation.muscles,
             "How much amplitudes, frequencies and phases of muscles change (default 0)", "X")
      .on_first_screen();
  add_text(command, "--name", options->name, "Children are named NAME-0, NAME-1, ... (default: PARENT-m0, ...)", "NAME")
      .on_first_screen();
  command.set_footer(
      "A child differs from its parent and from the other children. The same files, options and seed give the same\n"
      "children on every machine. Their origin names the parent and the seed. The names of the files are printed.\n"
      "Of robots that no generator made, only the muscles change.\n\n"
      "Examples:\n"
      "  mercury mutate eel.json -o children/ --count 20 --seed 3\n"
      "  mercury mutate eel.json -o late.json --strength 0 --muscles 1\n"
      "  mercury mutate sample:dog -o dogs/ --count 8 --muscles 1\n"
      "  mercury mutate best/ -o generation-2/ --count 8 --strength 2 --muscles 0.5");
  command.when_chosen([options, choose] { choose([options] { return options->robots.status(mutate(*options)); }); });
}

}  // namespace mercury
