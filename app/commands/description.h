// SPDX-License-Identifier: Apache-2.0
// What commands print and write: descriptions, a heading and then lines of what and how, as of mercury info; results;
// what a dry run would do.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/base/output_files.h"
#include "app/options/robot_options.h"
#include "app/recording/configuration_json.h"
#include "mercury/configuration.h"
#include "mercury/robot.h"
#include "mercury/run_folder.h"

namespace mercury {

// What is described. Names come from files: what a terminal would obey is shown as an escape, here and below.
void print_heading(const std::string& text);
// "  masses      300"
void print_line(const std::string& what, const std::string& text);

// A run of an evolution, which may be going on.
void describe(const RunHistory& run);

// A file that takes the results of a command, such as --csv FILE.

// Writes a file whole or not at all; writes directly into a device, a pipe or standard output ("-", "/dev/stdout").
// Waits for the reader of a named pipe. Throws InputError or std::runtime_error if it cannot be written, Interrupted;
// NameTaken as publish().
void write_results(const std::string& file, std::string_view content);

// What a command would do, as --dry-run prints it on standard output.

// What and how, a line each: {"robots", "12: 3600 masses, 14000 springs"}.
using Intentions = std::vector<std::pair<std::string, std::string>>;

// Prints "dry run of COMMAND; nothing was written" and the lines, those without text left out. Returns the exit status.
int print_dry_run(const std::string& command, const Intentions& intentions);

// "1 frame", "2 frames"
std::string count_text(std::int64_t count, const std::string& one, const std::string& several);

// "12: 3600 masses, 14000 springs". Of many random robots, which are made one after another, it makes some and says
// "about". Throws InputError as the source does.
std::string size_text(const RobotSequence& robots);
std::string size_text(std::span<const Robot> robots);
std::string size_text(std::span<const std::shared_ptr<const Robot>> robots);

// "10 s: 10000 steps of 0.001 s"
std::string time_text(const Configuration& configuration, std::int64_t steps);

// "cuda:1", "cpu, 4 threads", "automatic"
std::string device_text(const Device& device);

}  // namespace mercury
