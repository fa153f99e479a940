// SPDX-License-Identifier: Apache-2.0
// mercury describe-options: what the program accepts, for other programs. The build uses it; the help does not show it.
#include <fmt/format.h>

#include <memory>

#include "app/commands/command_list.h"
#include "app/commands/commands.h"
#include "app/options/option_values.h"

namespace mercury {
namespace {

struct DescribeOptions {
  std::string form;
};

int describe(const DescribeOptions&, const CLI::App& program) {
  fmt::print("{}", json_of(command_list(program)));
  return 0;
}

}  // namespace

void add_describe_command(CLI::App& program, const Choose& choose) {
  auto options = std::make_shared<DescribeOptions>();
  CLI::App* command = program.add_subcommand("describe-options", "Print all commands and options (JSON)")->group("");
  add_choice(*command, "FORM", options->form, {"json"}, "What is printed")->required();
  command->callback(
      [options, choose, &program] { choose([options, &program] { return describe(*options, program); }); });
}

}  // namespace mercury
