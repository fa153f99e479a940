// SPDX-License-Identifier: Apache-2.0
// What this machine can do for the program.
#pragma once

#include <string>
#include <vector>

namespace mercury {

// One resource of the program: what was found, and advice if it is missing or could be better.
struct Finding {
  std::string what;    // "encoder"
  std::string found;   // "ffmpeg 5.1.9 (H.264, VP9, GIF)", or "none"
  std::string advice;  // empty = all is well
};

// Processor, memory, GPUs, ways to draw, encoder. `ffmpeg` as in encoder_program().
std::vector<Finding> inspect_machine(const std::string& ffmpeg);

}  // namespace mercury
