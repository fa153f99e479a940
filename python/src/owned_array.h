// SPDX-License-Identifier: Apache-2.0
// NumPy arrays that own what C++ computed.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <initializer_list>
#include <utility>
#include <vector>

namespace mercury::python {

// Takes the values over without a copy. `shape` has as many elements.
template <class T>
nanobind::object owned_array(std::vector<T> values, std::initializer_list<std::size_t> shape) {
  auto* kept = new std::vector<T>(std::move(values));
  const nanobind::capsule owner(kept, [](void* memory) noexcept { delete static_cast<std::vector<T>*>(memory); });
  static T none{};  // an empty array points somewhere, too
  return nanobind::cast(nanobind::ndarray<nanobind::numpy, T>(kept->empty() ? &none : kept->data(), shape, owner));
}

}  // namespace mercury::python
