// SPDX-License-Identifier: Apache-2.0
#include "app/export/simulated_motion.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "app/recording/trajectory_writer.h"

namespace mercury {
namespace {

constexpr double rounding = 1e-6;  // of a step: a frame as near as this is at the step

// What the simulation is at a step.
struct Moment {
  std::int64_t step = -1;
  std::vector<Vec3> positions, velocities;

  void take(const Simulation& simulation) {
    step = simulation.steps();
    positions.resize(simulation.mass_count());
    velocities.resize(simulation.mass_count());
    simulation.read_positions(positions);
    simulation.read_velocities(velocities);
  }
};

// The steps on both sides of a time.
class StepsAround {
 public:
  explicit StepsAround(Simulation& simulation) : simulation_(simulation) { after_.take(simulation); }

  // Writes the state at `place`, in steps; places rise.
  void at(double place, TrajectoryWriter::Frame into) {
    auto floor = static_cast<std::int64_t>(std::floor(place + rounding));
    const double share = place - static_cast<double>(floor);
    if (after_.step < floor) advance(floor, after_);
    const bool is_between = share > rounding;
    if (is_between && after_.step == floor) {
      std::swap(before_, after_);
      advance(floor + 1, after_);
    }
    const Moment& low = is_between || after_.step > floor ? before_ : after_;
    const auto u = static_cast<float>(is_between ? share : 0);
    for (std::size_t i = 0; i < into.positions.size(); ++i) {
      into.positions[i] = low.positions[i];
      into.velocities[i] = low.velocities[i];
      if (!is_between) continue;
      into.positions[i] = into.positions[i] + u * (after_.positions[i] - low.positions[i]);
      into.velocities[i] = into.velocities[i] + u * (after_.velocities[i] - low.velocities[i]);
    }
  }

 private:
  void advance(std::int64_t step, Moment& moment) {
    simulation_.step(step - simulation_.steps());
    moment.take(simulation_);
  }

  Simulation& simulation_;
  Moment before_, after_;
};

}  // namespace

TemporaryRecording::TemporaryRecording(const std::filesystem::path& beside)
    : beside_(beside), path_(beside.parent_path() / fmt::format(".{}.{}.h5", beside.filename().string(), getpid())) {}

TemporaryRecording::~TemporaryRecording() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

namespace {

SimulatedMotion record(Simulation& simulation, double seconds, const std::filesystem::path& path,
                       std::optional<std::uint64_t> seed, const std::function<void(std::int64_t)>& watch, double rate) {
  const double dt = simulation.configuration().dt, start_time = simulation.time();
  const std::int64_t first = simulation.steps(), last = first + std::llround(seconds / dt),
                     frames = motion_frames(seconds, rate);
  std::vector<const Robot*> robots;
  for (std::size_t i = 0; i < simulation.size(); ++i) robots.push_back(&simulation.robot(i));
  const double steps_per_frame = 1 / (rate * dt);
  TrajectoryWriter writer(path,
                          {.configuration = simulation.configuration(),
                           .device_name = simulation.device_name(),
                           .seed = seed,
                           .every = std::max<std::int64_t>(1, std::llround(steps_per_frame)),
                           .expected_frames = frames,
                           .time = simulation.clock()},
                          robots, simulation.materials(), "-o");
  StepsAround steps(simulation);
  std::int64_t step_before = first - 1;
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    const double place = std::min(static_cast<double>(frame) * steps_per_frame, static_cast<double>(last - first));
    step_before = std::max(step_before + 1, first + static_cast<std::int64_t>(std::floor(place + rounding)));
    steps.at(static_cast<double>(first) + place,
             writer.add(step_before, start_time + static_cast<double>(frame) / rate));
    writer.commit();
    watch(frame + 1);
  }
  simulation.step(last - simulation.steps());
  SimulatedMotion motion{.frames = frames, .final_states = {}};
  for (std::size_t robot = 0; robot < simulation.size(); ++robot)
    motion.final_states.push_back(fmt::format("{:016x} at {:.6g} s", simulation.hash(robot), simulation.time()));
  writer.finish(simulation.telemetry());
  return motion;
}

}  // namespace

SimulatedMotion record_motion(Simulation& simulation, double seconds, const TemporaryRecording& file,
                              std::optional<std::uint64_t> seed, const std::function<void(std::int64_t)>& watch,
                              double rate) {
  try {
    return record(simulation, seconds, file.path(), seed, watch, rate);
  } catch (const RecordingFailure& failure) {  // the frames so far are of no use without the rest
    throw std::runtime_error(fmt::format("{}: {}; nothing was kept", file.beside().string(), failure.reason()));
  }
}

std::int64_t motion_frames(double seconds, double rate) {
  return static_cast<std::int64_t>(std::floor(seconds * rate + rounding)) + 1;
}

}  // namespace mercury
