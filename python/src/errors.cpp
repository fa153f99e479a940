// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <new>
#include <stdexcept>

#include "mercury/error.h"
#include "mercury/host_memory.h"
#include "python/src/bindings.h"

namespace mercury::python {

// std::out_of_range becomes IndexError, std::invalid_argument ValueError by nanobind itself.
void bind_errors(nb::module_& module) {
  nb::exception<InputError>(module, "InputError", PyExc_ValueError).attr("__doc__") =
      "What the caller gave cannot be used. One line says where, what is wrong, and what would be accepted.";
  nb::exception<DeviceError>(module, "DeviceError", PyExc_RuntimeError).attr("__doc__") =
      "The machine lacks what was asked for: a GPU, memory, OpenGL.";
  nb::register_exception_translator([](const std::exception_ptr& error, void*) {
    const auto no_memory = [] { PyErr_SetString(PyExc_MemoryError, no_memory_line().c_str()); };
    try {
      std::rethrow_exception(error);
    } catch (const std::bad_alloc&) {
      no_memory();
    } catch (const std::length_error&) {
      no_memory();
    }
  });
}

}  // namespace mercury::python
