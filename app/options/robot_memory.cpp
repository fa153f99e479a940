// SPDX-License-Identifier: Apache-2.0
#include "app/options/robot_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/base/progress.h"
#include "mercury/error.h"

namespace mercury {
namespace {

// The mean of a few robots [bytes]; 0 if none of them can be made, which is reported when all are made.
double mean_bytes(RandomRobots request, const MemoryUse& use) {
  constexpr std::size_t fewest = 1, most = 16;
  request.count = std::clamp(request.count / most, fewest, most);
  std::vector<FailedRobot> failed;
  double sum = 0;
  const std::vector<Robot> robots = make_random_robots(request, &failed, shown_work());
  for (const Robot& robot : robots) sum += use.of(robot);
  return robots.empty() ? 0 : sum / static_cast<double>(robots.size());
}

// Two digits, downwards: "31,000".
std::string rounded(double count) {
  const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(std::max(count, 1.0))) - 1));
  return fmt::format("{:.0f}", std::floor(count / unit) * unit);
}

}  // namespace

void require_memory_for(std::span<const RandomRobots> requests, const MemoryUse& use, std::size_t usable) {
  constexpr std::size_t few = 16;
  double needed = 0;
  std::size_t robots = 0;
  for (const RandomRobots& request : requests) {
    robots += request.count;
    if (request.count > few) needed += static_cast<double>(request.count) * mean_bytes(request, use);
  }
  if (needed <= static_cast<double>(usable)) return;
  const double fit = static_cast<double>(robots) * static_cast<double>(usable) / needed;
  throw InputError("--random", memory_line(static_cast<std::size_t>(needed), usable,
                                           fmt::format("up to {} robots", rounded(std::max(fit, 1.0)))));
}

}  // namespace mercury
