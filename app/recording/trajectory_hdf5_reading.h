// SPDX-License-Identifier: Apache-2.0
// Attributes and datasets of a trajectory that is read. All functions throw Error, and for content that is not of the
// expected kind too.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "app/recording/trajectory_hdf5.h"

namespace mercury::hdf5 {

// The names of a group's members, in any order.
std::vector<std::string> members(hid_t group);

template <class Number>
Number read_attribute(hid_t object, const std::string& name);
template <class Number, std::size_t count>
std::array<Number, count> read_attributes(hid_t object, const std::string& name);
std::string read_text(hid_t object, const std::string& name);

// Opens a file for reading. One that another program is writing, or was writing when it was killed, opens if that
// program wrote in HDF5's mode for multiple readers; `unfinished` is then true.
Handle open_file(const std::filesystem::path& path, bool& unfinished);

// Throws Error unless the file is large enough to hold that many bytes of the dataset's content, compressed as far as
// deflate can. Call it before memory is allocated: a damaged file may announce any size.
void require_content(hid_t dataset, std::uint64_t bytes);
// Throws Error unless the first `file_size` bytes of the file have the chunk that holds this row. In an unfinished file
// that lost its end, the library would read zeros there.
void require_chunk(hid_t dataset, hsize_t row, std::uintmax_t file_size);
// Reads the whole content.
void read_dataset(hid_t dataset, hid_t memory_type, void* content);
// Reads a selection of a dataset in which a program was writing when it was killed. A chunk that it wrote a second
// time, with more rows, may have the checksum of neither: its first rows, which did not change, are read without the
// check.
void read_last_rows(hid_t dataset, hid_t memory_type, hid_t memory, hid_t selection, void* content);
// All elements of a dataset of any length whose elements have the extent `row`.
template <class Element>
std::vector<Element> read_rows(hid_t parent, const std::string& name, hid_t memory_type, const Extent& row) {
  const Handle dataset = open_dataset(parent, name);
  const Extent extent = extent_of(dataset);
  if (extent.size() != row.size() + 1 || !std::equal(row.begin(), row.end(), extent.begin() + 1))
    throw Error("\"" + name + "\" has another shape");
  if (extent[0] > std::numeric_limits<std::uint64_t>::max() / sizeof(Element))
    throw Error("\"" + name + "\" is too large");
  require_content(dataset, extent[0] * sizeof(Element));
  std::vector<Element> rows(extent[0]);
  if (!rows.empty()) read_dataset(dataset, memory_type, rows.data());
  return rows;
}
std::string read_text_dataset(hid_t parent, const std::string& name);
std::vector<std::string> read_texts_dataset(hid_t parent, const std::string& name);

}  // namespace mercury::hdf5
