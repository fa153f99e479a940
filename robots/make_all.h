// SPDX-License-Identifier: Apache-2.0
// Makes many robots on all cores.
#pragma once

#include <algorithm>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "mercury/error.h"
#include "mercury/generator.h"
#include "mercury/parallel.h"
#include "mercury/work_counter.h"

namespace mercury {

// make(index) for the indices first .. first + count - 1, in order. A robot for which it throws InputError is left out
// and listed in `failed`; without `failed`, the first such error is thrown, with the robot's name before it. The watch
// sees how many are made.
template <class Make>
std::vector<Robot> make_all(const std::string& kind, std::uint64_t seed, std::size_t count, std::uint64_t first,
                            Make make, std::vector<FailedRobot>* failed, const WorkWatch& watch = {}) {
  std::vector<Robot> robots(count);
  std::vector<FailedRobot> missing;
  std::mutex of_missing;
  WorkCounter counter(watch, "making robots", count);
  // Robots differ in work, and the smallest take a hundred times as long as a task costs.
  parallel_tasks(0, count, [&](std::size_t i) {
    try {
      robots[i] = make(first + i);
    } catch (const InputError& error) {
      const std::scoped_lock lock(of_missing);
      missing.push_back({first + i, error.what()});
    }
    counter.add_one();
  });
  if (missing.empty()) return robots;
  std::ranges::sort(missing, {}, &FailedRobot::index);
  if (!failed) {
    const auto& [index, reason] = missing.front();
    throw InputError(kind + "-" + std::to_string(seed) + "-" + std::to_string(index), reason);
  }
  std::size_t kept = 0;
  auto next_missing = missing.begin();
  for (std::size_t i = 0; i < count; ++i) {
    if (next_missing != missing.end() && next_missing->index == first + i) {
      ++next_missing;
      continue;
    }
    if (kept != i) robots[kept] = std::move(robots[i]);
    ++kept;
  }
  robots.resize(kept);
  failed->insert(failed->end(), missing.begin(), missing.end());
  return robots;
}

}  // namespace mercury
