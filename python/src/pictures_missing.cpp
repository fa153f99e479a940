// SPDX-License-Identifier: Apache-2.0
// What stands for pictures in a build without OpenGL (MERCURY_APP=OFF).
#include "mercury/error.h"
#include "python/src/bindings.h"

namespace mercury::python {
namespace {

[[noreturn]] void refuse(const nb::args&, const nb::kwargs&) {
  throw DeviceError("this build cannot draw: it was made with MERCURY_APP=OFF");
}

}  // namespace

void bind_pictures(nb::module_& module) {
  for (const char* name : {"_picture", "_render_robots", "_render_recording", "_Film"}) module.def(name, &refuse);
  module.def("_end_drawing", [] {});
}

}  // namespace mercury::python
