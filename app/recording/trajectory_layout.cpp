// SPDX-License-Identifier: Apache-2.0
#include "app/recording/trajectory_layout.h"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "app/base/messages.h"

namespace mercury {
namespace {

constexpr std::size_t longest_name = 200;  // bytes of a group's name

std::string legal(std::string_view name) {
  std::string result;
  while (!name.empty() && result.size() < longest_name) {
    const std::size_t length = utf8_length(name);
    const bool plain =
        length > 1 || (length == 1 && static_cast<unsigned char>(name[0]) >= 0x20 && name[0] != '/' && name[0] != 0x7f);
    result += plain ? std::string(name.substr(0, length)) : "_";
    name.remove_prefix(std::max<std::size_t>(1, length));
  }
  return result.empty() || result == "." || result == ".." ? "robot" : result;
}

}  // namespace

bool is_trajectory_name(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return extension == ".h5" || extension == ".hdf5" || extension == ".h5md";
}

bool is_readable_trajectory_name(const std::filesystem::path& path) {
  // UnfinishedFile chooses the temporary names: NAME.PROCESS-NUMBER.part.
  return is_trajectory_name(path) || (path.extension() == ".part" && is_trajectory_name(path.stem().stem()));
}

std::vector<std::string> group_names(std::span<const std::string> robot_names) {
  std::vector<std::string> names;
  for (const std::string& name : robot_names) names.push_back(legal(name));
  const std::unordered_set<std::string> asked(names.begin(), names.end());
  std::unordered_set<std::string> taken;
  std::unordered_map<std::string, std::size_t> last;  // number given out for a name
  for (std::string& name : names) {
    if (taken.insert(name).second) continue;
    std::size_t& number = last.try_emplace(name, 1).first->second;
    std::string other;
    do other = name + "-" + std::to_string(++number);
    while (asked.contains(other) || taken.contains(other));
    taken.insert(other);
    name = other;
  }
  return names;
}

}  // namespace mercury
