// SPDX-License-Identifier: Apache-2.0
// Tests send signals to programs that they start, which inherit what this process ignores: SIGHUP under nohup, SIGINT
// in the background of a script. A handler in place of that is not inherited, and does as little.
#include <csignal>

namespace {

[[maybe_unused]] const bool programs_receive_signals = [] {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    const auto before = std::signal(number, [](int) {});
    if (before != SIG_IGN) std::signal(number, before);
  }
  return true;
}();

}  // namespace
