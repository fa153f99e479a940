// SPDX-License-Identifier: Apache-2.0
// A child process that reads from us through its standard input.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace mercury {

// The program cannot be started: it does not exist or is not executable, or a limit of the system is reached.
class CannotStart : public std::runtime_error {
 public:
  explicit CannotStart(int error);             // of errno
  bool is_limit() const { return is_limit_; }  // for want of processes or memory, not because of the program

 private:
  bool is_limit_;
};

// Starts the program without a shell and in its own process group, so that Ctrl-C at the terminal reaches only us.
// Keeps its standard output and standard error in memory. Owns the process: the destructor kills it if it still runs.
class ChildProcess {
 public:
  // `program` is looked up on PATH unless it has a slash. Throws CannotStart.
  ChildProcess(const std::string& program, const std::vector<std::string>& arguments);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // Writes to the child's standard input; blocks while the pipe is full. Returns false when the child has closed it.
  bool write(std::span<const std::uint8_t> bytes);

  // Closes the child's standard input and waits for the child to end. Returns the status of waitpid().
  int finish();
  // Whether the child still runs, without waiting for it. finish() then returns at once.
  bool running();
  // Ends the child and its process group at once (SIGKILL).
  void kill();
  // Leaves the child to itself: the destructor no longer kills it.
  void release();
  // Sends a signal to the child and its process group if the child still runs. Another thread may call it during
  // write().
  void signal(int number);

  std::string output() const;    // the last 64 KiB of its standard output so far
  std::string messages() const;  // the last 64 KiB of its standard error so far

 private:
  void close_input();
  void reap();

  std::atomic<pid_t> pid_ = -1;
  int input_ = -1;
  int output_ = -1;
  int messages_ = -1;
  int status_ = 0;
};

// Ends all children that were not released, with their process groups. Only for the last moment of this process: a
// signal handler may call it.
void kill_children();

// "ended with status 1", "was killed by signal 9 (Killed)"; empty for status 0.
std::string describe_exit(int status);

// Runs `program` to its end. Returns its standard output, or nothing if it cannot be started or fails.
std::string output_of(const std::string& program, const std::vector<std::string>& arguments);

}  // namespace mercury
