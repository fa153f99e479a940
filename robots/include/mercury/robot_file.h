// SPDX-License-Identifier: Apache-2.0
// Robots as files: JSON (*.json) and the same document as CBOR (*.cbor).
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mercury/robot.h"

namespace mercury {

enum class RobotFormat { json, cbor };

// By the extension. Throws InputError for one that is neither .json nor .cbor.
RobotFormat robot_format_of(const std::filesystem::path& path);

// The robot that a document holds, validated. A document without a name gives a robot without one.
// Throws InputError in one line that says where and why: "/springs/7: mass 912 is out of range, the robot has 300",
// "line 3, column 7: not valid JSON: invalid literal". Memory follows what the document holds, never what it announces.
Robot parse_robot(std::string_view document, RobotFormat format);

// The document of a robot; every float in it is read back bit for bit. Throws InputError if validate() refuses the
// robot, its origin is not a JSON object, or a text is not UTF-8.
std::string serialize_robot(const Robot& robot, RobotFormat format);

// As parse_robot, the path before the message: "eel.json: /springs/7: ...". A robot without a name is named by its
// file. Throws InputError, too, for a file that cannot be read.
Robot load_robot(const std::filesystem::path& path);

// Writes the file whole or not at all. Throws InputError as serialize_robot and write_whole_file.
void save_robot(const std::filesystem::path& path, const Robot& robot);

// The robots of files and folders in the order given; a folder's *.json and *.cbor by name, without its own folders.
// Throws InputError as load_robot, and for a folder that holds no such file.
std::vector<Robot> load_robots(std::span<const std::filesystem::path> paths);

}  // namespace mercury
