// SPDX-License-Identifier: Apache-2.0
#include "app/options/output_options.h"

namespace mercury {

void OutputOptions::add_to(CLI::App& command) {
  add_force_to(command);
  command.add_flag("--dry-run", dry_run_, "Check everything and print what would be done; write nothing");
}

void OutputOptions::add_force_to(CLI::App& command) {
  command_ = &command;
  command.add_flag("--force", force_, "Replace what exists: files, pictures in a folder, a run");
}

OutputFiles OutputOptions::files() const {
  OutputFiles files(force_, !dry_run_);
  const CLI::Option* config = command_ ? command_->get_option_no_throw("--config") : nullptr;
  if (config)
    for (const std::string& file : config->results()) files.add_input(file);
  return files;
}

}  // namespace mercury
