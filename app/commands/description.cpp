// SPDX-License-Identifier: Apache-2.0
#include "app/commands/description.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <thread>

#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/base/standard_streams.h"
#include "mercury/clock.h"
#include "mercury/error.h"
#include "robots/file/whole_file.h"

namespace mercury {

void print_heading(const std::string& text) { fmt::print("{}\n", printable(text)); }

void print_line(const std::string& what, const std::string& text) { fmt::print("  {:<12}{}\n", what, printable(text)); }

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

namespace {

bool is_named_pipe(const std::string& file) {
  struct stat status {};
  return ::stat(file.c_str(), &status) == 0 && S_ISFIFO(status.st_mode);
}

// A named pipe, open while an object of this class lives. Opening it would block until somebody reads, and Ctrl-C would
// not end that; so this asks again and again.
class PipeWithReader {
 public:
  explicit PipeWithReader(const std::string& file) {
    while (true) {
      descriptor_ = ::open(file.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
      if (descriptor_ >= 0 || errno != ENXIO) return;
      throw_if_interrupted();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  ~PipeWithReader() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  PipeWithReader(const PipeWithReader&) = delete;
  PipeWithReader& operator=(const PipeWithReader&) = delete;

 private:
  int descriptor_ = -1;
};

// A terminal would obey control characters in the names of robots; files and pipes get every byte.
void print_results(std::string_view content) {
  if (isatty(STDOUT_FILENO) == 0) return fmt::print("{}", content);
  while (!content.empty()) {
    const std::string_view line = content.substr(0, content.find('\n'));
    fmt::print("{}\n", printable(line, 8 * line.size()));
    content.remove_prefix(std::min(content.size(), line.size() + 1));
  }
}

}  // namespace

void write_results(const std::string& file, std::string_view content) {
  if (is_standard_output(file)) {
    print_results(content);
    return;
  }
  flush_results_so_far();  // what was printed so far is not lost if this takes long, or fails
  std::optional<PipeWithReader> pipe;
  if (is_named_pipe(file)) pipe.emplace(file);
  write_whole_file(file, content);
}

}  // namespace mercury
