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
constexpr const char* paper_folder = "paper";

struct Sample {
  std::string name;
  fs::path file;
};

// Those installed beside the running program or, when it runs from the build, those of the sources.
fs::path sample_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);  // empty without /proc
  const fs::path installed = program.empty() ? program : program.parent_path() / MERCURY_SAMPLES_FROM_PROGRAM;
  for (const fs::path& folder : {installed, fs::path(MERCURY_SAMPLES_SOURCE)})
    if (fs::is_directory(folder, error)) return folder;
  return {};
}

std::vector<Sample> samples() {
  std::vector<Sample> found;
  const fs::path folder = sample_folder();
  std::error_code error;
  const auto add = [&](const fs::path& from, const std::string& prefix) {
    if (!fs::is_directory(from, error)) return;
    for (const fs::path& file : robot_files(std::span(&from, 1)))
      found.push_back({prefix + file.stem().string(), file});
  };
  add(folder, "");
  add(folder / paper_folder, std::string(paper_folder) + "/");
  return found;
}

}  // namespace

std::vector<std::string> sample_names() {
  std::vector<std::string> names;
  for (const Sample& sample : samples()) names.push_back(sample_prefix + sample.name);
  return names;
}

fs::path sample_or_path(const fs::path& path) {
  const std::string name = path.string();
  if (!name.starts_with(sample_prefix)) return path;
  const std::string word = name.substr(std::string_view(sample_prefix).size());
  std::vector<std::string> known;
  const std::vector<Sample> all = samples();
  for (const std::string& wanted : {word, std::string(paper_folder) + "/" + word})
    for (const Sample& sample : all)
      if (sample.name == wanted) return sample.file.lexically_normal();
  for (const Sample& sample : all) known.push_back(sample.name);
  if (known.empty()) throw InputError(name, "the sample robots are not installed beside the program");
  throw InputError(name, "there is no such sample; give " + list_of(known, " or ") + suggestion(word, known));
}

}  // namespace mercury
