// SPDX-License-Identifier: Apache-2.0
// Writes the positions and velocities of a batch, frame by frame, into an H5MD 1.1 file (docs/formats.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/base/interrupt.h"
#include "app/recording/trajectory_hdf5.h"
#include "mercury/configuration.h"
#include "mercury/robot.h"
#include "mercury/telemetry.h"

namespace mercury {

// Everything in a trajectory except robots and frames.
struct TrajectoryHeader {
  Configuration configuration;
  std::string device_name;            // for people
  std::optional<std::uint64_t> seed;  // of the random robots, if any
  std::int64_t every = 1;             // steps per frame
  std::int64_t expected_frames = 0;   // 0 = unknown
  int deflate = 0;                    // compression of the frames: 0 = none, 1 (fast) .. 9
};

// Streams: holds a few frames (at most 64 MB, or one frame if that is more) and keeps no HDF5 object open per robot.
// The file has a temporary name until finish(); without finish() nothing is left behind.
class TrajectoryWriter {
 public:
  // `materials` has robots.size() * max_materials elements, as Simulation::materials(). Robots may share a name;
  // numbers distinguish their groups. Throws InputError that begins with `option` if the file cannot be created, and
  // std::runtime_error if the disk is full.
  TrajectoryWriter(const std::filesystem::path& path, const TrajectoryHeader& header,
                   std::span<const Robot* const> robots, std::span<const Material> materials, const char* option);
  ~TrajectoryWriter();

  // A frame that the caller fills: one element per mass, robot after robot.
  struct Frame {
    std::span<Vec3> positions, velocities;
  };
  // The next frame. Fill it before any other call. Steps increase from frame to frame.
  // Throws std::runtime_error, as in "run.h5: the disk is full; nothing was kept".
  Frame add(std::int64_t step, double time);

  // Records which robots exploded (`telemetry` has one element per robot), closes the file and gives it its name.
  // Throws like add().
  void finish(std::span<const Telemetry> telemetry);

  std::int64_t frames() const { return frames_; }

 private:
  void write_header(const TrajectoryHeader& header);
  void write_configuration(hid_t parameters, const Configuration& configuration);
  void write_robot(std::size_t index, const Robot& robot, std::span<const Material> materials);
  void write_connectivity(const std::string& group, const Robot& robot, hid_t particles);
  void write_materials(hid_t particles, const Robot& robot, std::span<const Material> materials);
  void write_actuators(hid_t particles, const Robot& robot);
  void create_frames(hid_t particles, std::size_t masses);
  void flush();
  void flush_times(hsize_t first);
  void flush_robot(std::size_t robot, const char* element, const std::vector<Vec3>& values, hsize_t first);
  template <class Work>
  void guarded(const Work& work);

  std::filesystem::path path_;
  UnfinishedFile unfinished_;
  hdf5::Handle file_, particles_, connectivity_, parameters_;
  std::vector<std::string> groups_;   // names in /particles
  std::vector<std::size_t> offsets_;  // of each robot's first mass in a frame, then the number of masses
  std::vector<std::int64_t> steps_;   // of the frames in memory
  std::vector<double> times_;
  std::vector<Vec3> positions_, velocities_;  // frames_per_block_ times offsets_.back() elements
  std::size_t frames_per_block_ = 1;
  std::int64_t frames_ = 0;
  int deflate_ = 0;
};

}  // namespace mercury
