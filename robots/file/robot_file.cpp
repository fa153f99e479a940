// SPDX-License-Identifier: Apache-2.0
#include "mercury/robot_file.h"
#include "mercury/real_body.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "mercury/error.h"
#include "mercury/samples.h"
#include "robots/file/inner_members.h"
#include "robots/file/robot_document.h"
#include "robots/file/whole_file.h"

namespace mercury {
namespace {

// Adds the robot files of a folder, sorted, each folder's own files before those of the folders inside it. Links to
// folders are not followed, since they may lead in circles.
void add_files_of(const std::filesystem::path& folder, bool recursive, std::vector<std::filesystem::path>& files) {
  std::vector<std::filesystem::path> own, folders;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_directory(ignored)) {
      if (!entry->is_symlink(ignored)) folders.push_back(entry->path());
    } else if (find_robot_format(entry->path())) {
      own.push_back(entry->path());
    }
  }
  if (error) throw InputError(folder.string(), error.message());
  std::ranges::sort(own);
  files.insert(files.end(), own.begin(), own.end());
  if (!recursive) return;
  std::ranges::sort(folders);
  for (const auto& inner : folders) add_files_of(inner, recursive, files);
}

}  // namespace

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& letter : extension)
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  return extension;
}

std::optional<RobotFormat> find_robot_format(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  if (extension == ".json") return RobotFormat::json;
  if (extension == ".cbor") return RobotFormat::cbor;
  return std::nullopt;
}

RobotFormat robot_format_of(const std::filesystem::path& path) {
  if (const auto format = find_robot_format(path)) return *format;
  const auto extension = path.extension();
  throw InputError(path.string(), extension.empty()
                                      ? "a robot file needs an extension; give .json or .cbor"
                                      : "extension " + extension.string() + " is not a robot's; give .json or .cbor");
}

Robot parse_robot(std::string_view document, RobotFormat format) {
  RobotReader reader;
  InnerMembersReader all(reader);
  format == RobotFormat::json ? read_json(document, all) : read_cbor(document, all);
  Robot robot = reader.take();
  robot.other = all.with_inner(robot.other, !real_material_of(robot));  // whose table is another one than the file's
  return robot;
}

RobotDocuments::RobotDocuments(std::string_view text) : rest_(text), format_(RobotFormat::json) {
  // JSON begins with ASCII or a byte order mark, a robot in CBOR with a map (0xa0 to 0xbf) or a tag (0xc0 to 0xdb).
  const auto first = static_cast<unsigned char>(rest_.empty() ? 0 : rest_.front());
  if (first >= 0x80 && first != 0xef) format_ = RobotFormat::cbor;
}

std::optional<Robot> RobotDocuments::next() {
  if (format_ == RobotFormat::json) {
    constexpr std::string_view space = " \t\r\n";
    rest_.remove_prefix(std::min(rest_.find_first_not_of(space), rest_.size()));
  }
  if (rest_.empty()) return std::nullopt;
  ++number_;
  const std::string_view all = std::exchange(rest_, {});
  try {
    const std::size_t end = format_ == RobotFormat::json ? first_json_value(all) : first_cbor_item(all);
    rest_ = all.substr(end);
    return parse_robot(all.substr(0, end), format_);
  } catch (const InputError& error) {
    throw InputError("document " + std::to_string(number_), error.what());
  }
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

Robot load_robot(const std::filesystem::path& given) {
  const std::filesystem::path path = sample_or_path(given);
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
  save_robot(path, robot, robot_format_of(path));
}

void save_robot(const std::filesystem::path& path, const Robot& robot, RobotFormat format) {
  std::string document;
  try {
    document = serialize_robot(robot, format);
  } catch (const InputError& error) {
    throw InputError(path.string(), error.what());
  }
  write_whole_file(path, document);
}

std::vector<std::filesystem::path> robot_files(std::span<const std::filesystem::path> paths, bool recursive) {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;
  for (const auto& path : paths) {
    if (!std::filesystem::is_directory(path, ignored)) {
      files.push_back(path);
      continue;
    }
    const std::size_t before = files.size();
    add_files_of(path, recursive, files);
    if (files.size() == before)
      throw InputError(path.string(), recursive ? "the folder and those in it hold no robot, neither *.json nor *.cbor"
                                                : "the folder holds no robot, neither *.json nor *.cbor");
  }
  return files;
}

std::vector<Robot> load_robots(std::span<const std::filesystem::path> paths) {
  std::vector<Robot> robots;
  for (const auto& file : robot_files(paths)) robots.push_back(load_robot(file));
  return robots;
}

}  // namespace mercury
