// SPDX-License-Identifier: Apache-2.0
// A child process that is fed through its standard input.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace mercury {

// The program cannot be started: there is none of that name, or it may not be run.
class CannotStart : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Started without a shell, in a process group of its own, so that Ctrl-C at the terminal reaches only us.
// Standard output and standard error are kept in memory. Owns the process: the destructor kills it if it still runs.
class ChildProcess {
 public:
  // `program` is looked up on PATH unless it has a slash. Throws CannotStart.
  ChildProcess(const std::string& program, const std::vector<std::string>& arguments);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // Feeds its standard input; blocks while the pipe is full. False when the child reads no more.
  bool write(std::span<const std::uint8_t> bytes);

  // Closes its standard input and waits for its end. Returns the status as waitpid tells it.
  int finish();
  // Ends it at once.
  void kill();
  // Sends it a signal, if it still runs.
  void signal(int number);

  std::string output() const;    // what it wrote to standard output so far
  std::string messages() const;  // what it wrote to standard error so far

 private:
  void close_input();

  pid_t pid_ = -1;
  int input_ = -1;
  int output_ = -1;
  int messages_ = -1;
  int status_ = 0;
};

// "ended with status 1", "was killed by signal 9 (Killed)"; empty for status 0.
std::string describe_exit(int status);

// Runs `program` to its end and returns its standard output; empty if it cannot be started or fails.
std::string output_of(const std::string& program, const std::vector<std::string>& arguments);

}  // namespace mercury
