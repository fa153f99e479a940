// SPDX-License-Identifier: Apache-2.0
#include "python/src/array.h"

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "python/src/bindings.h"

namespace mercury::python {
namespace {

// nanobind's own array object, which speaks DLPack and the buffer protocol. It keeps the memory.
template <class... Kind>
nb::object exchange(const Array& array) {
  const nb::capsule owner(new std::shared_ptr<void>(array.memory),
                          [](void* memory) noexcept { delete static_cast<std::shared_ptr<void>*>(memory); });
  const bool on_host = array.cuda_device < 0;
  return nb::cast(
      nb::ndarray<Kind...>(array.memory.get(), array.shape.size(), array.shape.data(), owner, nullptr, array.dtype,
                           on_host ? nb::device::cpu::value : nb::device::cuda::value, on_host ? 0 : array.cuda_device),
      nb::rv_policy::reference);
}

nb::object as_dlpack(const Array& array) {
  return array.writable ? exchange<nb::array_api>(array) : exchange<nb::array_api, nb::ro>(array);
}

nb::object as_numpy(const Array& array) {
  if (array.cuda_device >= 0)
    throw nb::type_error(
        "this array is in the memory of a GPU; give it to torch.as_tensor, cupy.asarray or "
        "jax.dlpack.from_dlpack");
  return array.writable ? exchange<nb::numpy>(array) : exchange<nb::numpy, nb::ro>(array);
}

}  // namespace

void bind_array(nb::module_& module) {
  nb::class_<Array>(module, "Array",
                    "Memory of the device that steps the robots. Other libraries take it without a copy.")
      .def_prop_ro("shape", [](const Array& self) { return nb::tuple(nb::cast(self.shape)); })
      .def("__dlpack__",
           [](const Array& self, const nb::kwargs& options) { return as_dlpack(self).attr("__dlpack__")(**options); })
      .def("__dlpack_device__",
           [](const Array& self) {
             return self.cuda_device < 0 ? nb::make_tuple(1, 0) : nb::make_tuple(2, self.cuda_device);
           })
      .def(
          "__array__", [](const Array& self, nb::handle, nb::handle) { return as_numpy(self); },
          nb::arg("dtype") = nb::none(), nb::arg("copy") = nb::none());
}

}  // namespace mercury::python
