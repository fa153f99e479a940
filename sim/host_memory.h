// SPDX-License-Identifier: Apache-2.0
// Parts of available_host_memory(), for its tests.
#pragma once

#include <cstddef>
#include <limits>
#include <string>

namespace mercury {

inline constexpr std::size_t unlimited_memory = std::numeric_limits<std::size_t>::max();

// What the limits of a process's control groups leave, of version 1 or 2 [bytes]. Files that the group holds in memory
// and that Linux can drop do not count as taken. `root` = where control groups are mounted (/sys/fs/cgroup),
// `membership` = what /proc/self/cgroup holds.
std::size_t left_in_control_groups(const std::string& root, const std::string& membership);

// What RLIMIT_AS and RLIMIT_DATA leave [bytes].
std::size_t left_by_process_limits();

}  // namespace mercury
