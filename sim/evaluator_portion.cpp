// SPDX-License-Identifier: Apache-2.0
#include "sim/evaluator_portion.h"

#include <algorithm>
#include <deque>
#include <mutex>

#include "mercury/error.h"
#include "mercury/parallel.h"

namespace mercury {
namespace {

// About what a robot and its part of a simulation take on the host: the robot, its schedule on the way to the device,
// its material table.
std::size_t host_bytes(const Robot& robot) {
  constexpr std::size_t per_robot = 16384, copies = 5;
  return per_robot + robot.name.size() + robot.origin.size() +
         copies * (robot.masses.size() * sizeof(Vec3) + robot.springs.size() * sizeof(Spring) +
                   robot.faces.size() * sizeof(Face) + robot.materials.size() * sizeof(Material));
}

constexpr std::size_t unknown_bytes = 1 << 20;  // expected of a robot before the first one is there

// Several threads take the next index in turn, so the indices that are taken are always consecutive.
class PortionMaker {
 public:
  PortionMaker(const RobotSource& source, std::size_t first, std::size_t end, const PortionLimits& limits,
               std::atomic<std::size_t>& largest)
      : source_(source), first_(first), end_(end), limits_(limits), largest_(largest) {}

  void work() {
    while (Entry* const entry = take()) make(*entry);
  }

  Portion result() {
    Portion portion{.first = first_};
    for (Entry& entry : entries_)
      if (entry.index < end_) portion.candidates.push_back(std::move(entry.candidate));
    portion.is_last = first_ + portion.candidates.size() == end_;
    return portion;
  }

 private:
  struct Entry {
    std::size_t index;
    Candidate candidate;
  };

  // nullptr if the portion is complete.
  Entry* take() {
    const std::lock_guard lock(mutex_);
    const std::size_t count = entries_.size();
    if (first_ + count >= end_ || limits_.canceled()) return nullptr;
    // Robots that are being made are expected to be as large as the largest so far.
    const std::size_t known = largest_, expected = known > 0 ? known : unknown_bytes;
    if (count > 0 && (bytes_ + (in_making_ + 1) * expected > limits_.bytes || limits_.enough(count))) return nullptr;
    ++in_making_;
    return &entries_.emplace_back(Entry{first_ + count, {}});
  }

  void make(Entry& entry) {
    Candidate& candidate = entry.candidate;
    bool is_there = true;
    try {
      candidate.robot = source_(entry.index);
      is_there = candidate.robot != nullptr;
    } catch (const InputError& error) {
      candidate.failure = error.what();
    }
    candidate.bytes = candidate.robot ? host_bytes(*candidate.robot) : sizeof(Evaluation) + candidate.failure.size();
    const std::lock_guard lock(mutex_);
    --in_making_;
    bytes_ += candidate.bytes;
    if (candidate.robot) largest_ = std::max(largest_.load(), candidate.bytes);
    if (!is_there) end_ = std::min(end_, entry.index);
  }

  const RobotSource& source_;
  const std::size_t first_;
  std::size_t end_;
  const PortionLimits& limits_;
  std::atomic<std::size_t>& largest_;
  std::mutex mutex_;
  std::deque<Entry> entries_;  // their addresses do not change
  std::size_t bytes_ = 0, in_making_ = 0;
};

}  // namespace

std::size_t Portion::bytes() const {
  std::size_t sum = 0;
  for (const Candidate& candidate : candidates) sum += candidate.bytes;
  return sum;
}

std::vector<std::shared_ptr<const Robot>> Portion::robots() const {
  std::vector<std::shared_ptr<const Robot>> robots;
  for (const Candidate& candidate : candidates)
    if (candidate.failure.empty()) robots.push_back(candidate.robot);
  return robots;
}

Portion make_portion(const RobotSource& source, std::size_t first, std::size_t end, const PortionLimits& limits,
                     bool is_serial, std::atomic<std::size_t>& largest) {
  PortionMaker maker(source, first, end, limits, largest);
  if (is_serial) {
    maker.work();
    return maker.result();
  }
  parallel_tasks(0, parallel_threads(), [&](std::size_t) { maker.work(); });
  return maker.result();
}

}  // namespace mercury
