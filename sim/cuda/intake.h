// SPDX-License-Identifier: Apache-2.0
// New robots on their way to the device.
//
//   inspect    all new robots   rest lengths, measures, which of them share a topology       all cores
//   assign     all new robots   a size class and a place each, most springs first            one core
//   upload     a portion        arrange topologies that are not yet, fill and copy chunks    all cores
//              a portion        ...
//
// A portion is so small that its chunks fit into a pinned buffer, and the arrangements of its robots are dropped with
// it, unless robots to come share them. So a batch takes little more memory on the host than its robots do.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "mercury/backend.h"
#include "sim/cuda/arranged_robots.h"
#include "sim/cuda/size_class.h"

namespace mercury::cuda {

// Where a robot is.
struct Place {
  std::uint32_t size_class, number;
};

// The size classes of a batch.
class SizeClasses {
 public:
  std::size_t size() const { return classes_.size(); }
  SizeClass& operator[](std::size_t i) const { return *classes_[i]; }
  auto begin() const { return classes_.begin(); }
  auto end() const { return classes_.end(); }

  // The class for robots of this size, made if it is missing.
  std::uint32_t class_for(std::uint32_t tiles, std::uint32_t record_words);
  // Frees the memory of classes without robots.
  void free_empty();

 private:
  std::vector<std::unique_ptr<SizeClass>> classes_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> index_;
};

// Brings robots into places of `classes`, at rest in the positions of their files, with their own materials. Takes what
// `arranged` has of them, which may be null. Returns the place of each, and adds to `times`. Throws DeviceError if the
// device has no room for them; the classes then are as before. So they are after an exception of the watch.
std::vector<Place> add_robots(SizeClasses& classes, std::span<const Robot* const> robots,
                              const Configuration& configuration, ArrangedRobots* arranged, LoadTimes& times,
                              const WorkWatch& watch);

}  // namespace mercury::cuda
