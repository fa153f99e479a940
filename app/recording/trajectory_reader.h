// SPDX-License-Identifier: Apache-2.0
// Reads a trajectory: robots, configuration, and frames by index.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/base/frame_places.h"
#include "app/recording/hdf5_handle.h"
#include "mercury/clock.h"
#include "mercury/configuration.h"
#include "mercury/robot.h"
#include "mercury/state.h"
#include "mercury/work_watch.h"

namespace mercury {

// A robot of a trajectory, enough to simulate it again.
struct RecordedRobot {
  Robot robot;
  std::string group;                  // its name in /particles
  std::optional<double> exploded_at;  // [s]
  std::optional<std::uint32_t> culprit_spring;
};

// Holds a few frames (at most 64 MB, or one frame if that is more). A damaged file cannot make it allocate more memory
// than its content justifies. Every member throws InputError, which begins with the path, if the file cannot be read.
class TrajectoryReader {
 public:
  // `watch` sees how many robots are read; it may throw to stop the work.
  explicit TrajectoryReader(const std::filesystem::path& path, const WorkWatch& watch = {});

  const std::filesystem::path& path() const { return path_; }
  const std::vector<RecordedRobot>& robots() const { return robots_; }  // in the order of the batch
  const Configuration& configuration() const { return configuration_; }
  const std::string& device_name() const { return device_name_; }  // for people
  const std::string& program() const { return program_; }          // that wrote the file: "mercury 0.1.0"
  std::optional<std::uint64_t> seed() const { return seed_; }
  // Whether frames have the senses and neurons of robots with brains.
  bool has_brains() const { return senses_.width() + neurons_.width() > 0; }
  bool has_brains(std::size_t robot) const { return senses_.width(robot) + neurons_.width(robot) > 0; }
  std::int64_t every() const { return every_; }  // steps per frame, rounded
  // Frames per second, where frames are not at steps: one lies at its time(), at step() or between it and the next.
  std::optional<double> frame_rate() const { return frame_rate_; }
  // Where the frames are.
  FramePlaces places() const;

  // Whether the program that wrote the file has not finished it: it was killed, or it still runs. The trajectory then
  // has the frames up to the last that it had flushed when the reader opened the file; explosions are not marked.
  bool unfinished() const { return unfinished_; }

  std::size_t frames() const { return steps_.size(); }
  std::int64_t step(std::size_t frame) const { return steps_.at(frame); }
  double time(std::size_t frame) const { return times_.at(frame); }  // [s]
  // The instant of the step of a frame.
  Clock clock(std::size_t frame) const;
  // The state at a frame, from which a simulation of robots() and configuration() goes on bit for bit, unless the frame
  // is between two steps. The neurons and last senses of brains are part of it if they are recorded; what brains have
  // learned, senses that are delayed, and where a sense's noise has come to, is as at the start.
  BatchState state(std::size_t frame);
  // The last frame at or before a time or step; 0 if that is before the first frame.
  std::size_t frame_at(double time) const;
  std::size_t frame_of_step(std::int64_t step) const;

  std::size_t mass_count() const { return positions_.width(); }                     // of all robots
  std::span<const std::size_t> mass_offsets() const { return positions_.offsets; }  // size() + 1 elements
  // The masses of all robots, one robot after the other. The span is valid until the next call. Reading frames in
  // order is fastest.
  std::span<const Vec3> positions(std::size_t frame) { return read(positions_, frame); }
  std::span<const Vec3> velocities(std::size_t frame) { return read(velocities_, frame); }
  // The masses of one robot. Reads only that robot; go through all frames of one before the next.
  std::span<const Vec3> positions_of(std::size_t robot, std::size_t frame) {
    return read(of_robot(robot_positions_, robot), frame);
  }
  std::span<const Vec3> velocities_of(std::size_t robot, std::size_t frame) {
    return read(of_robot(robot_velocities_, robot), frame);
  }
  // What brains sampled last and their neurons, of all robots or of one, in the order of BrainLayout; nothing of robots
  // without a brain, and unless has_brains(). Valid as positions() are.
  std::span<const float> senses(std::size_t frame) { return read(senses_, frame); }
  std::span<const float> neurons(std::size_t frame) { return read(neurons_, frame); }
  std::span<const float> senses_of(std::size_t robot, std::size_t frame) {
    return read(of_robot(robot_senses_, robot), frame);
  }
  std::span<const float> neurons_of(std::size_t robot, std::size_t frame) {
    return read(of_robot(robot_neurons_, robot), frame);
  }

 private:
  // Consecutive frames of one element, read together because they are stored together.
  template <class Value>
  struct Block {
    const char* element;
    std::vector<std::size_t> offsets{0};  // of each robot's first value in a frame, then their number
    std::size_t robot = all_robots;
    std::size_t first = 0, count = 0;
    std::vector<Value> values;

    std::size_t width() const { return offsets.back(); }  // values of a frame of all robots
    std::size_t width(std::size_t of) const { return offsets.at(of + 1) - offsets.at(of); }
  };
  static constexpr std::size_t all_robots = static_cast<std::size_t>(-1);

  void read_parameters();
  void read_base(hdf5::Id parameters);
  void read_unfinished_times(hdf5::Id parameters);
  void require_chunks(hdf5::Id dataset, std::size_t first, std::size_t count) const;
  void read_robots(const WorkWatch& watch);
  RecordedRobot read_robot(const std::string& group, hdf5::Id particles) const;
  void read_brains(const std::string& group, const Robot& robot);
  void require_frames(hdf5::Id robot, const char* element, const std::vector<std::size_t>& row) const;
  template <class Value>
  static Block<Value>& of_robot(Block<Value>& block, std::size_t robot);
  template <class Value>
  std::size_t length_of(const Block<Value>& block) const;  // frames
  template <class Value>
  std::span<const Value> read(Block<Value>& block, std::size_t frame);
  template <class Value>
  void read_block(Block<Value>& block, std::size_t first);
  void add_brains(BatchState& state, std::size_t frame);
  template <class Work>
  auto guarded(const Work& work) const;

  std::filesystem::path path_;
  hdf5::Handle file_, particles_, observables_;
  bool unfinished_ = false;
  Configuration configuration_;
  std::string device_name_, program_;
  std::optional<std::uint64_t> seed_;
  std::int64_t every_ = 1;
  std::optional<double> frame_rate_;
  Clock base_;
  std::vector<std::int64_t> steps_;
  std::vector<double> times_;
  std::vector<RecordedRobot> robots_;
  std::vector<BrainState> brains_at_start_;  // one per robot, or none yet
  std::size_t chunk_ = 1;                    // frames that are stored together, at most
  Block<Vec3> positions_{"position"}, velocities_{"velocity"}, robot_positions_{"position"},
      robot_velocities_{"velocity"};
  Block<float> senses_{"senses"}, neurons_{"neurons"}, robot_senses_{"senses"}, robot_neurons_{"neurons"};
};

}  // namespace mercury
