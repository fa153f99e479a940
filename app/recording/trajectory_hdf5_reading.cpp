// SPDX-License-Identifier: Apache-2.0
#include "app/recording/trajectory_hdf5_reading.h"

#include <fstream>

namespace mercury::hdf5 {
namespace {

Handle open_attribute(hid_t object, const std::string& name, hsize_t count) {
  if (!has_attribute(object, name)) throw Error("the attribute \"" + name + "\" is missing");
  Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT));
  const Handle space(H5Aget_space(attribute));
  if (checked(H5Sget_simple_extent_npoints(space)) != static_cast<hid_t>(count))
    throw Error("the attribute \"" + name + "\" has another extent");
  return attribute;
}

void read_numbers(hid_t object, const std::string& name, hid_t memory_type, hsize_t count, void* values) {
  const Handle attribute = open_attribute(object, name, count);
  checked(H5Aread(attribute, memory_type, values));
}

// The text without the zeros that pad it to a fixed length.
std::string without_padding(std::string text) {
  text.erase(text.find_last_not_of('\0') + 1);
  return text;
}

void require_text(hid_t type, const std::string& name) {
  if (H5Tget_class(type) != H5T_STRING) throw Error("\"" + name + "\" is not text");
}

// The type in memory must have the character set of the file, or the library refuses to convert.
Handle text_type_like(hid_t type, std::size_t size) {
  Handle memory = size == H5T_VARIABLE ? variable_text_type() : text_type(size);
  checked(H5Tset_cset(memory, H5Tget_cset(type)));
  return memory;
}

// All bytes of a dataset of texts of fixed length, and that length.
std::pair<std::string, std::size_t> read_text_bytes(hid_t dataset, const std::string& name, std::uint64_t count) {
  const Handle type(H5Dget_type(dataset));
  require_text(type, name);
  if (checked(H5Tis_variable_str(type)) > 0) throw Error("\"" + name + "\" is text of variable length, not of fixed");
  const std::size_t size = H5Tget_size(type);
  if (count > 1'000'000 || size > 1'000'000'000) throw Error("\"" + name + "\" is too large");
  require_content(dataset, count * size);
  std::string bytes(count * size, '\0');
  if (!bytes.empty()) read_dataset(dataset, text_type_like(type, size), bytes.data());
  return {std::move(bytes), size};
}

// Whether the file says that a program is writing it: the mark stays when that program is killed.
bool is_marked_as_written(const std::filesystem::path& path) {
  constexpr std::size_t version = 8, flags = 11;  // bytes of the superblock, from version 3 on
  std::array<char, 12> start{};
  return std::ifstream(path, std::ios::binary).read(start.data(), start.size()) && start[version] >= 3 &&
         (start[flags] & 1) != 0;
}

}  // namespace

std::vector<std::string> members(hid_t group) {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* data) -> herr_t {
    static_cast<std::vector<std::string>*>(data)->emplace_back(name);
    return 0;
  };
  checked(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names));
  return names;
}

template <class Number>
Number read_attribute(hid_t object, const std::string& name) {
  Number value{};
  read_numbers(object, name, number_type<Number>().memory, 1, &value);
  return value;
}
template float read_attribute<float>(hid_t, const std::string&);
template double read_attribute<double>(hid_t, const std::string&);
template std::uint8_t read_attribute<std::uint8_t>(hid_t, const std::string&);
template std::uint32_t read_attribute<std::uint32_t>(hid_t, const std::string&);
template std::uint64_t read_attribute<std::uint64_t>(hid_t, const std::string&);
template std::int32_t read_attribute<std::int32_t>(hid_t, const std::string&);
template std::int64_t read_attribute<std::int64_t>(hid_t, const std::string&);

template <class Number, std::size_t count>
std::array<Number, count> read_attributes(hid_t object, const std::string& name) {
  std::array<Number, count> values{};
  read_numbers(object, name, number_type<Number>().memory, count, values.data());
  return values;
}
template std::array<float, 3> read_attributes<float, 3>(hid_t, const std::string&);
template std::array<std::int32_t, 2> read_attributes<std::int32_t, 2>(hid_t, const std::string&);

std::string read_text(hid_t object, const std::string& name) {
  const Handle attribute = open_attribute(object, name, 1);
  const Handle type(H5Aget_type(attribute));
  require_text(type, name);
  if (checked(H5Tis_variable_str(type)) > 0) {  // as h5py writes them
    char* text = nullptr;
    checked(H5Aread(attribute, text_type_like(type, H5T_VARIABLE), &text));
    const std::string copy = text ? text : "";
    H5free_memory(text);
    return copy;
  }
  std::string text(H5Tget_size(type), '\0');
  checked(H5Aread(attribute, text_type_like(type, text.size()), text.data()));
  return without_padding(std::move(text));
}

Handle open_file(const std::filesystem::path& path, bool& unfinished) {
  prepare();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS));
  checked(H5Pset_file_locking(access, true, true));
  unfinished = false;
  try {
    return Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access));
  } catch (const Error& error) {
    if (error.number() == 0 && H5Fis_hdf5(path.c_str()) <= 0) throw Error("is not an HDF5 file");
    if (!is_marked_as_written(path)) throw;
  }
  unfinished = true;
  // A piece of metadata may be half written. The library reads it again, after 1, 2, 4, ... ns.
  checked(H5Pset_metadata_read_attempts(access, 20));
  try {
    return Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access));
  } catch (const Error&) {
    throw Error(
        "was not finished and cannot be read: its program is still writing the beginning, or ended while it did");
  }
}

void require_content(hid_t dataset, std::uint64_t bytes) {
  constexpr std::uint64_t deflate_limit = 1032;    // no dataset shrinks further
  constexpr std::uint64_t always_accepted = 4096;  // [bytes]
  const std::uint64_t stored = H5Dget_storage_size(dataset);
  hsize_t file_size = 0;
  const Handle file(H5Iget_file_id(dataset));
  checked(H5Fget_filesize(file, &file_size));
  if (bytes > always_accepted && bytes / deflate_limit > std::min<std::uint64_t>(stored, file_size))
    throw Error("a dataset announces more than the file holds");
}

void require_chunk(hid_t dataset, hsize_t row, std::uintmax_t file_size) {
  Extent start(extent_of(dataset).size(), 0);
  start.at(0) = row;
  unsigned mask = 0;
  haddr_t address = HADDR_UNDEF;
  hsize_t size = 0;
  checked(H5Dget_chunk_info_by_coord(dataset, start.data(), &mask, &address, &size));
  if (address == HADDR_UNDEF || address > file_size || size > file_size - address)
    throw Error("was not finished, and the end of what was written is missing");
}

void read_last_rows(hid_t dataset, hid_t memory_type, hid_t memory, hid_t selection, void* content) {
  try {
    checked(H5Dread(dataset, memory_type, memory, selection, H5P_DEFAULT, content));
  } catch (const Error&) {
    const Handle properties(H5Pcreate(H5P_DATASET_XFER));
    checked(H5Pset_edc_check(properties, H5Z_DISABLE_EDC));
    checked(H5Dread(dataset, memory_type, memory, selection, properties, content));
  }
}

void read_dataset(hid_t dataset, hid_t memory_type, void* content) {
  checked(H5Dread(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, content));
}

std::string read_text_dataset(hid_t parent, const std::string& name) {
  const Handle dataset = open_dataset(parent, name);
  if (!extent_of(dataset).empty()) throw Error("\"" + name + "\" is not one text");
  return without_padding(read_text_bytes(dataset, name, 1).first);
}

std::vector<std::string> read_texts_dataset(hid_t parent, const std::string& name) {
  const Handle dataset = open_dataset(parent, name);
  const Extent extent = extent_of(dataset);
  if (extent.size() != 1) throw Error("\"" + name + "\" is not a row of texts");
  const auto [bytes, size] = read_text_bytes(dataset, name, extent[0]);
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < bytes.size(); at += size) texts.push_back(without_padding(bytes.substr(at, size)));
  return texts;
}

}  // namespace mercury::hdf5
