// SPDX-License-Identifier: Apache-2.0
#include "app/base/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "app/base/standard_streams.h"

extern char** environ;

namespace mercury {
namespace {

constexpr std::size_t kept_text = 65536;  // text_of() returns the last bytes of the output, at most this many

// The children that kill_children() ends, 0 = none. A signal handler reads them.
constexpr std::size_t most_children = 64;
std::array<std::atomic<pid_t>, most_children> children{};
static_assert(std::atomic<pid_t>::is_always_lock_free);

void enter(pid_t child) {
  for (auto& slot : children) {
    pid_t empty = 0;
    if (slot.compare_exchange_strong(empty, child)) return;
  }
}

// Call it before the child is waited for: after that, its number may be another process.
void strike_out(pid_t child) {
  for (auto& slot : children) {
    pid_t number = child;
    if (slot.compare_exchange_strong(number, 0)) return;
  }
}

// Waits until the child has ended, without releasing its number. Returns whether it has.
bool has_ended(pid_t child, int flags) {
  siginfo_t state{};
  int result = 0;
  do {
    result = waitid(P_PID, static_cast<id_t>(child), &state, WEXITED | WNOWAIT | flags);
  } while (result < 0 && errno == EINTR);
  return result < 0 || state.si_pid == child;
}

[[noreturn]] void throw_errno(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

int memory_file(const char* name) {
  const int descriptor = memfd_create(name, MFD_CLOEXEC);
  if (descriptor < 0) throw_errno("memfd_create");
  return descriptor;
}

std::string text_of(int descriptor) {
  const off_t size = lseek(descriptor, 0, SEEK_END);
  if (size <= 0) return {};
  const off_t start = std::max<off_t>(0, size - static_cast<off_t>(kept_text));
  std::string text(static_cast<std::size_t>(size - start), '\0');
  const ssize_t got = pread(descriptor, text.data(), text.size(), start);
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(0, got)));
  return text;
}

// Settings of posix_spawn: standard streams, process group and signals of the child.
class SpawnSettings {
 public:
  SpawnSettings() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    sigset_t broken_pipe, none;
    sigemptyset(&none);
    sigemptyset(&broken_pipe);
    sigaddset(&broken_pipe, SIGPIPE);
    posix_spawnattr_setsigdefault(&attributes, &broken_pipe);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnSettings() {
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
};

}  // namespace

CannotStart::CannotStart(int error)
    : std::runtime_error(std::strerror(error)), is_limit_(error == EAGAIN || error == ENOMEM) {}

ChildProcess::ChildProcess(const std::string& program, const std::vector<std::string>& arguments) {
  int pipe_ends[2];
  if (pipe2(pipe_ends, O_CLOEXEC) != 0) throw_errno("pipe");
  input_ = pipe_ends[1];
  // A larger pipe means fewer context switches. If the system refuses, only speed is lost.
  fcntl(input_, F_SETPIPE_SZ, 1 << 20);
  output_ = memory_file("child output");
  messages_ = memory_file("child messages");

  SpawnSettings settings;
  posix_spawn_file_actions_adddup2(&settings.actions, pipe_ends[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&settings.actions, output_, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&settings.actions, messages_, STDERR_FILENO);

  std::vector<char*> argv;
  argv.push_back(const_cast<char*>(program.c_str()));
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  pid_t pid = -1;
  const int error = posix_spawnp(&pid, program.c_str(), &settings.actions, &settings.attributes, argv.data(), environ);
  ::close(pipe_ends[0]);
  if (error == 0) {
    pid_ = pid;
    enter(pid);
    return;
  }
  for (const int descriptor : {input_, output_, messages_}) ::close(descriptor);
  throw CannotStart(error);
}

ChildProcess::~ChildProcess() {
  kill();
  ::close(output_);
  ::close(messages_);
}

void ChildProcess::close_input() {
  if (input_ >= 0) ::close(input_);
  input_ = -1;
}

bool ChildProcess::write(std::span<const std::uint8_t> bytes) {
  const NoBrokenPipeSignal quiet;
  while (!bytes.empty()) {
    const ssize_t count = ::write(input_, bytes.data(), bytes.size());
    if (count >= 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    } else if (errno == EPIPE) {
      return false;
    } else if (errno != EINTR) {
      throw_errno("write to a child process");
    }
  }
  return true;
}

// Takes the status of a child that has ended.
void ChildProcess::reap() {
  strike_out(pid_);
  while (waitpid(pid_, &status_, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
}

int ChildProcess::finish() {
  close_input();
  if (pid_ > 0 && has_ended(pid_, 0)) reap();
  return status_;
}

bool ChildProcess::running() {
  if (pid_ > 0 && has_ended(pid_, WNOHANG)) reap();
  return pid_ > 0;
}

void ChildProcess::release() {
  strike_out(pid_);
  pid_ = -1;
  close_input();
}

void ChildProcess::kill() {
  if (pid_ > 0) {
    ::kill(-pid_, SIGKILL);
    reap();
  }
  close_input();
}

void ChildProcess::signal(int number) {
  if (const pid_t child = pid_; child > 0) ::kill(-child, number);
}

std::string ChildProcess::output() const { return text_of(output_); }
std::string ChildProcess::messages() const { return text_of(messages_); }

void kill_children() {
  for (const auto& slot : children)
    if (const pid_t child = slot.load(); child > 0) ::kill(-child, SIGKILL);
}

std::string describe_exit(int status) {
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    return "was killed by signal " + std::to_string(number) + " (" + strsignal(number) + ")";
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) != 0) return "ended with status " + std::to_string(WEXITSTATUS(status));
  return {};
}

std::string output_of(const std::string& program, const std::vector<std::string>& arguments) {
  try {
    ChildProcess child(program, arguments);
    return child.finish() == 0 ? child.output() : std::string{};
  } catch (const CannotStart&) {
    return {};
  }
}

}  // namespace mercury
