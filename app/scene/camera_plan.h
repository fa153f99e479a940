// SPDX-License-Identifier: Apache-2.0
// How the camera moves: an option of the command line, or a camera file.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "render/camera.h"
#include "render/vector.h"

namespace mercury {

enum class CameraMode {
  group,      // keeps all robots in view
  follow,     // moves with one robot, or with the middle of the group
  turntable,  // circles the group
  top,        // looks straight down, all robots in view
  still,      // does not move
};

struct CameraPlan {
  CameraMode mode = CameraMode::group;
  std::string robot;                      // follow: its name, or its number from 0; empty = the group
  std::optional<float> azimuth;           // direction from the robots to the eye, from +x toward +y [rad]
  std::optional<float> elevation;         // of the eye above the horizon [rad]
  float zoom = 1;                         // above 1 = closer
  float field_of_view = 0.6f;             // of the picture's height [rad]
  double period = 20;                     // turntable: of a turn [s of video]
  std::optional<render::Vector3> target;  // still: what it looks at, in the picture's coordinates [m]; else all robots
  std::optional<float> distance;          // still: from the target [m]

  friend bool operator==(const CameraPlan&, const CameraPlan&) = default;
};

// "group", "follow", "turntable", "top", "still".
std::string_view name_of(CameraMode mode);

// Whether it is the name of a camera file, *.json.
bool is_camera_file(const std::string& text);
// "turntable", "follow:eel", the name of a camera file (*.json), or its members as text, {"mode": "still", ...}. Throws
// ParameterError("camera", ...).
CameraPlan camera_named(const std::string& text);

// Cameras to go back to.
constexpr std::size_t most_bookmarks = 4;
using CameraBookmarks = std::array<std::optional<CameraPlan>, most_bookmarks>;
// A JSON list of cameras, null where there is none. Empty text if there is none at all. The other way throws
// ParameterError("bookmarks", ...).
std::string bookmarks_text(const CameraBookmarks& bookmarks);
CameraBookmarks bookmarks_from(const std::string& text);

// A camera file: {"format": "mercury-camera", "version": 1, "mode": "still", "azimuth": -1.3, "target": [0, 0, 1],
// ...}, members as in CameraPlan, angles in radians; only the format and version are required. Throws InputError in one
// line that says where and why.
CameraPlan load_camera(const std::filesystem::path& path);
void save_camera(const std::filesystem::path& path, const CameraPlan& plan);

}  // namespace mercury
