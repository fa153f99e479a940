// SPDX-License-Identifier: Apache-2.0
#include "python/src/arguments.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>

#include "mercury/error.h"

namespace mercury::python {
namespace {

nb::object as_array(nb::handle value, const char* name, const char* accepted) {
  try {
    return nb::module_::import_("numpy").attr("asarray")(value);
  } catch (nb::python_error& error) {
    if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) throw;
    throw nb::type_error((std::string(name) + ": " + accepted).c_str());
  }
}

std::string text_of(const nb::object& object) { return nb::str(nb::handle(object)).c_str(); }
std::string dtype_of(nb::handle array) { return text_of(array.attr("dtype")); }
std::string shape_of(nb::handle array) { return text_of(array.attr("shape")); }

// A copy in C order as this dtype, with its address.
template <class T>
std::vector<T> copied(nb::handle array, const char* dtype) {
  const nb::object contiguous =
      nb::module_::import_("numpy").attr("ascontiguousarray")(array, nb::arg("dtype") = dtype);
  std::vector<T> values(nb::cast<std::size_t>(contiguous.attr("size")));
  const auto address = nb::cast<std::uintptr_t>(contiguous.attr("ctypes").attr("data"));
  if (!values.empty()) std::memcpy(values.data(), reinterpret_cast<const void*>(address), values.size() * sizeof(T));
  return values;
}

}  // namespace

std::size_t checked_index(std::int64_t index, std::size_t size) {
  if (index < 0 || static_cast<std::uint64_t>(index) >= size)
    throw std::out_of_range("robot " + std::to_string(index) + " is out of range, the batch has " +
                            std::to_string(size));
  return static_cast<std::size_t>(index);
}

std::vector<std::int64_t> indices_from(nb::handle indices) {
  constexpr const char* accepted = "give a sequence of integers; for a mask, numpy.flatnonzero(mask)";
  const nb::object array = as_array(indices, "indices", accepted);
  const auto kind = nb::cast<std::string>(array.attr("dtype").attr("kind"));
  const bool is_empty = nb::cast<std::size_t>(array.attr("size")) == 0;
  if (nb::cast<int>(array.attr("ndim")) != 1 || (kind != "i" && kind != "u" && !is_empty))
    throw nb::type_error((std::string("indices: ") + accepted).c_str());
  return copied<std::int64_t>(array, "int64");
}

namespace {

struct Shaped {
  std::vector<float> numbers;
  std::vector<std::size_t> shape;
};

// Of one of the accepted shapes.
Shaped numbers_of_shape(nb::handle values, const std::string& name,
                        const std::vector<std::vector<std::size_t>>& shapes) {
  std::string accepted = "give numbers of shape ";
  for (std::size_t i = 0; i < shapes.size(); ++i)
    accepted += (i == 0                  ? ""
                 : i + 1 < shapes.size() ? ", "
                                         : " or ") +
                text_of(nb::steal(PySequence_Tuple(nb::cast(shapes[i]).ptr())));
  const nb::object array = as_array(values, name.c_str(), accepted.c_str());
  const auto kind = nb::cast<std::string>(array.attr("dtype").attr("kind"));
  if (kind != "f" && kind != "i" && kind != "u") throw nb::type_error((name + ": " + accepted).c_str());
  const auto shape = nb::cast<std::vector<std::size_t>>(array.attr("shape"));
  if (std::ranges::find(shapes, shape) == shapes.end())
    throw InputError(name, "the shape " + shape_of(array) + " is not accepted; " + accepted);
  return {copied<float>(array, "float32"), shape};
}

}  // namespace

std::vector<float> numbers_from(nb::handle values, std::size_t rows, const std::string& name) {
  return numbers_of_shape(values, name, {{}, {rows}}).numbers;
}

std::vector<Vec3> vectors_from(nb::handle values, std::size_t rows, const std::string& name, bool magnitudes) {
  std::vector<std::vector<std::size_t>> shapes{{3}, {rows, 3}};
  if (magnitudes) shapes.insert(shapes.end(), {{}, {rows, 1}});
  const auto [numbers, shape] = numbers_of_shape(values, name, shapes);
  std::vector<Vec3> vectors;
  if (shape.empty() || shape.back() == 1)
    for (const float magnitude : numbers) vectors.push_back({0, 0, -magnitude});
  else
    for (std::size_t i = 0; i < numbers.size(); i += 3) vectors.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  return vectors;
}

std::vector<Vec3> vectors_from(nb::handle values, std::size_t rows, const char* name) {
  const std::string accepted = "give an array of " + std::to_string(rows) + " x 3 numbers";
  const nb::object array = as_array(values, name, accepted.c_str());
  const auto kind = nb::cast<std::string>(array.attr("dtype").attr("kind"));
  if (kind != "f" && kind != "i" && kind != "u")
    throw nb::type_error(
        (std::string(name) + ": elements of " + dtype_of(array) + " are not accepted; " + accepted).c_str());
  if (!array.attr("shape").equal(nb::make_tuple(rows, 3)))
    throw InputError(name, "the shape " + shape_of(array) + " is not accepted; " + accepted);
  const std::vector<float> numbers = copied<float>(array, "float32");
  std::vector<Vec3> vectors(rows);
  for (std::size_t i = 0; i < rows; ++i) vectors[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
  return vectors;
}

nb::object vector_array(std::span<const Vec3> vectors) {
  const nb::object array =
      nb::module_::import_("numpy").attr("empty")(nb::make_tuple(vectors.size(), 3), nb::arg("dtype") = "float32");
  auto* out = reinterpret_cast<float*>(nb::cast<std::uintptr_t>(array.attr("ctypes").attr("data")));
  for (const Vec3 vector : vectors)
    for (const float number : {vector.x, vector.y, vector.z}) *out++ = number;
  return array;
}

int cuda_device_of(nb::handle array) {
  constexpr int dlpack_cuda = 2;
  if (!nb::hasattr(array, "__dlpack_device__")) return -1;
  const nb::object device = array.attr("__dlpack_device__")();
  return nb::cast<int>(device[0]) == dlpack_cuda ? nb::cast<int>(device[1]) : -1;
}

std::vector<std::uint8_t> mask_from(nb::handle mask) {
  constexpr const char* accepted = "give one bool per robot, as a sequence or as an array of bool or uint8";
  const nb::object array = as_array(mask, "mask", accepted);
  const std::string dtype = dtype_of(array);
  if (nb::cast<int>(array.attr("ndim")) != 1 ||
      (dtype != "bool" && dtype != "uint8" && nb::cast<std::size_t>(array.attr("size")) > 0))
    throw nb::type_error((std::string("mask: ") + accepted).c_str());
  return copied<std::uint8_t>(array, "uint8");
}

DeviceMask device_mask_from(nb::handle mask, void* cuda_stream) {
  const std::intptr_t handle = cuda_stream ? reinterpret_cast<std::intptr_t>(cuda_stream) : 1;  // 1 = legacy default
  const nb::object capsule = mask.attr("__dlpack__")(nb::arg("stream") = handle);
  nb::ndarray<nb::ro, nb::device::cuda> array;
  if (!nb::try_cast(capsule, array, false)) throw nb::type_error("mask: this array is no DLPack tensor of a GPU");
  const bool has_bytes = array.dtype() == nb::dtype<bool>() || array.dtype() == nb::dtype<std::uint8_t>();
  if (array.ndim() != 1 || !has_bytes || (array.shape(0) > 1 && array.stride(0) != 1))
    throw nb::type_error("mask: give one bool or uint8 per robot, one after another");
  return {.owner = nb::borrow(mask), .data = static_cast<const std::uint8_t*>(array.data()), .size = array.shape(0)};
}

}  // namespace mercury::python
