// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/batch.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <ranges>

#include "sim/cuda/arrangement.h"
#include "sim/cuda/step.h"

namespace mercury::cuda {
namespace {

constexpr unsigned threads = 256;

// Turns the partner of every record from one unit into another: slot (rows 0) or word offset among groups of so
// many rows.
__global__ void place_partners(std::uint32_t* records, std::size_t count, std::uint32_t record_words,
                               std::uint32_t old_rows, std::uint32_t new_rows) {
  for (std::size_t i = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x; i < count;
       i += std::size_t{gridDim.x} * blockDim.x) {
    std::uint32_t& key = records[i * record_words];
    const std::uint32_t place = key >> 16;
    const std::uint32_t slot = slot_at(place, old_rows);
    const std::uint32_t moved = new_rows == 0 ? slot : slot / lanes * new_rows * lanes + slot % lanes;
    key = moved << 16 | (key & 0xffff);
  }
}

__global__ void compute_phases(const Material* materials, MusclePhase* phases, std::size_t count, Clock clock) {
  const std::size_t i = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x;
  if (i < count) phases[i] = muscle_phase(materials[i], clock);
}

__global__ void gather_rows(const float* state, const RobotRecord* records, const std::uint64_t* first_mass,
                            std::uint32_t group_stride, std::uint32_t first_row, float* out) {
  const std::uint32_t robot = blockIdx.x;
  const SlotOrder order = slot_order(records[robot]);
  const std::uint64_t first = first_mass[robot], masses = first_mass[robot + 1] - first;
  const float* groups = state + std::size_t{robot} * group_stride * state_rows * lanes + first_row * lanes;
  for (std::uint64_t k = threadIdx.x; k < 3 * masses; k += blockDim.x) {
    const auto axis = static_cast<std::uint32_t>(k % 3), slot = order.slot_of(static_cast<std::uint32_t>(k / 3));
    out[3 * first + k] = groups[(slot / lanes * state_rows + axis) * lanes + slot % lanes];
  }
}

unsigned blocks_for(std::size_t count) {
  return static_cast<unsigned>(std::min<std::size_t>((count + threads - 1) / threads, 65536));
}

// A mass's vector in groups of state_rows.
Vec3 vector_at(std::span<const float> groups, std::uint32_t slot, std::uint32_t row) {
  const float* at = groups.data() + (slot / lanes * state_rows + row) * lanes + slot % lanes;
  return {at[0], at[lanes], at[2 * lanes]};
}
void put_vector(std::span<float> groups, std::uint32_t slot, std::uint32_t row, Vec3 value) {
  float* at = groups.data() + (slot / lanes * state_rows + row) * lanes + slot % lanes;
  at[0] = value.x;
  at[lanes] = value.y;
  at[2 * lanes] = value.z;
}

}  // namespace

Batch::Batch(std::span<const Robot* const> robots) : robots_(robots.begin(), robots.end()) {
  measures_.resize(size());
  oneapi::tbb::parallel_for(std::size_t{0}, robots_.size(),
                            [&](std::size_t i) { measures_[i] = measure(*robots_[i]); });
  for (const Robot* robot : robots_) {
    first_mass_.push_back(first_mass_.back() + robot->masses.size());
    group_stride_ = std::max(group_stride_, groups_of(*robot));
  }
  if (size() > 0) upload(measures_);
}

// Robots are prepared on all cores and uploaded a portion at a time, so that the host never holds all of the device's
// layout.
void Batch::upload(std::span<const RobotMeasures> measures) {
  const std::size_t count = robots_.size();
  constexpr std::size_t portion = 512;
  // The strides are known only once every build was arranged. A few builds are kept, many arranged twice.
  constexpr std::ptrdiff_t most_kept = 2048;
  const std::vector<std::uint32_t> first_alike = first_of_build(robots_);
  const auto is_first = [&](std::size_t i) { return first_alike[i] == i; };
  const bool keep = std::ranges::count_if(std::views::iota(std::size_t{0}, count), is_first) <= most_kept;
  std::vector<Arrangement> kept(keep ? count : 0);
  std::vector<std::uint32_t> rows(count), pairs(count);
  std::vector<std::vector<float>> lengths(count);
  oneapi::tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    lengths[i] = lengths_of(*robots_[i]);
    if (!is_first(i)) return;
    Arrangement arrangement = arrange(*robots_[i]);
    rows[i] = arrangement.schedule.rows();
    pairs[i] = static_cast<std::uint32_t>(arrangement.faces.size());
    if (keep) kept[i] = std::move(arrangement);
  });
  record_words_ = std::ranges::all_of(lengths, [](const auto& some) { return some.size() <= max_lengths; }) ? 1 : 2;
  row_stride_ = std::ranges::max(rows);
  face_stride_ = std::ranges::max(pairs);

  device_records_ = DeviceArray<RobotRecord>(count);
  device_statuses_ = DeviceArray<DeviceStatus>(count);
  state_ = DeviceArray<float>(count * group_stride_ * state_rows * lanes);
  splits_ = DeviceArray<float>(count * group_stride_ * lanes);
  const std::size_t robot_words = std::size_t{row_stride_} * lanes * record_words_;
  springs_ = DeviceArray<std::uint32_t>(count * robot_words + rows_at_once * lanes * record_words_);
  springs_.clear();
  if (record_words_ == 1) lengths_ = DeviceArray<float>(count * max_lengths);
  arrivals_ = DeviceArray<std::uint32_t>(count * group_stride_ * lanes);
  row_start_ = DeviceArray<std::uint32_t>(count * (group_stride_ + 1));
  face_pairs_ = DeviceArray<FacePair>(count * face_stride_);
  device_materials_ = DeviceArray<Material>(count * max_materials);
  phases_ = DeviceArray<MusclePhase>(count * max_materials);
  device_first_mass_ = DeviceArray<std::uint64_t>(first_mass_.size());
  device_first_mass_.write(0, first_mass_);
  const std::vector<DeviceStatus> fresh(count, DeviceStatus{-1, no_mass});
  device_statuses_.write(0, fresh);

  records_.resize(count);
  materials_.assign(count * max_materials, {});
  for (std::size_t first = 0; first < count; first += portion) {
    const std::size_t n = std::min(portion, count - first);
    std::vector<float> state(n * group_stride_ * state_rows * lanes), splits(n * group_stride_ * lanes);
    std::vector<std::uint32_t> springs(n * robot_words);
    std::vector<float> length_table(record_words_ == 1 ? n * max_lengths : 0);
    std::vector<std::uint32_t> row_start(n * (group_stride_ + 1)), arrivals(n * group_stride_ * lanes);
    std::vector<FacePair> face_pairs(n * face_stride_);
    oneapi::tbb::parallel_for(std::size_t{0}, n, [&](std::size_t k) {
      const std::size_t i = first + k;
      const Robot& robot = *robots_[i];
      const Arrangement anew = keep ? Arrangement{} : arrange(robot);
      const auto& [order, schedule, faces] = keep ? kept[first_alike[i]] : anew;
      records_[i] = {static_cast<std::uint32_t>(robot.masses.size()),
                     schedule.groups(),
                     static_cast<std::uint32_t>(faces.size()),
                     static_cast<std::uint32_t>(robot.springs.size()),
                     order.turn,
                     1,
                     1,
                     measures[i].squared_stretch_limit(),
                     measures[i].contact_distance()};
      const std::size_t state_size = std::size_t{group_stride_} * state_rows * lanes;
      const auto groups = std::span(state).subspan(k * state_size, state_size);
      const std::vector<std::uint32_t> at = valences(robot);
      for (std::uint32_t m = 0; m < robot.masses.size(); ++m) {
        const std::uint32_t slot = order.slot_of(m);
        put_vector(groups, slot, 0, robot.masses[m]);
        splits[k * group_stride_ * lanes + slot] = static_cast<float>(at[m]);
      }
      std::uint32_t* to = springs.data() + k * robot_words;
      for (const ScheduledSpring& place : schedule.places) {
        // An empty place is of air, so that it adds nothing.
        const Spring spring = place.spring == no_spring ? Spring{} : robot.springs[place.spring];
        const std::uint32_t key = static_cast<std::uint32_t>(place.partner) << 16 | spring.material;
        if (record_words_ == 1) {
          const auto number = std::ranges::lower_bound(lengths[i], spring.rest_length) - lengths[i].begin();
          *to++ = key | static_cast<std::uint32_t>(number) << 8;
        } else {
          *to++ = key;
          *to++ = std::bit_cast<std::uint32_t>(spring.rest_length);
        }
        ++arrivals[k * group_stride_ * lanes + place.partner];
      }
      if (record_words_ == 1)
        std::ranges::copy(lengths[i], length_table.begin() + static_cast<std::ptrdiff_t>(k * max_lengths));
      std::ranges::copy(schedule.row_start, row_start.begin() + static_cast<std::ptrdiff_t>(k * (group_stride_ + 1)));
      std::ranges::copy(faces, face_pairs.begin() + static_cast<std::ptrdiff_t>(k * face_stride_));
      std::ranges::copy(materials_of(robot), materials_.begin() + static_cast<std::ptrdiff_t>(i * max_materials));
    });
    state_.write(first * group_stride_ * state_rows * lanes, state);
    splits_.write(first * group_stride_ * lanes, splits);
    springs_.write(first * robot_words, springs);
    lengths_.write(first * max_lengths, length_table);
    row_start_.write(first * (group_stride_ + 1), row_start);
    arrivals_.write(first * group_stride_ * lanes, arrivals);
    face_pairs_.write(first * face_stride_, face_pairs);
  }
  device_materials_.write(0, materials_);
}

void Batch::configure(const Configuration& configuration) {
  if (size() == 0) return;
  update_scales(configuration);
}

void Batch::update_scales(const Configuration& configuration) {
  oneapi::tbb::parallel_for(std::size_t{0}, robots_.size(), [&](std::size_t i) {
    const FixedPointScale scale =
        fixed_point_scale(measures_[i], std::span(materials_).subspan(i * max_materials, max_materials), configuration);
    records_[i].force_scale = scale.force;
    records_[i].correction_scale = scale.correction;
  });
  device_records_.write(0, records_);
  const auto first_table = materials_.begin();
  same_materials_ = std::ranges::all_of(records_, [&](const RobotRecord& record) {
    const auto i = &record - records_.data();
    return std::equal(first_table, first_table + max_materials, first_table + i * max_materials);
  });
}

void Batch::place_records(std::uint32_t rows) {
  if (rows == rows_placed_) return;
  const std::size_t count = springs_.size() / record_words_;
  place_partners<<<blocks_for(count), threads>>>(springs_.data(), count, record_words_, rows_placed_, rows);
  check(cudaGetLastError(), "placing springs");
  rows_placed_ = rows;
}

void Batch::set_materials(std::size_t first_robot, std::span<const Material> tables,
                          const Configuration& configuration) {
  std::ranges::copy(tables, materials_.begin() + static_cast<std::ptrdiff_t>(first_robot * max_materials));
  device_materials_.write(first_robot * max_materials, tables);
  phases_stale_ = true;
  update_scales(configuration);
}

void Batch::update_phases(const Clock& clock) {
  const bool same_base = clock.dt == phase_clock_.dt && clock.base_time == phase_clock_.base_time;
  if (size() == 0 || (!phases_stale_ && same_base)) return;
  const auto blocks = static_cast<unsigned>((phases_.size() + threads - 1) / threads);
  compute_phases<<<blocks, threads>>>(device_materials_.data(), phases_.data(), phases_.size(), clock);
  check(cudaGetLastError(), "computing muscle phases");
  phase_clock_ = clock;
  phases_stale_ = false;
}

void Batch::set_perturbations(std::span<const Perturbation> perturbations) {
  std::vector<DevicePerturbation> converted;
  for (const Perturbation& perturbation : perturbations)
    converted.push_back({static_cast<std::uint32_t>(perturbation.robot),
                         order_of(perturbation.robot).slot_of(perturbation.mass), perturbation.target,
                         perturbation.stiffness});
  perturbations_ = DeviceArray<DevicePerturbation>(converted.size());
  perturbations_.write(0, converted);
}

void Batch::reserve_workspace(std::size_t bytes_a_robot) {
  if (bytes_a_robot == workspace_stride_) return;
  workspace_ = DeviceArray<char>();
  workspace_ = DeviceArray<char>(bytes_a_robot * robots_.size());
  workspace_stride_ = bytes_a_robot;
}

BatchView Batch::view() const {
  return {device_records_.data(),
          device_statuses_.data(),
          state_.data(),
          springs_.data(),
          lengths_.data(),
          row_start_.data(),
          face_pairs_.data(),
          splits_.data(),
          arrivals_.data(),
          device_materials_.data(),
          phases_.data(),
          perturbations_.data(),
          workspace_.data(),
          size(),
          group_stride_,
          row_stride_,
          face_stride_,
          static_cast<std::uint32_t>(perturbations_.size()),
          static_cast<std::uint32_t>(workspace_stride_),
          record_words_};
}

void Batch::read(std::size_t robot, std::span<Vec3> positions, std::span<Vec3> velocities) const {
  const SlotOrder order = order_of(robot);
  std::vector<float> groups(std::size_t{group_stride_} * state_rows * lanes);
  state_.read(robot * groups.size(), std::span(groups));
  for (std::uint32_t i = 0; i < positions.size(); ++i) positions[i] = vector_at(groups, order.slot_of(i), row_x);
  for (std::uint32_t i = 0; i < velocities.size(); ++i) velocities[i] = vector_at(groups, order.slot_of(i), row_v);
}

void Batch::write(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities) {
  const SlotOrder order = order_of(robot);
  std::vector<float> groups(std::size_t{group_stride_} * state_rows * lanes);
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    put_vector(groups, order.slot_of(i), row_x, positions[i]);
    put_vector(groups, order.slot_of(i), row_v, velocities[i]);
  }
  state_.write(robot * groups.size(), groups);
}

DeviceStatus Batch::status(std::size_t robot) const {
  DeviceStatus status{};
  device_statuses_.read(robot, std::span(&status, 1));
  return status;
}
std::vector<DeviceStatus> Batch::statuses() const {
  std::vector<DeviceStatus> all(size());
  device_statuses_.read(0, all);
  return all;
}
void Batch::set_status(std::size_t robot, DeviceStatus status) { device_statuses_.write(robot, std::span(&status, 1)); }

void Batch::gather(float* device_out, std::uint32_t first_row) const {
  if (size() == 0) return;
  gather_rows<<<size(), threads>>>(state_.data(), device_records_.data(), device_first_mass_.data(), group_stride_,
                                   first_row, device_out);
  check(cudaGetLastError(), "gathering masses");
}

}  // namespace mercury::cuda
