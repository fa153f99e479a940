// SPDX-License-Identifier: Apache-2.0
#include "mercury/robot_file.h"

#include <algorithm>
#include <system_error>

#include "mercury/error.h"
#include "robots/robot_document.h"
#include "robots/whole_file.h"

namespace mercury {
namespace {

std::vector<std::filesystem::path> robot_files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const auto extension = entry->path().extension();
    if ((extension == ".json" || extension == ".cbor") && !entry->is_directory()) files.push_back(entry->path());
  }
  if (error) throw InputError(folder.string(), error.message());
  if (files.empty()) throw InputError(folder.string(), "the folder holds no robot, neither *.json nor *.cbor");
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

RobotFormat robot_format_of(const std::filesystem::path& path) {
  const auto extension = path.extension();
  if (extension == ".json") return RobotFormat::json;
  if (extension == ".cbor") return RobotFormat::cbor;
  throw InputError(path.string(), extension.empty()
                                      ? "a robot file needs an extension; give .json or .cbor"
                                      : "extension " + extension.string() + " is not a robot's; give .json or .cbor");
}

Robot parse_robot(std::string_view document, RobotFormat format) {
  RobotReader reader;
  format == RobotFormat::json ? read_json(document, reader) : read_cbor(document, reader);
  return reader.take();
}

std::string serialize_robot(const Robot& robot, RobotFormat format) {
  validate(robot);
  std::string document;
  if (format == RobotFormat::json) {
    JsonWriter writer(document, JsonWriter::Layout::rows);
    write_robot(robot, writer);
    document += '\n';
  } else {
    CborWriter writer(document);
    write_robot(robot, writer);
  }
  return document;
}

Robot load_robot(const std::filesystem::path& path) {
  std::error_code missing;
  if (!std::filesystem::exists(path, missing) && !missing) throw InputError(path.string(), "No such file or directory");
  const RobotFormat format = robot_format_of(path);
  const std::string document = read_whole_file(path);
  try {
    Robot robot = parse_robot(document, format);
    if (robot.name.empty()) robot.name = path.stem().string();
    return robot;
  } catch (const InputError& error) {
    throw InputError(path.string(), error.what());
  }
}

void save_robot(const std::filesystem::path& path, const Robot& robot) {
  const RobotFormat format = robot_format_of(path);
  std::string document;
  try {
    document = serialize_robot(robot, format);
  } catch (const InputError& error) {
    throw InputError(path.string(), error.what());
  }
  write_whole_file(path, document);
}

std::vector<Robot> load_robots(std::span<const std::filesystem::path> paths) {
  std::vector<Robot> robots;
  std::error_code ignored;
  for (const auto& path : paths) {
    if (!std::filesystem::is_directory(path, ignored)) {
      robots.push_back(load_robot(path));
      continue;
    }
    for (const auto& file : robot_files_in(path)) robots.push_back(load_robot(file));
  }
  return robots;
}

}  // namespace mercury
