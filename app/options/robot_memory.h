// SPDX-License-Identifier: Apache-2.0
// Whether the robots that a command asks for fit into memory, before they are made.
#pragma once

#include <cstddef>
#include <span>

#include "mercury/generator.h"
#include "mercury/host_memory.h"

namespace mercury {

// Measured on the CPU (docs/experiments.md): recorded; drawn.
inline constexpr MemoryUse recorded_memory{.per_robot = 20 << 10, .per_content = 3.5},
    drawn_memory{.per_robot = 36 << 10, .per_content = 7};

// Makes a few of the robots to see how large they are. Throws InputError("--random", memory_line()) if all of them
// would not fit into `usable` bytes, and Interrupted after Ctrl-C. A few robots are always accepted.
void require_memory_for(std::span<const RandomRobots> requests, const MemoryUse& use, std::size_t usable);

}  // namespace mercury
