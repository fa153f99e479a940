// SPDX-License-Identifier: Apache-2.0
#include "app/base/terminal_question.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>

#include "app/base/interrupt.h"
#include "app/base/messages.h"

namespace mercury {
namespace {

// A line of standard input without its end. poll() returns at a signal; read() alone would go on waiting.
std::string read_line() {
  std::string line;
  while (!interrupted()) {
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (poll(&input, 1, -1) < 0) {
      if (errno == EINTR) continue;
      break;
    }
    char letter = 0;
    if (read(STDIN_FILENO, &letter, 1) != 1 || letter == '\n') break;
    line += letter;
  }
  return line;
}

}  // namespace

bool can_ask() { return isatty(STDIN_FILENO) == 1 && isatty(STDERR_FILENO) == 1; }

bool ask(const std::string& question) {
  write_to_standard_error("mercury: " + printable(question) + " [y/N] ");
  const std::string answer = read_line();
  if (interrupted()) write_to_standard_error("\n");
  throw_if_interrupted();
  return answer == "y" || answer == "Y" || answer == "yes" || answer == "Yes";
}

}  // namespace mercury
