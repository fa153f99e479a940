// SPDX-License-Identifier: Apache-2.0
// Array: memory of the device that steps robots, as NumPy, PyTorch, JAX and CuPy take it, without a copy.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "mercury/shared_array.h"

namespace mercury::python {

struct Array {
  std::shared_ptr<void> memory;  // kept as long as anybody uses it
  nanobind::dlpack::dtype dtype;
  std::vector<std::size_t> shape;
  int cuda_device = -1;  // -1 = the host's memory
  bool writable = false;
};

// (rows, columns), or (rows,) for one column if `flat`.
template <class Element, class T>
Array array_of(const SharedArray<T>& shared, bool writable, bool flat = false) {
  return {.memory = shared.data,
          .dtype = nanobind::dtype<Element>(),
          .shape = flat ? std::vector{shared.rows} : std::vector{shared.rows, shared.columns},
          .cuda_device = shared.cuda_device,
          .writable = writable};
}

}  // namespace mercury::python
