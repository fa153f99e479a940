// SPDX-License-Identifier: Apache-2.0
// The threads of an evaluator, see evaluator_parts.h.
#include <algorithm>
#include <future>
#include <thread>
#include <utility>

#include "mercury/backend.h"
#include "mercury/cuda_devices.h"
#include "mercury/host_memory.h"
#include "mercury/parallel.h"
#include "sim/devices.h"
#include "sim/evaluator_parts.h"
#include "sim/robot_notes.h"

namespace mercury {
namespace {

// Per device. Stepping on the CPU uses all cores by itself.
constexpr int cuda_workers = 4, cpu_workers = 1;
// More robots make fuller lockstep groups on the CPU: with 64 per thread stepping takes a seventh longer, with 1024 as
// long.
constexpr std::size_t cpu_robots_per_thread = 512;
// Robots that the maker makes before it hands them on, if a device waits for them and if none does.
constexpr std::size_t smallest_piece = 256, usual_piece = 512;
// Robots per portion on CUDA: the first, then twice as many, and so on. If more wait when the device starts, one
// portion takes them all, or a few share them evenly: stepping begins earlier than if one took more bytes than these.
// One simulation steps robots faster than several do: its size classes need few of CUDA's queues.
constexpr std::size_t first_portion = 512, largest_portion = 8192;
constexpr std::size_t usual_portion_bytes = std::size_t{192} << 20;
// A device takes portions until it has this many times the robots that it steps at once, so that the others keep it
// full while a worker loads robots.
constexpr std::size_t most_in_hand = 4;
// A batch waits for the one before it unless that has more than this many times the robots that a device steps at once:
// then some robots end while others begin.
constexpr double largest_awaited = 3;
// It waits until what is left are the whole trials of this share of the robots that a device steps at once.
constexpr double share_not_awaited = 0.125;
// Until it is known how many robots a device steps at once.
constexpr std::size_t portions_at_start = 2, waiting_at_start = 16384;

}  // namespace

Evaluator::Parts::Parts(const EvaluationRequest& wanted, RobotSource robots, std::size_t number)
    : request(wanted), source(std::move(robots)),
      memory_limit(wanted.memory_limit > 0 ? wanted.memory_limit : available_host_memory() / 4), count(number),
      end(number) {
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
  if (maker.joinable()) maker.join();  // the constructor of a thread may have failed
  for (std::thread& worker : workers) worker.join();
}

void Evaluator::Parts::start(std::vector<MakeBackend> given) {
  const bool are_known = !given.empty() || request.configuration.device.kind == DeviceKind::cpu || !built_with_cuda();
  if (given.empty() && request.configuration.device.kind != DeviceKind::cpu) prepared = prepare_for_cuda();
  prepares = prepared != nullptr;
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
        parts.make_backend = [this, device] {
          return device.kind == DeviceKind::cuda ? make_cuda_backend(device, prepared) : make_backend(device);
        };
      }
    {
      const std::lock_guard lock(mutex);
      devices.swap(found);
      devices_are_known = true;
      if (std::ranges::all_of(devices, &DeviceParts::is_cpu)) prepares = false;
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
    for (bool is_complete = count == 0 && !request.grows; !is_complete;) {
      PortionLimits limits{.bytes = 0,
                           .enough = [&](std::size_t robots) { return is_large_enough(first, robots); },
                           .canceled = [&] { return stopping || (first >= end && first < count); }};
      std::size_t known;
      {
        std::unique_lock lock(mutex);
        maker_may_go_on.wait(lock, [&] { return limits.canceled() || (first < count && may_make()); });
        if (limits.canceled()) break;
        limits.bytes = piece_bytes();
        known = count;
      }
      std::optional<UnionClock::Interval> interval(std::in_place, making);
      Portion portion = make_portion(source, first, known, limits, request.serial_source, largest_robot);
      interval.reset();
      prepare(portion);
      {
        const std::lock_guard lock(mutex);
        if (limits.canceled()) break;
        const bool made_known = first + portion.candidates.size() == known;
        is_complete = portion.candidates.empty() || (portion.is_last && !(request.grows && made_known));
        first += portion.candidates.size();
        made += portion.candidates.size();
        memory_in_use += portion.bytes();
        waiting_robots += portion.candidates.size();
        if (!portion.candidates.empty()) waiting.push_back(std::move(portion));
        update_demand();
        portion_waits.notify_all();
      }
    }
  } catch (...) {
    fail(first, std::current_exception());
  }
  const std::lock_guard lock(mutex);
  all_made = true;
  end_at(first);
  notify_all();
}

// Before a worker takes them. Workers that each prepared their own, on the same cores, would all be ready late.
void Evaluator::Parts::prepare(const Portion& portion) {
  if (!prepares) return;
  const std::vector<std::shared_ptr<const Robot>> robots = portion.robots();
  parallel_for(0, robots.size(), [&](std::size_t i) {
    const bool is_repeated = i > 0 && robots[i] == robots[i - 1];
    if (prepares && !is_repeated) prepared->prepare(robots[i]);
  });
}

// --- The workers

void Evaluator::Parts::work(DeviceParts& device) {
  std::size_t first = 0;
  try {
    std::optional<UnionClock::Interval> interval(std::in_place, starting);
    std::unique_ptr<Backend> made = device.make_backend();
    const Backend& backend = *made;
    Simulation simulation(request.configuration, std::span<const Robot>(), std::move(made));
    interval.reset();
    device_started(device, backend);
    StepPace pace(backend.cuda_device() >= 0);
    while (std::optional<Portion> portion = take(device)) {
      first = portion->first;
      evaluate(device, simulation, backend, *std::move(portion), pace);
    }
  } catch (...) {
    fail(first, std::current_exception());
  }
}

void Evaluator::Parts::device_started(DeviceParts& device, const Backend& backend) {
  const int cuda = backend.cuda_device();
  const std::size_t free = cuda >= 0 ? free_cuda_memory(cuda) : unknown_count;
  const std::lock_guard lock(mutex);
  device.name = backend.device_name();
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
  device.in_hand[portion.first] = {.robots = portion.candidates.size()};
  ++device.portions_taken;
  update_demand();
  notify_all();
  return portion;
}

void Evaluator::Parts::evaluate(DeviceParts& device, Simulation& simulation, const Backend& backend, Portion portion,
                                StepPace& pace) {
  const std::size_t first = portion.first;
  const TrialContext context{.canceled = [&] { return first >= end; },
                             .stopping = [&] { return stopping.load(); },
                             .stepped = [&](std::int64_t steps) { robot_steps += steps; },
                             .sampled =
                                 [&](std::int64_t steps) {
                                   const std::lock_guard lock(mutex);
                                   device.in_hand.at(first).steps = steps;
                                   portion_may_begin.notify_all();
                                 },
                             .device_stepping = &device.stepping,
                             .stepping = &stepping};
  FinishedPortion result;
  if (!stopping) {
    const LoadTimes before = simulation.load_times();
    std::optional<UnionClock::Interval> interval(std::in_place, loading);
    load(simulation, portion);
    interval.reset();
    loaded(device, backend);
    // The robots are looked at while they are stepped.
    std::future<void> noting;
    if (request.notes)
      noting = std::async(std::launch::async,
                          [this, robots = portion.robots()] { add_notes(robot_notes(robots, request.configuration)); });
    wait_for_earlier_batches(device, portion);
    PortionTrial trial(simulation, request, context, pace, portion);
    if (!stopping && trial.run()) {
      interval.emplace(reading);
      result.results = trial.results();
    }
    add_load_times(before, simulation.load_times());
    simulation.keep({});
    if (noting.valid()) noting.get();
  }
  // From here on, only the results hold the robots.
  for (Candidate& candidate : portion.candidates) candidate.robot.reset();
  finish(device, portion, std::move(result));
}

void Evaluator::Parts::wait_for_earlier_batches(const DeviceParts& device, const Portion& portion) {
  std::unique_lock lock(mutex);
  portion_may_begin.wait(lock, [&] { return stopping || portion.first >= end || may_begin(device, portion); });
}

void Evaluator::Parts::loaded(DeviceParts& device, const Backend& backend) {
  const std::size_t at_once = backend.robots_at_once();
  if (request.notes) add_notes(backend.notes());
  const std::lock_guard lock(mutex);
  if (at_once > 0) device.robots_at_once = at_once;
  update_demand();
  portion_waits.notify_all();
}

void Evaluator::Parts::add_notes(const std::vector<std::string>& lines) {
  const std::lock_guard lock(mutex);
  for (const std::string& line : lines)
    if (std::ranges::find(notes, line) == notes.end()) notes.push_back(line);
}

void Evaluator::Parts::add_load_times(const LoadTimes& before, const LoadTimes& after) {
  const std::lock_guard lock(mutex);
  load_times.check += after.check - before.check;
  load_times.schedule += after.schedule - before.schedule;
  load_times.upload += after.upload - before.upload;
}

// Without results if the portion was given up: unwanted, or not begun when the evaluation stopped.
void Evaluator::Parts::finish(DeviceParts& device, const Portion& portion, FinishedPortion result) {
  const std::lock_guard lock(mutex);
  device.in_hand.erase(portion.first);
  if (result.results.empty()) {
    memory_in_use -= portion.bytes();
    given_up.emplace(portion.first, portion.candidates.size());
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

bool Evaluator::Parts::next_is_known() {
  for (auto gap = given_up.find(next_index); gap != given_up.end(); gap = given_up.find(next_index))
    next_index += gap->second;
  return next_index >= end || finished.contains(next_index);
}

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
  portion_may_begin.notify_all();
  result_waits.notify_all();
  device_has_started.notify_all();
}

// --- Portions
//
// How many robots an evaluator makes at a time, and which worker takes how many of them. Results do not depend on it.
//
// A GPU needs many robots at the same time: most robots are too small to use much of it alone, and their steps take as
// long whether it is full or not. So an idle device takes what there is, at once; one that is not full waits for as
// many robots as it has, so that its workers do not all have small portions while many robots wait; one that is full
// waits until there is a large portion for the time after. The first portions are small, so that stepping begins early.

int Evaluator::Parts::workers_of(const DeviceParts& device) const {
  return request.workers > 0 ? request.workers : device.is_cpu ? cpu_workers : cuda_workers;
}

// --- How many robots the maker makes

bool Evaluator::Parts::is_made() const { return all_made || made == count; }

bool Evaluator::Parts::may_make() const {
  std::size_t most_waiting = 0;
  for (const DeviceParts& device : devices)
    most_waiting += device.is_cpu ? 1 : device.robots_at_once > 0 ? 2 * largest_portion_of(device) : waiting_at_start;
  if (!devices_are_known) most_waiting = waiting_at_start;
  const std::size_t in_use = memory_in_use;
  return waiting_robots < most_waiting &&
         (in_use == 0 || in_use + std::max(piece_bytes(), largest_robot.load()) <= memory_limit);
}

std::size_t Evaluator::Parts::piece_bytes() const { return std::min(memory_limit / 8, portion_bytes); }

bool Evaluator::Parts::is_large_enough(std::size_t first, std::size_t robots) const {
  std::size_t most = piece_robots;
  if (request.portion > 0) return robots >= most;
  if (const std::size_t known = count; known != unknown_count) {
    const std::size_t remaining = known - first;
    if (device_count > 1)  // all devices should end at the same time
      most = std::min(most, std::max(smallest_piece, remaining / (4 * device_count)));
    else if (remaining <= most + most / 4)  // rather a larger piece than a tiny one at the end
      most = remaining;
  }
  return robots >= most || (device_is_hungry && robots >= smallest_piece);
}

void Evaluator::Parts::update_demand() {
  device_count = devices.size();
  device_is_hungry =
      waiting.empty() && std::ranges::any_of(devices, [&](const DeviceParts& device) {
        return !device.is_cpu && !device.name.empty() && device.robots_in_hand() < robots_that_fill(device);
      });
  std::size_t most = usual_piece;
  for (const DeviceParts& device : devices)
    if (device.is_cpu) most = std::max(most, robots_that_fill(device));
  piece_robots = request.portion > 0 ? request.portion : most;
}

// --- How many robots a worker takes

std::size_t Evaluator::Parts::DeviceParts::robots_in_hand() const {
  std::size_t sum = 0;
  for (const auto& [first, portion] : in_hand) sum += portion.robots;
  return sum;
}

std::size_t Evaluator::Parts::robots_that_fill(const DeviceParts& device) const {
  if (!device.is_cpu) return std::max<std::size_t>(1, device.robots_at_once);
  const auto threads = static_cast<std::size_t>(request.configuration.device.threads);
  return cpu_robots_per_thread * (threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency()));
}

std::size_t Evaluator::Parts::largest_portion_of(const DeviceParts& device) const {
  if (request.portion > 0) return request.portion;
  if (device.is_cpu) return robots_that_fill(device);
  const std::size_t growing = first_portion << std::min<std::size_t>(device.portions_taken, 10);
  std::size_t most = std::min(growing, largest_portion);
  if (device.portions_taken < portions_at_start) {
    const std::size_t portions =
        std::clamp<std::size_t>(memory_in_use / usual_portion_bytes, 1, portions_at_start - device.portions_taken);
    const std::size_t sharing = portions * std::max<std::size_t>(1, devices.size());
    most = std::clamp((waiting_robots + sharing - 1) / sharing, most, largest_portion);
  }
  if (device.robots_at_once > 0) most = std::min(most, std::max(usual_piece, device.robots_at_once));
  if (devices.size() > 1 && count != unknown_count)  // all devices should end at the same time
    most = std::min(most, std::max(smallest_piece, (count - next_first) / (2 * devices.size())));
  return most;
}

bool Evaluator::Parts::may_take(const DeviceParts& device) const {
  if (waiting.empty()) return false;
  const auto share_in_hand = [&](const DeviceParts& any) {
    return static_cast<double>(any.robots_in_hand()) / static_cast<double>(robots_that_fill(any));
  };
  const auto has_less_to_do = [&](const DeviceParts& other) {
    return other.idle_workers > 0 && share_in_hand(other) < share_in_hand(device);
  };
  if (std::ranges::any_of(devices, has_less_to_do)) return false;
  if (request.portion > 0 || device.in_hand.empty()) return true;
  if (!device.is_cpu && device.robots_at_once == 0) return device.in_hand.size() < portions_at_start;
  const std::size_t fill = robots_that_fill(device), in_hand = device.robots_in_hand();
  const std::size_t as_many = std::min(in_hand, largest_portion_of(device));
  if (in_hand < fill) return is_made() || waiting_robots >= as_many;
  return in_hand < most_in_hand * fill && (is_made() || waiting_robots >= largest_portion_of(device));
}

bool Evaluator::Parts::may_begin(const DeviceParts& device, const Portion& portion) const {
  const auto next = std::ranges::upper_bound(batches, portion.first);
  if (device.is_cpu || next - batches.begin() < 2) return true;
  const std::size_t first = *(next - 1), before = first - *(next - 2);
  const auto fill = static_cast<double>(robots_that_fill(device));
  const double share_of_device = static_cast<double>(before) / static_cast<double>(devices.size());
  if (share_of_device > largest_awaited * fill) return true;
  double left = 0;
  for (const auto& [index, in_hand] : device.in_hand)
    if (index < first)
      left += static_cast<double>(in_hand.robots) *
              (1 - static_cast<double>(in_hand.steps) / static_cast<double>(std::max<std::int64_t>(1, request.steps)));
  return left <= share_not_awaited * fill;
}

Portion Evaluator::Parts::next_portion(const DeviceParts& device) {
  const std::size_t most = largest_portion_of(device), most_bytes = std::min(memory_limit / 4, portion_bytes);
  Portion portion = std::move(waiting.front());
  waiting.pop_front();
  std::size_t bytes = portion.bytes();
  while (!waiting.empty()) {
    Portion& next = waiting.front();
    bytes += next.bytes();
    if (portion.candidates.size() + next.candidates.size() > most || bytes > most_bytes) break;
    portion.candidates.insert(portion.candidates.end(), std::make_move_iterator(next.candidates.begin()),
                              std::make_move_iterator(next.candidates.end()));
    waiting.pop_front();
  }
  waiting_robots -= portion.candidates.size();
  next_first = portion.first + portion.candidates.size();
  return portion;
}

}  // namespace mercury
