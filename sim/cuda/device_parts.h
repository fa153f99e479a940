// SPDX-License-Identifier: Apache-2.0
// The parts of a size class's robots (parts.h) in device memory.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sim/cuda/chunks.h"
#include "sim/cuda/launch_configuration.h"
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
  // What a launch in parts has in common with that of whole robots.
  struct Wanted {
    const Configuration& configuration;
    bool same_materials, viscous;
    std::uint32_t table_chunks;
    std::size_t batch_size;  // robots of all classes
  };

  // Splits the robots of a class into as few parts as fit, since springs between parts are computed twice; into more if
  // the batch leaves multiprocessors idle. Uses all cores. Keeps the parts that there are, if they fit and the robots
  // are the same. Returns nothing if no number of parts fits, or if the device has no clusters.
  std::optional<LaunchConfiguration> choose(std::span<const Source> robots, bool same_robots, const ChunkSizes& sizes,
                                            const Wanted& wanted);
  // Brings what choose() made to the device, with the properties of masses of the whole robots.
  void upload(const BatchView& robots, cudaStream_t stream);

  // That of the robots, with the arrays of the parts in place of theirs.
  BatchView view(BatchView robots) const;

 private:
  void split(std::span<const Source> robots, std::uint32_t parts, const ChunkSizes& sizes);
  void upload_parts(cudaStream_t stream);
  void copy_points(const BatchView& robots, cudaStream_t stream);
  void find_backs(const BatchView& robots, cudaStream_t stream);

  std::vector<Source> sources_;
  std::vector<std::uint32_t> first_of_topology_;
  std::vector<std::vector<Part>> split_;  // [robot], of the first of each topology; empty after upload()
  std::uint32_t record_words_ = 1;
  std::uint32_t fields_ = 0;  // of the tiles by which partners and corners are addressed; 0 = nothing is uploaded

  PartsView view_;
  std::uint32_t tile_stride_ = 0, group_stride_ = 0, face_stride_ = 0;
  DeviceArray<PartHeader> headers_;
  DeviceArray<std::uint32_t> springs_, groups_, face_dithers_, face_backs_, export_start_, places_;
  DeviceArray<SlotRows> rows_;
  DeviceArray<FacePair> face_pairs_;
  DeviceArray<std::uint16_t> slots_;
  DeviceArray<Export> exports_;
  DeviceArray<PointProperties> points_;
};

}  // namespace mercury::cuda
