// SPDX-License-Identifier: Apache-2.0
// Results of mercury run --json as inputs: what they say of robots and settings, so that both can be simulated again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/options/robot_options.h"
#include "mercury/configuration.h"
#include "mercury/robot.h"
#include "mercury/simulation.h"

namespace mercury {

// A robot of a result. All but the names are there only if it was stepped.
struct RobotOfResult {
  std::string place;  // "/robots/3"
  std::string name;
  std::string file;    // that it was read from; empty = a random robot
  std::string random;  // what makes it alone with --random
  std::size_t masses = 0, springs = 0;
  std::string physics;
  std::uint64_t hash = 0;  // of the final state
};

struct RunResult {
  std::filesystem::path path;
  std::string program, device;  // that made it
  Configuration configuration;
  std::int64_t steps = 0;
  double seconds = 0;  // simulated
  std::int64_t trials = 1;
  double jitter = 0;
  std::vector<RobotOfResult> robots;  // those that were stepped
};

// Whether a file is a result of mercury run --json, by its first members. False if it cannot be read.
bool is_result(const std::filesystem::path& path);

// Throws InputError that begins with the path, for what is no result or names no robot that was stepped.
RunResult read_result(const std::filesystem::path& path);

// The robots of a result, in its order, with the options of their kind. Files are looked for where the command runs,
// then beside the result. Throws InputError for those that are not there, or that are not the robots of the result.
std::vector<std::shared_ptr<const Robot>> robots_of(const RunResult& result, const RobotOptions& options);

// Simulates robots as the result says, and compares final states. Says in one line what became of it: as a note if all
// are the same or cannot be compared, as a warning if some differ. Returns false then. Throws Interrupted.
bool check_again(const RunResult& result, const std::vector<std::shared_ptr<const Robot>>& robots,
                 const Device& device);

}  // namespace mercury
