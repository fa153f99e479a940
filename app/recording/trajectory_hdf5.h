// SPDX-License-Identifier: Apache-2.0
// HDF5 as trajectories use it: objects are closed by their owners, and a failure is an exception of one line.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/recording/hdf5_handle.h"
#include "mercury/material.h"

namespace mercury::hdf5 {

// A call of the library failed. what() is the innermost message.
class Error : public std::runtime_error {
 public:
  Error(const std::string& message, int number) : std::runtime_error(message), number_(number) {}
  explicit Error(const std::string& message) : Error(message, 0) {}
  int number() const { return number_; }  // errno of the system call that failed; 0 = none

 private:
  int number_;
};

// Call this first. The library then prints nothing by itself, and does not close files when the program ends: on a full
// disk it cannot.
void prepare();

// Returns the result of a call. Throws Error with the library's message if the result is negative.
hid_t checked(hid_t result);

using Extent = std::vector<hsize_t>;

// The type of a number in memory and in the file, where it is little-endian.
struct NumberType {
  hid_t memory, file;
};
template <class Number>
NumberType number_type();

// Materials as compounds of four floats, named as its members. Where a table needs them, after them half_wave as h5py
// writes a bool, an enum of FALSE and TRUE, and relaxation_time, a float.
struct MaterialFields {
  bool half_wave = false, relaxation_time = false;
};
Handle material_type(MaterialFields fields);         // in the file
Handle material_memory_type(MaterialFields fields);  // of a Material
// UTF-8 of a fixed length, padded with zeros.
Handle text_type(std::size_t size);
// ASCII of variable length.
Handle variable_text_type();

Handle space_of(const Extent& extent);
Extent extent_of(hid_t dataset);

// Throw Error if there is no such group or dataset.
Handle open_group(hid_t parent, const std::string& name);
Handle open_dataset(hid_t parent, const std::string& name);
bool has_member(hid_t group, const std::string& name);
bool has_attribute(hid_t object, const std::string& name);

}  // namespace mercury::hdf5
