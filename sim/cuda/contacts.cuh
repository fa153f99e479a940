// SPDX-License-Identifier: Apache-2.0
// Contacts: masses of a robot that are near each other without a spring between them repel (land).
//
//   every step        |  list of near pairs  -> which of them touch -> forces
//   now and then      |  cell grid -> list of near pairs, without those that a spring joins
//
//   0          contact distance        list_radius = 1.5 contact distances
//   |--------------- touch -----------------|------- listed --------|
//                                           |<-- margin: 0.5 ------>|
//
// 1. Searching the grid costs far more than reading the list, which is short or empty unless the robot folds up.
// 2. The list can miss a pair only after one of its masses has moved half the margin. Each thread adds up the
//    farthest that one of its masses moved per step; the list is made again when a sum reaches list_reach.
// 3. If there are more pairs than the list holds, every step searches the grid.
// 4. Both ways find exactly the pairs that touch, and forces are summed as integers. So when the list was made does
//    not change a bit.
#pragma once

#include "sim/cuda/block_robot.cuh"
#include "sim/physics/contact.h"
#include "sim/physics/environments.h"

namespace mercury::cuda {

// Pairs within this many contact distances are listed.
inline constexpr float list_radius = 1.5f;
// How far a mass may go before the list is made again, in contact distances: half the margin, less 1 % for rounding.
inline constexpr float list_reach = 0.99f * (list_radius - 1) / 2;

struct ContactMemory {
  std::uint32_t* count;  // pairs found, of which contact_list_size fit
  std::uint32_t* pairs;  // i << 16 | j
  std::uint32_t* heads;  // [bucket], its first slot
  std::uint16_t* links;  // [slot], the next one in its bucket

  __device__ ContactMemory(char* memory, std::uint32_t buckets)
      : count(reinterpret_cast<std::uint32_t*>(memory)), pairs(count + 1), heads(pairs + contact_list_size),
        links(reinterpret_cast<std::uint16_t*>(heads + buckets)) {}
  __device__ bool overflows() const { return *static_cast<volatile std::uint32_t*>(count) > contact_list_size; }
};

// Calls visit(j) for every slot j within list_radius of slot i at x that comes after i, so each pair is visited once.
template <class Position, class Visit>
__device__ void for_each_near(const ContactMemory& memory, std::uint32_t buckets, float distance, std::uint32_t i,
                              Vec3 x, const Position& position, const Visit& visit) {
  const float radius = list_radius * distance, inverse_size = 1 / radius;
  const Cell cell = cell_of(x, inverse_size);
  for (int n = 0; n < half_neighborhood; ++n) {
    const Cell other = neighbor_cell(cell, n);
    for (std::uint32_t j = memory.heads[bucket_of(other, buckets - 1)]; j != end_of_list; j = memory.links[j]) {
      if (n == 0 && j <= i) continue;
      const Vec3 xj = position(j);
      if (squared_length(xj - x) < radius * radius && cell_of(xj, inverse_size) == other) visit(j);
    }
  }
}

template <class Robot>
class ContactPass {
 public:
  __device__ explicit ContactPass(char* memory) : memory_(memory) {}

  // Makes the list of near pairs. All threads of the block must call it, since it has barriers.
  __device__ void make_list(const Robot& robot) {
    const ContactMemory memory = contact_memory(robot);
    traveled_ = 0;
    for (std::uint32_t b = robot.thread(); b < buckets(robot); b += robot.threads()) memory.heads[b] = end_of_list;
    if (robot.thread() == 0) *memory.count = 0;
    __syncthreads();
    const float inverse_size = 1 / (list_radius * robot.header().contact_distance);
    for (std::uint32_t tile = robot.first_tile(); collides(robot) && tile < robot.last_tile(); ++tile) {
      if (!robot.has_mass(tile)) continue;
      const std::uint32_t slot = robot.own_slot(tile);
      const Cell cell = cell_of(robot.own_mass(tile).vector(field_x), inverse_size);
      const std::uint32_t bucket = bucket_of(cell, buckets(robot) - 1);
      memory.links[slot] = static_cast<std::uint16_t>(atomicExch(memory.heads + bucket, slot));
    }
    __syncthreads();
    if (collides(robot))
      for_each_near_pair(robot, [&](std::uint32_t i, Vec3, std::uint32_t j) {
        if (joined(robot, i, j)) return;
        const std::uint32_t index = atomicAdd(memory.count, 1u);
        if (index < contact_list_size) memory.pairs[index] = i << 16 | j;
      });
    __syncthreads();
  }

  // No mass of this thread moved farther than this in a step [m].
  __device__ void moved(float farthest) { traveled_ += farthest; }
  // Whether the list must be made again before the next step.
  __device__ bool stale(const Robot& robot) const {
    return collides(robot) &&
           (traveled_ > list_reach * robot.header().contact_distance || contact_memory(robot).overflows());
  }

  // Adds the forces of all pairs that touch.
  __device__ void add(const Robot& robot) const {
    if (!collides(robot)) return;
    const ContactMemory memory = contact_memory(robot);
    if (memory.overflows()) {
      for_each_near_pair(robot, [&](std::uint32_t i, Vec3 x, std::uint32_t j) {
        if (touches(robot, robot.mass_at(j).vector(field_x) - x) && !joined(robot, i, j)) add_pair(robot, i, j);
      });
      return;
    }
    const std::uint32_t count = *memory.count;
    for (std::uint32_t p = robot.thread(); p < count; p += robot.threads())
      add_pair(robot, memory.pairs[p] >> 16, memory.pairs[p] & 0xffff);
  }

 private:
  __device__ static std::uint32_t buckets(const Robot& robot) { return robot.arguments().launch.contact_buckets; }
  __device__ static bool collides(const Robot& robot) {
    return buckets(robot) > 0 && robot.header().contact_distance > 0 && robot.header().contact_stiffness > 0;
  }
  __device__ ContactMemory contact_memory(const Robot& robot) const { return {memory_, buckets(robot)}; }

  // Calls visit(i, x_i, j) for every pair within list_radius whose slot i is one of this thread's.
  template <class Visit>
  __device__ void for_each_near_pair(const Robot& robot, const Visit& visit) const {
    const auto position = [&](std::uint32_t j) { return robot.mass_at(j).vector(field_x); };
    for (std::uint32_t tile = robot.first_tile(); tile < robot.last_tile(); ++tile) {
      if (!robot.has_mass(tile)) continue;
      const std::uint32_t i = robot.own_slot(tile);
      const Vec3 x = robot.own_mass(tile).vector(field_x);
      for_each_near(contact_memory(robot), buckets(robot), robot.header().contact_distance, i, x, position,
                    [&](std::uint32_t j) { visit(i, x, j); });
    }
  }

  __device__ static bool touches(const Robot& robot, Vec3 d) {
    return squared_length(d) < robot.header().contact_distance * robot.header().contact_distance;
  }

  __device__ static void add_pair(const Robot& robot, std::uint32_t i, std::uint32_t j) {
    const Vec3 d = robot.mass_at(j).vector(field_x) - robot.mass_at(i).vector(field_x);
    if (!touches(robot, d)) return;
    const float stiffness = robot.header().contact_stiffness * robot.header().force_scale;
    const Vec3 units = repulsion(squared_length(d), robot.header().contact_distance, stiffness) * d;
    robot.mass_at(i).add_to_sum(units);
    robot.mass_at(j).add_to_sum(-units);
  }

  __device__ static bool joined(const Robot& robot, std::uint32_t i, std::uint32_t j) {
    return owns(robot, i, j) || owns(robot, j, i);
  }

  // Whether slot i owns a spring to slot j.
  __device__ static bool owns(const Robot& robot, std::uint32_t i, std::uint32_t j) {
    const std::uint32_t wanted = Robot::Memory::on_chip ? Robot::byte_offset(j) / 4 : j, tile = i / lanes;
    const auto* spring = robot.springs() + i % lanes;
    for (std::uint32_t row = robot.row_start()[tile]; row < robot.row_start()[tile + 1]; ++row) {
      const std::uint32_t key = spring[std::size_t{row} * lanes].x;
      if (key >> 16 == wanted && (key & 0xff) != air) return true;
    }
    return false;
  }

  char* const memory_;
  float traveled_ = 0;  // upper bound for this thread's masses since the list was made [m]
};

}  // namespace mercury::cuda
