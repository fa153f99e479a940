// SPDX-License-Identifier: Apache-2.0
// The subcommands of the program, one source file per command.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace mercury {

// Runs a command after its options were parsed. Returns the exit status. Throws InputError (exit status 2) or another
// std::exception (exit status 1).
using CommandBody = std::function<int()>;

// Receives the command that the user chose.
using Choose = std::function<void(CommandBody)>;

// Each function adds one subcommand to the program. Parsing the command line calls `choose`.
void add_run_command(CLI::App& program, const Choose& choose);
void add_view_command(CLI::App& program, const Choose& choose);
void add_render_command(CLI::App& program, const Choose& choose);
void add_evolve_command(CLI::App& program, const Choose& choose);
void add_new_command(CLI::App& program, const Choose& choose);
void add_mutate_command(CLI::App& program, const Choose& choose);
void add_cross_command(CLI::App& program, const Choose& choose);
void add_grow_command(CLI::App& program, const Choose& choose);
void add_import_command(CLI::App& program, const Choose& choose);
void add_bench_command(CLI::App& program, const Choose& choose);
void add_export_command(CLI::App& program, const Choose& choose);
void add_verify_command(CLI::App& program, const Choose& choose);
void add_info_command(CLI::App& program, const Choose& choose);
void add_describe_command(CLI::App& program, const Choose& choose);

}  // namespace mercury
