// SPDX-License-Identifier: Apache-2.0
// Memory that this process may still take, asked before it is taken: a process that takes too much is killed by the
// kernel without a word.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mercury {

struct Robot;

// Of the host [bytes]: the least of what Linux calls available, what the limits of the control groups (containers)
// leave, and what the limits of the process (ulimit -v, ulimit -d) leave.
std::size_t available_host_memory();

// The same without a reserve of an eighth, at most 1 GiB, for what nobody has counted [bytes].
std::size_t usable_host_memory();

// What a robot's lists and texts take [bytes].
std::size_t content_bytes(const Robot& robot);

// About what a program takes for each robot that it holds, the robot included.
struct MemoryUse {
  std::size_t per_robot = 1024;  // [bytes]
  double per_content = 1;        // times content_bytes()
  double of(const Robot& robot) const {
    return static_cast<double>(per_robot) + per_content * static_cast<double>(content_bytes(robot));
  }
};
// In a simulation on the CPU, measured (docs/experiments.md).
inline constexpr MemoryUse simulated_memory{.per_robot = 8 << 10, .per_content = 3.5};

// "300 kB", "1.2 GB", in powers of 1000.
std::string byte_text(std::size_t bytes);

// "about 24 GB of memory are needed, 8.1 GB can be used; give up to 31000 robots". Without `fits`, it ends at the
// semicolon.
std::string memory_line(std::size_t needed, std::size_t usable, std::string_view fits = {});

// For a failed allocation: "not enough memory: more is needed than the limit, 40 MiB (ulimit -d)".
std::string no_memory_line();

// The limit of the process that leaves the least memory: "40 MiB (ulimit -d)"; empty if there is none.
std::string memory_limit_text();

}  // namespace mercury
