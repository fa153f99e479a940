// SPDX-License-Identifier: Apache-2.0
// One robot of a block as one of its threads sees it: its tiles, its masses, and a walk over its springs.
#pragma once

#include "sim/cuda/thread_context.cuh"
#include "sim/physics/fixed_point.h"

namespace mercury::cuda {

template <Solver solver_, class Memory_, int record_words>
class BlockRobot {
 public:
  static constexpr Solver solver = solver_;
  using Memory = Memory_;
  static constexpr std::uint32_t fields = working_fields(solver, Memory::keeps_valence);
  static constexpr std::uint32_t tile_bytes = fields * field_bytes;
  using SpringRecord = std::conditional_t<record_words == 1, uint1, uint2>;  // .x = key, .y = rest length (layout.h)

  __device__ BlockRobot(const StepArguments& arguments, const ThreadContext<Memory>& context)
      : arguments_(arguments), header_(header_of(arguments.batch, context.robot)), context_(context) {
    first_tile_ = first_tile_of(context.warp, header_.tiles, warps());
    last_tile_ = first_tile_of(context.warp + 1, header_.tiles, warps());
  }

  __device__ const StepArguments& arguments() const { return arguments_; }
  __device__ const RobotHeader& header() const { return header_; }
  // The same in device memory, for what is rarely needed: it takes no register.
  __device__ const RobotHeader& stored_header() const { return arguments_.batch.robots[context_.robot]; }
  __device__ const ThreadContext<Memory>& context() const { return context_; }
  __device__ std::uint32_t warps() const { return arguments_.launch.warps_per_robot; }
  __device__ std::uint32_t threads() const { return warps() * lanes; }
  __device__ std::uint32_t thread() const { return context_.warp * lanes + context_.lane; }

  // This warp's tiles are [first_tile, last_tile).
  __device__ std::uint32_t first_tile() const { return first_tile_; }
  __device__ std::uint32_t last_tile() const { return last_tile_; }

  // This thread's slot in a tile; the last tile has slots without a mass.
  __device__ std::uint32_t own_slot(std::uint32_t tile) const { return tile * lanes + context_.lane; }
  __device__ bool has_mass(std::uint32_t tile) const { return own_slot(tile) < header_.masses; }
  __device__ Mass<Memory> own_mass(std::uint32_t tile) const {
    return {context_.masses + tile * tile_bytes + context_.lane * 4};
  }
  __device__ Mass<Memory> mass_at(std::uint32_t slot) const { return {context_.masses + byte_offset(slot)}; }
  // The mass at a corner of a face (layout.h), whose address is in the lower or the higher half of a word.
  template <bool higher>
  __device__ Mass<Memory> corner(std::uint32_t word) const {
    if constexpr (Memory::on_chip)
      return {__dp2a_lo(word, higher ? 0x0400u : 0x0004u, context_.masses)};  // masses + 4 times the half
    else
      return mass_at(higher ? word >> 16 : word & 0xffff);
  }
  __device__ static std::uint32_t slot_of_corner(std::uint32_t address) {
    return slot_at_offset(address, Memory::on_chip ? fields : 0);
  }
  __device__ static std::uint32_t byte_offset(std::uint32_t slot) {
    return slot / lanes * tile_bytes + slot % lanes * 4;
  }

  // The number of this part of the robot.
  __device__ std::uint32_t part() const { return Memory::in_parts ? blockIdx.x % arguments_.batch.parts.per_robot : 0; }
  // Where a robot in parts has the mass of a slot of the whole robot: part << 16 | slot in that part.
  __device__ std::uint32_t place_of(std::uint32_t slot) const {
    const PartsView& parts = arguments_.batch.parts;
    return __ldg(parts.places + std::size_t{context_.robot} * parts.robot_tile_stride * lanes + slot);
  }
  // Where the chunks begin that each part of a robot has, if robots are in parts.
  __device__ std::size_t chunk() const { return Memory::in_parts ? blockIdx.x : context_.robot; }

  // This thread's part of a tile's state in device memory.
  __device__ float* state(std::uint32_t tile) const {
    if constexpr (Memory::in_parts) {
      const std::size_t first = std::size_t{context_.robot} * arguments_.batch.parts.robot_tile_stride;
      return arguments_.batch.state + first * state_fields * lanes +
             offset_of_slot(slot_in_robot(own_slot(tile)), state_fields);
    }
    const std::size_t index = std::size_t{context_.robot} * arguments_.batch.tile_stride + tile;
    return arguments_.batch.state + index * state_fields * lanes + context_.lane;
  }
  // The index of this thread's slot in a tile among those of the batch.
  __device__ std::size_t slot_in_batch(std::uint32_t tile) const {
    return (chunk() * arguments_.batch.tile_stride + tile) * lanes + context_.lane;
  }
  // Where the whole robot has the mass of a slot.
  __device__ std::uint32_t slot_in_robot(std::uint32_t slot) const {
    if constexpr (Memory::in_parts)
      return __ldg(arguments_.batch.parts.slots + chunk() * arguments_.batch.tile_stride * lanes + slot);
    else
      return slot;
  }
  // The number of the mass that stands in a slot.
  __device__ std::uint32_t number_of(std::uint32_t slot) const {
    return arguments_.batch.masses[first_slot_of_robot() + slot_in_robot(slot)];
  }
  // The number of springs at a slot.
  __device__ float load_valence(std::uint32_t slot) const {
    return __ldg(arguments_.batch.valences + first_slot_of_robot() + slot_in_robot(slot));
  }
  // The reactions that this thread's slot in a tile receives per step.
  __device__ std::uint32_t incoming_count(std::uint32_t tile) const {
    return __ldg(arguments_.batch.incoming_counts + slot_in_batch(tile));
  }
  // What a sum that receives that many reactions starts with (springs.cuh).
  __device__ static int bias_of(std::uint32_t incoming) { return -static_cast<int>(incoming) * rounding_magic_bits; }
  __device__ int incoming_bias(std::uint32_t tile) const { return bias_of(incoming_count(tile)); }

  // Of this thread's mass in a tile.
  __device__ PointProperties point(std::uint32_t tile) const {
    if (!arguments_.batch.points) return {};
    const float2 pair = __ldg(reinterpret_cast<const float2*>(arguments_.batch.points + slot_in_batch(tile)));
    return {pair.x, pair.y};
  }
  __device__ float point_mass(std::uint32_t tile) const {
    return arguments_.batch.point_masses ? __ldg(arguments_.batch.point_masses + slot_in_batch(tile)) : 1.0f;
  }

  __device__ const std::uint32_t* row_start() const {
    return arguments_.batch.row_start + chunk() * (arguments_.batch.tile_stride + 1);
  }
  __device__ const SpringRecord* springs() const {
    return reinterpret_cast<const SpringRecord*>(arguments_.batch.springs) +
           chunk() * arguments_.batch.row_stride * lanes;
  }

  // Units of fixed point per newton, or per meter of correction: a power of two. Rest lengths and the 1 of the
  // constraint ratio are multiplied by it instead of the stiffnesses, so that robots can share a material table.
  __device__ float scale() const { return solver == Solver::force ? header_.force_scale : header_.correction_scale; }

  // What a spring record says. A dot product of bytes multiplies a field and adds an address in one instruction.
  __device__ Mass<Memory> partner_of(const SpringRecord& record) const {
    if constexpr (Memory::on_chip)
      return {context_.masses + (record.x >> 14)};  // 4 (record.x >> 16), since the bits between are 0
    else
      return mass_at(record.x >> 16);
  }
  __device__ float scaled_rest_length_of(const SpringRecord& record) const {
    if constexpr (record_words == 1)
      return OnChip::load(__dp4a(record.x, 0x0400u, context_.lengths), 0);  // lengths + 4 (record.x >> 8 & 0xff)
    else
      return scale() * __uint_as_float(record.y);
  }
  // The same without the units [m].
  __device__ float rest_length_of(const SpringRecord& record) const {
    if constexpr (record_words == 1)
      return scaled_rest_length_of(record) * (1 / scale());
    else
      return __uint_as_float(record.y);
  }
  __device__ static std::uint32_t material_of(const SpringRecord& record) { return record.x & 0xff; }
  __device__ SpringParameters<solver> parameters_of(const SpringRecord& record) const {
    const float2 pair = table_entry_of(record);
    return {pair.x, pair.y};
  }
  // tau [s], from the one table of relaxation times that the lanes share: few materials lie in one bank.
  __device__ float relaxation_time_of(const SpringRecord& record) const {
    return OnChip::load(context_.relaxation_times + material_of(record) * 4, 0);
  }
  // d(L / L0) / dt [1/s] and L / L0, after MaterialTable::write_rates().
  __device__ float2 rate_and_length_factor_of(const SpringRecord& record) const { return table_entry_of(record); }

  // Visits the springs that this thread's masses own. For each mass it calls
  //   auto sum = begin(tile, mass, rows)                       with the number of rows of the tile,
  //   add(integral_constant<int, count>, records, sum)         for its springs, up to four at once,
  //   end(mass, sum).
  // The rows of all tiles follow one another: the records of the next rows are under way while `add` handles these.
  template <class Begin, class Add, class End>
  __device__ void walk_springs(const Begin& begin, const Add& add, const End& end) const {
    if (first_tile_ == last_tile_) return;
    const std::uint32_t* start = row_start();
    std::uint32_t row = start[first_tile_];
    const SpringRecord* next = springs() + std::size_t{row} * lanes + context_.lane;
    SpringRecord records[rows_at_once];
    load_records(next, records);
    for (std::uint32_t tile = first_tile_; tile < last_tile_; ++tile) {
      const Mass<Memory> mass = own_mass(tile);
      const std::uint32_t last = start[tile + 1];
      auto sum = begin(tile, mass, last - row);
      for (; row < last; row += rows_at_once) {
        SpringRecord present[rows_at_once];
#pragma unroll
        for (int i = 0; i < rows_at_once; ++i) present[i] = records[i];
        const std::uint32_t left = last - row;
        next += min(left, static_cast<std::uint32_t>(rows_at_once)) * lanes;
        load_records(next, records);
        if (left >= 4)
          add(std::integral_constant<int, 4>{}, present, sum);
        else if (left == 3)
          add(std::integral_constant<int, 3>{}, present, sum);
        else if (left == 2)
          add(std::integral_constant<int, 2>{}, present, sum);
        else
          add(std::integral_constant<int, 1>{}, present, sum);
      }
      row = last;
      end(mass, sum);
    }
  }

 private:
  // Of a part: its own numbers of masses, tiles and faces.
  __device__ static RobotHeader header_of(const BatchView& batch, std::uint32_t robot) {
    RobotHeader header = batch.robots[robot];
    if constexpr (Memory::in_parts) {
      const PartHeader part = batch.parts.headers[blockIdx.x];
      header.masses = part.masses;
      header.tiles = part.tiles;
      header.face_pairs = part.face_pairs;
    }
    return header;
  }
  __device__ std::size_t first_slot_of_robot() const {
    const BatchView& batch = arguments_.batch;
    return std::size_t{context_.robot} * (Memory::in_parts ? batch.parts.robot_tile_stride : batch.tile_stride) * lanes;
  }

  __device__ float2 table_entry_of(const SpringRecord& record) const {
    const std::uint32_t bytes_per_material = parameter_bytes << arguments_.launch.table_copy_bits;
    return load_pair(__dp4a(record.x, bytes_per_material, context_.material_table));  // of the lowest byte
  }

  // Bypasses the L1 cache, which is left to data that is read again.
  __device__ static void load_records(const SpringRecord* from, SpringRecord (&records)[rows_at_once]) {
#pragma unroll
    for (int i = 0; i < rows_at_once; ++i) {
      if constexpr (record_words == 1)
        asm volatile("ld.global.nc.L1::no_allocate.u32 %0, [%1];" : "=r"(records[i].x) : "l"(from + i * lanes));
      else
        asm volatile("ld.global.nc.L1::no_allocate.v2.u32 {%0, %1}, [%2];"
                     : "=r"(records[i].x), "=r"(records[i].y)
                     : "l"(from + i * lanes));
    }
  }

  const StepArguments& arguments_;
  const RobotHeader header_;
  const ThreadContext<Memory> context_;
  std::uint32_t first_tile_, last_tile_;
};

}  // namespace mercury::cuda
