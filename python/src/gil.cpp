// SPDX-License-Identifier: Apache-2.0
#include "python/src/bindings.h"

#include <cxxabi.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace mercury::python {
namespace {

namespace nb = nanobind;

// The thread that ends the interpreter, once it does.
std::atomic<std::thread::id> exiting_thread;

[[noreturn]] void sleep_until_exit() {
  while (true) std::this_thread::sleep_for(std::chrono::hours(1));
}

}  // namespace

ReleasedGil::ReleasedGil() : state_(PyEval_SaveThread()) {}

// The interpreter may begin to exit while this thread waits in PyEval_RestoreThread(). Python before 3.14 then ends the
// thread by unwinding its stack, which destructors do not survive.
ReleasedGil::~ReleasedGil() {
  const std::thread::id exiting = exiting_thread;
  if (exiting != std::thread::id() && exiting != std::this_thread::get_id()) sleep_until_exit();
  try {
    PyEval_RestoreThread(state_);
  } catch (const abi::__forced_unwind&) {
    sleep_until_exit();
  }
}

void watch_exit() {
  nb::module_::import_("atexit").attr("register")(
      nb::cpp_function([] { exiting_thread = std::this_thread::get_id(); }));
}

}  // namespace mercury::python
