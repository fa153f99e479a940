// SPDX-License-Identifier: Apache-2.0
#include "app/commands/evolution_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "app/base/messages.h"
#include "app/base/progress.h"

namespace mercury {
namespace {

constexpr std::chrono::milliseconds bar_period{100};
constexpr std::chrono::seconds line_period{5};

}  // namespace

EvolutionProgress::EvolutionProgress(int first_generation, int last_generation)
    : first_(first_generation), last_(last_generation), terminal_(draws_on_terminal()), generation_(first_generation),
      start_(Clock::now()), last_drawn_(start_) {}

EvolutionProgress::~EvolutionProgress() {
  if (shown_ && terminal_) write_to_standard_error("\r\033[K");
}

std::string EvolutionProgress::line() const {
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  std::string text = fmt::format("generation {}/{}", std::min(generation_, last_), last_);
  if (is_known_) text += fmt::format("  best {:.4g}  median {:.4g}", best_, median_);
  const double generations = generation_ - first_ + share_;
  if (generations <= 0 || elapsed <= 0) return text;
  const double left = (last_ + 1 - first_ - generations) * elapsed / generations;
  return text + fmt::format("  {} robots/s  {} left", with_magnitude(static_cast<double>(trials_ + partly_) / elapsed),
                            clock_text(left));
}

void EvolutionProgress::draw() {
  if (verbosity() == Verbosity::quiet) return;
  const Clock::time_point now = Clock::now();
  // Lines in a log stay, so their intervals grow.
  const Clock::duration period = terminal_ ? bar_period : std::max<Clock::duration>(line_period, (now - start_) / 4);
  if (now - last_drawn_ < period) return;
  last_drawn_ = now;
  shown_ = true;
  // A line as wide as the terminal would wrap.
  const auto room = static_cast<std::size_t>(std::max(1, terminal_columns() - 1));
  if (terminal_)
    write_to_standard_error(fmt::format("\r{}\033[K", line().substr(0, room)));
  else
    write_to_standard_error(line() + "\n");
}

void EvolutionProgress::update(std::size_t done, std::size_t all) {
  partly_ = done;
  share_ = all > 0 ? static_cast<double>(done) / static_cast<double>(all) : 0;
  draw();
}

void EvolutionProgress::finish_generation(std::size_t trials, double best, double median) {
  ++generation_;
  trials_ += trials;
  partly_ = 0;
  share_ = 0;
  best_ = best;
  median_ = median;
  is_known_ = true;
  draw();
}

}  // namespace mercury
