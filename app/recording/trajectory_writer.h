// SPDX-License-Identifier: Apache-2.0
// Writes the positions and velocities of a batch, and if wanted what its brains sense and do, frame by frame, into an
// H5MD 1.1 file (docs/formats.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/base/interrupt.h"
#include "app/recording/frame_series.h"
#include "app/recording/hdf5_handle.h"
#include "app/recording/recording_file.h"
#include "mercury/clock.h"
#include "mercury/configuration.h"
#include "mercury/robot.h"
#include "mercury/stopwatch.h"
#include "mercury/telemetry.h"
#include "mercury/work_watch.h"

namespace mercury {

// Everything in a trajectory except robots and frames.
struct TrajectoryHeader {
  Configuration configuration;
  std::string device_name;                  // for people
  std::optional<std::uint64_t> seed;        // of the random robots, if any
  std::int64_t every = 1;                   // steps per frame, rounded
  std::optional<double> frame_rate;         // frames per second, also between steps; none = at steps
  std::int64_t expected_frames = 0;         // 0 = unknown
  Clock time;                               // of the simulation: its base, from which times count
  bool brains = false;                      // frames have the senses and neurons of robots with brains, too
  int deflate = 0;                          // compression of the frames: 0 = none, 1 (fast) .. 9
  double flush_period = 5;                  // [s] of wall time from one flush to the next; 0 = flush each frame
  double (*clock)() = wall_now;             // [s]; tests set their own
  WorkWatch watch;                          // sees how many robots are written; may throw to stop the work
  std::function<void(hdf5::Id file)> more;  // writes what else the file has, before the frames; throws hdf5::Error
};

// A recording could not be written to its end: the disk is full, say. what() names the file, the reason and how many
// frames were kept.
class RecordingFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Whether to flush now, so that at most two periods pass between flushes: the next frame may take as long as the last.
// All in seconds of wall time.
bool flush_is_due(double since_flush, double last_frame_took, double period);

// Streams: holds a few frames (at most 64 MB, or one frame if that is more) and keeps no HDF5 object open per robot.
// The file has a temporary name until finish(); without finish() nothing is left behind, unless a write failed: then
// the frames of the last flush are kept under the file's name. With more than 2,000 robots these are the blocks so far.
//
// A program that is killed leaves a file that opens with the frames of the last flush. This is HDF5's mode for a single
// writer and multiple readers (SWMR): metadata reaches the file after what it points to. The file announces frames in
// the order
//
//   positions, velocities and so on of all robots  ->  flush  ->  step and time  ->  flush
//
// so the length of step is a number of frames that all robots have. In this mode no dataset may be created, so the
// datasets of the frames are created with the first block, when the speed of the simulation is known: a slow one gets
// blocks of one period, and is rarely flushed with an incomplete block, which HDF5 would have to write again.
class TrajectoryWriter {
 public:
  // `materials` has robots.size() * max_materials elements, as Simulation::materials(). Robots may share a name;
  // numbers distinguish their groups. Throws InputError that begins with `option` if the file cannot be created, and
  // RecordingFailure if the disk is full.
  TrajectoryWriter(const std::filesystem::path& path, const TrajectoryHeader& header,
                   std::span<const Robot* const> robots, std::span<const Material> materials, const char* option);
  ~TrajectoryWriter();

  // A frame that the caller fills: one element per mass, robot after robot; with brains also one per sense and per
  // neuron, in the order of BrainLayout.
  struct Frame {
    std::span<Vec3> positions, velocities;
    std::span<float> senses, neurons;
  };
  // The next frame. Fill it, then call commit(); without that it does not count. Steps increase from frame to frame.
  Frame add(std::int64_t step, double time);
  // Writes and flushes what is due. Throws RecordingFailure, as in "run.h5: the disk is full; the first 120 frames were
  // kept"; after that, only failed(), frames() and the destructor may be called.
  void commit();

  // Writes all frames so far, so that they survive the program. Throws like commit().
  void flush();
  // The temporary name that the file has until finish().
  const std::filesystem::path& unfinished_path() const { return unfinished_.path(); }

  // Records which robots exploded (`telemetry` has one element per robot, or none if it is unknown), closes the file
  // and gives it its name. Throws like commit().
  void finish(std::span<const Telemetry> telemetry);

  std::int64_t frames() const { return frames_; }
  // Whether a write failed.
  bool failed() const { return failed_; }

 private:
  void write_header(const TrajectoryHeader& header);
  void write_configuration(hdf5::Id parameters, const Configuration& configuration);
  void write_robot(std::size_t index, const Robot& robot, std::span<const Material> materials);
  void write_points(hdf5::Id particles, const Robot& robot);
  void write_connectivity(const std::string& group, const Robot& robot, hdf5::Id particles);
  void write_materials(hdf5::Id particles, const Robot& robot, std::span<const Material> materials);
  void write_actuators(hdf5::Id particles, const Robot& robot);
  void write_brains(hdf5::Id particles, const Robot& robot);
  void write_brain_names(std::size_t index, const Robot& robot);
  void hold(std::size_t frames_per_block);
  void start_frames();
  void reserve_block();
  void write_block();
  std::size_t frame_bytes() const;
  bool survives_kill() const;  // otherwise the file can be read only once it is complete
  template <class Work>
  void guarded(const Work& work);
  void announce(std::int64_t count);
  void close();
  bool is_completed();
  [[noreturn]] void give_up(const std::string& reason);
  void require_written() const;  // throws Error after a write that failed

  std::filesystem::path path_;
  UnfinishedFile unfinished_;
  std::unique_ptr<WriteFailure> failure_;
  hdf5::Handle file_, particles_, connectivity_, parameters_, observables_;
  std::vector<std::string> groups_;  // names in /particles, and of those with brains in /observables
  FrameSeries<Vec3> positions_{"position", "m"}, velocities_{"velocity", "m s-1"};
  FrameSeries<float> senses_{"senses", ""}, neurons_{"neurons", ""};
  std::vector<std::int64_t> steps_;  // of the frames since the last flush
  std::vector<double> times_;
  std::int64_t next_step_ = 0;  // of the frame that is being filled
  double next_time_ = 0;        // [s]
  std::size_t frames_per_block_ = 1;
  std::int64_t frames_ = 0, written_ = 0, flushed_ = 0;  // written_: in the file; flushed_: announced by step
  std::uint64_t reserved_ = 0;                           // bytes of the file for which the disk has room; 0 = unknown
  bool failed_ = false;
  bool started_ = false;  // the datasets of the frames exist
  int deflate_ = 0;
  double flush_period_;  // [s]
  double (*clock_)();
  double last_commit_, last_flush_;  // [s]
  double flush_cost_ = 0;            // of the last flush, without its block [s]
};

}  // namespace mercury
