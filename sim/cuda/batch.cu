// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/batch.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

namespace mercury::cuda {
namespace {

constexpr unsigned threads = 256;

// Rewrites the partners of all records for tiles of another number of fields.
__global__ void readdress_partners(std::uint32_t* records, std::size_t count, std::uint32_t record_words,
                                   std::uint32_t old_fields, std::uint32_t new_fields) {
  for (std::size_t i = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x; i < count;
       i += std::size_t{gridDim.x} * blockDim.x) {
    std::uint32_t& key = records[i * record_words];
    const std::uint32_t slot = slot_at_offset(key >> 16, old_fields);
    key = offset_of_slot(slot, new_fields) << 16 | (key & 0xffff);
  }
}

__global__ void compute_phases(const Material* materials, MusclePhase* phases, std::size_t count, Clock clock) {
  const std::size_t i = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x;
  if (i < count) phases[i] = muscle_phase(materials[i], clock);
}

// One block per robot.
__global__ void gather_vectors(const float* state, const RobotHeader* headers, const std::uint64_t* first_mass,
                               std::uint32_t tile_stride, std::uint32_t first_field, float* out) {
  const std::uint32_t robot = blockIdx.x;
  const SlotOrder order = slot_order(headers[robot]);
  const std::uint64_t first = first_mass[robot], masses = first_mass[robot + 1] - first;
  const float* chunk = state + std::size_t{robot} * tile_stride * state_fields * lanes + first_field * lanes;
  for (std::uint64_t k = threadIdx.x; k < 3 * masses; k += blockDim.x) {
    const auto axis = static_cast<std::uint32_t>(k % 3), slot = order.slot_of(static_cast<std::uint32_t>(k / 3));
    out[3 * first + k] = chunk[offset_of_slot(slot, state_fields) + axis * lanes];
  }
}

unsigned blocks_for(std::size_t count) {
  return static_cast<unsigned>(std::min<std::size_t>((count + threads - 1) / threads, 65536));
}

RobotHeader header_of(const Robot& robot, const Arrangement& arrangement, const RobotMeasures& measures) {
  return {.masses = static_cast<std::uint32_t>(robot.masses.size()),
          .tiles = arrangement.schedule.tiles(),
          .face_pairs = static_cast<std::uint32_t>(arrangement.faces.size()),
          .springs = static_cast<std::uint32_t>(robot.springs.size()),
          .lane_shift = arrangement.order.shift,
          .force_scale = 1,  // Batch::configure sets the scales
          .correction_scale = 1,
          .squared_stretch_limit = measures.squared_stretch_limit(),
          .contact_distance = measures.contact_distance()};
}

}  // namespace

Batch::Batch(std::span<const Robot* const> robots) : robots_(robots.begin(), robots.end()) {
  measures_.resize(size());
  oneapi::tbb::parallel_for(std::size_t{0}, robots_.size(),
                            [&](std::size_t i) { measures_[i] = measure(*robots_[i]); });
  for (const Robot* robot : robots_) first_mass_.push_back(first_mass_.back() + robot->masses.size());
  if (size() > 0) upload();
}

// Prepares robots on all cores and uploads a portion at a time, so that the host never holds the buffers of the whole
// batch.
void Batch::upload() {
  constexpr std::size_t portion = 512;
  const std::size_t count = robots_.size();
  const Arrangements arrangements(robots_);
  sizes_ = arrangements.sizes();
  allocate();
  headers_.resize(count);
  materials_.resize(count * max_materials);
  for (std::size_t first = 0; first < count; first += portion) {
    const std::size_t n = std::min(portion, count - first);
    Chunks chunks(sizes_, n);
    oneapi::tbb::parallel_for(std::size_t{0}, n, [&](std::size_t k) {
      const std::size_t i = first + k;
      const std::shared_ptr<const Arrangement> arrangement = arrangements.of(i);
      headers_[i] = header_of(*robots_[i], *arrangement, measures_[i]);
      chunks.fill(k, *robots_[i], *arrangement, arrangements.lengths(i));
      std::ranges::copy(materials_of(*robots_[i]), materials_.begin() + static_cast<std::ptrdiff_t>(i * max_materials));
    });
    write_chunks(first, chunks);
  }
  device_materials_.write(0, materials_);
}

void Batch::allocate() {
  const std::size_t count = robots_.size();
  device_headers_ = DeviceArray<RobotHeader>(count);
  statuses_ = DeviceArray<DeviceStatus>(count);
  statuses_.write(0, std::vector<DeviceStatus>(count, DeviceStatus{-1, no_mass}));
  state_ = DeviceArray<float>(count * sizes_.state());
  valences_ = DeviceArray<float>(count * sizes_.slots());
  springs_ = DeviceArray<std::uint32_t>(count * sizes_.springs() + rows_at_once * lanes * sizes_.record_words);
  springs_.clear();
  lengths_ = DeviceArray<float>(count * sizes_.lengths());
  incoming_counts_ = DeviceArray<std::uint32_t>(count * sizes_.slots());
  row_start_ = DeviceArray<std::uint32_t>(count * sizes_.row_starts());
  face_pairs_ = DeviceArray<FacePair>(count * sizes_.face_pairs);
  device_materials_ = DeviceArray<Material>(count * max_materials);
  phases_ = DeviceArray<MusclePhase>(count * max_materials);
  device_first_mass_ = DeviceArray<std::uint64_t>(first_mass_.size());
  device_first_mass_.write(0, first_mass_);
}

void Batch::write_chunks(std::size_t first_robot, const Chunks& chunks) {
  state_.write(first_robot * sizes_.state(), chunks.state);
  valences_.write(first_robot * sizes_.slots(), chunks.valences);
  springs_.write(first_robot * sizes_.springs(), chunks.springs);
  lengths_.write(first_robot * sizes_.lengths(), chunks.lengths);
  row_start_.write(first_robot * sizes_.row_starts(), chunks.row_start);
  incoming_counts_.write(first_robot * sizes_.slots(), chunks.incoming_counts);
  face_pairs_.write(first_robot * sizes_.face_pairs, chunks.face_pairs);
}

void Batch::configure(const Configuration& configuration) {
  if (size() == 0) return;
  oneapi::tbb::parallel_for(std::size_t{0}, robots_.size(), [&](std::size_t i) {
    const FixedPointScale scale =
        fixed_point_scale(measures_[i], std::span(materials_).subspan(i * max_materials, max_materials), configuration);
    headers_[i].force_scale = scale.force;
    headers_[i].correction_scale = scale.correction;
  });
  device_headers_.write(0, headers_);
  const auto first_table = materials_.begin();
  same_materials_ = std::ranges::all_of(headers_, [&](const RobotHeader& header) {
    const auto i = &header - headers_.data();
    return std::equal(first_table, first_table + max_materials, first_table + i * max_materials);
  });
}

void Batch::address_partners(std::uint32_t fields) {
  if (fields == partner_fields_) return;
  const std::size_t count = springs_.size() / sizes_.record_words;
  readdress_partners<<<blocks_for(count), threads>>>(springs_.data(), count, sizes_.record_words, partner_fields_,
                                                     fields);
  check(cudaGetLastError(), "addressing the partners of springs");
  partner_fields_ = fields;
}

void Batch::set_materials(std::size_t first_robot, std::span<const Material> tables,
                          const Configuration& configuration) {
  std::ranges::copy(tables, materials_.begin() + static_cast<std::ptrdiff_t>(first_robot * max_materials));
  device_materials_.write(first_robot * max_materials, tables);
  phases_stale_ = true;
  configure(configuration);
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

void Batch::reserve_workspace(std::size_t bytes_per_robot) {
  if (bytes_per_robot == workspace_stride_) return;
  workspace_ = DeviceArray<char>();  // frees the old one first
  workspace_ = DeviceArray<char>(bytes_per_robot * robots_.size());
  workspace_stride_ = bytes_per_robot;
}

BatchView Batch::view() const {
  return {.robots = device_headers_.data(),
          .statuses = statuses_.data(),
          .state = state_.data(),
          .springs = springs_.data(),
          .lengths = lengths_.data(),
          .row_start = row_start_.data(),
          .face_pairs = face_pairs_.data(),
          .valences = valences_.data(),
          .incoming_counts = incoming_counts_.data(),
          .materials = device_materials_.data(),
          .phases = phases_.data(),
          .perturbations = perturbations_.data(),
          .workspace = workspace_.data(),
          .robot_count = size(),
          .tile_stride = sizes_.tiles,
          .row_stride = sizes_.rows,
          .face_stride = sizes_.face_pairs,
          .perturbation_count = static_cast<std::uint32_t>(perturbations_.size()),
          .workspace_stride = static_cast<std::uint32_t>(workspace_stride_),
          .record_words = sizes_.record_words};
}

void Batch::read(std::size_t robot, std::span<Vec3> positions, std::span<Vec3> velocities) const {
  const SlotOrder order = order_of(robot);
  std::vector<float> state(sizes_.state());
  state_.read(robot * state.size(), std::span(state));
  for (std::uint32_t i = 0; i < positions.size(); ++i) positions[i] = vector_at(state, order.slot_of(i), field_x);
  for (std::uint32_t i = 0; i < velocities.size(); ++i) velocities[i] = vector_at(state, order.slot_of(i), field_v);
}

void Batch::write(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities) {
  const SlotOrder order = order_of(robot);
  std::vector<float> state(sizes_.state());
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    put_vector(state, order.slot_of(i), field_x, positions[i]);
    put_vector(state, order.slot_of(i), field_v, velocities[i]);
  }
  state_.write(robot * state.size(), state);
}

DeviceStatus Batch::status(std::size_t robot) const {
  DeviceStatus status{};
  statuses_.read(robot, std::span(&status, 1));
  return status;
}
std::vector<DeviceStatus> Batch::statuses() const {
  std::vector<DeviceStatus> all(size());
  statuses_.read(0, all);
  return all;
}
void Batch::set_status(std::size_t robot, DeviceStatus status) { statuses_.write(robot, std::span(&status, 1)); }

void Batch::gather(float* device_out, Field first_field) const {
  if (size() == 0) return;
  gather_vectors<<<size(), threads>>>(state_.data(), device_headers_.data(), device_first_mass_.data(), sizes_.tiles,
                                      first_field, device_out);
  check(cudaGetLastError(), "gathering masses");
}

}  // namespace mercury::cuda
