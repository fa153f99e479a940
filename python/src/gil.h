// SPDX-License-Identifier: Apache-2.0
// Python's global interpreter lock while the library works.
#pragma once

#include <nanobind/nanobind.h>

namespace mercury::python {

// Lets other threads of Python run until its end. A daemon thread that comes back while the interpreter exits sleeps
// instead: Python would end the thread in the middle of C++ functions, and with it the process.
class ReleasedGil {
 public:
  ReleasedGil();
  ~ReleasedGil();
  ReleasedGil(const ReleasedGil&) = delete;
  ReleasedGil& operator=(const ReleasedGil&) = delete;

 private:
  PyThreadState* state_;
};

// Notices when the interpreter exits.
void watch_exit();

}  // namespace mercury::python
