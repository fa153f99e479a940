// SPDX-License-Identifier: Apache-2.0
// What `mercury info --json` says. docs/formats.md describes the members.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "app/options/scene_file.h"
#include "app/recording/repro.h"
#include "app/recording/trajectory_reader.h"
#include "mercury/environment.h"
#include "mercury/robot.h"
#include "mercury/run_folder.h"

namespace mercury {

// One resource of the program: what was found, and advice if it is missing or could be better.
struct Finding {
  std::string what;    // "encoder"
  std::string found;   // "ffmpeg 5.1.9 (H.264, VP9, GIF)", or "none"
  std::string advice;  // empty = all is well
};

// Processor, memory, GPUs, ways to draw, encoder. `ffmpeg` as in encoder_program().
std::vector<Finding> inspect_machine(const std::string& ffmpeg);

// The environment that the robot says it was made for, else the default.
Environment environment_made_for(const Robot& robot);

// The text, or null if it is empty.
nlohmann::ordered_json text_or_null(const std::string& text);

// The members of Python's Robot.info() have its names.
nlohmann::ordered_json info_of(const Robot& robot, const std::filesystem::path& file);
nlohmann::ordered_json info_of(const TrajectoryReader& recording);
nlohmann::ordered_json info_of(const Repro& repro, const std::filesystem::path& file);
nlohmann::ordered_json info_of(const RunHistory& run);
// Reads the robots' files for the environment that they are made for.
nlohmann::ordered_json info_of(const SceneFile& scene);
// The configuration of a scene's robots.
Configuration configuration_of(const SceneFile& scene);
nlohmann::ordered_json info_of(std::span<const Finding> machine);

}  // namespace mercury
