// SPDX-License-Identifier: Apache-2.0
#include "sim/available_memory.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>

namespace mercury {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

// The number that follows `format` in one of the lines of a system file; none if there is no such line.
std::optional<std::size_t> number_in(const char* path, const char* format) {
  const File file(std::fopen(path, "r"), std::fclose);
  char line[256];
  unsigned long long number = 0;
  while (file && std::fgets(line, sizeof line, file.get()))
    if (std::sscanf(line, format, &number) == 1) return number;
  return std::nullopt;
}

}  // namespace

std::size_t available_host_memory() {
  std::size_t bytes =
      static_cast<std::size_t>(sysconf(_SC_AVPHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  if (const auto kilobytes = number_in("/proc/meminfo", "MemAvailable: %llu kB")) bytes = *kilobytes * 1024;
  const auto limit = number_in("/sys/fs/cgroup/memory.max", "%llu");
  const auto used = number_in("/sys/fs/cgroup/memory.current", "%llu");
  if (limit && used) bytes = std::min(bytes, *limit - std::min(*limit, *used));
  return bytes;
}

}  // namespace mercury
