// SPDX-License-Identifier: Apache-2.0
// Steps and reports of the CUDA backend.

#include <algorithm>
#include <utility>

#include "mercury/parallel.h"
#include "sim/cuda/backend.h"

namespace mercury::cuda {
namespace {

// Keeps launches so short that the same GPU can serve a display.
constexpr std::int64_t max_steps_per_launch = 2000;

// Reports that step_and_report() makes before it reads them, while the next ones are made: few enough to stay in the
// cache, enough that launches are queued far ahead.
constexpr std::size_t most_reports = std::size_t{1} << 15;

}  // namespace

void CudaBackend::step(const Clock& clock, std::int64_t steps) {
  if (places_.empty()) return;
  use_device();
  // The caller that requested a report after the last call is expected to request it again.
  DeviceTelemetry* const report = std::exchange(report_expected_, false) ? reports_on_device() : nullptr;
  report_valid_ = false;
  actuate_after_caller(clock);
  begin_launches(clock);
  launch(clock, steps, report, main().get());
  end_launches();
  report_valid_ = report != nullptr && steps > 0;
}

// `report_at(k)` = the k-th report, in the order of classes and places.
template <class ReportAt>
void CudaBackend::copy_reports(const ReportAt& report_at, std::span<Telemetry> telemetry,
                               std::span<RobotStatus> statuses) const {
  for (std::size_t i = 0; i < telemetry.size(); ++i) {
    const DeviceTelemetry& from = report_at(first_report_[places_[i].size_class] + places_[i].number);
    Telemetry& to = telemetry[i];  // field by field, which avoids building a Telemetry and copying it
    to.center_of_mass = from.center_of_mass;
    to.velocity = from.velocity;
    to.kinetic_energy = from.kinetic_energy;
    to.elastic_energy = from.elastic_energy;
    to.muscle_power = static_cast<double>(from.muscle_power);
    to.largest_strain = from.largest_strain;
    to.strained_share = from.strained_share;
    if (from.exploded_step < 0) to.inverted = from.inverted;
    statuses[i] = {from.exploded_step, from.bad_mass};
  }
}

// The launches of all portions follow one another in the streams of their classes, without a pause: those of the next
// portion are queued before the reports of the last one are read. (A kernel that reports on the way was 1 to 6 %
// slower.)
void CudaBackend::step_and_report(const Clock& clock, std::int64_t steps, std::int64_t every,
                                  std::span<Telemetry> samples, std::span<RobotStatus> statuses) {
  if (places_.empty()) return;
  use_device();
  report_valid_ = false;
  const std::size_t robots = places_.size(), all = static_cast<std::size_t>(steps / every);
  const std::size_t portion = std::clamp(most_reports / robots, std::size_t{1}, all);
  MappedArray<DeviceTelemetry>& reports = owned_->samples;
  if (reports.size() < 2 * portion * robots) reports = MappedArray<DeviceTelemetry>(2 * portion * robots);
  const auto place_of = [&](std::size_t sample) { return sample % (2 * portion) * robots; };
  const auto read = [&](std::size_t first, std::size_t end) {
    owned_->reported[first / portion % 2].synchronize();
    parallel_for(first, end, [&](std::size_t k) {
      copy_reports([&](std::size_t i) -> const DeviceTelemetry& { return reports[place_of(k) + i]; },
                   samples.subspan(k * robots, robots), statuses.subspan(k * robots, robots));
    });
  };
  Clock now = clock;
  actuate_after_caller(clock);
  begin_launches(clock);
  for (std::size_t first = 0; first < all; first += portion) {
    const std::size_t end = std::min(first + portion, all);
    for (std::size_t k = first; k < end; ++k, now.step += every)
      launch(now, every, reports.on_device() + place_of(k), main().get());
    for (const std::uint32_t c : launch_order_) {
      const SizeClass& of_class = owned_->classes[c];
      of_class.done().record(of_class.stream().get());
      of_class.done().hold(owned_->reporting.get());
    }
    owned_->reported[first / portion % 2].record(owned_->reporting.get());
    if (first > 0) read(first - portion, first);
  }
  read((all - 1) / portion * portion, all);
  end_launches();
}

void CudaBackend::report(const Clock& clock, std::span<Telemetry> telemetry, std::span<RobotStatus> statuses) const {
  if (telemetry.empty()) return;
  use_device();
  report_expected_ = true;
  if (!report_valid_) {
    begin_launches(clock);
    launch(clock, 0, reports_on_device(), main().get());
    join_launches(main().get());
    main().synchronize();
    report_valid_ = true;
  }
  copy_reports([&](std::size_t i) -> const DeviceTelemetry& { return owned_->reports[i]; }, telemetry, statuses);
}

// Nothing here waits for the device, allocates memory or sorts: with small batches, a call must cost the host less than
// the steps cost the device.
void CudaBackend::step_in_stream(const Clock& clock, std::int64_t steps, const PublishedArrays& arrays,
                                 void* cuda_stream) {
  if (places_.empty()) return;
  use_device();
  report_valid_ = report_expected_ = copy_valid_ = false;
  const cudaStream_t stream = enter(cuda_stream);
  owned_->actuators.apply(clock, true, stream);
  fork_launches(clock, stream);
  launch(clock, steps, nullptr, stream, true);
  join_launches(stream);
  publish_states(views(), places_.size(), arrays, stream);
  leave(stream);
}

cudaStream_t CudaBackend::enter(void* cuda_stream) const {
  const cudaStream_t stream = cuda_stream ? static_cast<cudaStream_t>(cuda_stream) : cudaStreamLegacy;
  // A stream keeps the order of its work by itself, without the time that waiting for an event takes.
  if (queued_ && id_of(stream) != queued_in_) owned_->queued.hold(stream);
  return stream;
}

void CudaBackend::leave(cudaStream_t stream) const {
  owned_->queued.record(stream);
  queued_in_ = id_of(stream);
  queued_ = true;
}

void CudaBackend::actuate_after_caller(const Clock& clock) const {
  if (owned_->actuators.empty()) return;
  const cudaStream_t stream = enter(nullptr);
  owned_->actuators.apply(clock, true, stream);
  leave(stream);
}

void CudaBackend::fork_launches(const Clock& clock, cudaStream_t stream) const {
  if (launch_order_.size() > 1) owned_->forked.record(stream);
  for (const std::uint32_t c : launch_order_) {
    SizeClass& robots = owned_->classes[c];
    const bool first = c == launch_order_.front();
    if (!first) robots.stream().wait_for(owned_->forked);
    robots.update_phases(clock, first ? stream : robots.stream().get());
  }
}

void CudaBackend::begin_launches(const Clock& clock) const {
  if (queued_) main().wait_for(owned_->queued);
  owned_->start.record(main().get());
  fork_launches(clock, main().get());
}

void CudaBackend::launch(const Clock& clock, std::int64_t steps, DeviceTelemetry* report, cudaStream_t stream,
                         bool early) const {
  for (const std::uint32_t c : launch_order_) {
    SizeClass& robots = owned_->classes[c];
    StepArguments arguments{.batch = robots.view(),
                            .clock = clock,
                            .constants = constants_,
                            .stiffness_scale = stiffness_scale_of(configuration_.environment),
                            .launch = robots.launch(),
                            .thoughts = owned_->brains.thoughts(c, configuration_.environment, owned_->actuators)};
    const StepModel model = model_for(robots);
    const cudaStream_t of_class = c == launch_order_.front() ? stream : robots.stream().get();
    std::int64_t done = 0;
    do {
      arguments.clock.step = clock.step + done;
      arguments.steps = static_cast<std::uint32_t>(std::min(steps - done, max_steps_per_launch));
      arguments.lists_kept = arguments.steps > 0 && robots.keeps_lists();
      done += arguments.steps;
      arguments.report = done == steps && report ? report + first_report_[c] : nullptr;
      if (robots.launch_in_parts() && arguments.steps > 0) {
        StepArguments in_parts = arguments;
        in_parts.batch = robots.view_of_parts();
        in_parts.launch = *robots.launch_in_parts();
        in_parts.report = nullptr;
        launch_steps(configuration_.solver, model_in_parts(robots), in_parts, early, of_class);
        if (!arguments.report) continue;
        arguments.clock.step += std::exchange(arguments.steps, 0);
      }
      launch_steps(configuration_.solver, model, arguments, early, of_class);
    } while (done < steps);
    if (report && owned_->robot_cells.size() > 0)
      report_inversion(owned_->robot_cells.data() + first_report_[c], robots.size(), owned_->cells.data(),
                       report + first_report_[c], of_class);
  }
}

void CudaBackend::join_launches(cudaStream_t stream) const {
  for (const std::uint32_t c : std::span(launch_order_).subspan(1)) {
    const SizeClass& robots = owned_->classes[c];
    robots.done().record(robots.stream().get());
    robots.done().hold(stream);
  }
}

void CudaBackend::end_launches() {
  Event& end = owned_->end;
  join_launches(main().get());
  if (positions_copy_) publish_states(views(), places_.size(), {.positions = positions_copy_.get()}, main().get());
  end.record(main().get());
  busy_seconds_ += end.seconds_since(owned_->start);
  copy_valid_ = positions_copy_ != nullptr;
}

DeviceTelemetry* CudaBackend::reports_on_device() const {
  if (owned_->reports.size() != places_.size()) owned_->reports = MappedArray<DeviceTelemetry>(places_.size());
  return owned_->reports.on_device();
}

}  // namespace mercury::cuda
