// SPDX-License-Identifier: Apache-2.0
#include "app/base/output_files.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "mercury/error.h"
#include "mercury/file_links.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

// A line of standard input without its end. poll() returns at a signal; read() alone would go on waiting.
std::string read_line() {
  std::string line;
  while (!interrupted()) {
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (poll(&input, 1, -1) < 0) {
      if (errno == EINTR) continue;
      break;
    }
    char letter = 0;
    if (read(STDIN_FILENO, &letter, 1) != 1 || letter == '\n') break;
    line += letter;
  }
  return line;
}

// Whether there is somebody to ask.
bool can_ask() { return isatty(STDIN_FILENO) == 1 && isatty(STDERR_FILENO) == 1; }

// Prints "mercury: QUESTION [y/N] " and waits for a line. True for "y" and "yes". Throws Interrupted at Ctrl-C.
bool ask(const std::string& question) {
  write_to_standard_error("mercury: " + printable(question) + " [y/N] ");
  const std::string answer = read_line();
  if (interrupted()) write_to_standard_error("\n");
  throw_if_interrupted();
  return answer == "y" || answer == "Y" || answer == "yes" || answer == "Yes";
}

std::optional<struct stat> status_of(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return status;
}

// For the effective user, as open() decides it. Returns 0, or the error.
int access_error(const fs::path& path, int mode) {
  return ::faccessat(AT_FDCWD, path.c_str(), mode, AT_EACCESS) == 0 ? 0 : errno;
}

using FileNumber = std::pair<dev_t, ino_t>;
FileNumber number_of(const struct stat& status) { return {status.st_dev, status.st_ino}; }

// The files that the inputs name, and the robot files in folders among them.
std::set<FileNumber> files_of(const std::vector<fs::path>& inputs) {
  std::set<FileNumber> files;
  for (const fs::path& input : inputs) {
    const auto status = status_of(input);
    if (!status) continue;
    files.insert(number_of(*status));
    if (!S_ISDIR(status->st_mode)) continue;
    std::error_code error;
    for (fs::recursive_directory_iterator entry(input, error), end; !error && entry != end; entry.increment(error))
      if (const auto inside = status_of(entry->path()); find_robot_format(entry->path()) && inside)
        files.insert(number_of(*inside));
  }
  return files;
}

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

// The folder, or the one above it that exists, must take new files.
void require_writable_folder(const std::string& option, const std::string& name, fs::path folder) {
  std::error_code error;
  while (!fs::exists(fs::symlink_status(folder, error)) && folder.has_parent_path() && folder != folder.parent_path())
    folder = folder.parent_path();
  if (!fs::exists(fs::symlink_status(folder, error))) folder = ".";
  const auto status = status_of(folder);
  if (status && !S_ISDIR(status->st_mode))
    throw InputError(option, name + " cannot be written: " + folder.string() + " is no folder");
  if (const int refused = access_error(folder, W_OK | X_OK))
    throw InputError(option, name + " cannot be written: " + folder.string() + ": " + std::strerror(refused));
}

}  // namespace

bool is_standard_output(std::string_view file) { return file == "-" || file == "/dev/stdout"; }

void OutputFiles::add_stream(const std::string& option, const std::string& file, const fs::path& inside) {
  add(option, file, Kind::stream, inside);
}
void OutputFiles::add_file(const std::string& option, const std::string& file, const fs::path& inside) {
  add(option, file, Kind::file, inside);
}
void OutputFiles::add_folder(const std::string& option, const std::string& folder) {
  add(option, folder, Kind::folder);
}
void OutputFiles::add_new_folder(const std::string& option, const std::string& folder, const fs::path& inside) {
  add(option, folder, Kind::new_folder, inside);
}

void OutputFiles::add(const std::string& option, const std::string& name, Kind kind, const fs::path& inside) {
  std::error_code ignored;
  const fs::path end = follow_links(name);
  const fs::path target = fs::weakly_canonical(end.empty() ? end : fs::absolute(end, ignored), ignored);
  outputs_.push_back({option, name, kind, ignored ? end : target, inside});
}

void OutputFiles::require_usable(const Output& output) const {
  const auto& [option, name, kind, target, inside] = output;
  if (name.empty()) throw InputError(option, output.is_folder() ? "give a folder" : "give a file");
  if (kind == Kind::stream && is_standard_output(name)) return;
  if (!inside.empty() && status_of(inside)) require_inside(inside, name);
  const auto status = status_of(name);
  if (!status) return require_writable_folder(option, name, folder_of(target));
  if (output.is_folder()) {
    if (!S_ISDIR(status->st_mode)) throw InputError(option, name + " is a file, not a folder");
    return require_writable_folder(option, name, target);
  }
  if (S_ISDIR(status->st_mode)) throw InputError(option, name + " is a folder; give a file");
  if (is_device_or_pipe(name)) {
    if (kind == Kind::file) throw InputError(option, name + " is a device or pipe; give the name of a file");
    if (const int refused = access_error(name, W_OK))
      throw InputError(option, name + " cannot be written: " + std::strerror(refused));
    return;
  }
  // The superuser may write everything; who protects a file does not want it replaced.
  if ((status->st_mode & (S_IWUSR | S_IWGRP | S_IWOTH)) == 0 || access_error(name, W_OK) != 0)
    throw InputError(option, name + " is write-protected; give another name");
  require_writable_folder(option, name, folder_of(target));
}

// Of each existing output that is a regular file.
void OutputFiles::require_no_input() const {
  std::optional<std::set<FileNumber>> files;  // of the inputs; only existing outputs can be among them
  for (const Output& output : outputs_) {
    const auto file = status_of(output.target);
    if (is_device_or_pipe(output.name) || !file || !S_ISREG(file->st_mode)) continue;
    if (!files) files = files_of(inputs_);
    if (files->contains(number_of(*file)))
      throw InputError(output.option, output.name + " is a file that this command reads; give another name");
  }
}

void OutputFiles::require_distinct() const {
  std::map<fs::path, const Output*> first_with;  // by target, without devices and pipes
  const Output* first_printed = nullptr;
  for (const Output& output : outputs_) {
    const Output*& first = is_standard_output(output.name) ? first_printed : first_with[output.target];
    if (first)
      throw InputError(first->option == output.option ? first->option : first->option + ", " + output.option,
                       output.name + " is named twice; give each output a name of its own");
    if (is_standard_output(output.name) || !is_device_or_pipe(output.name)) first = &output;
  }
}

void OutputFiles::require_replaceable(const std::vector<const Output*>& existing) const {
  const Output& first = *existing.front();
  const bool is_folder = first.is_folder();
  if (!may_ask_ || !can_ask())
    throw InputError(first.option, first.name + (is_folder ? " is not empty; use --force to write into it, or give "
                                                             "another folder"
                                                           : " exists already; use --force to replace it, or give "
                                                             "another name"));
  const std::size_t others = existing.size() - 1;
  const std::string what = others == 0 ? first.name : first.name + " and " + std::to_string(others) + " more";
  const std::string question = others > 0  ? " exist; replace them?"
                               : is_folder ? " is not empty; write into it?"
                                           : " exists; replace it?";
  if (!ask(what + question)) throw InputError(first.option, first.name + " stays as it is; nothing was done");
}

bool OutputFiles::check() const {
  require_distinct();
  require_no_input();
  std::vector<const Output*> existing;
  std::error_code ignored;
  for (const Output& output : outputs_) {
    require_usable(output);
    const auto status = status_of(output.name);
    if (output.kind != Kind::folder) note_output(output.target, status.has_value());
    if (!status || is_standard_output(output.name) || output.kind == Kind::folder) continue;
    if (output.is_folder() ? !fs::is_empty(output.name, ignored) : !is_device_or_pipe(output.name))
      existing.push_back(&output);
  }
  if (existing.empty() || force_) return force_;
  require_replaceable(existing);
  return true;
}

void OutputFiles::make_folders() const {
  for (const Output& output : outputs_) {
    if (!output.is_folder() && is_standard_output(output.name)) continue;
    const fs::path folder = output.is_folder() ? output.target : output.target.parent_path();
    std::error_code error;
    if (!folder.empty()) fs::create_directories(folder, error);
    if (error) throw InputError(output.option, "cannot make the folder " + folder.string() + ": " + error.message());
  }
}

fs::path name_given(const fs::path& file, const std::function<void()>& write) {
  try {
    write();
    return file;
  } catch (const NameTaken& taken) {
    warn(taken.what());
    return taken.name;
  }
}

std::string csv_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

std::string base64(std::string_view bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? letters[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace mercury
