// SPDX-License-Identifier: Apache-2.0
#include "app/options/output_options.h"

namespace mercury {

void OutputOptions::add_to(const Command& command) {
  add_force_to(command);
  command.add_flag("--dry-run", dry_run_, "Check everything and print what would be done; write nothing");
}

void OutputOptions::add_force_to(const Command& command) {
  command_ = command;
  command.add_flag("--force", force_, "Replace what exists: files, pictures in a folder, a run");
}

OutputFiles OutputOptions::files() const {
  OutputFiles files(force_, !dry_run_);
  const std::optional<Option> config = command_ ? command_->find_option("--config") : std::nullopt;
  if (config)
    for (const std::string& file : config->values()) files.add_input(file);
  return files;
}

}  // namespace mercury
