// SPDX-License-Identifier: Apache-2.0
// Groups, attributes and datasets of a trajectory that is written. All functions throw Error.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include "app/recording/trajectory_hdf5.h"

namespace mercury::hdf5 {

Handle create_group(hid_t parent, const std::string& name);
// A group that lists its members in the order of their creation.
Handle create_ordered_group(hid_t parent, const std::string& name);

template <class Number>
void write_attribute(hid_t object, const std::string& name, Number value);
template <class Number>
void write_attribute(hid_t object, const std::string& name, std::span<const Number> values);
// Text of fixed length, UTF-8.
void write_text(hid_t object, const std::string& name, std::string_view text);
// A row of texts, all of one fixed length.
void write_texts(hid_t object, const std::string& name, std::initializer_list<std::string_view> texts);
// As H5MD's module `units` requires: "m s-1", of variable length, ASCII.
void write_unit(hid_t object, std::string_view unit, const std::string& name = "unit");

// A dataset that grows along its first axis.
struct Growing {
  Extent row;         // extent of one element
  hsize_t chunk = 1;  // elements per chunk
  int deflate = 0;    // 0 = not compressed, 1..9
};
// Creates it with no elements. Its chunks have checksums.
Handle create_growing(hid_t parent, const std::string& name, hid_t file_type, const Growing& growing);

// A dataset of that extent with its content: one chunk, with a checksum.
Handle write_dataset(hid_t parent, const std::string& name, hid_t file_type, hid_t memory_type, const Extent& extent,
                     const void* content);
// A dataset that has one value everywhere and takes no space in the file.
Handle write_constant(hid_t parent, const std::string& name, float value, const Extent& extent);
// A dataset that is one text, or a row of texts.
void write_text_dataset(hid_t parent, const std::string& name, std::string_view text);
void write_text_dataset(hid_t parent, const std::string& name, std::span<const std::string> texts);

// Extends a growing dataset to first + count elements, writes the last `count` and closes it, so that all bytes have
// reached the file or an Error is thrown. `memory` selects their
// numbers in `content`; H5S_ALL = all of them.
void append_rows(Handle dataset, hid_t memory_type, hsize_t first, hsize_t count, const void* content,
                 hid_t memory = H5S_ALL);

// An attribute that refers to a member of `parent`.
void write_reference(hid_t object, const std::string& name, hid_t parent, const std::string& target);

// Another name for an object of the same file.
void link(hid_t target_parent, const std::string& target, hid_t parent, const std::string& name);

}  // namespace mercury::hdf5
