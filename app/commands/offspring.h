// SPDX-License-Identifier: Apache-2.0
// Children of robots, written into files: `mercury mutate` and `mercury cross`.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "app/options/robot_inputs.h"
#include "app/options/robot_output.h"
#include "mercury/robot.h"

namespace mercury {

// The robots of files and folders that a generator made. One that cannot be grown again is as a file that cannot be
// used, with `verb` in the message: "eel: cannot be mutated, ...".
std::vector<Robot> load_parents(const RobotInputs& files, const char* verb);
// The same, but calls handmade(robot), which may throw InputError, for a robot that no generator made.
std::vector<Robot> load_parents_of(const RobotInputs& files, const std::function<void(const Robot&)>& handmade);

// Makes the index-th child from a seed. Throws InputError if it cannot be made.
using MakeChild = std::function<Robot(std::uint64_t index, std::uint64_t seed)>;

// Makes children 0 .. count - 1 and writes them. No two of them have the same body (body_hash()), and none has that of
// a parent. A child that cannot be made, or whose body is there already, is drawn again with other seeds; after 30
// draws it is reported on standard error and left out. The children depend on the seed of the output alone, not on
// threads. Returns the exit status: 0, or 1 if a child is missing or the user interrupted.
int write_children(const RobotOutput& output, RobotFiles files, std::uint64_t count, const std::vector<Robot>& parents,
                   const MakeChild& make);

}  // namespace mercury
