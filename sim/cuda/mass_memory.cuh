// SPDX-License-Identifier: Apache-2.0
// Working memory of the masses: shared memory, or device memory for robots that are too large. Both offer the same
// interface to the step kernel: an address per slot, and fields at constant offsets from it (tile.h).
#pragma once

#include "mercury/vec3.h"
#include "sim/cuda/tile.h"

namespace mercury::cuda {

// Shared memory, by its own 32-bit addresses. The inline assembly keeps the accesses in the order of the source: the
// compiler cannot know that a load never depends on the additions before it, and would wait for them.
class OnChip {
 public:
  using Address = std::uint32_t;
  static constexpr bool on_chip = true;
  static constexpr bool keeps_valence = true;  // in field_valence, for XPBD
  static constexpr bool in_parts = false;      // a block has the whole robot
  static constexpr bool finds_contacts = true;

  __device__ static float load(Address at, std::uint32_t offset) {
    float value;
    asm volatile("ld.shared.f32 %0, [%1];" : "=f"(value) : "r"(at + offset));
    return value;
  }
  __device__ static void store(Address at, std::uint32_t offset, float value) {
    asm volatile("st.shared.f32 [%0], %1;" ::"r"(at + offset), "f"(value));
  }
  // Returns the old value.
  __device__ static int exchange(Address at, std::uint32_t offset, int value) {
    int old;
    asm volatile("atom.shared.exch.b32 %0, [%1], %2;" : "=r"(old) : "r"(at + offset), "r"(value));
    return old;
  }
  __device__ static void add(Address at, std::uint32_t offset, int value) {
    asm volatile("red.shared.add.s32 [%0], %1;" ::"r"(at + offset), "r"(value));
  }
  // Stores the larger of the old and the given value.
  __device__ static void raise(Address at, std::uint32_t offset, std::uint32_t value) {
    asm volatile("red.shared.max.u32 [%0], %1;" ::"r"(at + offset), "r"(value));
  }
  // 16 bytes from device memory. They are there after wait_for_copies().
  __device__ static void copy(Address at, const float* from) {
#if __CUDA_ARCH__ >= 800
    asm volatile("cp.async.cg.shared.global [%0], [%1], 16;" ::"r"(at), "l"(from) : "memory");
#else
    const float4 all = *reinterpret_cast<const float4*>(from);
    asm volatile("st.shared.v4.f32 [%0], {%1, %2, %3, %4};" ::"r"(at), "f"(all.x), "f"(all.y), "f"(all.z), "f"(all.w));
#endif
  }
  __device__ static void wait_for_copies() {
#if __CUDA_ARCH__ >= 800
    asm volatile("cp.async.wait_all;" ::: "memory");
#endif
  }
};

// For robots that are too large by this one field: the valences are read from device memory.
class OnChipWithoutValence : public OnChip {
 public:
  static constexpr bool keeps_valence = false;
};

// Shared memory of one part of a robot (parts.h).
class InParts : public OnChip {
 public:
  static constexpr bool in_parts = true;

  // The same address in the memory of the block that has this part of the robot.
  __device__ static Address of_part(Address at, std::uint32_t part) {
#if __CUDA_ARCH__ >= 900
    asm("mapa.shared::cluster.u32 %0, %0, %1;" : "+r"(at) : "r"(part));
#endif
    return at;
  }
  __device__ static float load_there(Address at, std::uint32_t offset) {
    float value = 0;
#if __CUDA_ARCH__ >= 900
    asm volatile("ld.shared::cluster.f32 %0, [%1];" : "=f"(value) : "r"(at + offset));
#endif
    return value;
  }
  __device__ static void add_there(Address at, std::uint32_t offset, int value) {
#if __CUDA_ARCH__ >= 900
    asm volatile("red.relaxed.cluster.shared::cluster.add.s32 [%0], %1;" ::"r"(at + offset), "r"(value));
#endif
  }
  __device__ static void store_there(Address at, std::uint32_t offset, float value) {
#if __CUDA_ARCH__ >= 900
    asm volatile("st.shared::cluster.f32 [%0], %1;" ::"r"(at + offset), "f"(value));
#endif
  }
  // Stores the smaller or the larger of the old and the given value.
  __device__ static void raise_there(Address at, std::uint32_t value) {
#if __CUDA_ARCH__ >= 900
    asm volatile("red.relaxed.cluster.shared::cluster.max.u32 [%0], %1;" ::"r"(at), "r"(value) : "memory");
#endif
  }
  __device__ static void lower_there(Address at, std::uint32_t value) {
#if __CUDA_ARCH__ >= 900
    asm volatile("red.relaxed.cluster.shared::cluster.min.u32 [%0], %1;" ::"r"(at), "r"(value) : "memory");
#endif
  }
};

// The same without the code for contacts, which takes registers.
class InPartsWithoutContacts : public InParts {
 public:
  static constexpr bool finds_contacts = false;
};

// Device memory.
class OffChip {
 public:
  using Address = char*;
  static constexpr bool on_chip = false;
  static constexpr bool keeps_valence = true;
  static constexpr bool in_parts = false;
  static constexpr bool finds_contacts = true;

  __device__ static float load(Address at, std::uint32_t offset) {
    return *reinterpret_cast<volatile float*>(at + offset);
  }
  __device__ static void store(Address at, std::uint32_t offset, float value) {
    *reinterpret_cast<volatile float*>(at + offset) = value;
  }
  __device__ static int exchange(Address at, std::uint32_t offset, int value) {
    volatile int& stored = *reinterpret_cast<volatile int*>(at + offset);
    const int old = stored;
    stored = value;
    return old;
  }
  __device__ static void add(Address at, std::uint32_t offset, int value) {
    atomicAdd(reinterpret_cast<int*>(at + offset), value);
  }
  __device__ static void raise(Address at, std::uint32_t offset, std::uint32_t value) {
    atomicMax(reinterpret_cast<std::uint32_t*>(at + offset), value);
  }
  __device__ static void copy(Address at, const float* from) {
    *reinterpret_cast<float4*>(at) = *reinterpret_cast<const float4*>(from);
  }
  __device__ static void wait_for_copies() {}
};

// Two floats of shared memory in one instruction.
__device__ inline float2 load_pair(std::uint32_t at) {
  float2 value;
  asm volatile("ld.shared.v2.f32 {%0, %1}, [%2];" : "=f"(value.x), "=f"(value.y) : "r"(at));
  return value;
}

// Four, which lie in 16 aligned bytes.
__device__ inline float4 load_four(std::uint32_t at) {
  float4 value;
  asm volatile("ld.shared.v4.f32 {%0, %1, %2, %3}, [%4];"
               : "=f"(value.x), "=f"(value.y), "=f"(value.z), "=f"(value.w)
               : "r"(at));
  return value;
}

// A mass in working memory.
template <class Memory>
struct Mass {
  typename Memory::Address at;

  // Three fields as a vector, from `field` on.
  __device__ Vec3 vector(std::uint32_t field) const { return {value(field), value(field + 1), value(field + 2)}; }
  __device__ void set_vector(std::uint32_t field, Vec3 v) const {
    set_value(field, v.x);
    set_value(field + 1, v.y);
    set_value(field + 2, v.z);
  }
  __device__ float value(std::uint32_t field) const { return Memory::load(at, field * field_bytes); }
  __device__ void set_value(std::uint32_t field, float value) const { Memory::store(at, field * field_bytes, value); }

  // The sum of forces or corrections, in units of fixed point; it begins again at 0.
  __device__ int take_sum(std::uint32_t axis) const {
    return Memory::exchange(at, (field_sum + axis) * field_bytes, 0);
  }
  __device__ void set_sum(int sum) const {
    for (std::uint32_t axis = 0; axis < 3; ++axis) set_value(field_sum + axis, __int_as_float(sum));
  }
  __device__ void add_to_sum(int x, int y, int z) const {
    Memory::add(at, field_sum * field_bytes, x);
    Memory::add(at, (field_sum + 1) * field_bytes, y);
    Memory::add(at, (field_sum + 2) * field_bytes, z);
  }
  __device__ void add_to_sum(Vec3 units) const {
    add_to_sum(round_to_int(units.x), round_to_int(units.y), round_to_int(units.z));
  }
};

}  // namespace mercury::cuda
