// SPDX-License-Identifier: Apache-2.0
#include "app/commands/dry_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/interrupt.h"
#include "app/commands/description.h"
#include "mercury/clock.h"
#include "mercury/error.h"

namespace mercury {
namespace {

constexpr std::size_t most_made = 64;  // robots, to say how large they are

struct Size {
  std::size_t robots = 0, masses = 0, springs = 0;
  void add(const Robot& robot) {
    ++robots;
    masses += robot.masses.size();
    springs += robot.springs.size();
  }
};

std::string text_of(const Size& size) {
  return fmt::format("{}: {} masses, {} springs", size.robots, size.masses, size.springs);
}

}  // namespace

int print_dry_run(const std::string& command, const Intentions& intentions) {
  fmt::print("dry run of mercury {}; nothing was written\n", command);
  for (const auto& [what, text] : intentions)
    if (!text.empty()) print_line(what, text);
  return 0;
}

std::string count_text(std::int64_t count, const std::string& one, const std::string& several) {
  return fmt::format("{} {}", count, count == 1 ? one : several);
}

std::string size_text(std::span<const Robot> robots) {
  Size size;
  for (const Robot& robot : robots) size.add(robot);
  return text_of(size);
}

std::string size_text(std::span<const std::shared_ptr<const Robot>> robots) {
  Size size;
  for (const auto& robot : robots) size.add(*robot);
  return text_of(size);
}

std::string size_text(const RobotSequence& robots) {
  const std::size_t files = robots.files.size(), random = robots.count - files, made = std::min(random, most_made);
  Size size, sample;
  for (std::size_t i = 0; i < files; ++i) size.add(*robots.source(i));
  for (std::size_t i = 0; i < made; ++i) {
    throw_if_interrupted();
    try {
      sample.add(*robots.source(files + i * random / made));  // from all requests
    } catch (const InputError&) {                             // the command leaves it out
    }
  }
  const double share = sample.robots == 0 ? 0 : static_cast<double>(random) / static_cast<double>(made);
  size.robots = robots.count;
  size.masses += static_cast<std::size_t>(share * static_cast<double>(sample.masses));
  size.springs += static_cast<std::size_t>(share * static_cast<double>(sample.springs));
  if (made == random) return text_of(size);
  return fmt::format("{}: about {:.2g} masses, {:.2g} springs", size.robots, static_cast<double>(size.masses),
                     static_cast<double>(size.springs));
}

std::string time_text(const Configuration& configuration, std::int64_t steps) {
  return fmt::format("{:.6g} s: {} of {} s", time_of({.dt = configuration.dt, .step = steps}),
                     count_text(steps, "step", "steps"), configuration.dt);
}

std::string device_text(const Device& device) {
  std::string text(name_of(device));
  if (device.threads > 0) text += fmt::format(", {} threads", device.threads);
  return text;
}

}  // namespace mercury
