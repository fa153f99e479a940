// SPDX-License-Identifier: Apache-2.0
// One robot of a block, as one of its threads sees it: where its masses stand, and a walk over their springs.
//
// A block steps `robots_per_block` robots side by side; each has `warps_per_robot` warps, which share its groups of 32
// masses among them.
#pragma once

#include "sim/cuda/block.cuh"
#include "sim/cuda/mass_memory.cuh"

namespace mercury::cuda {

// A thread's place at a robot. Shared addresses: `table` of this lane's copy of the material table, `lengths` of the
// rest lengths.
template <class Memory>
struct Seat {
  std::uint32_t robot, warp, lane;
  typename Memory::Address masses;
  std::uint32_t table, lengths;
};

extern __shared__ char shared_memory[];

__device__ inline std::uint32_t shared_address(const void* pointer) {
  return static_cast<std::uint32_t>(__cvta_generic_to_shared(pointer));
}

// What a thread finds where in its block.
template <class Memory>
struct BlockPlaces {
  std::uint32_t first_robot;
  bool has_robot;  // the last block may have seats left
  SpringLaw* table;
  float* lengths;
  Failure* failure;
  char* contacts;
  Seat<Memory> seat;

  // `rows` = of a group of masses.
  __device__ BlockPlaces(const StepArguments& arguments, std::uint32_t rows) {
    const Shape& shape = arguments.shape;
    const BatchView& batch = arguments.batch;
    const std::uint32_t block_warp = threadIdx.x / lanes, number = block_warp / shape.warps_per_robot;
    const std::uint32_t table_copies = 1u << shape.table_copy_bits;
    const BlockLayout layout = block_layout(shape, batch.group_stride, rows);
    const std::uint32_t working_bytes = batch.group_stride * rows * row_bytes;
    first_robot = blockIdx.x * shape.robots_per_block;
    has_robot = first_robot + number < batch.robot_count;
    seat.robot = min(first_robot + number, batch.robot_count - 1);
    seat.warp = block_warp % shape.warps_per_robot;
    seat.lane = threadIdx.x % lanes;

    char* const workspace = batch.workspace + std::size_t{seat.robot} * batch.workspace_stride;
    if constexpr (Memory::on_chip)
      seat.masses = shared_address(shared_memory) + layout.contacts + number * working_bytes;
    else
      seat.masses = workspace;
    contacts = shape.contacts_on_chip
                   ? shared_memory + layout.lengths + number * contact_bytes(shape.contact_buckets, batch.group_stride)
                   : workspace + (Memory::on_chip ? 0 : working_bytes);
    table =
        reinterpret_cast<SpringLaw*>(shared_memory) + (shape.shared_table ? 0 : number * table_copies * max_materials);
    seat.table = shared_address(table + seat.lane % table_copies);
    failure = reinterpret_cast<Failure*>(shared_memory + layout.tables) + number;
    lengths = reinterpret_cast<float*>(shared_memory + layout.failures) + number * max_lengths;
    seat.lengths = shared_address(lengths);
  }
};

template <Solver solver, class Memory, int record_words>
class BlockRobot {
 public:
  static constexpr std::uint32_t rows = working_rows(solver, Memory::keeps_splits);
  static constexpr std::uint32_t group_bytes = rows * row_bytes;
  using Record = std::conditional_t<record_words == 1, uint1, uint2>;

  __device__ BlockRobot(const StepArguments& arguments, const Seat<Memory>& seat)
      : arguments_(arguments), record_(arguments.batch.robots[seat.robot]), seat_(seat) {
    const std::uint32_t turns = (record_.groups + warps() - 1) / warps();
    first_group_ = min(seat.warp * turns, record_.groups);
    last_group_ = min(first_group_ + turns, record_.groups);
  }

 protected:
  __device__ std::uint32_t warps() const { return arguments_.shape.warps_per_robot; }
  __device__ std::uint32_t thread() const { return seat_.warp * lanes + seat_.lane; }
  __device__ Mass<Memory> own(std::uint32_t group) const {
    return {seat_.masses + group * group_bytes + seat_.lane * 4};
  }
  __device__ bool is_mass(std::uint32_t group) const { return group * lanes + seat_.lane < record_.masses; }
  __device__ static std::uint32_t offset_of(std::uint32_t mass) {
    return mass / lanes * group_bytes + mass % lanes * 4;
  }
  __device__ Mass<Memory> at(std::uint32_t mass) const { return {seat_.masses + offset_of(mass)}; }

  __device__ float* state(std::uint32_t group) const {
    const std::size_t place = std::size_t{seat_.robot} * arguments_.batch.group_stride + group;
    return arguments_.batch.state + place * state_rows * lanes + seat_.lane;
  }
  __device__ const std::uint32_t* row_start() const {
    return arguments_.batch.row_start + std::size_t{seat_.robot} * (arguments_.batch.group_stride + 1);
  }
  __device__ const Record* springs() const {
    return reinterpret_cast<const Record*>(arguments_.batch.springs) +
           std::size_t{seat_.robot} * arguments_.batch.row_stride * lanes;
  }
  __device__ Mass<Memory> partner_of(const Record& record) const {
    if constexpr (Memory::on_chip)
      return {seat_.masses + __byte_perm(record.x, 0, 0x4432) * 4};  // one instruction less than record.x >> 16
    else
      return at(record.x >> 16);
  }
  // What springs give is in units of fixed point: their laws are those of the material table, which robots may share,
  // and their lengths are multiplied by the units in a newton, or in a metre of correction, a power of two.
  __device__ float unit() const { return solver == Solver::force ? record_.force_scale : record_.correction_scale; }
  __device__ float rest_length_of(const Record& record) const {
    if constexpr (record_words == 1)
      return OnChip::load(seat_.lengths + __byte_perm(record.x, 0, 0x4441) * 4, 0);  // record.x >> 8 & 0xff
    else
      return unit() * __uint_as_float(record.y);
  }
  __device__ static std::uint32_t material_of(const Record& record) { return record.x & 0xff; }
  // .x = hardness, .y = factor
  __device__ float2 law_of(const Record& record) const {
    return load_pair(seat_.table + material_of(record) * law_bytes());
  }

  // begin(group, mass, rows) makes what a mass's springs are collected in, add(integral_constant count, records, that)
  // adds up to four rows to it, and end(mass, that) ends it, for each of this thread's masses. Their rows follow one
  // another, and the records of the next rows are on their way while the present ones are added.
  template <class Begin, class Add, class End>
  __device__ void for_each_rows(const Begin& begin, const Add& add, const End& end) const {
    if (first_group_ == last_group_) return;
    const std::uint32_t* start = row_start();
    std::uint32_t row = start[first_group_];
    const Record* next = springs() + std::size_t{row} * lanes + seat_.lane;
    Record records[rows_at_once];
    load_records(next, records);
    for (std::uint32_t g = first_group_; g < last_group_; ++g) {
      const Mass<Memory> mass = own(g);
      const std::uint32_t last = start[g + 1];
      auto sum = begin(g, mass, last - row);
      for (; row < last; row += rows_at_once) {
        Record present[rows_at_once];
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
  __device__ std::uint32_t law_bytes() const {
    return static_cast<std::uint32_t>(sizeof(SpringLaw)) << arguments_.shape.table_copy_bits;
  }

  // Past the L1 cache, which is left to what is read again.
  __device__ static void load_records(const Record* from, Record (&records)[rows_at_once]) {
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

 protected:
  const StepArguments& arguments_;
  const RobotRecord record_;
  const Seat<Memory> seat_;
  std::uint32_t first_group_, last_group_;
};

}  // namespace mercury::cuda
