// SPDX-License-Identifier: Apache-2.0
#include "mercury/error.h"
#include "python/src/bindings.h"

namespace mercury::python {

// std::out_of_range becomes IndexError, std::invalid_argument ValueError by nanobind itself.
void bind_errors(nb::module_& module) {
  nb::exception<InputError>(module, "InputError", PyExc_ValueError).attr("__doc__") =
      "What the caller gave cannot be used. One line says where, what is wrong, and what would be accepted.";
  nb::exception<DeviceError>(module, "DeviceError", PyExc_RuntimeError).attr("__doc__") =
      "The machine lacks what was asked for: a GPU, memory, OpenGL.";
}

}  // namespace mercury::python
