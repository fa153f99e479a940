// SPDX-License-Identifier: Apache-2.0
#include "mercury/samples.h"

#include <span>
#include <string_view>
#include <system_error>

#include "mercury/error.h"
#include "mercury/names.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

constexpr const char* sample_prefix = "sample:";

// Those installed beside the running program or, when it runs from the build, those of the sources.
std::vector<fs::path> sample_files() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);  // empty without /proc
  const fs::path installed = program.empty() ? program : program.parent_path() / MERCURY_SAMPLES_FROM_PROGRAM;
  for (const fs::path& folder : {installed, fs::path(MERCURY_SAMPLES_SOURCE)})
    if (fs::is_directory(folder, error)) return robot_files(std::span(&folder, 1));
  return {};
}

}  // namespace

std::vector<std::string> sample_names() {
  std::vector<std::string> names;
  for (const fs::path& file : sample_files()) names.push_back(sample_prefix + file.stem().string());
  return names;
}

fs::path sample_or_path(const fs::path& path) {
  const std::string name = path.string();
  if (!name.starts_with(sample_prefix)) return path;
  const std::vector<fs::path> files = sample_files();
  std::vector<std::string> known;
  for (const fs::path& file : files) {
    known.push_back(file.stem().string());
    if (sample_prefix + known.back() == name) return file.lexically_normal();
  }
  if (known.empty()) throw InputError(name, "the sample robots are not installed beside the program");
  const std::string word = name.substr(std::string_view(sample_prefix).size());
  throw InputError(name, "there is no such sample; give " + list_of(known, " or ") + suggestion(word, known));
}

}  // namespace mercury
