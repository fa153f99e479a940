// SPDX-License-Identifier: Apache-2.0
// A batch in device memory, built from robots.
#pragma once

#include "mercury/backend.h"
#include "sim/cuda/layout.h"
#include "sim/cuda/memory.h"
#include "sim/physics/measures.h"

namespace mercury::cuda {

class Batch {
 public:
  Batch() = default;
  // Chunks sized by the largest robot; state and materials as the robots have them. Uses all cores.
  explicit Batch(std::span<const Robot* const> robots);

  std::uint32_t size() const { return static_cast<std::uint32_t>(robots_.size()); }
  std::uint32_t groups() const { return group_stride_; }  // of the largest robot
  std::span<const Robot* const> robots() const { return robots_; }

  // Follows a change of configuration: scales, and where a record's partner lies in the working memory.
  void configure(const Configuration& configuration);
  // Sets where records find their partners: as slot (rows 0), or as offset among groups of so many rows.
  void place_records(std::uint32_t rows);
  std::uint32_t rows_placed() const { return rows_placed_; }
  void set_materials(std::size_t first_robot, std::span<const Material> tables, const Configuration& configuration);
  // Brings the phases up to a clock whose base or dt is new.
  void update_phases(const Clock& clock);
  void set_perturbations(std::span<const Perturbation> perturbations);
  // Room for working memory off the chip; 0 = none.
  void reserve_workspace(std::size_t bytes_a_robot);

  std::uint32_t record_words() const { return record_words_; }
  bool same_materials() const { return same_materials_; }  // all robots have the same table
  BatchView view() const;

  void read(std::size_t robot, std::span<Vec3> positions, std::span<Vec3> velocities) const;
  void write(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities);
  DeviceStatus status(std::size_t robot) const;
  std::vector<DeviceStatus> statuses() const;
  void set_status(std::size_t robot, DeviceStatus status);
  // Three floats a mass, robot after robot, into device memory; `first_row` 0 = positions, 3 = velocities.
  void gather(float* device_out, std::uint32_t first_row) const;
  std::size_t mass_count() const { return first_mass_.back(); }

 private:
  void upload(std::span<const RobotMeasures> measures);
  void update_scales(const Configuration& configuration);
  SlotOrder order_of(std::size_t robot) const { return slot_order(records_[robot]); }

  std::vector<const Robot*> robots_;
  std::vector<RobotMeasures> measures_;
  std::vector<RobotRecord> records_;
  std::vector<Material> materials_;
  std::vector<std::uint64_t> first_mass_{0};
  std::uint32_t group_stride_ = 0, row_stride_ = 0, face_stride_ = 0, rows_placed_ = 0, record_words_ = 1;
  std::size_t workspace_stride_ = 0;
  bool same_materials_ = false;
  bool phases_stale_ = true;
  Clock phase_clock_;

  DeviceArray<RobotRecord> device_records_;
  DeviceArray<DeviceStatus> device_statuses_;
  DeviceArray<float> state_, splits_;
  DeviceArray<std::uint32_t> springs_;
  DeviceArray<float> lengths_;
  DeviceArray<std::uint32_t> row_start_, arrivals_;
  DeviceArray<FacePair> face_pairs_;
  DeviceArray<Material> device_materials_;
  DeviceArray<MusclePhase> phases_;
  DeviceArray<DevicePerturbation> perturbations_;
  DeviceArray<std::uint64_t> device_first_mass_;
  DeviceArray<char> workspace_;
};

}  // namespace mercury::cuda
