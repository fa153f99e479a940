// SPDX-License-Identifier: Apache-2.0
#include "app/base/standard_streams.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

#include "mercury/error.h"

namespace mercury {
namespace {

sigset_t broken_pipe() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGPIPE);
  return set;
}

int flush_error = 0;  // of the first flush that failed

}  // namespace

void replace_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    // The lowest free number is this one. Opened the wrong way round, so that use is an error; messages may be dropped.
    const int opened = open("/dev/null", stream == STDOUT_FILENO ? O_RDONLY : O_WRONLY);
    if (opened > STDERR_FILENO) close(opened);
  }
}

void flush_results_so_far() {
  if (std::fflush(stdout) != 0 && flush_error == 0) flush_error = errno;
}

void flush_standard_output() {
  flush_results_so_far();
  if (flush_error == 0 && !std::ferror(stdout)) return;
  const std::string reason = flush_error != 0 ? ": " + reason_of(flush_error) : "";
  throw std::runtime_error("standard output cannot be written" + reason);
}

NoBrokenPipeSignal::NoBrokenPipeSignal() {
  const sigset_t set = broken_pipe();
  sigset_t before;
  pthread_sigmask(SIG_BLOCK, &set, &before);
  was_blocked_ = sigismember(&before, SIGPIPE) == 1;
}

NoBrokenPipeSignal::~NoBrokenPipeSignal() {
  if (was_blocked_) return;
  // A signal that is pending would be delivered as soon as it is unblocked.
  const sigset_t set = broken_pipe();
  const timespec at_once{};
  sigtimedwait(&set, nullptr, &at_once);
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

}  // namespace mercury
