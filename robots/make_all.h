// SPDX-License-Identifier: Apache-2.0
// Makes many robots on all cores.
#pragma once

#include <oneapi/tbb/parallel_for.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mercury/error.h"
#include "mercury/generator.h"

namespace mercury {

// make(index) for the indices first .. first + count - 1, in order. A robot for which it throws InputError is left out
// and listed in `failed`; without `failed`, the first such error is thrown, with the robot's name before it.
template <class Make>
std::vector<Robot> make_all(const std::string& kind, std::uint64_t seed, std::size_t count, std::uint64_t first,
                            Make make, std::vector<FailedRobot>* failed) {
  std::vector<std::optional<Robot>> made(count);
  std::vector<std::string> reasons(count);
  oneapi::tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    try {
      made[i] = make(first + i);
    } catch (const InputError& error) {
      reasons[i] = error.what();
    }
  });
  std::vector<Robot> robots;
  robots.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (made[i])
      robots.push_back(std::move(*made[i]));
    else if (failed)
      failed->push_back({first + i, std::move(reasons[i])});
    else
      throw InputError(kind + "-" + std::to_string(seed) + "-" + std::to_string(first + i), reasons[i]);
  }
  return robots;
}

}  // namespace mercury
