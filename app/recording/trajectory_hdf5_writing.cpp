// SPDX-License-Identifier: Apache-2.0
#include "app/recording/trajectory_hdf5_writing.h"

#include <algorithm>

namespace mercury::hdf5 {
namespace {

// Names are UTF-8.
Handle link_properties() {
  Handle properties(H5Pcreate(H5P_LINK_CREATE));
  checked(H5Pset_char_encoding(properties, H5T_CSET_UTF8));
  return properties;
}

Handle scalar_space() { return Handle(H5Screate(H5S_SCALAR)); }

void write_attribute_of(hid_t object, const std::string& name, hid_t file_type, hid_t memory_type, hid_t space,
                        const void* content) {
  const Handle attribute(H5Acreate2(object, name.c_str(), file_type, space, H5P_DEFAULT, H5P_DEFAULT));
  checked(H5Awrite(attribute, memory_type, content));
}

}  // namespace

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
  const Handle type = variable_text_type();
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
  // Without a cache, writing fails when the disk is full, rather than closing, which nobody checks.
  const Handle access(H5Pcreate(H5P_DATASET_ACCESS));
  checked(H5Pset_chunk_cache(access, 0, 0, H5D_CHUNK_CACHE_W0_DEFAULT));
  Handle dataset(H5Dcreate2(parent, name.c_str(), file_type, space, link_properties(), properties, access));
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

void append_rows(Handle dataset, hid_t memory_type, hsize_t first, hsize_t count, const void* content, hid_t memory) {
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
  dataset.close();
}

void write_reference(hid_t object, const std::string& name, hid_t parent, const std::string& target) {
  hobj_ref_t reference{};
  checked(H5Rcreate(&reference, parent, target.c_str(), H5R_OBJECT, -1));
  write_attribute_of(object, name, H5T_STD_REF_OBJ, H5T_STD_REF_OBJ, scalar_space(), &reference);
}

void link(hid_t target_parent, const std::string& target, hid_t parent, const std::string& name) {
  checked(H5Lcreate_hard(target_parent, target.c_str(), parent, name.c_str(), link_properties(), H5P_DEFAULT));
}

}  // namespace mercury::hdf5
