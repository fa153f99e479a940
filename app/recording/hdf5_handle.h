// SPDX-License-Identifier: Apache-2.0
// The owner of an object of HDF5, for headers that shall not include the library's.
#pragma once

#include <cstdint>
#include <utility>

namespace mercury::hdf5 {

using Id = std::int64_t;  // the library's hid_t

// Owns one object of the library: file, group, dataset, dataspace, type or property list.
class Handle {
 public:
  Handle() = default;
  // Throws Error with the library's message if the call that gave the id has failed.
  explicit Handle(Id id);
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, none)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Handle();
  operator Id() const { return id_; }
  // Closes the object now. Throws Error, unlike the destructor.
  void close();

 private:
  static constexpr Id none = -1;
  Id id_ = none;
};

}  // namespace mercury::hdf5
