// SPDX-License-Identifier: Apache-2.0
// Exports robots and motions, checked: what the command, the window and Python share.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/base/output_files.h"
#include "app/export/export_format.h"
#include "mercury/configuration.h"
#include "mercury/import.h"

namespace mercury {

// The format that a file is written in: that of `name` if it is not empty, else that of the file's extension. Throws
// ParameterError("format" | "output", ...) for an unknown format, and for a file with another format's extension.
const ExportFormat& format_for(const std::filesystem::path& file, const std::string& name);

// Throws InputError that begins with the robot's name, or ParameterError("springs" | "format", ...), for what the
// format cannot hold.
void require_pose(const ExportFormat& format, const Robot& robot, bool springs);
void require_motion(const ExportFormat& format, const Robot& robot, bool springs);
// Throws ParameterError("floor" | "with_camera", ...) for what the format cannot hold.
void require_stage(const ExportFormat& format, const StageChoices& stage);

// The indices of the robots of these names that are chosen: by a name, or a number from 0; all if `robot` is empty.
// Throws ParameterError("robot", ...).
std::vector<std::size_t> chosen_robots(const std::string& robot, const std::vector<std::string>& names);
std::vector<std::string> names_of_robots(const TrajectoryReader& recording);

// Adds the file and what the format writes beside it to outputs that are checked. `inside` as OutputFiles::add_file().
void add_outputs(const ExportFormat& format, const std::filesystem::path& file, OutputFiles& outputs,
                 const std::string& option, const std::filesystem::path& inside = {});

// All that is written: "eel.obj and eel.mtl".
std::string outputs_text(const ExportFormat& format, const std::filesystem::path& file);

// Where a robot is simulated, in the terms of VXA.

struct VxaWorld {
  ImportedSettings settings;
  std::vector<std::string> lost;  // what VXA cannot say, a sentence each
};

// `seconds`: how long to simulate; none = the file does not say.
VxaWorld vxa_world(const Environment& environment, double damping, std::optional<double> seconds = {});

}  // namespace mercury
