// SPDX-License-Identifier: Apache-2.0
// Where masses stand while they are stepped: on the chip, or in device memory if they are too many. All look alike to
// the step kernel: an address, and rows at constant distances from it.
#pragma once

#include "sim/cuda/layout.h"

namespace mercury::cuda {

// Shared memory by its own 32-bit addresses. Written in assembly so that the order of accesses is the source's: the
// compiler would keep every load behind the additions before it, which might concern the same place but never do.
class OnChip {
 public:
  using Address = std::uint32_t;
  static constexpr bool on_chip = true;
  static constexpr bool keeps_splits = true;  // XPBD's number of springs at a mass stands beside the mass

  __device__ static float load(Address at, std::uint32_t offset) {
    float value;
    asm volatile("ld.shared.f32 %0, [%1];" : "=f"(value) : "r"(at + offset));
    return value;
  }
  __device__ static void store(Address at, std::uint32_t offset, float value) {
    asm volatile("st.shared.f32 [%0], %1;" ::"r"(at + offset), "f"(value));
  }
  __device__ static void add(Address at, std::uint32_t offset, int value) {
    asm volatile("red.shared.add.s32 [%0], %1;" ::"r"(at + offset), "r"(value));
  }
};

// For robots that are too large by this one row: the numbers of springs are read from device memory.
class OnChipWithoutSplits : public OnChip {
 public:
  static constexpr bool keeps_splits = false;
};

class OffChip {
 public:
  using Address = char*;
  static constexpr bool on_chip = false;
  static constexpr bool keeps_splits = true;

  __device__ static float load(Address at, std::uint32_t offset) {
    return *reinterpret_cast<volatile float*>(at + offset);
  }
  __device__ static void store(Address at, std::uint32_t offset, float value) {
    *reinterpret_cast<volatile float*>(at + offset) = value;
  }
  __device__ static void add(Address at, std::uint32_t offset, int value) {
    atomicAdd(reinterpret_cast<int*>(at + offset), value);
  }
};

// A float2 of shared memory.
__device__ inline float2 load_pair(std::uint32_t at) {
  float2 value;
  asm volatile("ld.shared.v2.f32 {%0, %1}, [%2];" : "=f"(value.x), "=f"(value.y) : "r"(at));
  return value;
}

// One mass: three floats or integers in consecutive rows.
template <class Memory>
struct Mass {
  typename Memory::Address at;

  __device__ Vec3 vector(std::uint32_t row) const {
    return {Memory::load(at, row * row_bytes), Memory::load(at, (row + 1) * row_bytes),
            Memory::load(at, (row + 2) * row_bytes)};
  }
  __device__ void set_vector(std::uint32_t row, Vec3 value) const {
    Memory::store(at, row * row_bytes, value.x);
    Memory::store(at, (row + 1) * row_bytes, value.y);
    Memory::store(at, (row + 2) * row_bytes, value.z);
  }
  __device__ float value(std::uint32_t row) const { return Memory::load(at, row * row_bytes); }
  __device__ void set_value(std::uint32_t row, float value) const { Memory::store(at, row * row_bytes, value); }

  __device__ int sum(std::uint32_t axis) const {
    return __float_as_int(Memory::load(at, (row_sum + axis) * row_bytes));
  }
  __device__ void set_sum(int value) const {
    for (std::uint32_t axis = 0; axis < 3; ++axis)
      Memory::store(at, (row_sum + axis) * row_bytes, __int_as_float(value));
  }
  __device__ void add_to_sum(int x, int y, int z) const {
    Memory::add(at, row_sum * row_bytes, x);
    Memory::add(at, (row_sum + 1) * row_bytes, y);
    Memory::add(at, (row_sum + 2) * row_bytes, z);
  }
  __device__ void add_to_sum(Vec3 units) const {
    add_to_sum(round_to_int(units.x), round_to_int(units.y), round_to_int(units.z));
  }
};

}  // namespace mercury::cuda
