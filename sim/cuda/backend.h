// SPDX-License-Identifier: Apache-2.0
// The CUDA backend.
//
// Work is queued in three kinds of streams:
//
//   urgent()   of each class: copies from and to the host, done when a function returns
//   stream()   of each class: steps. That of the largest robots, main(), begins before the others and ends after them
//   a caller's stream, which then takes the part of main():
//
//   caller's stream   ... actuators --+-- steps ---------------------+-- publish -- ...
//   other classes                     +-- phases, steps -- done --->-+
//
// 1. Functions that take a caller's stream return at once. The steps follow what the caller has queued, and what the
//    caller queues later follows the steps; the host waits for neither.
// 2. What such functions queue ends with an event. Further work in callers' streams and in main() follows it. Functions
//    that use other streams, or read what a kernel writes to the host, call settle() first.
// 3. Functions that use arrays of the program and take no stream behave as if in the legacy default stream.
#pragma once

#include <array>
#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "mercury/backend.h"
#include "sim/cuda/brains.h"
#include "sim/cuda/intake.h"
#include "sim/cuda/step.h"

namespace mercury::cuda {

class CudaBackend final : public Backend {
 public:
  // `arranged` may be null.
  CudaBackend(const Device& device, std::shared_ptr<ArrangedRobots> arranged);
  ~CudaBackend() override;

  std::string device_name() const override { return name_; }
  std::vector<std::string> notes() const override;
  std::size_t robots_at_once() const override;
  double spring_limit() const override;
  double busy_seconds() const override { return busy_seconds_; }
  LoadTimes load_times() const override { return load_times_; }
  void set_watch(const WorkWatch& watch) override { watch_ = watch; }

  // Robots and settings (backend.cpp).
  void load(std::span<const Robot* const> robots, const Configuration& configuration) override;
  void add(std::span<const Robot* const> robots, std::size_t first_new) override;
  void keep(std::span<const Robot* const> robots, std::span<const std::size_t> indices) override;
  void configure(const Configuration& configuration) override;
  void set_environments(std::span<const std::size_t> robots, std::span<const Environment> environments) override;
  void write_materials(std::span<const Material> tables) override;
  void write_materials(std::size_t robot, std::span<const Material> table) override;
  void set_perturbations(std::span<const Perturbation> perturbations) override;
  bool set_actuation(const ActuationSources& sources) override;
  bool set_brains(std::span<const BrainPlan* const> plans) override;
  void write_brains(const PackedBrains& brains) override;
  PackedBrains read_brains(bool weights) const override;
  BrainArrays share_brains() override;
  bool measure_inversion(std::span<const BodyCells* const> cells) override;

  // Time (backend_steps.cpp).
  void step(const Clock& clock, std::int64_t steps) override;
  void step_and_report(const Clock& clock, std::int64_t steps, std::int64_t every, bool from_now,
                       const VisitReports& visit) override;
  void report(const Clock& clock, std::span<Telemetry> telemetry, std::span<RobotStatus> statuses) const override;
  void step_in_stream(const Clock& clock, std::int64_t steps, const PublishedArrays& arrays,
                      void* cuda_stream) override;

  // States (backend_state.cpp).
  void read(std::size_t robot, std::span<Vec3> positions, std::span<Vec3> velocities) const override;
  void write(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities) override;
  void put_at_rest(std::span<const Robot* const> robots, std::size_t first, std::span<const float> lifts) override;
  void put_at_rest_in_stream(std::span<const Robot* const> robots, std::span<const float> lifts,
                             const std::uint8_t* mask, const PublishedArrays& arrays, void* cuda_stream) override;
  void read_positions(std::span<Vec3> out) const override;
  void read_velocities(std::span<Vec3> out) const override;
  int cuda_device() const override { return device_; }
  bool copy_positions(float* device_out) const override;
  void copy_positions_with_steps(std::shared_ptr<float> device_out) const override;
  std::shared_ptr<void> allocate_shared(std::size_t bytes) const override;
  void copy_shared(void* to, const void* from, std::size_t bytes) const override;
  void publish(std::span<const Robot* const> robots, const PublishedArrays& arrays) const override;
  RobotStatus status(std::size_t robot) const override;
  std::vector<RobotStatus> statuses() const override;
  void set_status(std::size_t robot, const RobotStatus& status) override;

 private:
  // What must be released while the device is the current one.
  struct Owned {
    SizeClasses classes;
    Event start{Event::timed}, end{Event::timed}, forked;
    Event queued;                          // the end of what was last queued in a caller's stream
    DeviceArray<RobotView> views;          // [robot], if views_valid_
    DeviceArray<float> rest;               // [mass][6], positions and velocities at the start, if rest_valid_
    DeviceArray<RobotCells> robot_cells;   // in the order of reports, if inversion is measured
    DeviceArray<DeviceCell> cells;         // of all robots
    Actuators actuators;                   // none are driven if it is empty
    std::vector<DrivenMaterial> driven;    // what these drive
    DeviceBrains brains;                   // none think if it is empty
    MappedArray<DeviceTelemetry> reports;  // of the current state if report_valid_
    // Of step_and_report(): some portions, that one of them which the host reads, their ends, and a stream that waits
    // for these.
    MappedArray<DeviceTelemetry> samples;
    std::vector<Telemetry> portion;
    std::vector<RobotStatus> portion_statuses;
    std::array<Event, 4> reported{Event(Event::sleepy), Event(Event::sleepy), Event(Event::sleepy),
                                  Event(Event::sleepy)};
    Stream reporting{true};
  };

  const SizeClasses& classes() const { return owned_->classes; }
  // The stream of the largest robots. Those of the other classes start after it, and it ends after them.
  const Stream& main() const { return owned_->classes[launch_order_.front()].stream(); }
  SizeClass& class_of(std::size_t robot) const { return owned_->classes[places_[robot].size_class]; }
  // Writes one vector per mass, see SizeClass.
  void read_all(Field first_field, std::span<Vec3> out) const;
  static RobotStatus status_of(const DeviceStatus& status) { return {status.exploded_step, status.bad_mass}; }

  void use_device() const { check(cudaSetDevice(device_), "choosing the device"); }
  // Waits for what is queued in a caller's stream. To be called before everything that does not begin with enter() or
  // begin_launches().
  void settle() const;
  // The same for what programs have queued that write into shared arrays of brains.
  void settle_brains() const;
  // settle() before a change by the caller: it invalidates the last report and the copy of the positions.
  void begin_change();
  // To be called before robots come or go: what names places or masses of the batch is no longer valid.
  void begin_exchange();

  // Chooses how each class is launched.
  void choose_launches();
  void divide_memory();
  StepModel model_for(const SizeClass& robots) const {
    return step_model_of(configuration_, real_bodies_, robots.launch(), robots.own_models());
  }
  StepModel model_in_parts(const SizeClass& robots) const {
    return step_model_in_parts(configuration_, real_bodies_, *robots.launch_in_parts(), robots.own_models(),
                               robots.environments_differ());
  }
  void number_masses(std::span<const Robot* const> robots);
  const RobotView* views() const;
  const float* rest_positions(std::span<const Robot* const> robots, std::span<const float> lifts);

  // Everything between the two follows what was queued in other callers' streams. Null = the legacy default stream.
  cudaStream_t enter(void* cuda_stream) const;
  void leave(cudaStream_t stream) const;
  // For steps without a stream: sets the materials that actuators drive, after what is in the legacy default stream.
  void actuate_after_caller(const Clock& clock) const;
  // The launches of a call: the largest robots in `stream`, the others in streams that begin after it and that it
  // joins.
  void fork_launches(const Clock& clock, cudaStream_t stream) const;
  void join_launches(cudaStream_t stream) const;
  // Reports of all robots to make: one after each `every` steps, of which there is a whole number, or, if that is 0,
  // one without a step.
  struct ReportPlan {
    DeviceTelemetry* first = nullptr;  // [report][robot], or null
    std::int64_t every = 0;
  };
  // Queues launches of all classes.
  void launch(const Clock& clock, std::int64_t steps, const ReportPlan& plan, cudaStream_t stream,
              bool early = false) const;
  // fork_launches() and join_launches() in main(), with the time in between.
  void begin_launches(const Clock& clock) const;
  void end_launches();

  DeviceTelemetry* reports_on_device() const;
  template <class ReportAt>
  void copy_reports(const ReportAt& report_at, std::span<Telemetry> telemetry, std::span<RobotStatus> statuses) const;

  int device_;
  std::future<void> memory_;  // is set up while robots are checked
  std::shared_ptr<ArrangedRobots> arranged_;
  std::string name_;
  std::unique_ptr<Owned> owned_;
  std::vector<Place> places_;                                   // [robot]
  std::vector<std::pair<std::size_t, std::size_t>> driven_of_;  // [robot], its driven materials: the first, how many
  std::vector<std::size_t> first_report_;                       // [class]
  std::vector<std::uint32_t> launch_order_;                     // classes that have robots, the largest robots first
  mutable bool report_valid_ = false, report_expected_ = false;
  mutable std::shared_ptr<float> positions_copy_;  // where steps leave the positions; nullptr = nowhere
  mutable bool copy_valid_ = false;                // it holds those of the current state
  mutable bool queued_ = false;                    // something in a caller's stream that may not be done
  mutable unsigned long long queued_in_ = 0;       // id of that stream
  mutable bool views_valid_ = false;
  bool rest_valid_ = false;
  Configuration configuration_;
  bool real_bodies_ = false;  // of any robot
  StepConstants constants_;
  double busy_seconds_ = 0;
  LoadTimes load_times_;
  WorkWatch watch_;  // of load()
};

}  // namespace mercury::cuda
