// SPDX-License-Identifier: Apache-2.0
// What the writer and the reader of trajectories agree on: version and names in the file; and files of links to frames.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace mercury {

inline constexpr int trajectory_format = 1;  // attribute "format" of /parameters
inline constexpr std::array<int, 2> h5md_version{1, 1};
inline constexpr std::size_t held_bytes = std::size_t{64} << 20;  // of frames that a writer or reader keeps in memory

// Whether the name has the extension of a trajectory: .h5, .hdf5 or .h5md.
bool is_trajectory_name(const std::filesystem::path& path);
// Whether a trajectory can be read from a file of this name: is_trajectory_name(), or the temporary name that such a
// file has while it is written, as swim.h5.1234-0.part.
bool is_readable_trajectory_name(const std::filesystem::path& path);

// A group's name for each robot, all different: the robot's own name where HDF5 allows it. Slashes and control
// characters become "_"; "", "." and ".." become "robot"; long names are cut; a name that is already taken gets "-2",
// "-3", ...
std::vector<std::string> group_names(std::span<const std::string> robot_names);

// An HDF5 file in which each frame of a recorded robot has names of its own, for programs that read whole datasets
// alone: position/0, position/1, ..., velocity/0, ... It holds no numbers; those stay in the recording, which it refers
// to.

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
