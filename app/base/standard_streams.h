// SPDX-License-Identifier: Apache-2.0
// Standard input, output and error of a program that was started without one of them, or whose output nobody can take.
#pragma once

namespace mercury {

// Puts /dev/null in the place of standard streams that are closed, so that no file which the program opens becomes its
// standard error. Reading such an input and writing such an output still fails.
void replace_closed_streams();

// Writes the results printed so far. A failure is reported by flush_standard_output().
void flush_results_so_far();
// Writes what is left of the results. Throws std::runtime_error("standard output cannot be written: ...") if they could
// not be written.
void flush_standard_output();

// While an object of this class lives, writing to a pipe that nobody reads gives this thread an error (EPIPE) and no
// signal.
class NoBrokenPipeSignal {
 public:
  NoBrokenPipeSignal();
  ~NoBrokenPipeSignal();
  NoBrokenPipeSignal(const NoBrokenPipeSignal&) = delete;
  NoBrokenPipeSignal& operator=(const NoBrokenPipeSignal&) = delete;

 private:
  bool was_blocked_;
};

}  // namespace mercury
