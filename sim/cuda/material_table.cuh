// SPDX-License-Identifier: Apache-2.0
// The material table of a block: the parameters of every material's springs in the current step.
//
// Copies are interleaved: the parameters of material m in copy c are at index m * copies + c. With 16 copies, lane i of
// a half-warp reads copy i and no bank twice, whatever its material is (block_layout.h).
//
// It is written while masses move and faces push, when nobody needs it:
//
//   a robot of the block    springs | end of step | faces | springs | end of step | faces
//   another one                springs | end of step | faces | springs | end of step
//   a warp that writes               ^ | end, write |  ... ^
//                                    |                     all wait until the table is written
//                                    it waits until the springs of all robots are done
#pragma once

#include "sim/cuda/block_layout.h"
#include "sim/cuda/step.h"
#include "sim/cuda/thread_context.cuh"

namespace mercury::cuda {

// A warp takes every `warps`th chunk of 32 materials, one per lane, and writes all their copies.
template <Solver solver>
class MaterialTable {
 public:
  using Parameters = SpringParameters<solver>;

  // `warps` = those that share this table; `warp` = the number of this one among them. `moving` = [chunk], in shared
  // memory: a bit for each material whose length changes by itself. `barriers` = the address of two SplitBarriers.
  __device__ MaterialTable(const StepArguments& arguments, std::uint32_t robot, std::uint32_t warp, std::uint32_t warps,
                           std::uint32_t lane, Parameters* table, std::uint32_t* moving, std::uint32_t barriers = 0)
      : warp_(warp), warps_(warps), lane_(lane), chunks_(arguments.launch.table_chunks),
        copies_(1u << arguments.launch.table_copy_bits), copy_bits_(arguments.launch.table_copy_bits), table_(table),
        moving_(moving), barriers_(barriers),
        materials_(arguments.batch.materials + std::size_t{robot} * max_materials),
        phases_(arguments.batch.phases + std::size_t{robot} * max_materials),
        swings_(arguments.batch.swings + std::size_t{robot} * max_materials) {}

  // Writes the parameters of the launch's first step.
  __device__ void fill(const StepArguments& arguments) {
    if (warp_ == 0 && lane_ == 0) {
      springs_done().begin(arguments.launch.robots_per_block);
      written().begin(min(chunks_, warps_));
    }
    for (std::uint32_t chunk = warp_; chunk < arguments.launch.table_chunks; chunk += warps_) {
      const std::uint32_t id = chunk * lanes + lane_;
      const Material material = materials_[id];
      const MuscleSwing swing = swings_[id];
      const MusclePhase phase = phases_[id];
      // A muscle of frequency 0, as a brain drives it, keeps its length.
      const std::uint32_t moving = __ballot_sync(0xffffffffu, swing.amplitude != 0 && phase.per_step != 0);
      if (lane_ == 0) moving_[chunk] = moving;
      spread(chunk, {coefficient_of(arguments, material), factor_at(arguments, swing, phase, 0)});
    }
    __syncwarp();
  }

  // Writes the relaxation times of all materials.
  __device__ void fill_relaxation_times(float* table) const {
    for (std::uint32_t chunk = warp_; chunk < chunks_; chunk += warps_)
      table[chunk * lanes + lane_] = materials_[chunk * lanes + lane_].relaxation_time;
  }

  // What this warp has to do for the table in each step, as long as no thought changes that.
  class Duty {
   public:
    __device__ bool writes(std::uint32_t chunk) const { return bits_ >> chunk & 1; }
    __device__ bool is_writer() const { return bits_ & writer; }
    // Several warps share a table that is written in each step.
    __device__ bool is_waited_for() const { return bits_ & waited_for; }
    // So do several robots.
    __device__ bool is_common() const { return bits_ & common; }

   private:
    friend MaterialTable;
    static constexpr std::uint32_t writer = 1u << max_chunks, waited_for = 2 * writer, common = 4 * writer;
    std::uint32_t bits_ = 0;
  };
  __device__ Duty duty(const LaunchConfiguration& launch) const {
    Duty duty;
    bool moves = false;
    for (std::uint32_t chunk = 0; chunk < chunks_; ++chunk) {
      if (moving_[chunk] == 0) continue;
      moves = true;
      if (chunk % warps_ == warp_) duty.bits_ |= 1u << chunk;
    }
    if (warp_ < chunks_) duty.bits_ |= Duty::writer;
    if (moves && warps_ > 1) duty.bits_ |= Duty::waited_for;
    if (moves && launch.shared_table && launch.apart) duty.bits_ |= Duty::common;
    return duty;
  }

  // In each step of the launch all warps call wait_until_written(), after which come springs; springs_end(), after the
  // robot's barrier; and update() for the next step, after masses have moved.
  __device__ void wait_until_written(const LaunchConfiguration& launch, std::uint32_t step, Duty duty) const {
    if (!duty.is_waited_for()) return;
    if constexpr (SplitBarrier::exists)
      written().wait_for(step - 1);
    else if (!launch.shared_table)
      wait_for_robot(number_in_block(launch), launch.warps_per_robot);
    else
      __syncthreads();
  }
  __device__ void springs_end(bool first_of_robot, Duty duty) const {
    if (duty.is_common() && first_of_robot) springs_done().arrive();
  }
  __device__ void update(const StepArguments& arguments, std::uint32_t step, Duty duty) {
    if (duty.is_common()) {
      if constexpr (!SplitBarrier::exists)
        __syncthreads();
      else if (duty.is_writer())
        springs_done().wait_for(step);
    }
    if (!duty.is_writer()) return;
    for (std::uint32_t chunk = warp_; chunk < chunks_; chunk += warps_) {
      if (!duty.writes(chunk)) continue;
      const std::uint32_t id = chunk * lanes + lane_;
      spread(chunk, &Parameters::length_factor, factor_at(arguments, swings_[id], phases_[id], step + 1));
    }
    __syncwarp();
    if (duty.is_waited_for() && lane_ == 0) written().arrive();
  }

  // Calls change(id, factor) for the materials below `count`, each by one lane, and writes those length factors for
  // which it returns true. These do not change by themselves from then on.
  template <class Change>
  __device__ void change_length_factors(std::uint32_t count, const Change& change) {
    for (std::uint32_t chunk = warp_; chunk * lanes < count; chunk += warps_) {
      const std::uint32_t id = chunk * lanes + lane_;
      float factor = table_[id * copies_].length_factor;
      const std::uint32_t changed = __ballot_sync(0xffffffffu, id < count && change(id, factor));
      if (changed == 0) continue;
      spread(chunk, &Parameters::length_factor, factor);
      if (lane_ == 0) moving_[chunk] &= ~changed;
      __syncwarp();
    }
  }

  // Replaces the coefficients by the rates of the length factors at this many steps after the launch's first [1/s].
  // Returns the chunks that this is done for, a bit each: of real bodies, which have few materials of their own, those
  // that some spring may read. Elsewhere it costs more to know than it saves.
  template <bool real_bodies>
  __device__ std::uint32_t write_rates(const StepArguments& arguments, std::uint32_t step) {
    std::uint32_t written = 0;
    for (std::uint32_t chunk = warp_; chunk < arguments.launch.table_chunks; chunk += warps_) {
      const std::int64_t now = arguments.clock.step - arguments.clock.base_step + step;
      const std::uint32_t id = chunk * lanes + lane_;
      if constexpr (real_bodies && solver == Solver::force)
        if (!__any_sync(0xffffffffu, table_[id * copies_].stiffness != 0)) continue;
      written |= 1u << chunk;
      spread(chunk, coefficient, muscle_rate(materials_[id], phase_at(phases_[id], now)));
    }
    return real_bodies ? written : ~0u;
  }
  // Puts them back.
  __device__ void write_coefficients(const StepArguments& arguments, std::uint32_t written) {
    for (std::uint32_t chunk = warp_; chunk < arguments.launch.table_chunks; chunk += warps_)
      if (written >> chunk & 1)
        spread(chunk, coefficient, coefficient_of(arguments, materials_[chunk * lanes + lane_]));
  }

 private:
  __device__ SplitBarrier springs_done() const { return SplitBarrier(barriers_); }
  __device__ SplitBarrier written() const { return SplitBarrier(barriers_ + SplitBarrier::bytes); }

  using Parameter = float Parameters::*;
  static constexpr Parameter coefficient = [] {
    if constexpr (solver == Solver::force)
      return &Parameters::stiffness;
    else
      return &Parameters::compliance;
  }();

  __device__ static float coefficient_of(const StepArguments& arguments, const Material& material) {
    const double stiffness = static_cast<double>(arguments.stiffness_scale) * static_cast<double>(material.stiffness);
    if constexpr (solver == Solver::force)
      return static_cast<float>(stiffness);
    else
      return static_cast<float>(1 / (stiffness * arguments.clock.dt * arguments.clock.dt));
  }
  __device__ static float factor_at(const StepArguments& arguments, MuscleSwing swing, MusclePhase phase,
                                    std::uint32_t step) {
    const std::int64_t now = arguments.clock.step - arguments.clock.base_step + step;
    return length_factor(swing.amplitude, sine_of_phase(phase_at(phase, now)), swing.highest_sine);
  }

  // Writes each lane's value, or both, to all copies of its material.
  __device__ void spread(std::uint32_t chunk, Parameter parameter, float value) {
    for_each_copy(
        chunk, [&](Parameters& to, std::uint32_t source) { to.*parameter = __shfl_sync(0xffffffffu, value, source); });
  }
  __device__ void spread(std::uint32_t chunk, Parameters both) {
    for_each_copy(chunk, [&](Parameters& to, std::uint32_t source) {
      const float first = __shfl_sync(0xffffffffu, both.*coefficient, source);
      to = {first, __shfl_sync(0xffffffffu, both.length_factor, source)};
    });
  }

  // Calls write(entry, lane of its material). In a turn the warp writes 32 consecutive entries, which belong to
  // 32 / copies materials.
  template <class Write>
  __device__ void for_each_copy(std::uint32_t chunk, const Write& write) {
    Parameters* to = table_ + chunk * lanes * copies_ + lane_;
    const std::uint32_t sources_per_turn = lanes >> copy_bits_;
    std::uint32_t source = lane_ >> copy_bits_;
#pragma unroll 4
    for (std::uint32_t turn = 0; turn < copies_; ++turn, source += sources_per_turn, to += lanes) write(*to, source);
  }

  const std::uint32_t warp_, warps_, lane_, chunks_, copies_, copy_bits_;
  Parameters* const table_;
  std::uint32_t* const moving_;
  const std::uint32_t barriers_;
  const Material* const materials_;
  const MusclePhase* const phases_;
  const MuscleSwing* const swings_;
};

}  // namespace mercury::cuda
