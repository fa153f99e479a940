// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/actuation.h"

#include "sim/physics/actuation.h"

namespace mercury::cuda {
namespace {

constexpr unsigned threads = 256;

__global__ void actuate(const DrivenMaterial* driven, std::size_t count, const float* amplitude, const float* frequency,
                        const float* phase, const float* drive, Clock clock) {
  const std::size_t i = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x;
  if (i >= count) return;
  const DrivenMaterial to = driven[i];
  const Material now =
      actuated(*to.own, {amplitude[to.setting], frequency[to.setting], phase[to.setting], drive[to.setting]});
  *to.now = now;
  *to.phase = muscle_phase(now, clock);
  *to.swing = MuscleSwing::of(now);
}

}  // namespace

void Actuators::set(std::span<const DrivenMaterial> driven, const ActuationSources& sources, cudaStream_t stream) {
  driven_ = DeviceArray<DrivenMaterial>(driven.size());
  driven_.write(0, driven, stream);
  amplitude_ = sources.amplitude;
  frequency_ = sources.frequency;
  phase_ = sources.phase;
  drive_ = sources.drive;
}

void Actuators::apply(const Clock& clock, cudaStream_t stream) const {
  if (empty()) return;
  const std::size_t count = driven_.size();
  actuate<<<static_cast<unsigned>((count + threads - 1) / threads), threads, 0, stream>>>(
      driven_.data(), count, amplitude_, frequency_, phase_, drive_, clock);
  check(cudaGetLastError(), "driving actuators");
}

}  // namespace mercury::cuda
