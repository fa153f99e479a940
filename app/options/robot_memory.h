// SPDX-License-Identifier: Apache-2.0
// Whether the robots that a command asks for fit into memory, before they are made.
#pragma once

#include <cstddef>
#include <span>

#include "mercury/generator.h"

namespace mercury {

// About what a command takes for each robot that it holds, the robot included.
struct MemoryUse {
  std::size_t per_robot = 1024;  // [bytes]
  double per_content = 1;        // times content_bytes()
};

// Measured on the CPU (docs/experiments.md): in a simulation; recorded; drawn.
inline constexpr MemoryUse simulated_memory{.per_robot = 8 << 10, .per_content = 3.5},
    recorded_memory{.per_robot = 20 << 10, .per_content = 3.5}, drawn_memory{.per_robot = 36 << 10, .per_content = 7};

// What a robot's lists and texts take [bytes].
std::size_t content_bytes(const Robot& robot);

// Makes a few of the robots to see how large they are. Throws InputError("--random", memory_line()) if all of them
// would not fit into `usable` bytes, and Interrupted after Ctrl-C. A few robots are always accepted.
void require_memory_for(std::span<const RandomRobots> requests, const MemoryUse& use, std::size_t usable);

}  // namespace mercury
