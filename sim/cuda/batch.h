// SPDX-License-Identifier: Apache-2.0
// A batch of robots in device memory (layout.h).
#pragma once

#include "mercury/backend.h"
#include "sim/cuda/chunks.h"
#include "sim/cuda/layout.h"
#include "sim/cuda/memory.h"
#include "sim/physics/measures.h"

namespace mercury::cuda {

class Batch {
 public:
  Batch() = default;
  // Robots at rest in their files' positions, with their own materials. Uses all cores.
  explicit Batch(std::span<const Robot* const> robots);

  std::uint32_t size() const { return static_cast<std::uint32_t>(robots_.size()); }
  std::uint32_t tiles() const { return sizes_.tiles; }                // of the largest robot
  bool same_materials() const { return same_materials_; }             // all robots have the same table
  std::span<const Material> materials() const { return materials_; }  // [robot][max_materials]
  BatchView view() const;

  // Updates the scales of the fixed-point sums.
  void configure(const Configuration& configuration);
  // Rewrites the partners of all spring records: offsets in working memory with this many fields per tile, or slots
  // (0).
  void address_partners(std::uint32_t fields);
  // `tables` = those of consecutive robots.
  void set_materials(std::size_t first_robot, std::span<const Material> tables, const Configuration& configuration);
  // Computes the phases for a clock whose base or dt changed.
  void update_phases(const Clock& clock);
  void set_perturbations(std::span<const Perturbation> perturbations);
  // Allocates memory for what does not fit on the chip; 0 = none.
  void reserve_workspace(std::size_t bytes_per_robot);

  void read(std::size_t robot, std::span<Vec3> positions, std::span<Vec3> velocities) const;
  void write(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities);
  DeviceStatus status(std::size_t robot) const;
  std::vector<DeviceStatus> statuses() const;
  void set_status(std::size_t robot, DeviceStatus status);
  // Writes three floats per mass, robot after robot, to device memory. `first_field` = field_x or field_v.
  void gather(float* device_out, Field first_field) const;

 private:
  void upload();
  void allocate();
  void write_chunks(std::size_t first_robot, const Chunks& chunks);
  SlotOrder order_of(std::size_t robot) const { return slot_order(headers_[robot]); }

  std::vector<const Robot*> robots_;
  std::vector<RobotMeasures> measures_;
  std::vector<RobotHeader> headers_;
  std::vector<Material> materials_;
  std::vector<std::uint64_t> first_mass_{0};
  ChunkSizes sizes_;
  std::uint32_t partner_fields_ = 0;  // as in address_partners()
  std::size_t workspace_stride_ = 0;
  bool same_materials_ = false;
  bool phases_stale_ = true;
  Clock phase_clock_;

  DeviceArray<RobotHeader> device_headers_;
  DeviceArray<DeviceStatus> statuses_;
  DeviceArray<float> state_, valences_;
  DeviceArray<std::uint32_t> springs_;
  DeviceArray<float> lengths_;
  DeviceArray<std::uint32_t> row_start_, incoming_counts_;
  DeviceArray<FacePair> face_pairs_;
  DeviceArray<Material> device_materials_;
  DeviceArray<MusclePhase> phases_;
  DeviceArray<DevicePerturbation> perturbations_;
  DeviceArray<std::uint64_t> device_first_mass_;
  DeviceArray<char> workspace_;
};

}  // namespace mercury::cuda
