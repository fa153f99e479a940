// SPDX-License-Identifier: Apache-2.0
// One robot of a block as one of its threads sees it: its tiles, its masses, and a walk over its springs.
#pragma once

#include <type_traits>

#include "sim/cuda/early_start.cuh"
#include "sim/cuda/thread_context.cuh"
#include "sim/physics/fixed_point.h"

namespace mercury::cuda {

// How a warp walks over its springs, which decides how long it waits for the L2 cache.
struct SpringWalk {
  // ptxas likes to move a load to the end of a loop if only the next turn needs it. It moves none across
  // keep_loads_above(), an instruction that costs more than it saves where it does not happen.
  bool keeps_loads_above = false;
  int groups_per_turn = 1;  // of the loop; two need no copies of records, but registers
};

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

  // Of this thread's mass in a tile.
  __device__ PointProperties point(std::uint32_t tile) const {
    if (!arguments_.batch.points) return {};
    const float2 pair = __ldg(reinterpret_cast<const float2*>(arguments_.batch.points + slot_in_batch(tile)));
    return {pair.x, pair.y};
  }
  __device__ float point_mass(std::uint32_t tile) const {
    return arguments_.batch.point_masses ? __ldg(arguments_.batch.point_masses + slot_in_batch(tile)) : 1.0f;
  }

  // The first group of rows of a tile.
  __device__ std::uint32_t first_group_of(std::uint32_t tile) const {
    return __ldg(arguments_.batch.groups + chunk() * arguments_.batch.tile_stride + tile);
  }
  // The rows of a slot.
  __device__ SlotRows rows_of(std::uint32_t slot) const {
    const SlotRows* rows = arguments_.batch.rows + chunk() * arguments_.batch.tile_stride * lanes + slot;
    const int2 found = __ldg(reinterpret_cast<const int2*>(rows));
    return {static_cast<std::uint32_t>(found.x), found.y};
  }

  // Units of fixed point per newton, or per meter of correction: a power of two. Rest lengths and the 1 of the
  // constraint ratio are multiplied by it instead of the stiffnesses, so that robots can share a material table.
  __device__ float scale() const { return solver == Solver::force ? header_.force_scale : header_.correction_scale; }

  static constexpr bool has_length_table = record_words == 1;

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
  struct AnyLengths {
    const BlockRobot& robot;
    __device__ float of(const SpringRecord& record) const { return robot.scaled_rest_length_of(record); }
  };
  // The same from registers, for robots of up to three rest lengths, as lattices are: one access to shared memory less
  // per spring. 1 to 3 are the indices of lengths, as 0 is that of padding, which has any.
  struct ThreeLengths {
    float first, second, third;
    __device__ float of(const SpringRecord& record) const {
      const float odd = record.x & 0x200 ? third : first;
      return record.x & 0x100 ? odd : second;
    }
  };
  __device__ bool has_three_lengths() const { return OnChip::load(context_.lengths, 16) == 0; }
  __device__ ThreeLengths three_lengths() const {
    return {OnChip::load(context_.lengths, 4), OnChip::load(context_.lengths, 8), OnChip::load(context_.lengths, 12)};
  }
  // The same without the units [m].
  __device__ float rest_length_of(const SpringRecord& record) const {
    if constexpr (record_words == 1)
      return scaled_rest_length_of(record) * (1 / scale());
    else
      return __uint_as_float(record.y);
  }
  __device__ static std::uint32_t partner_slot_of(const SpringRecord& record) {
    return slot_at_offset(record.x >> 16, Memory::on_chip ? fields : 0);
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

  // Visits the springs that this thread's masses own, padding included. For each mass it calls
  //   auto sum = begin(tile, mass, rows)        with the SlotRows of the mass,
  //   load(record, sum)                         for up to four springs,
  //   add(what these returned, sum)             with an array,
  //   end(mass, sum).
  // The groups of all tiles follow one another: the records of the next one are under way while these are computed.
  template <SpringWalk walk, class Begin, class Load, class Add, class End>
  __device__ void walk_springs(const Begin& begin, const Load& load, const Add& add, const End& end) const {
    if (first_tile_ == last_tile_) return;
    const SpringRecord* from = group(0, context_.lane);
    asm volatile("" : "+l"(from));  // or its parts would be added up for each group
    std::uint32_t next = first_group_of(first_tile_);
    SpringRecord records[rows_at_once];
    load_records(from + std::size_t{next} * (lanes * rows_at_once), records);
    for (std::uint32_t tile = first_tile_; tile < last_tile_; ++tile) {
      const Mass<Memory> mass = own_mass(tile);
      const SlotRows rows = rows_of(own_slot(tile));
      auto sum = begin(tile, mass, rows);
      const auto visit = [&]<std::uint32_t count>(std::integral_constant<std::uint32_t, count>) {
        SpringRecord present[count];
#pragma unroll
        for (std::uint32_t i = 0; i < count; ++i) present[i] = records[i];
        ++next;
        load_records(from + std::size_t{next} * (lanes * rows_at_once), records);
        if constexpr (walk.keeps_loads_above) keep_loads_above();
        decltype(load(present[0], sum)) loaded[count];
#pragma unroll
        for (std::uint32_t i = 0; i < count; ++i) loaded[i] = load(present[i], sum);
        add(loaded, sum);
      };
      const std::uint32_t whole = next + rows.count / rows_at_once, left = rows.count % rows_at_once;
#pragma unroll(walk.groups_per_turn)
      while (next < whole) visit(std::integral_constant<std::uint32_t, rows_at_once>{});
      if (left == 3)
        visit(std::integral_constant<std::uint32_t, 3>{});
      else if (left == 2)
        visit(std::integral_constant<std::uint32_t, 2>{});
      else if (left == 1)
        visit(std::integral_constant<std::uint32_t, 1>{});
      end(mass, sum);
    }
  }

  // Calls visit(record) for the springs that the mass of a slot owns, of any warp. There is no way out of the loop, so
  // that loads need not wait for each other.
  template <class Visit>
  __device__ void for_each_spring_of(std::uint32_t slot, const Visit& visit) const {
    const std::uint32_t rows = rows_of(slot).count;
    const SpringRecord* from = group(first_group_of(slot / lanes), slot % lanes);
#pragma unroll 1
    for (std::uint32_t row = 0; row < rows; row += rows_at_once, from += lanes * rows_at_once) {
      SpringRecord records[rows_at_once];
      load_records(from, records);
#pragma unroll
      for (const SpringRecord& record : records)
        if (material_of(record) != air) visit(record);
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
    const std::uint32_t multiplier = arguments_.launch.bytes_per_material;  // of the lowest byte
    return load_pair(__dp4a(record.x, multiplier, context_.material_table));
  }

  // The records of a lane in a group of rows.
  __device__ const SpringRecord* group(std::uint32_t number, std::uint32_t lane) const {
    const std::size_t first = chunk() * arguments_.batch.group_stride + number;
    return reinterpret_cast<const SpringRecord*>(arguments_.batch.springs) + (first * lanes + lane) * rows_at_once;
  }
  // A kernel that lets the next one start has done so at its begin, and this changes nothing.
  __device__ static void keep_loads_above() { let_next_kernel_start(); }
  // Bypasses the L1 cache, which is left to data that is read again.
  __device__ static void load_records(const SpringRecord* from, SpringRecord (&records)[rows_at_once]) {
    static_assert(rows_at_once == 4);
    if constexpr (record_words == 1)
      asm volatile("ld.global.nc.L1::no_allocate.v4.u32 {%0, %1, %2, %3}, [%4];"
                   : "=r"(records[0].x), "=r"(records[1].x), "=r"(records[2].x), "=r"(records[3].x)
                   : "l"(from));
    else
#pragma unroll
      for (std::uint32_t i = 0; i < rows_at_once; i += 2)
        asm volatile("ld.global.nc.L1::no_allocate.v4.u32 {%0, %1, %2, %3}, [%4];"
                     : "=r"(records[i].x), "=r"(records[i].y), "=r"(records[i + 1].x), "=r"(records[i + 1].y)
                     : "l"(from + i));
  }

  const StepArguments& arguments_;
  const RobotHeader header_;
  const ThreadContext<Memory> context_;
  std::uint32_t first_tile_, last_tile_;
};

}  // namespace mercury::cuda
