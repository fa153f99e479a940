// SPDX-License-Identifier: Apache-2.0
// --force and --dry-run, the same in every command that writes files.
#pragma once

#include "app/base/output_files.h"
#include "app/options/command.h"

namespace mercury {

class OutputOptions {
 public:
  // Adds the options to a command. The object must outlive it.
  void add_to(const Command& command);
  // For a command that cannot say what it would do.
  void add_force_to(const Command& command);

  bool force() const { return force_; }
  // Everything is checked, nothing is written: the command prints what it would do, and ends.
  bool dry_run() const { return dry_run_; }
  // The outputs of the command, still none. A configuration file is an input.
  OutputFiles files() const;

 private:
  std::optional<Command> command_;
  bool force_ = false, dry_run_ = false;
};

}  // namespace mercury
