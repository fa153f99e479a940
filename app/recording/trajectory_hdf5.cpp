// SPDX-License-Identifier: Apache-2.0
#include "app/recording/trajectory_hdf5.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace mercury::hdf5 {
namespace {

struct Story {
  std::string innermost;
  int number = 0;
};

// "..., errno = 28, error message = ..." is how the library tells of system calls.
int errno_in(const std::string& text) {
  const std::size_t at = text.find("errno = ");
  return at == std::string::npos ? 0 : std::atoi(text.c_str() + at + 8);
}

herr_t note(unsigned, const H5E_error2_t* error, void* data) {
  Story& story = *static_cast<Story*>(data);
  const std::string text = error->desc ? error->desc : "";
  if (story.innermost.empty()) story.innermost = text;
  if (story.number == 0) story.number = errno_in(text);
  return 0;
}

[[noreturn]] void fail() {
  Story story;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, note, &story);
  H5Eclear2(H5E_DEFAULT);
  throw Error("HDF5: " + (story.innermost.empty() ? "failed" : story.innermost), story.number);
}

// Names are UTF-8.
Handle link_properties() {
  Handle properties(H5Pcreate(H5P_LINK_CREATE));
  checked(H5Pset_char_encoding(properties, H5T_CSET_UTF8));
  return properties;
}

Handle text_type(std::size_t size) {
  Handle type(H5Tcopy(H5T_C_S1));
  checked(H5Tset_size(type, std::max<std::size_t>(1, size)));
  checked(H5Tset_strpad(type, H5T_STR_NULLPAD));
  checked(H5Tset_cset(type, H5T_CSET_UTF8));
  return type;
}

Handle unit_type() {
  Handle type(H5Tcopy(H5T_C_S1));
  checked(H5Tset_size(type, H5T_VARIABLE));
  return type;
}

Handle scalar_space() { return Handle(H5Screate(H5S_SCALAR)); }
Handle space_of(const Extent& extent) {
  return Handle(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr));
}

void write_attribute_of(hid_t object, const std::string& name, hid_t file_type, hid_t memory_type, hid_t space,
                        const void* content) {
  const Handle attribute(H5Acreate2(object, name.c_str(), file_type, space, H5P_DEFAULT, H5P_DEFAULT));
  checked(H5Awrite(attribute, memory_type, content));
}

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

// What pads a text of fixed length.
std::string without_padding(std::string text) {
  text.erase(text.find_last_not_of('\0') + 1);
  return text;
}

void require_text(hid_t type, const std::string& name) {
  if (H5Tget_class(type) != H5T_STRING) throw Error("\"" + name + "\" is not text");
}

// Memory for a text must have the file's character set, or the library refuses to convert.
Handle text_type_like(hid_t type, std::size_t size) {
  Handle memory = size == H5T_VARIABLE ? unit_type() : text_type(size);
  checked(H5Tset_cset(memory, H5Tget_cset(type)));
  return memory;
}

}  // namespace

void prepare() {
  static const bool done = [] {
    H5dont_atexit();
    return true;
  }();
  (void)done;
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

hid_t checked(hid_t result) {
  if (result < 0) fail();
  return result;
}

template <>
NumberType number_type<float>() {
  return {H5T_NATIVE_FLOAT, H5T_IEEE_F32LE};
}
template <>
NumberType number_type<double>() {
  return {H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE};
}
template <>
NumberType number_type<std::uint8_t>() {
  return {H5T_NATIVE_UINT8, H5T_STD_U8LE};
}
template <>
NumberType number_type<std::uint16_t>() {
  return {H5T_NATIVE_UINT16, H5T_STD_U16LE};
}
template <>
NumberType number_type<std::uint32_t>() {
  return {H5T_NATIVE_UINT32, H5T_STD_U32LE};
}
template <>
NumberType number_type<std::uint64_t>() {
  return {H5T_NATIVE_UINT64, H5T_STD_U64LE};
}
template <>
NumberType number_type<std::int32_t>() {
  return {H5T_NATIVE_INT32, H5T_STD_I32LE};
}
template <>
NumberType number_type<std::int64_t>() {
  return {H5T_NATIVE_INT64, H5T_STD_I64LE};
}

Handle material_type() {
  Handle type(H5Tcreate(H5T_COMPOUND, sizeof(Material)));
  const auto add = [&](const char* name, std::size_t offset) {
    checked(H5Tinsert(type, name, offset, H5T_IEEE_F32LE));
  };
  add("stiffness", offsetof(Material, stiffness));
  add("amplitude", offsetof(Material, amplitude));
  add("frequency", offsetof(Material, frequency));
  add("phase", offsetof(Material, phase));
  return type;
}

Handle create_group(hid_t parent, const std::string& name) {
  return Handle(H5Gcreate2(parent, name.c_str(), link_properties(), H5P_DEFAULT, H5P_DEFAULT));
}

Handle create_ordered_group(hid_t parent, const std::string& name) {
  const Handle properties(H5Pcreate(H5P_GROUP_CREATE));
  checked(H5Pset_link_creation_order(properties, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
  return Handle(H5Gcreate2(parent, name.c_str(), link_properties(), properties, H5P_DEFAULT));
}

template <class Number>
void write_attribute(hid_t object, const std::string& name, Number value) {
  const auto [memory, file] = number_type<Number>();
  write_attribute_of(object, name, file, memory, scalar_space(), &value);
}
template <class Number>
void write_attribute(hid_t object, const std::string& name, std::span<const Number> values) {
  const auto [memory, file] = number_type<Number>();
  write_attribute_of(object, name, file, memory, space_of({values.size()}), values.data());
}
template void write_attribute(hid_t, const std::string&, float);
template void write_attribute(hid_t, const std::string&, double);
template void write_attribute(hid_t, const std::string&, std::uint8_t);
template void write_attribute(hid_t, const std::string&, std::uint32_t);
template void write_attribute(hid_t, const std::string&, std::uint64_t);
template void write_attribute(hid_t, const std::string&, std::int32_t);
template void write_attribute(hid_t, const std::string&, std::int64_t);
template void write_attribute(hid_t, const std::string&, std::span<const float>);
template void write_attribute(hid_t, const std::string&, std::span<const std::int32_t>);

void write_text(hid_t object, const std::string& name, std::string_view text) {
  const Handle type = text_type(text.size());
  const std::string content(text);
  write_attribute_of(object, name, type, type, scalar_space(), content.c_str());
}

void write_texts(hid_t object, const std::string& name, std::initializer_list<std::string_view> texts) {
  std::size_t size = 1;
  for (const std::string_view text : texts) size = std::max(size, text.size());
  std::string content;
  for (const std::string_view text : texts) content += std::string(text) + std::string(size - text.size(), '\0');
  const Handle type = text_type(size);
  write_attribute_of(object, name, type, type, space_of({texts.size()}), content.data());
}

void write_unit(hid_t object, std::string_view unit, const std::string& name) {
  const Handle type = unit_type();
  const std::string content(unit);
  const char* text = content.c_str();
  write_attribute_of(object, name, type, type, scalar_space(), &text);
}

Handle create_growing(hid_t parent, const std::string& name, hid_t file_type, const Growing& growing) {
  Extent now{0}, most{H5S_UNLIMITED}, chunk{growing.chunk};
  for (Extent* extent : {&now, &most, &chunk}) extent->insert(extent->end(), growing.row.begin(), growing.row.end());
  const Handle space(H5Screate_simple(static_cast<int>(now.size()), now.data(), most.data()));
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE));
  checked(H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data()));
  if (growing.deflate > 0) {
    checked(H5Pset_shuffle(properties));
    checked(H5Pset_deflate(properties, static_cast<unsigned>(growing.deflate)));
  }
  checked(H5Pset_fletcher32(properties));
  return Handle(H5Dcreate2(parent, name.c_str(), file_type, space, link_properties(), properties, H5P_DEFAULT));
}

Handle write_dataset(hid_t parent, const std::string& name, hid_t file_type, hid_t memory_type, const Extent& extent,
                     const void* content) {
  const Handle space = space_of(extent);
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE));
  const bool empty = std::find(extent.begin(), extent.end(), hsize_t{0}) != extent.end();
  if (!empty) {
    checked(H5Pset_chunk(properties, static_cast<int>(extent.size()), extent.data()));
    checked(H5Pset_fletcher32(properties));
  }
  Handle dataset(H5Dcreate2(parent, name.c_str(), file_type, space, link_properties(), properties, H5P_DEFAULT));
  if (!empty) checked(H5Dwrite(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, content));
  return dataset;
}

Handle write_constant(hid_t parent, const std::string& name, float value, const Extent& extent) {
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE));
  checked(H5Pset_alloc_time(properties, H5D_ALLOC_TIME_LATE));
  checked(H5Pset_fill_value(properties, H5T_NATIVE_FLOAT, &value));
  return Handle(
      H5Dcreate2(parent, name.c_str(), H5T_IEEE_F32LE, space_of(extent), link_properties(), properties, H5P_DEFAULT));
}

void write_text_dataset(hid_t parent, const std::string& name, std::string_view text) {
  const Handle type = text_type(text.size());
  const std::string content(text);
  const Handle dataset(
      H5Dcreate2(parent, name.c_str(), type, scalar_space(), link_properties(), H5P_DEFAULT, H5P_DEFAULT));
  checked(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, content.c_str()));
}

void write_text_dataset(hid_t parent, const std::string& name, std::span<const std::string> texts) {
  std::size_t size = 1;
  for (const std::string& text : texts) size = std::max(size, text.size());
  std::string content(size * texts.size(), '\0');
  for (std::size_t i = 0; i < texts.size(); ++i)
    std::copy(texts[i].begin(), texts[i].end(), content.begin() + static_cast<std::ptrdiff_t>(i * size));
  const Handle type = text_type(size);
  write_dataset(parent, name, type, type, {texts.size()}, content.data());
}

void append_rows(hid_t dataset, hid_t memory_type, hsize_t first, hsize_t count, const void* content, hid_t memory) {
  Extent extent = extent_of(dataset);
  extent[0] = first + count;
  checked(H5Dset_extent(dataset, extent.data()));
  const Handle space(H5Dget_space(dataset));
  Extent start(extent.size(), 0);
  start[0] = first;
  extent[0] = count;
  checked(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr));
  const Handle all = memory == H5S_ALL ? space_of(extent) : Handle();
  checked(H5Dwrite(dataset, memory_type, memory == H5S_ALL ? hid_t{all} : memory, space, H5P_DEFAULT, content));
}

void write_reference(hid_t object, const std::string& name, hid_t parent, const std::string& target) {
  hobj_ref_t reference{};
  checked(H5Rcreate(&reference, parent, target.c_str(), H5R_OBJECT, -1));
  write_attribute_of(object, name, H5T_STD_REF_OBJ, H5T_STD_REF_OBJ, scalar_space(), &reference);
}

void link(hid_t target_parent, const std::string& target, hid_t parent, const std::string& name) {
  checked(H5Lcreate_hard(target_parent, target.c_str(), parent, name.c_str(), link_properties(), H5P_DEFAULT));
}

Handle open_group(hid_t parent, const std::string& name) {
  if (!has_member(parent, name)) throw Error("the group \"" + name + "\" is missing");
  return Handle(H5Gopen2(parent, name.c_str(), H5P_DEFAULT));
}

Handle open_dataset(hid_t parent, const std::string& name) {
  if (!has_member(parent, name)) throw Error("the dataset \"" + name + "\" is missing");
  return Handle(H5Dopen2(parent, name.c_str(), H5P_DEFAULT));
}

bool has_member(hid_t group, const std::string& name) {
  return checked(H5Lexists(group, name.c_str(), H5P_DEFAULT)) > 0;
}

bool has_attribute(hid_t object, const std::string& name) { return checked(H5Aexists(object, name.c_str())) > 0; }

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

Extent extent_of(hid_t dataset) {
  const Handle space(H5Dget_space(dataset));
  if (H5Sget_simple_extent_type(space) == H5S_NULL) throw Error("a dataset is empty");
  const auto rank = static_cast<std::size_t>(checked(H5Sget_simple_extent_ndims(space)));
  Extent extent(rank);
  if (rank > 0) checked(H5Sget_simple_extent_dims(space, extent.data(), nullptr));
  return extent;
}

void require_content(hid_t dataset, std::uint64_t bytes) {
  constexpr std::uint64_t deflate_limit = 1032;  // the most that deflate can compress
  constexpr std::uint64_t always = 4096;         // bytes nobody minds
  const std::uint64_t stored = H5Dget_storage_size(dataset);
  hsize_t file_size = 0;
  const Handle file(H5Iget_file_id(dataset));
  checked(H5Fget_filesize(file, &file_size));
  if (bytes > always && bytes / deflate_limit > std::min<std::uint64_t>(stored, file_size))
    throw Error("a dataset announces more than the file holds");
}

void read_dataset(hid_t dataset, hid_t memory_type, void* content) {
  checked(H5Dread(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, content));
}

namespace {

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

}  // namespace

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
