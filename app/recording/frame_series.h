// SPDX-License-Identifier: Apache-2.0
// One element of all robots, such as their positions, while a trajectory is written: frames in memory, and their
// datasets in the file.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "app/recording/hdf5_handle.h"

namespace mercury {

// Value = Vec3 or float. A robot without values has no dataset. Members with handles throw hdf5::Error.
template <class Value>
class FrameSeries {
 public:
  // `element` names the group of a robot's dataset; `unit` may be empty.
  FrameSeries(const char* element, const char* unit) : element_(element), unit_(unit) {}

  // A robot more, of that many values per frame.
  void add_robot(std::size_t values) { offsets_.push_back(width() + values); }
  std::size_t width() const { return offsets_.back(); }  // values per frame, of all robots
  std::size_t width(std::size_t robot) const { return offsets_[robot + 1] - offsets_[robot]; }
  std::size_t bytes() const { return width() * sizeof(Value); }  // of a frame
  std::size_t largest_bytes() const;                             // of a robot's frame

  // Memory for that many frames; those that fit into it stay.
  void hold(std::size_t frames);
  std::span<Value> frame(std::size_t index) { return std::span(values_).subspan(index * width(), width()); }

  // Makes a robot's dataset, empty, in its group. All share the time axis that `parameters` has, as H5MD allows.
  void create(std::size_t robot, hdf5::Id group, hdf5::Id parameters, std::size_t chunk, int deflate) const;
  // Appends the frames in memory, `count` of them, after the first `first` ones of the file.
  void write(std::size_t robot, hdf5::Id group, std::size_t first, std::size_t count) const;

 private:
  const char *element_, *unit_;
  std::vector<std::size_t> offsets_{0};  // of each robot's first value in a frame, then their number
  std::vector<Value> values_;
};

}  // namespace mercury
