// SPDX-License-Identifier: Apache-2.0
// mercury verify: runs the configuration of a recording again, from its first frame, and compares all others.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/base/progress.h"
#include "app/base/stepping.h"
#include "app/options/command.h"
#include "app/options/option_values.h"
#include "app/options/parameter_options.h"
#include "app/recording/trajectory_reader.h"
#include "mercury/error.h"
#include "mercury/simulation.h"

namespace mercury {
namespace {

struct VerifyOptions {
  std::string file;
  Device device;
  double tolerance = 0;  // [m]
  bool json = false;
};

// One frame beside the same moment of the run.
struct FrameDifference {
  std::int64_t step = 0;
  double time = 0;        // [s]
  bool same = true;       // bit for bit
  double position = 0;    // largest of any mass [m]
  double velocity = 0;    // [m/s]
  double brain = 0;       // of any sense or neuron that is recorded
  std::size_t robot = 0;  // with the largest difference of positions
};

struct Verification {
  std::string device;  // that ran it again
  std::size_t robots = 0;
  std::vector<FrameDifference> frames;
  bool stopped = false;  // by the user

  const FrameDifference* first_difference() const {
    const auto found = std::ranges::find(frames, false, &FrameDifference::same);
    return found == frames.end() ? nullptr : &*found;
  }
  double largest() const {
    double largest = 0;
    for (const FrameDifference& frame : frames) largest = std::max(largest, frame.position);
    return largest;
  }
  bool same(double tolerance) const { return !first_difference() || (tolerance > 0 && largest() <= tolerance); }
};

double distance(Vec3 a, Vec3 b) {
  const double x = static_cast<double>(a.x) - static_cast<double>(b.x),
               y = static_cast<double>(a.y) - static_cast<double>(b.y),
               z = static_cast<double>(a.z) - static_cast<double>(b.z);
  const double length = std::sqrt(x * x + y * y + z * z);
  return std::isnan(length) ? std::numeric_limits<double>::infinity() : length;
}

bool same_bits(std::span<const Vec3> a, std::span<const Vec3> b) {
  return std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

// The largest distance between two elements, and its index.
std::pair<double, std::size_t> largest_distance(std::span<const Vec3> a, std::span<const Vec3> b) {
  std::pair<double, std::size_t> largest{0, 0};
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (same_bits(a.subspan(i, 1), b.subspan(i, 1))) continue;
    if (const double between = distance(a[i], b[i]); between > largest.first) largest = {between, i};
  }
  return largest;
}

// The kind of device that made the recording, where this machine has it.
Device device_for(const TrajectoryReader& recording, Device wanted) {
  if (wanted.kind == DeviceKind::automatic && recording.device_name().starts_with("CPU")) wanted.kind = DeviceKind::cpu;
  return wanted;
}

Simulation simulation_of(TrajectoryReader& recording, const Device& device) {
  Configuration configuration = recording.configuration();
  configuration.device = device_for(recording, device);
  std::vector<Robot> robots;
  for (const RecordedRobot& recorded : recording.robots()) robots.push_back(recorded.robot);
  Simulation simulation(configuration, robots);
  simulation.restore(recording.state(0));
  return simulation;
}

// The largest difference of two numbers.
double largest_difference(std::span<const float> a, std::span<const float> b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::memcmp(&a[i], &b[i], sizeof(float)) == 0) continue;
    const double between = std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
    largest = std::max(largest, std::isnan(between) ? std::numeric_limits<double>::infinity() : between);
  }
  return largest;
}

class Comparison {
 public:
  Comparison(const Simulation& simulation, TrajectoryReader& recording)
      : simulation_(simulation), recording_(recording), now_(simulation.mass_count()), next_(simulation.mass_count()),
        senses_(recording.senses(0).size()), neurons_(recording.neurons(0).size()) {}

  // Steps to a frame. Returns false if the user interrupts.
  bool advance_to(FramePlace place, Stepper& stepper) {
    if (!stepper.advance_to(place.step)) return false;
    read(now_);
    if (!place.is_between_steps()) return true;
    if (!stepper.advance_to(place.step + 1)) return false;
    read(next_);
    interpolate(now_.positions, next_.positions, place.share);
    interpolate(now_.velocities, next_.velocities, place.share);
    return true;
  }

  FrameDifference at(std::size_t frame) {
    FrameDifference difference{.step = recording_.step(frame), .time = recording_.time(frame)};
    const std::span<const Vec3> positions = recording_.positions(frame);
    difference.same = same_bits(now_.positions, positions);
    std::size_t mass = 0;
    if (!difference.same) std::tie(difference.position, mass) = largest_distance(now_.positions, positions);
    const auto offsets = recording_.mass_offsets();
    difference.robot = static_cast<std::size_t>(std::ranges::upper_bound(offsets, mass) - offsets.begin()) - 1;
    const std::span<const Vec3> velocities = recording_.velocities(frame);
    if (!same_bits(now_.velocities, velocities)) {
      difference.same = false;
      difference.velocity = largest_distance(now_.velocities, velocities).first;
    }
    if (recording_.has_brains()) compare_brains(frame, difference);
    return difference;
  }

 private:
  struct Moment {
    explicit Moment(std::size_t masses) : positions(masses), velocities(masses) {}
    std::vector<Vec3> positions, velocities;
  };
  void read(Moment& moment) const {
    simulation_.read_positions(moment.positions);
    simulation_.read_velocities(moment.velocities);
  }

  // Where the simulation is: of a frame between two steps, at the later one.
  void compare_brains(std::size_t frame, FrameDifference& difference) {
    simulation_.read_brains(senses_, neurons_);
    const auto compare = [&](std::span<const float> now, std::span<const float> recorded) {
      if (std::memcmp(now.data(), recorded.data(), recorded.size_bytes()) == 0) return;
      difference.same = false;
      difference.brain = std::max(difference.brain, largest_difference(now, recorded));
    };
    compare(senses_, recording_.senses(frame));
    compare(neurons_, recording_.neurons(frame));
  }

  const Simulation& simulation_;
  TrajectoryReader& recording_;
  Moment now_, next_;
  std::vector<float> senses_, neurons_;
};

Verification verify(TrajectoryReader& recording, const Device& device) {
  Simulation simulation = simulation_of(recording, device);
  Verification result{.device = simulation.device_name(), .robots = simulation.size(), .frames = {}};
  Comparison comparison(simulation, recording);
  Stepper stepper(simulation);
  const FramePlaces places = recording.places();
  const std::int64_t first = recording.step(0);
  Progress progress("comparing", "steps", recording.step(recording.frames() - 1) - first);
  for (std::size_t frame = 0; frame < recording.frames(); ++frame) {
    const FramePlace place = recording.frame_rate() ? places.of(static_cast<std::int64_t>(frame))
                                                    : FramePlace{.step = recording.step(frame)};
    if (!comparison.advance_to(place, stepper)) {
      result.stopped = true;
      break;
    }
    result.frames.push_back(comparison.at(frame));
    progress.update(simulation.steps() - first);
  }
  return result;
}

nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

nlohmann::ordered_json json_of(const FrameDifference& frame, bool brains) {
  return {{"step", frame.step},
          {"time", frame.time},
          {"identical", frame.same},
          {"position", number_or_null(frame.position)},
          {"velocity", number_or_null(frame.velocity)},
          {"brain", brains ? number_or_null(frame.brain) : nlohmann::ordered_json()},
          {"robot", frame.robot}};
}

void print_json(const Verification& result, const TrajectoryReader& recording, const VerifyOptions& options) {
  const FrameDifference* first = result.first_difference();
  nlohmann::ordered_json json{
      {"file", options.file},
      {"program", recording.program()},
      {"recorded_on", recording.device_name()},
      {"device", result.device},
      {"robots", result.robots},
      {"identical", first == nullptr},
      {"tolerance", options.tolerance},
      {"same", result.same(options.tolerance)},
      {"largest_difference", number_or_null(result.largest())},
      {"first_difference", first ? json_of(*first, recording.has_brains()) : nlohmann::ordered_json()},
      {"frames", nlohmann::ordered_json::array()}};
  for (const FrameDifference& frame : result.frames) json["frames"].push_back(json_of(frame, recording.has_brains()));
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

// At most a dozen frames, evenly spread, with the first and the last.
void print_table(const Verification& result, const TrajectoryReader& recording) {
  constexpr std::size_t rows = 12;
  const bool brains = recording.has_brains();
  fmt::print("\n{:>10}  {:>14}  {:>16}  {}{}\n", "time [s]", "position [m]", "velocity [m/s]",
             brains ? "       brain  " : "", "robot");
  const std::size_t last = result.frames.size() - 1, count = std::min(rows, last + 1);
  for (std::size_t row = 0; row < count; ++row) {
    const FrameDifference& frame = result.frames[count > 1 ? row * last / (count - 1) : 0];
    fmt::print("{:>10.6g}  {:>14.3g}  {:>16.3g}  {}{}\n", frame.time, frame.position, frame.velocity,
               brains ? fmt::format("{:>12.3g}  ", frame.brain) : "",
               frame.same ? "" : printable(recording.robots()[frame.robot].group));
  }
  fmt::print("\n");
}

void print_text(const Verification& result, const TrajectoryReader& recording, const VerifyOptions& options) {
  fmt::print("{}: {} frames, {} robots, {:.6g} s to {:.6g} s\n", printable(options.file), result.frames.size(),
             result.robots, result.frames.front().time, result.frames.back().time);
  fmt::print("recorded by {} on {}\nrun again on {}\n", printable(recording.program()),
             printable(recording.device_name()), result.device);
  const FrameDifference* first = result.first_difference();
  if (!first) {
    fmt::print("same: {} are identical, bit for bit\n",
               recording.has_brains() ? "positions, velocities, senses and neurons" : "positions and velocities");
    return;
  }
  print_table(result, recording);
  fmt::print("{}: first at {:.6g} s, step {}; positions differ by up to {:.3g} m\n",
             result.same(options.tolerance) ? "same within the tolerance" : "different", first->time, first->step,
             result.largest());
}

int run_verify(const VerifyOptions& options) {
  if (!(options.tolerance >= 0 && std::isfinite(options.tolerance)))
    throw InputError("--tolerance", fmt::format("{} is not accepted; give meters, 0 or more", options.tolerance));
  TrajectoryReader recording(options.file, shown_work());
  if (recording.frames() == 0) throw InputError(options.file, "holds no frames");
  const Verification result = verify(recording, options.device);
  if (result.frames.empty()) throw Interrupted();
  options.json ? print_json(result, recording, options) : print_text(result, recording, options);
  if (result.stopped) warn(fmt::format("stopped at {:.6g} s", result.frames.back().time));
  return !result.stopped && result.same(options.tolerance) ? 0 : 1;
}

}  // namespace

void add_verify_command(const Command& program, const Choose& choose) {
  auto options = std::make_shared<VerifyOptions>();
  const Command command = program.add_command("verify", "Run a recording again and compare");
  add_text(command, "FILE", options->file, "A recording (.h5)", "FILE.h5").required();
  command.add_flag("--json", options->json, "Print JSON instead of a table").on_first_screen();
  add_number(command, "--tolerance", options->tolerance,
             "Differences of positions that still count as the same (default 0: every bit)", "M")
      .on_first_screen();
  command
      .add_option(
          "--device",
          [&device = options->device](const std::string& text) {
            const Device named = device_named(text);
            device.kind = named.kind;
            device.index = named.index;
          },
          "What computes (default: the kind that made the recording)", "auto|cpu|cuda[:N]")
      .on_first_screen();
  add_parameters(command, options->device, "Options");
  command.find_option("--threads")->on_first_screen();
  command.set_footer(
      "Starts at the first frame and compares positions and velocities at all others, and the senses and neurons that\n"
      "mercury run --brains recorded. On the kind of device that made the recording they are the same bit for bit;\n"
      "elsewhere the table says how far they part. Frames between two steps are interpolated again. What a program "
      "changed while it recorded, such as materials or actuators, is\n"
      "not repeated.\n\n"
      "Exit status: 0 the same, 1 different, 2 the file is no recording.\n\n"
      "Examples:\n"
      "  mercury verify swim.h5\n"
      "  mercury verify swim.h5 --device cpu --tolerance 0.001 --json");
  command.when_chosen([options, choose] { choose([options] { return run_verify(*options); }); });
}

}  // namespace mercury
