// SPDX-License-Identifier: Apache-2.0
// An object of Python that C++ calls, from any thread.
#pragma once

#include <nanobind/nanobind.h>

#include <memory>

#include "mercury/error.h"

namespace mercury::python {

namespace nb = nanobind;

// Copies share the object; they come and go without the GIL.
class CalledObject {
 public:
  CalledObject() = default;
  // With the GIL. None = there is none.
  explicit CalledObject(nb::handle object) {
    if (object.is_none()) return;
    object_ = std::shared_ptr<PyObject>(object.inc_ref().ptr(), [](PyObject* owned) {
      if (!Py_IsInitialized()) return;
      const nb::gil_scoped_acquire gil;
      Py_DECREF(owned);
    });
  }

  explicit operator bool() const { return object_ != nullptr; }

  // Does something with the object while it has the GIL. An InputError of Python becomes one of C++; other exceptions
  // pass through.
  template <class Use>
  auto call(const Use& use) const {
    const nb::gil_scoped_acquire gil;
    try {
      return use(nb::handle(object_.get()));
    } catch (nb::python_error& raised) {
      if (raised.matches(nb::module_::import_("mercurysim").attr("InputError")))
        throw InputError(nb::str(raised.value()).c_str());
      throw;
    }
  }

 private:
  std::shared_ptr<PyObject> object_;
};

}  // namespace mercury::python
