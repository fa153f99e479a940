// SPDX-License-Identifier: Apache-2.0
#include "python/src/gil.h"

#include <atomic>
#include <chrono>
#include <thread>

namespace mercury::python {
namespace {

namespace nb = nanobind;

// The thread that ends the interpreter, once it does.
std::atomic<std::thread::id> exiting_thread;

}  // namespace

ReleasedGil::ReleasedGil() : state_(PyEval_SaveThread()) {}

ReleasedGil::~ReleasedGil() {
  const std::thread::id exiting = exiting_thread;
  while (exiting != std::thread::id() && exiting != std::this_thread::get_id())
    std::this_thread::sleep_for(std::chrono::hours(1));
  PyEval_RestoreThread(state_);
}

void watch_exit() {
  nb::module_::import_("atexit").attr("register")(nb::cpp_function([] {
    exiting_thread = std::this_thread::get_id();
    // Objects of the threads that sleep from now on are no leaks.
    if (nb::cast<int>(nb::module_::import_("threading").attr("active_count")()) > 1) nb::set_leak_warnings(false);
  }));
}

}  // namespace mercury::python
