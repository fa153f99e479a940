// SPDX-License-Identifier: Apache-2.0
// mercury describe-options: what the program accepts, for other programs and for the build, which makes man pages and
// completion with it.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/commands/command_list.h"
#include "app/options/command.h"
#include "app/options/option_values.h"
#include "robots/file/whole_file.h"

namespace mercury {
namespace {

struct DescribeOptions {
  std::string form, folder;
};

void write_man_pages(const std::filesystem::path& folder, const std::vector<CommandDescription>& commands) {
  std::filesystem::create_directories(folder);
  for (const CommandDescription& command : commands)
    write_whole_file(folder / (man_page_name(command) + ".1"), man_page(command, commands));
}

int describe(const DescribeOptions& options, const Command& program) {
  const std::vector<CommandDescription> commands = command_list(program);
  if (options.form == "json") fmt::print("{}", json_of(commands));
  if (options.form == "bash") fmt::print("{}", bash_completion(commands));
  if (options.form == "zsh") fmt::print("{}", zsh_completion(commands));
  if (options.form == "fish") fmt::print("{}", fish_completion(commands));
  if (options.form == "man") {
    if (options.folder.empty()) throw InputError("FOLDER", "give the folder of the pages");
    write_man_pages(options.folder, commands);
  }
  return 0;
}

}  // namespace

void add_describe_command(const Command& program, const Choose& choose) {
  auto options = std::make_shared<DescribeOptions>();
  const Command command = program.add_command("describe-options", "Print all commands and options, for other programs");
  add_choice(command, "FORM", options->form, {"json", "bash", "zsh", "fish", "man"},
             "A list, a completion script, or manual pages")
      .required();
  add_text(command, "FOLDER", options->folder, "Where manual pages go", "FOLDER");
  command.when_chosen(
      [options, choose, program] { choose([options, program] { return describe(*options, program); }); });
}

}  // namespace mercury
