// SPDX-License-Identifier: Apache-2.0
// The parts of a size class's robots (parts.h) in device memory.
#pragma once

#include <span>
#include <vector>

#include "sim/cuda/chunks.h"
#include "sim/cuda/layout.h"
#include "sim/cuda/memory.h"
#include "sim/cuda/parts.h"

namespace mercury::cuda {

class DeviceParts {
 public:
  // What each robot is split from. The spans belong to the caller.
  struct Source {
    const Robot* robot;
    const SlotOrder* order;
    std::span<const MaterialId> materials;  // as in RecordNames
  };
  // Splits all robots of a class into as many parts. Uses all cores.
  void split(std::span<const Source> robots, std::uint32_t parts, const ChunkSizes& sizes);
  // Uploads what split() made. Partners and corners are addressed in tiles of this many fields.
  void upload(std::uint32_t fields, cudaStream_t stream);
  // Copies the properties of masses from those of whole robots, if they have any.
  void copy_points(const BatchView& robots, cudaStream_t stream);

  std::uint32_t per_robot() const { return view_.per_robot; }
  std::uint32_t fields() const { return fields_; }  // of upload()
  // That of the robots, with the arrays of the parts in place of theirs.
  BatchView view(BatchView robots) const;

 private:
  std::vector<Source> sources_;
  std::vector<std::uint32_t> first_of_topology_;
  std::vector<std::vector<Part>> split_;  // [robot], of the first of each topology
  std::uint32_t record_words_ = 1, fields_ = 0;

  PartsView view_;
  std::uint32_t tile_stride_ = 0, row_stride_ = 0, face_stride_ = 0;
  DeviceArray<PartHeader> headers_;
  DeviceArray<std::uint32_t> springs_, row_start_, incoming_counts_, face_dithers_, export_start_, places_;
  DeviceArray<FacePair> face_pairs_;
  DeviceArray<std::uint16_t> slots_;
  DeviceArray<Export> exports_;
  DeviceArray<PointProperties> points_;
};

}  // namespace mercury::cuda
