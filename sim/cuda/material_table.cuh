// SPDX-License-Identifier: Apache-2.0
// The material table of a block: what every material's springs are at the present step.
#pragma once

#include "sim/cuda/block.cuh"

namespace mercury::cuda {

// Each warp keeps a share of the table's materials in registers, one a lane and turn, and writes all their copies: lane
// i of a half-warp then reads copy i, whatever material it has, and no bank twice.
class MaterialTable {
 public:
  // `warps` of them work on this table; at least 2.
  __device__ MaterialTable(const StepArguments& arguments, std::uint32_t robot, std::uint32_t warp, std::uint32_t warps,
                           std::uint32_t lane, SpringLaw* table)
      : warp_(warp), warps_(warps), lane_(lane), copies_(1u << arguments.shape.table_copy_bits),
        copy_bits_(arguments.shape.table_copy_bits), table_(table),
        materials_(arguments.batch.materials + std::size_t{robot} * max_materials),
        phases_(arguments.batch.phases + std::size_t{robot} * max_materials) {}

  // Hardness of every material, and the factors of the first step.
  template <Solver solver>
  __device__ void fill(const StepArguments& arguments) {
    for (std::uint32_t block = warp_; block < blocks; block += warps_) {
      const Material material = materials_[block * lanes + lane_];
      const double stiffness = static_cast<double>(arguments.stiffness_scale) * static_cast<double>(material.stiffness);
      float hardness = static_cast<float>(stiffness);
      if constexpr (solver == Solver::xpbd)
        hardness = static_cast<float>(1 / (stiffness * arguments.clock.dt * arguments.clock.dt));
      for (std::uint32_t copy = 0; copy < copies_; ++copy)
        table_[(block * lanes + lane_) * copies_ + copy].hardness = hardness;
    }
    update(arguments, 0);
  }

  // The factors at `step` steps from the launch's first.
  __device__ void update(const StepArguments& arguments, std::uint32_t step) {
    for (std::uint32_t block = warp_; block < blocks; block += warps_) {
      const float amplitude = materials_[block * lanes + lane_].amplitude;
      if (step > 0 && !__any_sync(0xffffffffu, amplitude != 0)) continue;
      const std::int64_t now = arguments.clock.step - arguments.clock.base_step + step;
      spread(block, muscle_factor(amplitude, phase_at(phases_[block * lanes + lane_], now)));
    }
  }

 private:
  static constexpr std::uint32_t blocks = max_materials / lanes;

  __device__ void spread(std::uint32_t block, float factor) {
    SpringLaw* to = table_ + block * lanes * copies_ + lane_;
    const std::uint32_t sources_a_turn = lanes >> copy_bits_;
    std::uint32_t source = lane_ >> copy_bits_;
#pragma unroll 4
    for (std::uint32_t turn = 0; turn < copies_; ++turn, source += sources_a_turn, to += lanes)
      to->factor = __shfl_sync(0xffffffffu, factor, source);
  }

  const std::uint32_t warp_, warps_, lane_, copies_, copy_bits_;
  SpringLaw* const table_;
  const Material* const materials_;
  const MusclePhase* const phases_;
};

}  // namespace mercury::cuda
