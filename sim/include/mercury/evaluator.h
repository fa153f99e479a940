// SPDX-License-Identifier: Apache-2.0
// Any number of robots, each tried for the same number of steps.
//
// A simulation holds a batch, and the batch must be there before its first step. An evaluator takes a source of robots
// instead. It makes the robots on all cores, in portions, while the devices step earlier ones, and yields the results
// in the order of the source:
//
//     source     |0..127|128..639|640..1151|...               made on all cores, one portion after the other
//     device 0          |0..127 |640..1151        |...        loaded and stepped, by the first device that is free
//     device 1                   |128..639      |...
//     next()                    0, 1, 2, ...                  in order, whatever finished first
//
// The number of robots that exist at a time is limited by memory, not by the length of the source.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mercury/backend.h"
#include "mercury/configuration.h"
#include "mercury/folding.h"
#include "mercury/robot.h"
#include "mercury/state.h"
#include "mercury/telemetry.h"

namespace mercury {

// The robot of an index; nullptr for every index from the end of the source on. Several threads call it at the same
// time, in no particular order, unless EvaluationRequest::serial_source says otherwise. An InputError becomes the
// result of that index (Evaluation::failure); any other exception ends the evaluation.
using RobotSource = std::function<std::shared_ptr<const Robot>(std::size_t index)>;

// Robots that are there already.
RobotSource source_of(std::vector<std::shared_ptr<const Robot>> robots);

struct Evaluation;

struct EvaluationRequest {
  Configuration configuration;  // the device may be cuda:all: each portion goes to one device
  std::int64_t settling = 0;    // steps before the start of the trial, at least 0
  std::int64_t steps = 0;       // of the trial, at least 0
  // Steps between two samples of the telemetry; 0 = only at start and end. `path`, `highest`, both kinds of work and
  // the strains of an Evaluation are as good as the samples are dense.
  std::int64_t sample_every = 0;
  // Where the masses of a robot begin: it changes `positions`, one per mass, from those of the robot at rest. With
  // ground, the robot is then set down on it. Robots that are one object (the same pointer, index after index) are
  // checked and scheduled once, so this is the cheap way to try a robot several times. Optional. Several threads call
  // it at the same time.
  std::function<void(std::size_t index, const Robot& robot, std::span<Vec3> positions)> start;
  // Of the noise in a robot's senses (Simulation::set_noise_seed()); none = 0. Several threads call it at the same
  // time.
  std::function<std::uint64_t(std::size_t index)> noise_seed;
  // Which of `inverted` and `overlap` the telemetry of a robot has: Simulation::measure_folding(). None = of no robot.
  std::function<MeasuredFolding(const Robot&)> folding;
  bool upright = false;  // the telemetry has `upright`: Simulation::measure_upright()
  // Drives of the actuators, as Simulation::hold_drives() takes them. Every `drive_every` steps, the steps before the
  // start included, drive() writes those of a robot for the next ones: one per actuator of actuators_of(robot), in [-1,
  // 1]; NaN = the actuator goes on by itself. `period` counts from 0. Several threads call it at the same time. It
  // needs drive_every > 0.
  std::int64_t drive_every = 0;
  std::function<void(std::size_t index, const Robot& robot, std::int64_t period, std::span<float> drives)> drive;
  bool hashes = false;  // of the final states
  bool states = false;  // the final states themselves
  bool notes = true;    // Evaluator::notes() has what there is to say about the robots, which takes a while to find out

  // Racing: robots that do badly are stopped early. At each of these numbers of steps of the trial (ascending, above 0
  // and below `steps`), goes_on() is asked about every robot that is still stepped. Robots for which it returns false
  // are removed. Their results are those of a trial that ends there; the results of the others are the same bit for bit
  // as without racing. `so_far` is what the result would be if the trial ended now, without hash and state. Exploded
  // robots are asked about like others.
  // Several threads call goes_on() at the same time, in no particular order, and other robots may be at other checks.
  // If it depends on anything but `so_far`, results depend on chance. An exception ends the evaluation.
  std::vector<std::int64_t> checks;
  std::function<bool(const Evaluation& so_far)> goes_on;

  // The source grows: Evaluator::extend() says of more robots. Its devices stay ready meanwhile.
  bool grows = false;
  // The source is called by one thread at a time, with 0, 1, 2, ... in turn.
  bool serial_source = false;

  // About how much host memory the robots may take that are made and not yet yielded, with what it takes to step them
  // [bytes]. 0 = a quarter of what is available. One robot at a time is always accepted.
  std::size_t memory_limit = 0;

  // Results do not depend on these. 0 = chosen by the evaluator.
  std::size_t portion = 0;  // robots that are loaded together, at most
  int workers = 0;          // portions in hand per device: one steps, others load or are read
};

// What became of one robot.
struct Evaluation {
  std::size_t index = 0;               // in the source
  std::shared_ptr<const Robot> robot;  // nullptr if the source threw
  std::string failure;                 // why this robot cannot be used; empty = it was stepped
  std::int64_t steps = 0;              // of the trial that it made; fewer than requested if it was removed or stopped
  Telemetry start, end;                // at the start of the trial, after settling, and at its end
  double path = 0;                     // length of the path of the center of mass from sample to sample [m]
  // Of the muscles, up to an explosion: the integral of the power P of all of them, Telemetry::muscle_power, which goes
  // from sample to sample along a line [J].
  double work = 0;
  double positive_work = 0;  // the integral of max(0, P): what they did, without what they took back [J]
  // The integral of |P| = 2 max(0, P) - P [J].
  double absolute_work() const { return 2 * positive_work - work; }
  double highest = 0;  // largest z of the center of mass of all samples [m]
  // Least distance_between() the center of mass and the target of all samples [m]; NaN if it is unknown.
  double nearest = std::numeric_limits<double>::quiet_NaN();
  double largest_strain = 0;  // of all samples [1]
  double strained_share = 0;  // largest Telemetry::strained_share of all samples [1]
  double inverted =
      std::numeric_limits<double>::quiet_NaN();  // largest Telemetry::inverted of all samples [1]; NaN = not measured
  double overlap = std::numeric_limits<double>::quiet_NaN();  // the same of Telemetry::overlap
  // Mean of Telemetry::upright over the trial, or until it exploded [1]; NaN = not measured.
  double upright = std::numeric_limits<double>::quiet_NaN();
  double third = 0;  // of the time of the trial [s]
  // Center of mass after a third and after two thirds of that time, between samples; NaN if it is unknown [m].
  Vec3 at_third, at_two_thirds;
  std::uint64_t hash = 0;  // Simulation::hash() of the final state, if requested
  State state;             // the final state, if requested
};

// Where an evaluation stands. The parts overlap: while robots are stepped, others are made and loaded.
struct EvaluationProgress {
  struct Device {
    std::string name;
    double busy_seconds = 0;  // during which it stepped robots [s]
    std::size_t robots = 0;   // that it stepped, to the end or until they were removed
  };
  std::vector<Device> devices;
  std::size_t made = 0, done = 0;  // robots: made, or without success; ready to be yielded
  std::int64_t robot_steps = 0;    // of all robots; one that failed or was removed counts with all its steps
  // How long at least one device was being started, or one portion was being made, loaded, ... [s]
  double starting = 0, making = 0, loading = 0, stepping = 0, reading = 0;
  LoadTimes load;  // of all portions that are done; several may be loaded at the same time
};

class Evaluator {
 public:
  static constexpr std::size_t unknown_count = std::numeric_limits<std::size_t>::max();
  // Makes a backend of one device. Each worker calls it once.
  using MakeBackend = std::function<std::unique_ptr<Backend>()>;

  // Begins at once. `count` = robots of the source; if it is unknown, the source ends with a nullptr. Throws InputError
  // for a configuration that breaks a rule, std::invalid_argument for a negative number of steps, for checks that are
  // not as EvaluationRequest says, and for a source that grows from an unknown number.
  Evaluator(const EvaluationRequest& request, RobotSource source, std::size_t count = unknown_count);
  // Uses these devices. The configuration's device has no effect.
  Evaluator(const EvaluationRequest& request, RobotSource source, std::size_t count, std::vector<MakeBackend> devices);
  // Cancels what has not been yielded. Waits for the robots that are being made and for one call of step(), about a
  // third of a second.
  ~Evaluator();
  Evaluator(const Evaluator&) = delete;
  Evaluator& operator=(const Evaluator&) = delete;

  // The source, which grows, has this many more robots from now on. Robots that were there before may still be stepped:
  // the devices go on without a pause.
  void extend(std::size_t more);
  // Waits for the next result in the order of the source; nothing after the last one that is known. Throws DeviceError
  // if a device fails or does not exist, and what the source throws, after the results before.
  std::optional<Evaluation> next();
  // Waits until next() would return at once, or until the time is over. Returns whether next() would.
  bool wait_for(std::chrono::milliseconds time);

  // Makes no more robots. Those that are being stepped stop within about a third of a second, and next() yields what
  // they have reached; it omits robots that have not started.
  void stop();

  // Of all devices, as Simulation::device_name(). Waits until they have started; throws DeviceError.
  std::string device_name();
  // What Simulation::notes() says of portions so far, those of all results included, each line once.
  std::vector<std::string> notes() const;
  EvaluationProgress progress() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
