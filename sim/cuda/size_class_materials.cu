// SPDX-License-Identifier: Apache-2.0
// Materials of a size class: tables, phases, and copies of the tables that actuators drive.
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#include "sim/cuda/size_class.h"

namespace mercury::cuda {
namespace {

constexpr unsigned threads = 256;

__global__ void compute_phases(const Material* materials, MusclePhase* phases, std::size_t count, Clock clock) {
  const std::size_t i = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x;
  if (i < count) phases[i] = muscle_phase(materials[i], clock);
}

}  // namespace

void SizeClass::update_scales(std::uint32_t place, const Configuration& configuration) {
  const FixedPointScale scale = fixed_point_scale(measures_[place], table(place), configuration);
  headers_[place].force_scale = scale.force;
  headers_[place].correction_scale = scale.correction;
}

void SizeClass::find_same_materials(std::uint32_t first_changed) {
  same_materials_ = first_changed == 0 || same_materials_;
  for (std::uint32_t place = first_changed; same_materials_ && place < size(); ++place)
    same_materials_ = std::ranges::equal(table(place), table(0));
  phases_stale_ = true;
}

void SizeClass::publish_materials(std::uint32_t place, const Configuration& configuration) {
  update_scales(place, configuration);
  device_headers_.write(place, std::span(headers_).subspan(place, 1), urgent_->get());
  device_materials_.write(place, table(place), urgent_->get());
  if (driven_materials_.size() > 0)
    driven_materials_.write(std::size_t{place} * max_materials, table(place), urgent_->get());
  find_same_materials(0);
}

void SizeClass::publish_all_materials(const Configuration& configuration) {
  configure(configuration);
  device_materials_.write(0, materials_, urgent_->get());
  if (driven_materials_.size() > 0) driven_materials_.write(0, materials_, urgent_->get());
  find_same_materials(0);
}

void SizeClass::update_phases(const Clock& clock) {
  const bool same_base = clock.dt == phase_clock_.dt && clock.base_time == phase_clock_.base_time;
  if (size() == 0 || (!phases_stale_ && same_base)) return;
  const std::size_t count = std::size_t{size()} * max_materials;
  compute_phases<<<static_cast<unsigned>((count + threads - 1) / threads), threads, 0, stream_->get()>>>(
      view().materials, phases_.data(), count, clock);
  check(cudaGetLastError(), "computing muscle phases");
  phase_clock_ = clock;
  phases_stale_ = false;
}

void SizeClass::begin_actuation() {
  const std::size_t count = std::size_t{size()} * max_materials;
  driven_materials_ = DeviceArray<Material>(count);
  check(cudaMemcpyAsync(driven_materials_.data(), device_materials_.data(), count * sizeof(Material),
                        cudaMemcpyDeviceToDevice, urgent_->get()),
        "copying materials");
  urgent_->synchronize();
  phases_stale_ = true;
}

void SizeClass::end_actuation() {
  if (driven_materials_.size() == 0) return;
  driven_materials_ = DeviceArray<Material>();
  phases_stale_ = true;
}

DrivenMaterial SizeClass::driven_material(std::uint32_t place, MaterialId id, std::uint32_t setting) const {
  const std::size_t at = std::size_t{place} * max_materials + id;
  return {device_materials_.data() + at, driven_materials_.data() + at, phases_.data() + at, setting};
}

}  // namespace mercury::cuda
