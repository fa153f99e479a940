// SPDX-License-Identifier: Apache-2.0
// What `mercury info --json` says. docs/formats.md describes the members.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>

#include "app/commands/machine.h"
#include "app/recording/repro.h"
#include "app/recording/trajectory_reader.h"
#include "mercury/robot.h"
#include "mercury/run_folder.h"

namespace mercury {

// The members of Python's Robot.info() have its names.
nlohmann::ordered_json info_of(const Robot& robot, const std::filesystem::path& file);
nlohmann::ordered_json info_of(const TrajectoryReader& recording);
nlohmann::ordered_json info_of(const Repro& repro, const std::filesystem::path& file);
nlohmann::ordered_json info_of(const RunHistory& run);
nlohmann::ordered_json info_of(std::span<const Finding> machine);

}  // namespace mercury
