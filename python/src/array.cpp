// SPDX-License-Identifier: Apache-2.0
#include "python/src/array.h"

#include <nanobind/stl/string.h>

#include <cstring>
#include <functional>
#include <numeric>
#include <string>

#include "mercury/cuda_devices.h"
#include "python/src/bindings.h"

namespace mercury::python {
namespace {

constexpr int dlpack_cpu = 1, dlpack_cuda = 2;
// Stream handles of CUDA's runtime, of DLPack and of __cuda_array_interface__.
constexpr std::intptr_t legacy_stream = 1;

nb::module_ numpy() { return nb::module_::import_("numpy"); }

const char* dtype_name(const Array& array) {
  return array.dtype.code == static_cast<std::uint8_t>(nb::dlpack::dtype_code::Bool) ? "bool" : "float32";
}

std::string device_of(const Array& array) {
  return array.on_host() ? "cpu" : "cuda:" + std::to_string(array.cuda_device);
}

nb::tuple shape_tuple(const Array& array) {
  nb::list shape;
  for (const std::size_t length : array.shape) shape.append(length);
  return nb::tuple(shape);
}

// nanobind's own array object, which speaks DLPack. It keeps the memory.
template <class... Kind>
nb::object exchange(const Array& array) {
  const nb::capsule owner(new std::shared_ptr<void>(array.memory),
                          [](void* memory) noexcept { delete static_cast<std::shared_ptr<void>*>(memory); });
  return nb::cast(
      nb::ndarray<Kind...>(array.memory.get(), array.shape.size(), array.shape.data(), owner, nullptr, array.dtype,
                           array.on_host() ? dlpack_cpu : dlpack_cuda, array.on_host() ? 0 : array.cuda_device),
      nb::rv_policy::reference);
}

// Waits until the work of the batch is done, unless it is in this stream anyway.
void wait_unless_in(const Array& array, void* stream) {
  if (array.on_host() || array.last_stream->load() == stream) return;
  const nb::gil_scoped_release release;
  synchronize_cuda_device(array.cuda_device);
}

Array copied_to_host(const Array& array) {
  Array copy{.memory = std::shared_ptr<void>(new std::byte[std::max<std::size_t>(1, array.bytes())],
                                             [](void* memory) { delete[] static_cast<std::byte*>(memory); }),
             .dtype = array.dtype,
             .shape = array.shape,
             .writable = true};
  const nb::gil_scoped_release release;
  if (array.bytes() == 0) return copy;
  if (array.on_host()) {
    std::memcpy(copy.memory.get(), array.memory.get(), array.bytes());
  } else {
    synchronize_cuda_device(array.cuda_device);
    copy_cuda_memory(copy.memory.get(), array.memory.get(), array.bytes());
  }
  return copy;
}

nb::object dlpack(const Array& array, nb::object max_version) {
  nb::object exchanged = array.writable ? exchange<nb::array_api>(array) : exchange<nb::array_api, nb::ro>(array);
  return exchanged.attr("__dlpack__")(nb::arg("max_version") = max_version);
}

nb::object to_dlpack(const Array& self, nb::object stream, nb::object max_version, nb::object dl_device,
                     nb::object copy) {
  const bool wants_host = !dl_device.is_none() && nb::cast<int>(dl_device[0]) == dlpack_cpu;
  if (!dl_device.is_none() && !wants_host &&
      (self.on_host() || nb::cast<int>(dl_device[0]) != dlpack_cuda || nb::cast<int>(dl_device[1]) != self.cuda_device))
    throw nb::buffer_error("the array stays on its device; it can be copied to the CPU");
  const bool moves = wants_host && !self.on_host(), wants_copy = !copy.is_none() && nb::cast<bool>(copy);
  if (moves && !copy.is_none() && !wants_copy) throw nb::buffer_error("only a copy can be on the CPU");
  if (wants_copy && !self.on_host() && !moves)
    throw nb::buffer_error("copy on the device by the library that takes it");
  if (moves || wants_copy) return dlpack(copied_to_host(self), max_version);
  if (!self.on_host()) {
    const std::intptr_t handle = stream.is_none() ? legacy_stream : nb::cast<std::intptr_t>(stream);
    if (handle != -1) wait_unless_in(self, stream_from(nb::cast(handle)));
  }
  return dlpack(self, max_version);
}

[[noreturn]] void refuse_host_access() {
  throw nb::type_error(
      "this array is in the memory of a GPU: give it to torch.from_dlpack, cupy.from_dlpack or jax.dlpack.from_dlpack, "
      "or copy it with numpy()");
}

nb::dict array_interface(const Array& self) {
  nb::dict interface;
  interface["version"] = 3;
  interface["shape"] = shape_tuple(self);
  interface["typestr"] = std::strcmp(dtype_name(self), "bool") == 0 ? "|b1" : "<f4";
  interface["strides"] = nb::none();
  return interface;
}

nb::dict host_interface(const Array& self) {
  if (!self.on_host()) throw nb::attribute_error("__array_interface__: this array is in the memory of a GPU");
  nb::dict interface = array_interface(self);
  interface["data"] = nb::make_tuple(reinterpret_cast<std::uintptr_t>(self.memory.get()), !self.writable);
  return interface;
}

// PyTorch takes nothing that says it is read-only.
nb::dict cuda_interface(const Array& self) {
  if (self.on_host()) throw nb::attribute_error("__cuda_array_interface__: this array is in the memory of the CPU");
  wait_unless_in(self, nullptr);
  nb::dict interface = array_interface(self);
  interface["data"] = nb::make_tuple(reinterpret_cast<std::uintptr_t>(self.memory.get()), false);
  interface["stream"] = legacy_stream;
  return interface;
}

nb::object numpy_view(nb::handle_t<Array> self) {
  if (!nb::cast<const Array&>(self).on_host()) refuse_host_access();
  return numpy().attr("asarray")(self);
}

nb::object numpy_copy(const Array& self) { return numpy().attr("asarray")(nb::cast(copied_to_host(self))); }

nb::object to_numpy(nb::handle_t<Array> self, nb::object dtype, nb::object copy) {
  const nb::object view = numpy_view(self);
  const bool converts = !dtype.is_none() && !view.attr("dtype").equal(numpy().attr("dtype")(dtype));
  if (converts && !copy.is_none() && !nb::cast<bool>(copy))
    throw nb::value_error("another dtype needs a copy, and copy is False");
  if (converts) return view.attr("astype")(dtype);
  return !copy.is_none() && nb::cast<bool>(copy) ? nb::object(view.attr("copy")()) : view;
}

std::string represent(nb::handle_t<Array> handle) {
  const Array& self = nb::cast<const Array&>(handle);
  const nb::object values = self.on_host() ? numpy_view(handle) : numpy_copy(self);
  const nb::object text = numpy().attr("array2string")(values, nb::arg("threshold") = 12, nb::arg("edgeitems") = 2);
  return "Array(shape=" + nb::cast<std::string>(nb::str(shape_tuple(self))) + ", dtype=" + dtype_name(self) +
         ", device='" + device_of(self) + "')\n" + nb::cast<std::string>(text);
}

constexpr const char* description =
    R"(Memory of the device that steps the robots. Other libraries take it without a copy:

    numpy.asarray(array)          torch.from_dlpack(array)
    cupy.from_dlpack(array)       jax.dlpack.from_dlpack(array)

The array keeps its memory, also when its batch is gone. While the batch lives, the values change with its steps. On the
CPU the array can be indexed like one of NumPy, and assigned to if it is writable.

Parts of the state are read-only. NumPy refuses to write to them. PyTorch and CuPy do not know read-only memory: what
they write has no effect on the robots and is gone after the next step. JAX takes it that arrays never change: give it
the array again after each step.

On CUDA, who takes an array by DLPack names a stream, and the array waits for the work of the batch unless that is in
the same stream. Views taken before are ordered by streams alone: use them in the stream of Batch.step().)";

}  // namespace

std::size_t Array::size() const {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

void* stream_from(nb::handle stream) {
  if (stream.is_none()) return nullptr;
  nb::object handle = nb::borrow(stream);
  if (nb::hasattr(stream, "__cuda_stream__")) {
    handle = stream.attr("__cuda_stream__");
    if (PyCallable_Check(handle.ptr())) handle = handle();
    handle = handle[1];
  } else if (nb::hasattr(stream, "cuda_stream")) {
    handle = stream.attr("cuda_stream");
  } else if (nb::hasattr(stream, "ptr")) {
    handle = stream.attr("ptr");
  }
  std::intptr_t number = 0;
  if (PyBool_Check(handle.ptr()) || !nb::try_cast(handle, number, false) || number < 0)
    throw nb::type_error(
        "stream: give the handle of a CUDA stream, or an object with __cuda_stream__, cuda_stream or ptr; None = the "
        "legacy default stream");
  return number == legacy_stream ? nullptr : reinterpret_cast<void*>(number);
}

void bind_array(nb::module_& module) {
  nb::class_<Array>(module, "Array", description)
      .def_prop_ro("shape", &shape_tuple, nb::sig("def shape(self) -> tuple[int, ...]"), "Length of each axis.")
      .def_prop_ro(
          "ndim", [](const Array& self) { return self.shape.size(); }, "Number of axes.")
      .def_prop_ro("size", &Array::size, "Number of elements.")
      .def_prop_ro("nbytes", &Array::bytes, "Bytes of all elements.")
      .def_prop_ro(
          "dtype", [](const Array& self) { return numpy().attr("dtype")(dtype_name(self)); },
          nb::sig("def dtype(self) -> numpy.dtype[typing.Any]"), "NumPy's name of the elements' type: float32 or bool.")
      .def_prop_ro("device", &device_of, "Where the memory is: 'cpu' or 'cuda:0'.")
      .def("__len__", [](const Array& self) { return self.shape[0]; })
      .def("__bool__",
           [](const Array&) -> bool {
             throw nb::value_error("an array is neither true nor false; use numpy.any(array) or numpy.all(array)");
           })
      .def("__repr__", &represent)
      .def(
          "__getitem__", [](nb::handle_t<Array> self, nb::handle key) { return nb::object(numpy_view(self)[key]); },
          nb::sig("def __getitem__(self, key: typing.Any, /) -> typing.Any"))
      .def(
          "__setitem__",
          [](nb::handle_t<Array> self, nb::handle key, nb::handle value) { numpy_view(self)[key] = value; },
          nb::sig("def __setitem__(self, key: typing.Any, value: numpy.typing.ArrayLike, /) -> None"))
      // Before numpy(), whose name hides the module's from what comes after it in the stub.
      .def("__array__", &to_numpy, nb::arg("dtype") = nb::none(), nb::arg("copy") = nb::none(),
           nb::sig("def __array__(self, dtype: typing.Any = None, copy: bool | None = None) -> "
                   "numpy.typing.NDArray[typing.Any]"))
      .def("numpy", &numpy_copy, nb::sig("def numpy(self) -> numpy.typing.NDArray[typing.Any]"),
           "A copy in the memory of the CPU, as a NumPy array.")
      .def(
          "torch", [](nb::handle_t<Array> self) { return nb::module_::import_("torch").attr("from_dlpack")(self); },
          nb::sig("def torch(self) -> typing.Any"), "The same memory as a PyTorch tensor.")
      .def_prop_ro("__array_interface__", &host_interface,
                   nb::sig("def __array_interface__(self) -> dict[str, typing.Any]"),
                   "NumPy's array interface, on the CPU only.")
      .def_prop_ro("__cuda_array_interface__", &cuda_interface,
                   nb::sig("def __cuda_array_interface__(self) -> dict[str, typing.Any]"),
                   "Numba's array interface, version 3, on CUDA only.")
      .def("__dlpack__", &to_dlpack, nb::kw_only(), nb::arg("stream") = nb::none(), nb::arg("max_version") = nb::none(),
           nb::arg("dl_device") = nb::none(), nb::arg("copy") = nb::none(),
           nb::sig("def __dlpack__(self, *, stream: typing.Any = None, max_version: tuple[int, int] | None = None, "
                   "dl_device: tuple[int, int] | None = None, copy: bool | None = None) -> typing.Any"),
           "A DLPack capsule of this memory. `stream` is the consumer's, -1 = do not wait for the batch.")
      .def(
          "__dlpack_device__",
          [](const Array& self) {
            return self.on_host() ? nb::make_tuple(dlpack_cpu, 0) : nb::make_tuple(dlpack_cuda, self.cuda_device);
          },
          nb::sig("def __dlpack_device__(self) -> tuple[int, int]"))
      .def("__reduce_ex__", refused_pickle("an Array cannot be pickled; pickle a copy: array.numpy()"),
           refused_pickle_signature);
}

}  // namespace mercury::python
