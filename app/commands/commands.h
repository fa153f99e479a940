// SPDX-License-Identifier: Apache-2.0
// The subcommands of the program, one file each.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace mercury {

// What a command does once its options are read; returns the exit status. Throws InputError (status 2), anything else
// derived from std::exception (status 1).
using CommandBody = std::function<int()>;

// Told which command was chosen.
using Choose = std::function<void(CommandBody)>;

// Each adds one subcommand to the program; `choose` is called while the command line is parsed.
void add_run_command(CLI::App& program, const Choose& choose);
void add_view_command(CLI::App& program, const Choose& choose);
void add_render_command(CLI::App& program, const Choose& choose);
void add_new_command(CLI::App& program, const Choose& choose);
void add_bench_command(CLI::App& program, const Choose& choose);
void add_info_command(CLI::App& program, const Choose& choose);

}  // namespace mercury
