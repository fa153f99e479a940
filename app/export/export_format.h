// SPDX-License-Identifier: Apache-2.0
// The formats that robots and motions can be exported to. Each is described once, in the table of export_format.cpp;
// the command line, the window, Python and their messages derive from it. A new format is one writer and one row there.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/export/writers.h"

namespace mercury {

struct ExportFormat {
  enum class Springs { never, if_asked, always };

  std::string_view name;       // on the command line: "obj"
  std::string_view extension;  // of the file that is named: ".obj"
  std::string_view title;      // in the window: "Wavefront OBJ"
  std::string_view help;       // what it holds and who reads it, without a full stop
  Springs springs = Springs::never;
  bool needs_skin = true;        // a robot without faces would be empty
  bool holds_scene = false;      // can hold a floor and a camera
  bool holds_world = false;      // gravity, floor, water
  bool needs_recording = false;  // the file refers to the recording, which must stay
  // What it can hold: a pose, a motion, or both; nullptr = it cannot.
  void (*pose)(const ExportedRobot&, const Pose&, const std::filesystem::path&, const ExportChoices&) = nullptr;
  void (*motion)(const ExportedRobot&, RecordedMotion&, const std::filesystem::path&, const ExportChoices&) = nullptr;
  // Several motions in one file; nullptr = it holds one robot.
  void (*motions)(std::span<RecordedMotion>, const std::filesystem::path&, const ExportChoices&) = nullptr;
  // Files and a folder that are written beside the file; nullptr = none.
  std::vector<std::filesystem::path> (*files_beside)(const std::filesystem::path&) = nullptr;
  std::filesystem::path (*folder_beside)(const std::filesystem::path&) = nullptr;
};

std::span<const ExportFormat> export_formats();

// The format of a name. Throws ParameterError("format", ...) that lists all.
const ExportFormat& export_format(std::string_view name);
// The format whose extension a file has, in any case of letters; nullptr = none.
const ExportFormat* export_format_of(const std::filesystem::path& file);

// "obj, ply, stl"; those for which `condition` holds.
std::string format_names(bool (*condition)(const ExportFormat&) = [](const ExportFormat&) { return true; });
inline bool holds_pose(const ExportFormat& format) { return format.pose != nullptr; }
inline bool holds_motion(const ExportFormat& format) { return format.motion != nullptr; }
// Those that the window can write, which has no recording.
inline bool holds_simulated_motion(const ExportFormat& format) {
  return holds_motion(format) && !format.needs_recording;
}
inline bool holds_scene(const ExportFormat& format) { return format.holds_scene; }
inline bool holds_springs(const ExportFormat& format) { return format.springs != ExportFormat::Springs::never; }

}  // namespace mercury
