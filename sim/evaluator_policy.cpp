// SPDX-License-Identifier: Apache-2.0
// How many robots an evaluator makes at a time, and which worker takes how many of them. Results do not depend on it.
//
// A GPU needs many robots at the same time: most robots are too small to use much of it alone, and their steps take as
// long whether it is full or not. So a device that is not full takes what there is, at once; one that is full waits
// until there is a large portion for the time after. The first portions are small, so that stepping begins early.
#include <algorithm>
#include <thread>

#include "sim/evaluator_parts.h"

namespace mercury {
namespace {

// Per device. Stepping on the CPU uses all cores by itself.
constexpr int cuda_workers = 4, cpu_workers = 1;
// More robots make fuller lockstep groups on the CPU: with 64 per thread stepping takes a seventh longer, with 1024 as
// long.
constexpr std::size_t cpu_robots_per_thread = 512;
// Robots that the maker makes before it hands them on, if a device waits for them and if none does.
constexpr std::size_t smallest_piece = 128, usual_piece = 512;
// Robots per portion on CUDA: the first, then twice as many, and so on. If more wait when the device starts, one
// portion takes them all, or a few share them evenly: stepping begins earlier than if one took more bytes than these.
constexpr std::size_t first_portion = 512, largest_portion = 8192;
constexpr std::size_t usual_portion_bytes = std::size_t{64} << 20;
// Until it is known how many robots a device steps at once.
constexpr std::size_t portions_at_start = 3, waiting_at_start = 16384;

}  // namespace

int Evaluator::Parts::workers_of(const DeviceParts& device) const {
  return request.workers > 0 ? request.workers : device.is_cpu ? cpu_workers : cuda_workers;
}

// --- The maker

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
  if (count != unknown_count) {
    const std::size_t remaining = count - first;
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
        return !device.is_cpu && !device.name.empty() && device.robots_in_hand < robots_that_fill(device);
      });
  std::size_t most = usual_piece;
  for (const DeviceParts& device : devices)
    if (device.is_cpu) most = std::max(most, robots_that_fill(device));
  piece_robots = request.portion > 0 ? request.portion : most;
}

// --- The workers

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
    return static_cast<double>(any.robots_in_hand) / static_cast<double>(robots_that_fill(any));
  };
  const auto has_less_to_do = [&](const DeviceParts& other) {
    return other.idle_workers > 0 && share_in_hand(other) < share_in_hand(device);
  };
  if (std::ranges::any_of(devices, has_less_to_do)) return false;
  if (request.portion > 0 || device.portions_in_hand == 0) return true;
  if (!device.is_cpu && device.robots_at_once == 0) return device.portions_in_hand < portions_at_start;
  const std::size_t fill = robots_that_fill(device);
  if (device.robots_in_hand < fill) return true;
  return device.robots_in_hand < 2 * fill && (all_made || waiting_robots >= largest_portion_of(device));
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
