// SPDX-License-Identifier: Apache-2.0
#include "app/base/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "app/base/interrupt.h"
#include "app/base/messages.h"

namespace mercury {
namespace {

constexpr std::chrono::milliseconds bar_period{100};

// Until the first line of a log.
std::chrono::duration<double> line_period() {
  const char* given = std::getenv("MERCURY_PROGRESS_SECONDS");
  const double seconds = given ? std::atof(given) : 0;
  return std::chrono::duration<double>(seconds > 0 ? seconds : 5);
}

std::string rate_and_time_left(const std::string& unit, double done, std::int64_t total, double elapsed) {
  if (done <= 0 || elapsed <= 0) return {};
  const double rate = done / elapsed;
  const double time_left = (static_cast<double>(total) - done) / rate;
  return fmt::format("  {} {}/s  {} left", with_magnitude(rate), unit, clock_text(time_left));
}

double fraction_of(double done, std::int64_t total) {
  return total > 0 ? std::clamp(done / static_cast<double>(total), 0.0, 1.0) : 0;
}

}  // namespace

bool draws_on_terminal() {
  const char* terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) && terminal && std::string(terminal) != "dumb";
}

int terminal_columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string with_magnitude(double value) {
  if (!std::isfinite(value)) return "-";
  const char* suffixes[] = {"", " k", " M", " G", " T", " P"};
  std::size_t step = 0;
  while (std::abs(value) >= 999.5 && step + 1 < std::size(suffixes)) {
    value /= 1000;
    ++step;
  }
  const double size = std::abs(value);
  const int decimals = size >= 99.95 || (step == 0 && value == std::floor(value)) ? 0 : size >= 9.995 ? 1 : 2;
  return fmt::format("{:.{}f}{}", value, decimals, suffixes[step]);
}

std::string clock_text(double seconds) {
  if (!std::isfinite(seconds) || seconds > 1e7) return "?";
  const auto whole = static_cast<std::int64_t>(std::lround(std::max(0.0, seconds)));
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

std::string duration_text(double seconds) {
  if (seconds < 10) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<std::int64_t>(std::llround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  const bool hours = whole >= 3600;
  const std::int64_t rest = hours ? whole / 60 % 60 : whole % 60;
  return fmt::format("{} {}", whole / (hours ? 3600 : 60), hours ? "h" : "min") +
         (rest == 0 ? "" : fmt::format(" {} {}", rest, hours ? "min" : "s"));
}

std::string progress_bar(const std::string& what, const std::string& unit, const Done& done, std::int64_t total,
                         double elapsed, int columns) {
  constexpr int width = 24;
  const int filled = static_cast<int>(fraction_of(done.in_all, total) * width);
  std::string text = fmt::format("{} [{:#<{}}{:.<{}}] {:3.0f} %  {}/{} {}{}", what, "", filled, "", width - filled,
                                 100 * fraction_of(done.in_all, total), done.whole, total, unit,
                                 rate_and_time_left(unit, done.in_all, total, elapsed));
  // A line as wide as the terminal would wrap, and \r could not overwrite it.
  if (const auto room = static_cast<std::size_t>(std::max(1, columns - 1)); text.size() > room) text.resize(room);
  return text;
}

std::string progress_line(const std::string& what, const std::string& unit, const Done& done, std::int64_t total,
                          double elapsed) {
  return fmt::format("{}: {}/{} {} ({:.0f} %){}", what, done.whole, total, unit, 100 * fraction_of(done.in_all, total),
                     rate_and_time_left(unit, done.in_all, total, elapsed));
}

Progress::Progress(std::string what, std::string unit, std::int64_t total)
    : what_(std::move(what)), unit_(std::move(unit)), total_(total), terminal_(draws_on_terminal()),
      line_period_(line_period()), start_(Clock::now()), last_(start_) {}

Progress::~Progress() {
  if (shown_ && terminal_) write_to_standard_error("\r\033[K");
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  say_detail(fmt::format("{}: {} of {} {} in {:.2f} s", what_, done_.whole, total_, unit_, elapsed));
}

void Progress::update(Done done) {
  done_ = done;
  if (verbosity() == Verbosity::quiet) return;
  const Clock::time_point now = Clock::now();
  // Lines in a log stay, so their intervals grow.
  using Period = std::chrono::duration<double>;
  const Period period = terminal_ ? Period(bar_period) : std::max(line_period_, Period(now - start_) / 4);
  if (now - last_ < period) return;
  draw();
}

void Progress::show() {
  if (terminal_ && verbosity() != Verbosity::quiet) draw();
}

void Progress::draw() {
  last_ = Clock::now();
  shown_ = true;
  const double elapsed = std::chrono::duration<double>(last_ - start_).count();
  if (terminal_)
    write_to_standard_error(
        fmt::format("\r{}\033[K", progress_bar(what_, unit_, done_, total_, elapsed, terminal_columns())));
  else
    write_to_standard_error(progress_line(what_, unit_, done_, total_, elapsed) + "\n");
}

WorkWatch shown_work() {
  struct Shown {
    std::string_view what;
    std::optional<Progress> progress;
  };
  return [shown = std::make_shared<Shown>()](const char* what, std::size_t done, std::size_t total) {
    throw_if_interrupted();
    if (shown->what != what) {
      shown->what = what;
      shown->progress.emplace(what, "robots", static_cast<std::int64_t>(total));
    }
    if (shown->progress) shown->progress->update(static_cast<std::int64_t>(done));
    if (done == total) shown->progress.reset();
  };
}

}  // namespace mercury
