// SPDX-License-Identifier: Apache-2.0
// Names of robots as names of files, and words of command lines.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

namespace mercury {

// A file name without folder and extension that holds this name: what file systems or shells would misread becomes "_".
// Never empty, at most 120 bytes.
std::string file_name_of(std::string_view name);

// Names of files for robots, each one once, so that no file replaces another: eel, eel-2, eel-3.
class FileNames {
 public:
  // file_name_of() the name, with a number if an earlier robot has it.
  std::string of(std::string_view name);

 private:
  std::unordered_set<std::string> taken_;
  std::unordered_map<std::string, std::size_t> last_;  // number given out for a name
};

// A word for the shell, in quotes if it needs them.
std::string shell_quoted(const std::string& word);

}  // namespace mercury
