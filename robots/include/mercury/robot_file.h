// SPDX-License-Identifier: Apache-2.0
// Robots as files: JSON (*.json) and the same document as CBOR (*.cbor).
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mercury/robot.h"

namespace mercury {

enum class RobotFormat { json, cbor };

// A file's extension in small letters, ".json", since it may be in capitals.
std::string extension_of(const std::filesystem::path& path);

// The format by the file's extension; none unless that is .json or .cbor.
std::optional<RobotFormat> find_robot_format(const std::filesystem::path& path);
// The same. Throws InputError for another extension.
RobotFormat robot_format_of(const std::filesystem::path& path);

// The robot in a document, validated. A document without a name gives a robot without a name.
// Throws InputError in one line that says where and why: "/springs/7: mass 912 is out of range, the robot has 300",
// "line 3, column 7: not valid JSON: invalid literal". Memory grows with what the document holds, not with the sizes
// that it announces, so a hostile file cannot exhaust it.
Robot parse_robot(std::string_view document, RobotFormat format);

// The robots of a text that holds several documents, one after another: JSON with or without lines between them, or
// CBOR (RFC 8742). The first byte shows which. Refers to the text.
class RobotDocuments {
 public:
  explicit RobotDocuments(std::string_view text);
  // The next robot; none at the end. Throws InputError as parse_robot, with the number of the document before the
  // message ("document 3: /springs/7: ..."). The next call goes on after a document that cannot be used; where its end
  // cannot be found either, there is no next one.
  std::optional<Robot> next();

 private:
  std::string_view rest_;
  RobotFormat format_;
  std::size_t number_ = 0;  // of documents so far
};

// The document of a robot. Every float reads back bit for bit. Throws InputError if validate() refuses the robot, its
// origin is not a JSON object, or a text is not UTF-8.
std::string serialize_robot(const Robot& robot, RobotFormat format);

// The senses and the brain of a robot as JSON text, as in its document.
std::string sensors_as_json(const Robot& robot);
std::string brain_as_json(const Brain& brain);
// Give them to a robot. Throw InputError with the place as a JSON pointer for a text that describes none;
// validate_brain() says whether they fit the robot.
void set_sensors(Robot& robot, std::string_view json);
void set_brain(Robot& robot, std::string_view json);

// Reads a file. Throws InputError as parse_robot, with the path before the message ("eel.json: /springs/7: ..."), and
// for a file that cannot be read. A robot without a name gets the name of its file. "sample:eel" is a sample robot
// (mercury/samples.h).
Robot load_robot(const std::filesystem::path& path);

// Writes a file, whole or not at all. Throws InputError as serialize_robot, and for a file that cannot be written, with
// the system's reason.
void save_robot(const std::filesystem::path& path, const Robot& robot);
// The same in a format that the name need not show, as for a device or a pipe.
void save_robot(const std::filesystem::path& path, const Robot& robot, RobotFormat format);

// The robot files that these files and folders stand for, in the given order. A folder stands for its *.json and *.cbor
// files, sorted by name. If `recursive`, those of the folders inside it follow; links to folders are not followed.
// Throws InputError for a folder without such files. Files need not exist.
std::vector<std::filesystem::path> robot_files(std::span<const std::filesystem::path> paths, bool recursive = false);

// The robots of files and folders, in the given order. A folder stands for its *.json and *.cbor files, sorted by name;
// folders inside it are ignored. Throws InputError as load_robot, and for a folder without such files.
std::vector<Robot> load_robots(std::span<const std::filesystem::path> paths);

}  // namespace mercury
