// SPDX-License-Identifier: Apache-2.0
// HDF5 as trajectories use it: what is opened is closed, and a failure is an exception of one line.
#pragma once

#include <hdf5.h>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mercury/material.h"

namespace mercury::hdf5 {

// A call of the library failed; what() is its innermost message.
class Error : public std::runtime_error {
 public:
  Error(const std::string& message, int number) : std::runtime_error(message), number_(number) {}
  explicit Error(const std::string& message) : Error(message, 0) {}
  int number() const { return number_; }  // errno of the system call that failed; 0 = none did

 private:
  int number_;
};

// To be called before anything else: the library prints nothing by itself, and does not tidy up when the program ends
// (a file on a full disk cannot be tidied up).
void prepare();

// The result of a call, unless it is negative: then throws Error with what the library noted.
hid_t checked(hid_t result);

// Owns one object of the library: file, group, dataset, dataspace, type or property list.
class Handle {
 public:
  Handle() = default;
  explicit Handle(hid_t id) : id_(checked(id)) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) H5Idec_ref(id_);
  }
  operator hid_t() const { return id_; }
  // Lets go of it now. Throws Error, as a destructor cannot.
  void close() { checked(H5Idec_ref(std::exchange(id_, H5I_INVALID_HID))); }

 private:
  hid_t id_ = H5I_INVALID_HID;
};

using Extent = std::vector<hsize_t>;

// How a number lies in memory, and how in the file: little-endian, as most machines have it.
struct NumberType {
  hid_t memory, file;
};
template <class Number>
NumberType number_type();

// Material as a compound of four floats by its members' names.
Handle material_type();

// --- writing ---

Handle create_group(hid_t parent, const std::string& name);
// A group whose members are listed in the order in which they were made.
Handle create_ordered_group(hid_t parent, const std::string& name);

template <class Number>
void write_attribute(hid_t object, const std::string& name, Number value);
template <class Number>
void write_attribute(hid_t object, const std::string& name, std::span<const Number> values);
// Of fixed length, UTF-8.
void write_text(hid_t object, const std::string& name, std::string_view text);
// A row of texts of one fixed length.
void write_texts(hid_t object, const std::string& name, std::initializer_list<std::string_view> texts);
// As H5MD's module `units` wants it: "m s-1", of variable length, ASCII.
void write_unit(hid_t object, std::string_view unit, const std::string& name = "unit");

// What a dataset that grows along its first axis is made of.
struct Growing {
  Extent row;         // extent of one element
  hsize_t chunk = 1;  // elements a chunk
  int deflate = 0;    // 0 = not compressed, 1..9
};
// Empty at first. Checksummed.
Handle create_growing(hid_t parent, const std::string& name, hid_t file_type, const Growing& growing);

// A dataset of that extent with its content; one piece, checksummed.
Handle write_dataset(hid_t parent, const std::string& name, hid_t file_type, hid_t memory_type, const Extent& extent,
                     const void* content);
// A dataset of one value everywhere, which takes no room in the file.
Handle write_constant(hid_t parent, const std::string& name, float value, const Extent& extent);
// A dataset that is one text, or a row of them.
void write_text_dataset(hid_t parent, const std::string& name, std::string_view text);
void write_text_dataset(hid_t parent, const std::string& name, std::span<const std::string> texts);

// Lengthens a growing dataset to first + count elements and writes the last `count`. `memory` selects their numbers
// within `content`; none = they are all of it.
void append_rows(hid_t dataset, hid_t memory_type, hsize_t first, hsize_t count, const void* content,
                 hid_t memory = H5S_ALL);

// An attribute that refers to a member of `parent`.
void write_reference(hid_t object, const std::string& name, hid_t parent, const std::string& target);

// Another name for an object of the same file.
void link(hid_t target_parent, const std::string& target, hid_t parent, const std::string& name);

// --- reading ---

Handle open_group(hid_t parent, const std::string& name);
Handle open_dataset(hid_t parent, const std::string& name);
bool has_member(hid_t group, const std::string& name);
bool has_attribute(hid_t object, const std::string& name);
// Names of a group's members, in any order.
std::vector<std::string> members(hid_t group);

template <class Number>
Number read_attribute(hid_t object, const std::string& name);
template <class Number, std::size_t count>
std::array<Number, count> read_attributes(hid_t object, const std::string& name);
std::string read_text(hid_t object, const std::string& name);

Extent extent_of(hid_t dataset);
// Throws Error unless the file holds enough for that many bytes of the dataset's content, compressed at most as far as
// deflate can: to be asked before memory is taken for what a damaged file announces.
void require_content(hid_t dataset, std::uint64_t bytes);
// The whole content.
void read_dataset(hid_t dataset, hid_t memory_type, void* content);
std::string read_text_dataset(hid_t parent, const std::string& name);
std::vector<std::string> read_texts_dataset(hid_t parent, const std::string& name);

}  // namespace mercury::hdf5
