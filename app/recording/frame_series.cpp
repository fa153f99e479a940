// SPDX-License-Identifier: Apache-2.0
#include "app/recording/frame_series.h"

#include <algorithm>
#include <type_traits>

#include "app/recording/trajectory_hdf5_writing.h"
#include "mercury/vec3.h"

namespace mercury {

using namespace hdf5;

namespace {

template <class Value>
Extent extent_of_row(hsize_t values) {
  return std::is_same_v<Value, Vec3> ? Extent{values, 3} : Extent{values};
}

Extent after(hsize_t first, Extent rest) {
  rest.insert(rest.begin(), first);
  return rest;
}

}  // namespace

template <class Value>
std::size_t FrameSeries<Value>::largest_bytes() const {
  std::size_t largest = 0;
  for (std::size_t robot = 0; robot + 1 < offsets_.size(); ++robot) largest = std::max(largest, width(robot));
  return largest * sizeof(Value);
}

template <class Value>
void FrameSeries<Value>::hold(std::size_t frames) {
  values_.resize(frames * width());
  values_.shrink_to_fit();
}

template <class Value>
void FrameSeries<Value>::create(std::size_t robot, hid_t group, hid_t parameters, std::size_t chunk,
                                int deflate) const {
  if (width(robot) == 0) return;
  const Handle series = has_member(group, element_) ? open_group(group, element_) : create_group(group, element_);
  const Handle dataset = create_growing(
      series, "value", H5T_IEEE_F32LE, {.row = extent_of_row<Value>(width(robot)), .chunk = chunk, .deflate = deflate});
  if (*unit_ != '\0') write_unit(dataset, unit_);
  link(parameters, "step", series, "step");
  link(parameters, "time", series, "time");
}

template <class Value>
void FrameSeries<Value>::write(std::size_t robot, hid_t group, std::size_t first, std::size_t count) const {
  if (width(robot) == 0) return;
  const Handle series = open_group(group, element_);
  const Extent all = after(count, extent_of_row<Value>(width())),
               own = after(count, extent_of_row<Value>(width(robot)));
  Extent start(all.size(), 0);
  start[1] = offsets_[robot];
  const Handle held(H5Screate_simple(static_cast<int>(all.size()), all.data(), nullptr));
  checked(H5Sselect_hyperslab(held, H5S_SELECT_SET, start.data(), nullptr, own.data(), nullptr));
  append_rows(open_dataset(series, "value"), H5T_NATIVE_FLOAT, first, count, values_.data(), held);
}

template class FrameSeries<Vec3>;
template class FrameSeries<float>;

}  // namespace mercury
