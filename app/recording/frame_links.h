// SPDX-License-Identifier: Apache-2.0
// An HDF5 file in which each frame of a recorded robot has names of its own, for programs that read whole datasets
// alone: position/0, position/1, ..., velocity/0, ... It holds no numbers; those stay in the recording, which it refers
// to.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace mercury {

struct LinkedRobot {
  std::string recording;   // its file, as seen from the folder of the links
  std::string group;       // of the robot in /particles
  std::size_t frames = 0;  // of the recording
  std::size_t masses = 0;
};

// `numbers`: those of the frames in the recording, in the order of their names. The file is whole or not there; one of
// that name is replaced. Throws std::runtime_error that begins with the path.
void write_frame_links(const std::filesystem::path& path, const LinkedRobot& robot,
                       std::span<const std::size_t> numbers);

}  // namespace mercury
