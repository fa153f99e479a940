// SPDX-License-Identifier: Apache-2.0
// Steps and reports of the CUDA backend.

#include <algorithm>
#include <utility>

#include "mercury/parallel.h"
#include "sim/cuda/backend.h"

namespace mercury::cuda {
namespace {

// Keeps launches so short that the same GPU can serve a display, and that classes of a mixed batch fill what others
// leave idle at the ends of theirs.
constexpr std::int64_t most_steps_alone = 2000, most_steps_beside_others = 500;

// Reports of a portion of step_and_report(): few enough that those of all portions stay in the cache.
constexpr std::size_t most_reports = std::size_t{1} << 13;

}  // namespace

void CudaBackend::step(const Clock& clock, std::int64_t steps) {
  if (places_.empty()) return;
  use_device();
  // The caller that requested a report after the last call is expected to request it again.
  DeviceTelemetry* const report = std::exchange(report_expected_, false) ? reports_on_device() : nullptr;
  report_valid_ = false;
  actuate_after_caller(clock);
  begin_launches(clock);
  launch(clock, steps, {.first = report, .every = steps}, main().get());
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

// The launches of all portions follow one another in the streams of their classes, without a pause: some are queued
// before the reports of the first one are read. A report before the first step is a portion without steps: to wait for
// it takes long while the device is busy.
void CudaBackend::step_and_report(const Clock& clock, std::int64_t steps, std::int64_t every, bool from_now,
                                  const VisitReports& visit) {
  if (places_.empty()) return;
  use_device();
  report_valid_ = false;
  const std::size_t robots = places_.size(), all = static_cast<std::size_t>(steps / every);
  const std::size_t of_portion = std::clamp(most_reports / robots, std::size_t{1}, all), before = from_now ? 1 : 0,
                    portions = before + (all + of_portion - 1) / of_portion, in_flight = owned_->reported.size();
  MappedArray<DeviceTelemetry>& reports = owned_->samples;
  if (reports.size() < in_flight * of_portion * robots)
    reports = MappedArray<DeviceTelemetry>(in_flight * of_portion * robots);
  const auto first_of = [&](std::size_t portion) { return portion % in_flight * of_portion * robots; };
  const auto size_of = [&](std::size_t portion) {
    return portion < before ? 1 : std::min(of_portion, all - (portion - before) * of_portion);
  };
  const auto start = [&](std::size_t portion) {
    DeviceTelemetry* const first = reports.on_device() + first_of(portion);
    if (portion < before) {
      launch(clock, 0, {.first = first}, main().get());
    } else {
      Clock now = clock;
      now.step += static_cast<std::int64_t>((portion - before) * of_portion) * every;
      launch(now, static_cast<std::int64_t>(size_of(portion)) * every, {.first = first, .every = every}, main().get());
    }
    for (const std::uint32_t c : launch_order_) {
      const SizeClass& of_class = owned_->classes[c];
      of_class.done().record(of_class.stream().get());
      of_class.done().hold(owned_->reporting.get());
    }
    owned_->reported[portion % in_flight].record(owned_->reporting.get());
  };
  const auto read = [&](std::size_t portion) {
    std::vector<Telemetry>& samples = owned_->portion;
    std::vector<RobotStatus>& statuses = owned_->portion_statuses;
    samples.assign(size_of(portion) * robots, {});
    statuses.resize(samples.size());
    owned_->reported[portion % in_flight].synchronize();
    parallel_for(0, size_of(portion), [&](std::size_t k) {
      const std::size_t first = first_of(portion) + k * robots;
      copy_reports([&](std::size_t i) -> const DeviceTelemetry& { return reports[first + i]; },
                   std::span(samples).subspan(k * robots, robots), std::span(statuses).subspan(k * robots, robots));
    });
    visit(samples, statuses);
  };
  actuate_after_caller(clock);
  begin_launches(clock);
  try {
    for (std::size_t portion = 0; portion < portions + in_flight - 1; ++portion) {
      if (portion < portions) start(portion);
      if (portion + 1 >= in_flight) read(portion + 1 - in_flight);
    }
  } catch (...) {
    end_launches();  // nobody may free what they use before
    throw;
  }
  end_launches();
}

void CudaBackend::report(const Clock& clock, std::span<Telemetry> telemetry, std::span<RobotStatus> statuses) const {
  if (telemetry.empty()) return;
  use_device();
  report_expected_ = true;
  if (!report_valid_) {
    begin_launches(clock);
    launch(clock, 0, {.first = reports_on_device()}, main().get());
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
  launch(clock, steps, {}, stream, true);
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

void CudaBackend::launch(const Clock& clock, std::int64_t steps, const ReportPlan& plan, cudaStream_t stream,
                         bool early) const {
  for (const std::uint32_t c : launch_order_) {
    SizeClass& robots = owned_->classes[c];
    StepArguments arguments{.batch = robots.view(),
                            .clock = clock,
                            .constants = constants_,
                            .stiffness_scale = stiffness_scale_of(configuration_.environment),
                            .launch = robots.launch(),
                            .thoughts = owned_->brains.thoughts(c, configuration_.environment, owned_->actuators)};
    if (owned_->robot_cells.size() > 0) {
      arguments.reports.robots = owned_->robot_cells.data() + first_report_[c];
      arguments.reports.cells = owned_->cells.data();
    }
    arguments.reports.stride = static_cast<std::uint32_t>(places_.size());
    const StepModel model = model_for(robots);
    const cudaStream_t of_class = c == launch_order_.front() ? stream : robots.stream().get();
    const std::int64_t most_steps = launch_order_.size() > 1 ? most_steps_beside_others : most_steps_alone;
    // A launch makes the steps of some reports, or some steps of one. Parts make no reports.
    std::int64_t at_once = most_steps;
    if (plan.first && plan.every > 0)
      at_once = robots.launch_in_parts() || plan.every > at_once ? plan.every : at_once - at_once % plan.every;
    std::int64_t done = 0;
    do {
      const std::int64_t count = std::min({steps - done, at_once - done % at_once, most_steps});
      arguments.clock.step = clock.step + done;
      arguments.steps = static_cast<std::uint32_t>(count);
      arguments.lists_kept = count > 0 && robots.keeps_lists();
      const std::int64_t reported = plan.every > 0 ? done / plan.every : 0;
      done += count;
      const bool reports = plan.first && (plan.every == 0 || done % plan.every == 0);
      arguments.reports.first =
          reports ? plan.first + static_cast<std::size_t>(reported) * places_.size() + first_report_[c] : nullptr;
      arguments.reports.every = static_cast<std::uint32_t>(std::min(plan.every, count));
      if (robots.launch_in_parts() && count > 0) {
        StepArguments in_parts = arguments;
        in_parts.batch = robots.view_of_parts();
        in_parts.launch = *robots.launch_in_parts();
        in_parts.reports = {};
        launch_steps(configuration_.solver, model_in_parts(robots), in_parts, early, of_class);
        if (!reports) continue;
        arguments.clock.step += std::exchange(arguments.steps, 0);
        arguments.reports.every = 0;
      }
      launch_steps(configuration_.solver, model, arguments, early, of_class);
    } while (done < steps);
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
