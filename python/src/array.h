// SPDX-License-Identifier: Apache-2.0
// Array: memory of the device that steps robots, as NumPy, PyTorch, JAX and CuPy take it, without a copy.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <atomic>
#include <initializer_list>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "mercury/shared_array.h"
#include "mercury/telemetry.h"

namespace mercury::python {

// The CUDA stream of a batch's last work, which its arrays ask for. A null pointer is the legacy default stream.
using LastStream = std::shared_ptr<std::atomic<void*>>;

struct Array {
  std::shared_ptr<void> memory;  // kept as long as anybody uses it; not null on the host
  nanobind::dlpack::dtype dtype;
  std::vector<std::size_t> shape;
  int cuda_device = -1;  // -1 = the host's memory
  bool writable = false;
  LastStream last_stream;

  bool on_host() const { return cuda_device < 0; }
  std::size_t size() const;  // elements
  std::size_t bytes() const { return size() * dtype.bits / 8; }
};

// (rows, columns), or (rows,) for one column if `flat`.
template <class Element, class T>
Array array_of(const SharedArray<T>& shared, LastStream last_stream, bool writable, bool flat = false) {
  Array array{.memory = shared.data,
              .dtype = nanobind::dtype<Element>(),
              .shape = flat ? std::vector{shared.rows} : std::vector{shared.rows, shared.columns},
              .cuda_device = shared.cuda_device,
              .writable = writable,
              .last_stream = std::move(last_stream)};
  if (!array.memory && array.on_host()) array.memory = std::make_shared<double>(0);  // an address for no elements
  return array;
}

// The stream that a caller names: None = the legacy default stream, a handle, or an object with __cuda_stream__(),
// cuda_stream (PyTorch) or ptr (CuPy). Throws TypeError.
void* stream_from(nanobind::handle stream);

// NumPy arrays that own what C++ computed.

// Takes the values over without a copy. `shape` has as many elements.
template <class T>
nanobind::object owned_array(std::vector<T> values, std::initializer_list<std::size_t> shape) {
  auto* kept = new std::vector<T>(std::move(values));
  const nanobind::capsule owner(kept, [](void* memory) noexcept { delete static_cast<std::vector<T>*>(memory); });
  static T none{};  // an empty array points somewhere, too
  return nanobind::cast(nanobind::ndarray<nanobind::numpy, T>(kept->empty() ? &none : kept->data(), shape, owner));
}

namespace nb = nanobind;

// One element per robot, a structured NumPy array; the fields are those of Telemetry.
nb::object telemetry_array(std::span<const Telemetry> telemetry);

}  // namespace mercury::python
