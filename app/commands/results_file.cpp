// SPDX-License-Identifier: Apache-2.0
#include "app/commands/results_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "mercury/error.h"
#include "robots/whole_file.h"

namespace mercury {

bool is_standard_output(const std::string& file) { return file == "-" || file == "/dev/stdout"; }

void require_writable(const std::string& option, const std::string& file) {
  if (is_standard_output(file)) return;
  const std::filesystem::path path(file);
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) throw InputError(option, file + " is a folder; give a file");
  const bool is_special = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (is_special ? access(file.c_str(), W_OK) != 0 : access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(option, file + " cannot be written: " + std::strerror(errno));
}

void write_results(const std::string& file, std::string_view content) {
  if (is_standard_output(file))
    fmt::print("{}", content);
  else
    write_whole_file(file, content);
}

}  // namespace mercury
