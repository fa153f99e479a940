// SPDX-License-Identifier: Apache-2.0
// The threads of an evaluator, see evaluator_parts.h.
#include <algorithm>
#include <utility>

#include "mercury/cuda_devices.h"
#include "mercury/error.h"
#include "mercury/host_memory.h"
#include "sim/devices.h"
#include "sim/evaluator_parts.h"

namespace mercury {

Evaluator::Parts::Parts(const EvaluationRequest& wanted, RobotSource robots, std::size_t number)
    : request(wanted), source(std::move(robots)), count(number),
      memory_limit(wanted.memory_limit > 0 ? wanted.memory_limit : available_host_memory() / 4), end(number) {
  update_demand();
}

Evaluator::Parts::~Parts() {
  {
    const std::lock_guard lock(mutex);
    stopping = true;
    end = 0;
    notify_all();
  }
  if (starter.joinable()) starter.join();
  maker.join();
  for (std::thread& worker : workers) worker.join();
}

void Evaluator::Parts::start(std::vector<MakeBackend> given) {
  const bool are_known = !given.empty() || request.configuration.device.kind == DeviceKind::cpu || !built_with_cuda();
  if (are_known) start_devices(given);
  maker = std::thread([this] { make_portions(); });
  // To look for CUDA devices can take a while; robots are made meanwhile.
  if (!are_known) starter = std::thread([this, given = std::move(given)] { start_devices(given); });
}

void Evaluator::Parts::start_devices(const std::vector<MakeBackend>& given) {
  try {
    std::deque<DeviceParts> found;
    for (const MakeBackend& make : given) found.emplace_back().make_backend = make;
    if (given.empty())
      for (const Device& device : single_devices(request.configuration.device)) {
        DeviceParts& parts = found.emplace_back();
        parts.is_cpu = device.kind == DeviceKind::cpu;
        parts.make_backend = [device] { return make_backend(device); };
      }
    {
      const std::lock_guard lock(mutex);
      devices.swap(found);
      devices_are_known = true;
      update_demand();
      maker_may_go_on.notify_one();
    }
    for (DeviceParts& device : devices)
      for (int i = 0; i < workers_of(device); ++i) workers.emplace_back([this, &device] { work(device); });
  } catch (...) {
    fail(0, std::current_exception());
  }
}

// --- The maker

void Evaluator::Parts::make_portions() {
  std::size_t first = 0;
  try {
    for (bool is_complete = count == 0; !is_complete;) {
      PortionLimits limits{.bytes = 0,
                           .enough = [&](std::size_t robots) { return is_large_enough(first, robots); },
                           .canceled = [&] { return stopping || first >= end; }};
      {
        std::unique_lock lock(mutex);
        maker_may_go_on.wait(lock, [&] { return limits.canceled() || may_make(); });
        if (limits.canceled()) break;
        limits.bytes = piece_bytes();
      }
      std::optional<UnionClock::Interval> interval(std::in_place, making);
      Portion portion = make_portion(source, first, count, limits, request.serial_source, largest_robot);
      interval.reset();
      const std::lock_guard lock(mutex);
      if (limits.canceled()) break;
      is_complete = portion.is_last || portion.candidates.empty();
      first += portion.candidates.size();
      made += portion.candidates.size();
      memory_in_use += portion.bytes();
      waiting_robots += portion.candidates.size();
      if (!portion.candidates.empty()) waiting.push_back(std::move(portion));
      update_demand();
      portion_waits.notify_all();
    }
  } catch (...) {
    fail(first, std::current_exception());
  }
  const std::lock_guard lock(mutex);
  all_made = true;
  end_at(first);
  notify_all();
}

// --- The workers

void Evaluator::Parts::work(DeviceParts& device) {
  std::size_t first = 0;
  try {
    std::optional<UnionClock::Interval> interval(std::in_place, starting);
    Simulation simulation(request.configuration, std::span<const Robot>(), device.make_backend());
    interval.reset();
    device_started(device, simulation);
    StepPace pace(simulation.cuda_device() >= 0);
    while (std::optional<Portion> portion = take(device)) {
      first = portion->first;
      evaluate(device, simulation, *std::move(portion), pace);
    }
  } catch (...) {
    fail(first, std::current_exception());
  }
}

void Evaluator::Parts::device_started(DeviceParts& device, const Simulation& simulation) {
  const int cuda = simulation.cuda_device();
  const std::size_t free = cuda >= 0 ? free_cuda_memory(cuda) : unknown_count;
  const std::lock_guard lock(mutex);
  device.name = simulation.device_name();
  portion_bytes = std::min(portion_bytes, free / static_cast<std::size_t>(workers_of(device) + 1));
  update_demand();
  device_has_started.notify_all();
  portion_waits.notify_all();
}

std::optional<Portion> Evaluator::Parts::take(DeviceParts& device) {
  std::unique_lock lock(mutex);
  ++device.idle_workers;
  portion_waits.wait(lock, [&] { return (all_made && waiting.empty()) || stopping || may_take(device); });
  --device.idle_workers;
  if (waiting.empty()) return std::nullopt;
  Portion portion = next_portion(device);
  ++device.portions_in_hand;
  ++device.portions_taken;
  device.robots_in_hand += portion.candidates.size();
  update_demand();
  notify_all();
  return portion;
}

void Evaluator::Parts::evaluate(DeviceParts& device, Simulation& simulation, Portion portion, StepPace& pace) {
  const std::size_t first = portion.first;
  const TrialContext context{.canceled = [&] { return first >= end; },
                             .stopping = [&] { return stopping.load(); },
                             .stepped = [&](std::int64_t steps) { robot_steps += steps; },
                             .device_stepping = &device.stepping,
                             .stepping = &stepping};
  FinishedPortion result;
  if (!stopping) {
    const LoadTimes before = simulation.load_times();
    std::optional<UnionClock::Interval> interval(std::in_place, loading);
    load(simulation, portion);
    interval.reset();
    loaded(device, simulation);
    PortionTrial trial(simulation, request, context, pace, portion);
    if (!stopping && trial.run()) {
      interval.emplace(reading);
      result.results = trial.results();
    }
    add_load_times(before, simulation.load_times());
    simulation.keep({});
  }
  // From here on, only the results hold the robots.
  for (Candidate& candidate : portion.candidates) candidate.robot.reset();
  finish(device, portion, std::move(result));
}

void Evaluator::Parts::loaded(DeviceParts& device, const Simulation& simulation) {
  const std::size_t at_once = simulation.robots_at_once();
  const std::lock_guard lock(mutex);
  if (at_once > 0) device.robots_at_once = at_once;
  for (const std::string& note : simulation.notes())
    if (std::ranges::find(notes, note) == notes.end()) notes.push_back(note);
  update_demand();
  portion_waits.notify_all();
}

void Evaluator::Parts::add_load_times(const LoadTimes& before, const LoadTimes& after) {
  const std::lock_guard lock(mutex);
  load_times.check += after.check - before.check;
  load_times.schedule += after.schedule - before.schedule;
  load_times.upload += after.upload - before.upload;
}

// Without results if the portion was given up.
void Evaluator::Parts::finish(DeviceParts& device, const Portion& portion, FinishedPortion result) {
  const std::lock_guard lock(mutex);
  --device.portions_in_hand;
  device.robots_in_hand -= portion.candidates.size();
  if (result.results.empty()) {
    memory_in_use -= portion.bytes();
    end_at(portion.first);
  } else {
    for (const Candidate& candidate : portion.candidates) {
      result.bytes.push_back(candidate.bytes);
      if (candidate.failure.empty())
        ++device.robots;
      else
        robot_steps += request.settling + request.steps;
    }
    done += portion.candidates.size();
    finished.emplace(portion.first, std::move(result));
  }
  update_demand();
  notify_all();
}

// --- All

bool Evaluator::Parts::next_is_known() const { return next_index >= end || finished.contains(next_index); }

void Evaluator::Parts::end_at(std::size_t index) { end = std::min(end.load(), index); }

void Evaluator::Parts::fail(std::size_t first, std::exception_ptr exception) {
  const std::lock_guard lock(mutex);
  if (first <= error_index) {
    error = std::move(exception);
    error_index = first;
  }
  end_at(first);
  notify_all();
}

void Evaluator::Parts::notify_all() {
  maker_may_go_on.notify_all();
  portion_waits.notify_all();
  result_waits.notify_all();
  device_has_started.notify_all();
}

}  // namespace mercury
