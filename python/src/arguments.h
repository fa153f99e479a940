// SPDX-License-Identifier: Apache-2.0
// What Python gives, as C++ takes it. The functions throw TypeError, IndexError and InputError with one line.
#pragma once

#include <nanobind/nanobind.h>

#include <cstdint>
#include <span>
#include <vector>

#include "mercury/vec3.h"

namespace mercury::python {

namespace nb = nanobind;

// Throws std::out_of_range unless 0 <= index < size.
std::size_t checked_index(std::int64_t index, std::size_t size);

// A sequence or an array of integers. What is none, such as a mask, is refused.
std::vector<std::int64_t> indices_from(nb::handle indices);

// `rows` vectors: anything that NumPy makes a (rows, 3) array of. `name` = of the argument, for messages.
std::vector<Vec3> vectors_from(nb::handle values, std::size_t rows, const char* name);

// One number, or one per row: anything that NumPy makes a () or (rows) array of. Returns 1 or `rows` numbers.
std::vector<float> numbers_from(nb::handle values, std::size_t rows, const std::string& name);
// One vector (3), or one per row (rows, 3). With `magnitudes`, a number m or a column (rows, 1) of them stands for
// (0, 0, -m). Returns 1 or `rows` vectors.
std::vector<Vec3> vectors_from(nb::handle values, std::size_t rows, const std::string& name, bool magnitudes);

// The reverse: a NumPy array with memory of its own.
nb::object vector_array(std::span<const Vec3> vectors);

// The CUDA device that holds an array; -1 = none.
int cuda_device_of(nb::handle array);

// One element per robot, not 0 where the mask is set: a sequence of bools, or an array of bool or uint8.
std::vector<std::uint8_t> mask_from(nb::handle mask);

// The same in the memory of a CUDA device, in the order of a stream.
struct DeviceMask {
  nb::object owner;
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};
DeviceMask device_mask_from(nb::handle mask, void* cuda_stream);

}  // namespace mercury::python
