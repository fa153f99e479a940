// SPDX-License-Identifier: Apache-2.0
// The subcommands of the program, one source file per command.
#pragma once

#include <functional>

#include "app/options/command.h"

namespace mercury {

// Runs a command after its options were parsed. Returns the exit status. Throws InputError (exit status 2) or another
// std::exception (exit status 1).
using CommandBody = std::function<int()>;

// Receives the command that the user chose.
using Choose = std::function<void(CommandBody)>;

// Each function adds one subcommand to the program. Parsing the command line calls `choose`.
void add_run_command(const Command& program, const Choose& choose);
void add_view_command(const Command& program, const Choose& choose);
void add_render_command(const Command& program, const Choose& choose);
void add_evolve_command(const Command& program, const Choose& choose);
void add_new_command(const Command& program, const Choose& choose);
void add_mutate_command(const Command& program, const Choose& choose);
void add_cross_command(const Command& program, const Choose& choose);
void add_grow_command(const Command& program, const Choose& choose);
void add_import_command(const Command& program, const Choose& choose);
void add_bench_command(const Command& program, const Choose& choose);
void add_export_command(const Command& program, const Choose& choose);
void add_verify_command(const Command& program, const Choose& choose);
void add_info_command(const Command& program, const Choose& choose);
void add_describe_command(const Command& program, const Choose& choose);

}  // namespace mercury
