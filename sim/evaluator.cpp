// SPDX-License-Identifier: Apache-2.0
// What the user of an evaluator calls. Its threads are in evaluator_threads.cpp.
#include "mercury/evaluator.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sim/devices.h"
#include "sim/evaluator_parts.h"

namespace mercury {

namespace {

void validate_checks(const EvaluationRequest& request) {
  const std::vector<std::int64_t>& checks = request.checks;
  if (checks.empty()) return;
  if (!request.goes_on) throw std::invalid_argument("checks need goes_on");
  if (checks.front() <= 0 || checks.back() >= request.steps || !std::ranges::is_sorted(checks, std::less_equal{}))
    throw std::invalid_argument("checks must be ascending, above 0 and below the number of steps");
}

}  // namespace

RobotSource source_of(std::vector<std::shared_ptr<const Robot>> robots) {
  return [robots = std::move(robots)](std::size_t index) {
    return index < robots.size() ? robots[index] : std::shared_ptr<const Robot>();
  };
}

Evaluator::Evaluator(const EvaluationRequest& request, RobotSource source, std::size_t count)
    : Evaluator(request, std::move(source), count, {}) {}

Evaluator::Evaluator(const EvaluationRequest& request, RobotSource source, std::size_t count,
                     std::vector<MakeBackend> devices) {
  validate(request.configuration);
  if (request.steps < 0 || request.settling < 0 || request.sample_every < 0)
    throw std::invalid_argument("numbers of steps must be 0 or more");
  if (request.drive && request.drive_every <= 0) throw std::invalid_argument("drives need steps between them");
  validate_checks(request);
  if (request.grows && count == unknown_count) throw std::invalid_argument("a source that grows needs a number");
  parts_ = std::make_unique<Parts>(request, std::move(source), count);
  parts_->start(std::move(devices));
}

Evaluator::~Evaluator() = default;

void Evaluator::extend(std::size_t more) {
  Parts& parts = *parts_;
  if (!parts.request.grows) throw std::logic_error("this source does not grow");
  const std::lock_guard lock(parts.mutex);
  const std::size_t before = parts.count;
  if (parts.batches.back() < before) parts.batches.push_back(before);
  if (parts.end == before) parts.end = before + more;  // nothing has failed
  parts.count = before + more;
  parts.update_demand();
  parts.notify_all();
}

std::optional<Evaluation> Evaluator::next() {
  Parts& parts = *parts_;
  FinishedPortion& current = parts.current;
  if (current.empty()) {
    std::unique_lock lock(parts.mutex);
    parts.maker_may_go_on.notify_one();  // all of the last portion was yielded
    parts.result_waits.wait(lock, [&] { return parts.next_is_known(); });
    if (parts.next_index >= parts.end) {
      if (parts.error && parts.error_index == parts.end) std::rethrow_exception(parts.error);
      return std::nullopt;
    }
    current = std::move(parts.finished.extract(parts.next_index).mapped());
    parts.next_index += current.results.size();
  }
  parts.memory_in_use -= current.bytes[current.next];
  return std::move(current.results[current.next++]);
}

bool Evaluator::wait_for(std::chrono::milliseconds time) {
  Parts& parts = *parts_;
  if (!parts.current.empty()) return true;
  std::unique_lock lock(parts.mutex);
  parts.maker_may_go_on.notify_one();
  return parts.result_waits.wait_for(lock, time, [&] { return parts.next_is_known(); });
}

void Evaluator::stop() {
  Parts& parts = *parts_;
  const std::lock_guard lock(parts.mutex);
  parts.stopping = true;
  if (!parts.waiting.empty()) parts.end_at(parts.waiting.front().first);
  for (const Portion& portion : parts.waiting) parts.memory_in_use -= portion.bytes();
  parts.waiting.clear();
  parts.waiting_robots = 0;
  parts.notify_all();
}

std::string Evaluator::device_name() {
  Parts& parts = *parts_;
  std::unique_lock lock(parts.mutex);
  const auto has_started = [](const auto& device) { return !device.name.empty(); };
  parts.device_has_started.wait(lock, [&] {
    return parts.error || (parts.devices_are_known && std::ranges::all_of(parts.devices, has_started));
  });
  if (!parts.devices_are_known || !std::ranges::all_of(parts.devices, has_started)) std::rethrow_exception(parts.error);
  std::vector<std::string> names;
  for (const auto& device : parts.devices) names.push_back(device.name);
  return joined_device_names(names);
}

std::vector<std::string> Evaluator::notes() const {
  const std::lock_guard lock(parts_->mutex);
  return parts_->notes;
}

EvaluationProgress Evaluator::progress() const {
  const Parts& parts = *parts_;
  const std::lock_guard lock(parts.mutex);
  EvaluationProgress progress{.devices = {},
                              .made = parts.made,
                              .done = parts.done,
                              .robot_steps = parts.robot_steps,
                              .starting = parts.starting.seconds(),
                              .making = parts.making.seconds(),
                              .loading = parts.loading.seconds(),
                              .stepping = parts.stepping.seconds(),
                              .reading = parts.reading.seconds(),
                              .load = parts.load_times};
  for (const auto& device : parts.devices)
    progress.devices.push_back({device.name, device.stepping.seconds(), device.robots});
  return progress;
}

}  // namespace mercury
