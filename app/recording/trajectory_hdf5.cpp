// SPDX-License-Identifier: Apache-2.0
#include "app/recording/trajectory_hdf5.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <type_traits>

namespace mercury::hdf5 {
namespace {

// What the library noted about a failure.
struct Failure {
  std::string innermost;
  int system_error = 0;  // errno
};

// The library reports system calls as "..., errno = 28, error message = ...".
int errno_in(const std::string& text) {
  const std::size_t at = text.find("errno = ");
  return at == std::string::npos ? 0 : std::atoi(text.c_str() + at + 8);
}

herr_t note(unsigned, const H5E_error2_t* error, void* data) {
  Failure& failure = *static_cast<Failure*>(data);
  const std::string text = error->desc ? error->desc : "";
  if (failure.innermost.empty()) failure.innermost = text;
  if (failure.system_error == 0) failure.system_error = errno_in(text);
  return 0;
}

[[noreturn]] void fail() {
  Failure failure;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, note, &failure);
  H5Eclear2(H5E_DEFAULT);
  throw Error("HDF5: " + (failure.innermost.empty() ? "failed" : failure.innermost), failure.system_error);
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

static_assert(std::is_same_v<Id, hid_t>);

Handle::Handle(Id id) : id_(checked(id)) {}

Handle::~Handle() {
  if (id_ >= 0) H5Idec_ref(id_);
}

void Handle::close() { checked(H5Idec_ref(std::exchange(id_, none))); }

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

static_assert(sizeof(bool) == 1);

Handle material_memory_type(MaterialFields fields) {
  Handle type(H5Tcreate(H5T_COMPOUND, sizeof(Material)));
  const auto add = [&](const char* name, std::size_t offset) {
    checked(H5Tinsert(type, name, offset, H5T_IEEE_F32LE));
  };
  add("stiffness", offsetof(Material, stiffness));
  add("amplitude", offsetof(Material, amplitude));
  add("frequency", offsetof(Material, frequency));
  add("phase", offsetof(Material, phase));
  if (fields.half_wave) {
    const Handle boolean(H5Tenum_create(H5T_STD_I8LE));
    for (const std::int8_t value : {std::int8_t{0}, std::int8_t{1}})
      checked(H5Tenum_insert(boolean, value == 0 ? "FALSE" : "TRUE", &value));
    checked(H5Tinsert(type, "half_wave", offsetof(Material, half_wave), boolean));
  }
  if (fields.relaxation_time) add("relaxation_time", offsetof(Material, relaxation_time));
  return type;
}

Handle material_type(MaterialFields fields) {
  Handle type = material_memory_type(fields);
  checked(H5Tpack(type));
  return type;
}

Handle text_type(std::size_t size) {
  Handle type(H5Tcopy(H5T_C_S1));
  checked(H5Tset_size(type, std::max<std::size_t>(1, size)));
  checked(H5Tset_strpad(type, H5T_STR_NULLPAD));
  checked(H5Tset_cset(type, H5T_CSET_UTF8));
  return type;
}

Handle variable_text_type() {
  Handle type(H5Tcopy(H5T_C_S1));
  checked(H5Tset_size(type, H5T_VARIABLE));
  return type;
}

Handle space_of(const Extent& extent) {
  return Handle(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr));
}

Extent extent_of(hid_t dataset) {
  const Handle space(H5Dget_space(dataset));
  if (H5Sget_simple_extent_type(space) == H5S_NULL) throw Error("a dataset is empty");
  const auto rank = static_cast<std::size_t>(checked(H5Sget_simple_extent_ndims(space)));
  Extent extent(rank);
  if (rank > 0) checked(H5Sget_simple_extent_dims(space, extent.data(), nullptr));
  return extent;
}

namespace {

// Links may lead to other files, and opening those may wait for ever.
void require_own_member(hid_t parent, const std::string& name, const char* kind) {
  if (!has_member(parent, name)) throw Error("the " + std::string(kind) + " \"" + name + "\" is missing");
  H5L_info_t link;
  checked(H5Lget_info(parent, name.c_str(), &link, H5P_DEFAULT));
  if (link.type != H5L_TYPE_HARD)
    throw Error("the " + std::string(kind) + " \"" + name +
                "\" is a link, which is not followed; put it into this file");
}

}  // namespace

Handle open_group(hid_t parent, const std::string& name) {
  require_own_member(parent, name, "group");
  return Handle(H5Gopen2(parent, name.c_str(), H5P_DEFAULT));
}

Handle open_dataset(hid_t parent, const std::string& name) {
  require_own_member(parent, name, "dataset");
  Handle dataset(H5Dopen2(parent, name.c_str(), H5P_DEFAULT));
  const Handle creation(H5Dget_create_plist(dataset));
  const bool is_elsewhere = H5Pget_layout(creation) == H5D_VIRTUAL ||
                            (H5Pget_layout(creation) == H5D_CONTIGUOUS && checked(H5Pget_external_count(creation)) > 0);
  if (is_elsewhere) throw Error("the dataset \"" + name + "\" has its values in other files; put them into this one");
  return dataset;
}

bool has_member(hid_t group, const std::string& name) {
  return checked(H5Lexists(group, name.c_str(), H5P_DEFAULT)) > 0;
}

bool has_attribute(hid_t object, const std::string& name) { return checked(H5Aexists(object, name.c_str())) > 0; }

}  // namespace mercury::hdf5
