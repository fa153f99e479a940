// SPDX-License-Identifier: Apache-2.0
#include "mercury/host_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "mercury/robot.h"
#include "sim/host_memory.h"

namespace mercury {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

// The lines of a system file; none if it cannot be read.
std::vector<std::string> lines_of(const std::string& path) {
  const File file(std::fopen(path.c_str(), "r"), std::fclose);
  std::vector<std::string> lines;
  std::array<char, 4096> line;
  while (file && std::fgets(line.data(), line.size(), file.get())) {
    lines.emplace_back(line.data());
    while (lines.back().ends_with('\n')) lines.back().pop_back();
  }
  return lines;
}

// The number after a word in one of the lines of a system file; with an empty word, the first number. None if there is
// no such line, or it has no number ("max").
std::optional<std::size_t> number_in(const std::string& path, const std::string& word) {
  for (const std::string& line : lines_of(path)) {
    unsigned long long number = 0;
    if (line.starts_with(word) && std::sscanf(line.c_str() + word.size(), "%llu", &number) == 1) return number;
  }
  return std::nullopt;
}

std::size_t difference(std::size_t limit, std::size_t taken) { return limit - std::min(limit, taken); }

// The names of the files differ between the versions of control groups.
struct GroupFiles {
  const char *limit, *taken, *droppable;
};

std::size_t left_in_group(const std::string& folder, const GroupFiles& files) {
  const auto limit = number_in(folder + "/" + files.limit, ""), taken = number_in(folder + "/" + files.taken, "");
  if (!limit || !taken) return unlimited_memory;
  const std::size_t droppable = number_in(folder + "/memory.stat", files.droppable).value_or(0);
  return difference(*limit, difference(*taken, droppable));
}

// A group ("/docker/1f") and all groups around it.
std::size_t left_in_groups(const std::string& mount, std::string group, const GroupFiles& files) {
  std::size_t left = left_in_group(mount, files);
  for (; group.size() > 1; group.resize(group.rfind('/'))) {
    if (group.front() != '/') return left;
    left = std::min(left, left_in_group(mount + group, files));
  }
  return left;
}

}  // namespace

std::size_t left_in_control_groups(const std::string& root, const std::string& membership) {
  constexpr GroupFiles version_1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file "},
      version_2{"memory.max", "memory.current", "inactive_file "};
  std::size_t left = unlimited_memory;
  for (std::size_t at = 0, end = 0; at < membership.size(); at = end + 1) {  // "0::/job", "4:cpu,memory:/docker/1f"
    end = std::min(membership.find('\n', at), membership.size());
    const std::string line = membership.substr(at, end - at);
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string group = line.substr(second + 1);
    if (second == first + 1) left = std::min(left, left_in_groups(root, group, version_2));
    std::string controllers = line.substr(first, second - first + 1);  // ":cpu,memory:"
    std::ranges::replace(controllers, ',', ':');
    if (controllers.find(":memory:") != std::string::npos)
      left = std::min(left, left_in_groups(root + "/memory", group, version_1));
  }
  return left;
}

namespace {

struct ProcessLimit {
  std::size_t left = unlimited_memory, limit = unlimited_memory;  // [bytes]
  const char* command = "";
};

// The one that leaves the least.
ProcessLimit tightest_limit() {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  unsigned long long size = 0, resident = 0, shared = 0, code = 0, unused = 0, data = 0;  // [pages]
  const std::vector<std::string> lines = lines_of("/proc/self/statm");
  if (lines.empty() || std::sscanf(lines.front().c_str(), "%llu %llu %llu %llu %llu %llu", &size, &resident, &shared,
                                   &code, &unused, &data) != 6)
    return {};
  ProcessLimit tightest;
  const auto apply = [&](auto resource, std::size_t taken, const char* command) {
    rlimit limit{};
    if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
    const std::size_t left = difference(limit.rlim_cur, taken * page);
    if (left < tightest.left) tightest = {left, limit.rlim_cur, command};
  };
  apply(RLIMIT_AS, size, "ulimit -v");
  apply(RLIMIT_DATA, data, "ulimit -d");
  return tightest;
}

}  // namespace

std::size_t left_by_process_limits() { return tightest_limit().left; }

std::size_t available_host_memory() {
  std::size_t bytes =
      static_cast<std::size_t>(sysconf(_SC_AVPHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  if (const auto kilobytes = number_in("/proc/meminfo", "MemAvailable:")) bytes = *kilobytes * 1024;
  std::string membership;
  for (const std::string& line : lines_of("/proc/self/cgroup")) membership += line + "\n";
  return std::min({bytes, left_by_process_limits(), left_in_control_groups("/sys/fs/cgroup", membership)});
}

std::size_t usable_host_memory() {
  const std::size_t available = available_host_memory();
  return available - std::min(available / 8, std::size_t{1} << 30);
}

std::size_t content_bytes(const Robot& robot) {
  std::size_t bytes = sizeof(Robot) + robot.name.size() + robot.origin.size() +
                      robot.materials.size() * (sizeof(Material) + sizeof(std::string)) +
                      robot.masses.size() * sizeof(Vec3) + robot.springs.size() * sizeof(Spring) +
                      robot.faces.size() * sizeof(Face) + robot.mass.size() * sizeof(float) +
                      robot.velocity.size() * sizeof(Vec3) + robot.fixed.size() * sizeof(std::uint16_t);
  for (const Actuator& actuator : robot.actuators) bytes += sizeof(Actuator) + actuator.materials.size();
  if (robot.brain) bytes += weights_of(*robot.brain).size() * sizeof(float);
  return bytes;
}

std::string byte_text(std::size_t bytes) {
  constexpr std::array units{"bytes", "kB", "MB", "GB", "TB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 999.5 && unit + 1 < units.size(); ++unit) value /= 1000;
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), value < 9.95 && unit > 0 ? "%.1f %s" : "%.0f %s", value, units[unit]);
  return text.data();
}

std::string memory_line(std::size_t needed, std::size_t usable, std::string_view fits) {
  std::string line = "about " + byte_text(needed) + " of memory are needed, " + byte_text(usable) + " can be used";
  if (!fits.empty()) line.append("; give ").append(fits);
  return line;
}

std::string memory_limit_text() {
  const ProcessLimit limit = tightest_limit();
  if (limit.limit == unlimited_memory) return {};
  return std::to_string(limit.limit >> 20) + " MiB (" + limit.command + ")";
}

std::string no_memory_line() {
  const std::string limit = memory_limit_text();
  if (limit.empty()) return "not enough memory: more is needed than can be used, " + byte_text(available_host_memory());
  return "not enough memory: more is needed than the limit, " + limit;
}

}  // namespace mercury
