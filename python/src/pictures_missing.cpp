// SPDX-License-Identifier: Apache-2.0
// What stands for pictures, recordings and exports in a build without the program (MERCURY_APP=OFF).
#include "mercury/error.h"
#include "python/src/bindings.h"

namespace mercury::python {
namespace {

[[noreturn]] void refuse(const nb::args&, const nb::kwargs&) {
  throw DeviceError("this build cannot draw: it was made with MERCURY_APP=OFF");
}

[[noreturn]] void refuse_recording(const nb::args&, const nb::kwargs&) {
  throw DeviceError("this build cannot read recordings: it was made with MERCURY_APP=OFF");
}

[[noreturn]] void refuse_export(const nb::args&, const nb::kwargs&) {
  throw DeviceError("this build cannot export: it was made with MERCURY_APP=OFF");
}

}  // namespace

void bind_pictures(nb::module_& module) {
  for (const char* name : {"_picture", "_render", "_Film"}) module.def(name, &refuse);
  module.def("_stop_videos", [] {});
  module.def("_end_drawing", [] {});
}

void bind_recording(nb::module_& module) {
  module.def("Recording", &refuse_recording);
  module.def("Recorder", &refuse_recording);
}
void bind_export(nb::module_& module) { module.def("export", &refuse_export); }

}  // namespace mercury::python
