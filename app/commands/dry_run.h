// SPDX-License-Identifier: Apache-2.0
// What a command would do, as --dry-run prints it on standard output.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/options/robot_options.h"
#include "mercury/configuration.h"
#include "mercury/robot.h"

namespace mercury {

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
