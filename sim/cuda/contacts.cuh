// SPDX-License-Identifier: Apache-2.0
// Contacts: masses of a robot that are near each other without a spring between them repel (land).
//
//   every step        |  list of near pairs  -> which of them touch -> forces
//   now and then      |  how far has each mass moved since it was listed?
//   if too far        |  cell grid -> list of near pairs, without those that a spring joins
//
//   0          contact distance          list radius (block_layout.h)
//   |--------------- touch -----------------|------- listed --------|
//                                           |<------ margin ------->|
//
// 1. Searching the grid costs far more than reading the list, which is short or empty unless the robot folds up. Most
//    pairs that it finds may be joined by springs, as in water, where masses touch at nearly the distance of neighbors
//    in a lattice. So it writes down all of them, and then each thread looks up the springs of one pair.
// 2. The list can miss a pair only after one of its masses has moved half the margin. Each thread adds up the
//    farthest that one of its masses moved per step, which costs nothing but is often too much: what swings comes back,
//    and the whole robot travels. So when a sum reaches the limit, the true ways are computed, relative to the mean way
//    of some masses, from the positions at which the masses were listed. They replace the sums if all are below half
//    the limit.
// 3. If there are more pairs than the list holds, every step searches the grid.
// 4. Both ways find exactly the pairs that touch, and forces are summed as integers. So when the list was made does
//    not change a bit.
#pragma once

#include "sim/cuda/block_robot.cuh"
#include "sim/physics/contact.h"
#include "sim/physics/environments.h"

namespace mercury::cuda {

struct ContactMemory {
  std::uint32_t* count;  // pairs found, of which launch.listed_pairs fit
  std::uint32_t* pairs;  // ContactPass::packed()
  std::uint32_t* heads;  // [bucket], its first slot
  std::uint16_t* links;  // [slot], the next one in its bucket

  __device__ ContactMemory(char* list, char* grid, std::uint32_t buckets)
      : count(reinterpret_cast<std::uint32_t*>(list)), pairs(count + 1), heads(reinterpret_cast<std::uint32_t*>(grid)),
        links(reinterpret_cast<std::uint16_t*>(heads + buckets)) {}
  __device__ bool overflows(const LaunchConfiguration& launch) const {
    return *static_cast<volatile std::uint32_t*>(count) > launch.listed_pairs;
  }
};

// Calls visit(j) for every slot j within `radius` of slot i at x that comes after i, so each pair is visited once.
template <class Position, class Visit>
__device__ void for_each_near(const ContactMemory& memory, std::uint32_t buckets, float radius, std::uint32_t i, Vec3 x,
                              const Position& position, const Visit& visit) {
  const float inverse_size = 1 / radius;
  const Cell cell = cell_of(x, inverse_size);
  for (int n = 0; n < half_neighborhood; ++n) {
    const Cell other = cell + neighbor(n);
    for (std::uint32_t j = memory.heads[bucket_of(hash_of(other), buckets - 1)]; j != end_of_list;
         j = memory.links[j]) {
      if (n == 0 && j <= i) continue;
      const Vec3 xj = position(j);
      if (squared_length(xj - x) < radius * radius && cell_of(xj, inverse_size) == other) visit(j);
    }
  }
}

// A robot in parts (parts.h) has one grid for all of its parts, in device memory: of slots of the whole robot, and of
// the positions at which masses were listed. Each part lists the pairs whose first mass is its own. If the second one
// is another part's, the part reads and adds to that part's memory.

// Pairs within this many contact distances are listed, if lists are not verified.
inline constexpr float plain_list_radius = 1.5f;

// `verifies`: whether the true ways are computed. What is rarely needed is then not inline, so that it takes no
// registers from the steps. Bodies of the paper have registers to spare.
template <class Robot, bool verifies>
class ContactPass {
 public:
  __device__ explicit ContactPass(const Robot& robot) : memory_(address(robot)) {}

  // Makes the list of near pairs, or makes sure that it is still complete. All threads of the block must call it, since
  // it has barriers.
  __device__ void update_list(const Robot& robot, std::uint32_t step) {
    if constexpr (verifies) {
      const float farthest =
          has_list_ && collides(robot) ? farthest_since_listed(robot.arguments(), robot.context()) : 0;
      const bool complete =
          has_list_ && (!collides(robot) ||
                        (farthest < reach(robot) / 2 && !contact_memory(robot).overflows(robot.arguments().launch)));
      if (!any(robot, !complete, 1, step)) {
        traveled_ = farthest;
        return;
      }
      has_list_ = true;
    }
    traveled_ = 0;
    if constexpr (verifies)
      make_list_apart(robot.arguments(), robot.context());
    else
      make_list(robot, contact_memory(robot));
  }

  // No mass of this thread moved farther than this in a step [m].
  __device__ void moved(float farthest) { traveled_ += farthest; }
  // Whether the list of some thread may miss a pair in the next step.
  __device__ bool stale(const Robot& robot, std::uint32_t step) const {
    return any(
        robot,
        collides(robot) && (traveled_ > reach(robot) || contact_memory(robot).overflows(robot.arguments().launch)), 0,
        step);
  }

  // Adds the forces of all pairs that touch.
  __device__ void add(const Robot& robot) const {
    if (!collides(robot)) return;
    const ContactMemory memory = contact_memory(robot);
    if (memory.overflows(robot.arguments().launch)) {
      if constexpr (verifies)
        add_by_search_apart(robot.arguments(), robot.context());
      else
        add_by_search(robot, memory);
      return;
    }
    const std::uint32_t count = *memory.count;
    for (std::uint32_t p = robot.thread(); p < count; p += robot.threads()) add_pair(robot, memory.pairs[p]);
  }
  // Before everything else; a barrier follows.
  __device__ static void begin(const Robot& robot) {
    if constexpr (in_parts)
      if (robot.thread() < 2) votes(robot)[robot.thread()] = 0;
  }

 private:
  static constexpr bool in_parts = Robot::Memory::in_parts;
  static_assert(verifies || !in_parts || !Robot::Memory::finds_contacts,
                "robots in parts need the positions at which masses were listed");
  using Context = ThreadContext<typename Robot::Memory>;

  __device__ static float list_radius(const Robot& robot) {
    if constexpr (verifies)
      return robot.stored_header().list_radius;
    else
      return plain_list_radius * robot.header().contact_distance;
  }
  // How far a mass may go before the list must be made again [m]: half the margin, less 1 % for rounding.
  __device__ static float reach(const Robot& robot) {
    if constexpr (verifies)
      return 0.99f * (list_radius(robot) - robot.header().contact_distance) / 2;
    else
      return 0.99f * (plain_list_radius - 1) / 2 * robot.header().contact_distance;
  }

  // Of this thread's masses, relative to the mean way of 32 masses from all over the robot [m].
  __device__ __noinline__ static float farthest_since_listed(const StepArguments& arguments, Context context) {
    const Robot robot(arguments, context);
    const auto way_of = [&](std::uint32_t slot, Vec3 x) { return x - listed_position(robot, slot); };
    const std::uint32_t sample = context.lane * robot.stored_header().masses / lanes;
    Vec3 mean = (1.0f / lanes) * way_of(sample, position_of(robot, other_of(robot, sample)));
    for (std::uint32_t half = lanes / 2; half > 0; half /= 2)
      mean = mean + Vec3{__shfl_xor_sync(0xffffffffu, mean.x, half), __shfl_xor_sync(0xffffffffu, mean.y, half),
                         __shfl_xor_sync(0xffffffffu, mean.z, half)};
    float squared = 0;
    for (std::uint32_t tile = robot.first_tile(); tile < robot.last_tile(); ++tile)
      if (robot.has_mass(tile))
        squared = fmaxf(squared, squared_length(way_of(robot.slot_in_robot(robot.own_slot(tile)),
                                                       robot.own_mass(tile).vector(field_x)) -
                                                mean));
    return sqrtf(squared);
  }

  __device__ __noinline__ static void add_by_search_apart(const StepArguments& arguments, Context context) {
    const Robot robot(arguments, context);
    add_by_search(robot, memory_of(robot, address(robot)));
  }
  __device__ static void add_by_search(const Robot& robot, const ContactMemory& memory) {
    for_each_near_pair(robot, memory, [&](std::uint32_t i, Vec3 x, std::uint32_t j) {
      if (touches(robot, position_in_grid(robot, j) - x) && !joined(robot, i, j)) add_pair(robot, packed(robot, i, j));
    });
  }

  __device__ __noinline__ static void make_list_apart(const StepArguments& arguments, Context context) {
    const Robot robot(arguments, context);
    make_list(robot, memory_of(robot, address(robot)));
  }
  __device__ static void make_list(const Robot& robot, const ContactMemory& memory) {
    fill_grid(robot, memory);
    const auto list = [&](std::uint32_t i, std::uint32_t j) {
      if (joined(robot, i, j)) return;
      const std::uint32_t index = atomicAdd(memory.count, 1u);
      if (index < robot.arguments().launch.listed_pairs) memory.pairs[index] = packed(robot, i, j);
    };
    const auto list_near = [&] {
      if (collides(robot))
        for_each_near_pair(robot, memory, [&](std::uint32_t i, Vec3, std::uint32_t j) { list(i, j); });
    };
    if constexpr (verifies) {
      const std::uint32_t most = near_pairs_per_slot * robot.header().tiles * lanes;
      const std::uint32_t found = write_near_pairs(robot, memory, most);
      const std::uint32_t* const near = near_pairs(robot);
      if (found > most)
        list_near();
      else
        for (std::uint32_t p = robot.thread(); p < found; p += robot.threads()) list(near[p] >> 16, near[p] & 0xffff);
    } else {
      list_near();
    }
    robot_barrier<typename Robot::Memory>();
  }

  // Between barriers.
  __device__ static void fill_grid(const Robot& robot, const ContactMemory& memory) {
    const std::uint32_t parts = in_parts ? robot.arguments().launch.parts : 1;
    for (std::uint32_t b = robot.part() * robot.threads() + robot.thread(); b < buckets(robot);
         b += parts * robot.threads())
      memory.heads[b] = end_of_list;
    if (robot.thread() == 0) *memory.count = 0;
    robot_barrier<typename Robot::Memory>();
    const float inverse_size = 1 / list_radius(robot);
    for (std::uint32_t tile = robot.first_tile(); collides(robot) && tile < robot.last_tile(); ++tile) {
      if (!robot.has_mass(tile)) continue;
      const std::uint32_t slot = robot.slot_in_robot(robot.own_slot(tile));
      const Vec3 x = robot.own_mass(tile).vector(field_x);
      if constexpr (verifies) {
        float* const listed = listed_positions(robot) + 3 * slot;
        listed[0] = x.x;
        listed[1] = x.y;
        listed[2] = x.z;
      }
      const std::uint32_t bucket = bucket_of(hash_of(cell_of(x, inverse_size)), buckets(robot) - 1);
      memory.links[slot] = static_cast<std::uint16_t>(atomicExch(memory.heads + bucket, slot));
    }
    robot_barrier<typename Robot::Memory>();
  }

  // Writes down all pairs within the list radius, or `most` of them. Returns their number.
  __device__ static std::uint32_t write_near_pairs(const Robot& robot, const ContactMemory& memory,
                                                   std::uint32_t most) {
    std::uint32_t* const near = near_pairs(robot);
    if (collides(robot))
      for_each_near_pair(robot, memory, [&](std::uint32_t i, Vec3, std::uint32_t j) {
        const std::uint32_t index = atomicAdd(memory.count, 1u);
        if (index < most) near[index] = i << 16 | j;
      });
    __syncthreads();
    const std::uint32_t found = *static_cast<volatile std::uint32_t*>(memory.count);
    __syncthreads();
    if (robot.thread() == 0) *memory.count = 0;
    __syncthreads();
    return found;
  }

  // Whether the predicate of any thread of the block is true, or of all parts of the robot. These vote by the number of
  // the step; between two votes of a kind, there is another barrier.
  __device__ static bool any(const Robot& robot, bool predicate, std::uint32_t kind, std::uint32_t step) {
    const bool in_block = __syncthreads_or(predicate);
    if constexpr (in_parts) {
      using Memory = typename Robot::Memory;
      const std::uint32_t vote = shared_address(votes(robot) + kind);
      if (in_block && robot.thread() < robot.arguments().launch.parts)
        Memory::raise_there(Memory::of_part(vote, robot.thread()), step + 1);
      robot_barrier<Memory>();
      return *static_cast<volatile std::uint32_t*>(votes(robot) + kind) == step + 1;
    }
    return in_block;
  }
  // [kind], the step before which a part last voted, plus 1.
  __device__ static std::uint32_t* votes(const Robot& robot) {
    return reinterpret_cast<std::uint32_t*>(address(robot) - contact_vote_bytes);
  }

  // A pair of this thread's slot and a slot of the grid, as the list has it: 16 bits each; in parts 13 bits each after
  // the part of the second one, in whose memory that one's slot is.
  __device__ static std::uint32_t packed(const Robot& robot, std::uint32_t i, std::uint32_t j) {
    if constexpr (!in_parts) return i << 16 | j;
    const std::uint32_t other = other_of(robot, j);
    return (other >> 16) << 26 | i << 13 | (other & 0xffff);
  }
  // Where the mass of a slot of the grid is: the slot, or part << 16 | slot in that part.
  __device__ static std::uint32_t other_of(const Robot& robot, std::uint32_t j) {
    if constexpr (in_parts) return robot.place_of(j);
    return j;
  }
  __device__ static typename Robot::Memory::Address address_of(const Robot& robot, std::uint32_t other) {
    if constexpr (in_parts) return Robot::Memory::of_part(robot.mass_at(other & 0xffff).at, other >> 16);
    return robot.mass_at(other).at;
  }
  __device__ static Vec3 position_of(const Robot& robot, std::uint32_t other) {
    const auto at = address_of(robot, other);
    if constexpr (in_parts)
      return {Robot::Memory::load_there(at, 0), Robot::Memory::load_there(at, field_bytes),
              Robot::Memory::load_there(at, 2 * field_bytes)};
    else
      return Mass<typename Robot::Memory>{at}.vector(field_x);
  }
  // In the grid of a robot in parts, that at which the mass was listed.
  __device__ static Vec3 position_in_grid(const Robot& robot, std::uint32_t j) {
    if constexpr (in_parts) return listed_position(robot, j);
    return robot.mass_at(j).vector(field_x);
  }
  __device__ static Vec3 listed_position(const Robot& robot, std::uint32_t slot) {
    const float* const x = listed_positions(robot) + 3 * slot;
    return {x[0], x[1], x[2]};
  }

  __device__ static std::uint32_t buckets(const Robot& robot) { return robot.arguments().launch.contact_buckets; }
  __device__ static bool collides(const Robot& robot) {
    return buckets(robot) > 0 && robot.header().contact_distance > 0;
  }

  // In device memory: contacts that do not fit on the chip, or the grid of a robot in parts; then
  // contact_workspace_bytes().
  __device__ static char* workspace(const Robot& robot) {
    const BatchView& batch = robot.arguments().batch;
    char* const begin = batch.workspace + std::size_t{robot.context().robot} * batch.workspace_stride;
    return begin + (Robot::Memory::on_chip ? 0 : batch.tile_stride * Robot::tile_bytes);
  }
  __device__ static char* address(const Robot& robot) {
    const LaunchConfiguration& launch = robot.arguments().launch;
    if constexpr (in_parts)
      return shared_memory + block_layout(launch, robot.arguments().batch.tile_stride, Robot::fields).contacts -
             contact_list_bytes(launch);
    if (!launch.contacts_on_chip) return workspace(robot);
    const std::uint32_t tiles = robot.arguments().batch.tile_stride;
    const std::uint32_t number = threadIdx.x / lanes / launch.warps_per_robot;
    return shared_memory + block_layout(launch, tiles, Robot::fields).relaxation_times +
           number * contact_bytes(launch, tiles);
  }
  // Found again where registers are scarce.
  __device__ ContactMemory contact_memory(const Robot& robot) const {
    return memory_of(robot, verifies ? address(robot) : memory_);
  }
  __device__ static ContactMemory memory_of(const Robot& robot, char* list) {
    return {list, in_parts ? workspace(robot) : list + contact_list_bytes(robot.arguments().launch), buckets(robot)};
  }
  // [slot of the grid][3], when the list was made [m].
  __device__ static float* listed_positions(const Robot& robot) {
    const BatchView& batch = robot.arguments().batch;
    std::uint32_t before = 0;
    if constexpr (in_parts)
      before = contact_grid_bytes(buckets(robot), batch.parts.robot_tile_stride);
    else if (!robot.arguments().launch.contacts_on_chip)
      before = contact_bytes(robot.arguments().launch, batch.tile_stride);
    return reinterpret_cast<float*>(workspace(robot) + before);
  }
  __device__ static std::uint32_t* near_pairs(const Robot& robot) {
    const BatchView& batch = robot.arguments().batch;
    const std::uint32_t tiles = in_parts ? batch.parts.robot_tile_stride : batch.tile_stride;
    return reinterpret_cast<std::uint32_t*>(listed_positions(robot) + 3 * tiles * lanes) +
           robot.part() * near_pairs_per_slot * batch.tile_stride * lanes;
  }

  // Calls visit(i, x_i, j) for every pair within the list radius whose slot i is one of this thread's; j is a slot of
  // the grid.
  template <class Visit>
  __device__ static void for_each_near_pair(const Robot& robot, const ContactMemory& memory, const Visit& visit) {
    const auto position = [&](std::uint32_t j) { return position_in_grid(robot, j); };
    for (std::uint32_t tile = robot.first_tile(); tile < robot.last_tile(); ++tile) {
      if (!robot.has_mass(tile)) continue;
      const std::uint32_t i = robot.own_slot(tile);
      const Vec3 x = robot.own_mass(tile).vector(field_x);
      for_each_near(memory, buckets(robot), list_radius(robot), robot.slot_in_robot(i), x, position,
                    [&](std::uint32_t j) { visit(i, x, j); });
    }
  }

  __device__ static bool touches(const Robot& robot, Vec3 d) {
    return squared_length(d) < robot.header().contact_distance * robot.header().contact_distance;
  }

  __device__ static void add_pair(const Robot& robot, std::uint32_t pair) {
    const std::uint32_t i = in_parts ? pair >> 13 & 0x1fff : pair >> 16;
    const std::uint32_t other = in_parts ? (pair >> 26) << 16 | (pair & 0x1fff) : pair & 0xffff;
    const Vec3 d = position_of(robot, other) - robot.mass_at(i).vector(field_x);
    if (!touches(robot, d)) return;
    const Vec3 units =
        repulsion(squared_length(d), robot.header().contact_distance, robot.stored_header().contact_units) * d;
    robot.mass_at(i).add_to_sum(units);
    if constexpr (in_parts) {
      const auto sum = address_of(robot, other) + field_sum * field_bytes;
      Robot::Memory::add_there(sum, 0, round_to_int(-units.x));
      Robot::Memory::add_there(sum, field_bytes, round_to_int(-units.y));
      Robot::Memory::add_there(sum, 2 * field_bytes, round_to_int(-units.z));
    } else {
      robot.mass_at(other).add_to_sum(-units);
    }
  }

  __device__ static bool joined(const Robot& robot, std::uint32_t i, std::uint32_t j) {
    if constexpr (in_parts) {
      const std::uint32_t other = other_of(robot, j);
      if (other >> 16 != robot.part()) return owns_to_ghost(robot, i, j);
      j = other & 0xffff;
    }
    return owns(robot, i, j) || owns(robot, j, i);
  }

  // Whether slot i owns a spring to a ghost of slot j of the grid. A spring to another part has its owner here.
  __device__ static bool owns_to_ghost(const Robot& robot, std::uint32_t i, std::uint32_t j) {
    const auto* spring = robot.springs() + i % lanes;
    const std::uint32_t last = robot.row_start()[i / lanes + 1];
    for (std::uint32_t row = robot.row_start()[i / lanes]; row < last; ++row) {
      const std::uint32_t key = spring[std::size_t{row} * lanes].x;
      if ((key & 0xff) != air && robot.slot_in_robot(slot_at_offset(key >> 16, Robot::fields)) == j) return true;
    }
    return false;
  }

  // Whether slot i owns a spring to slot j.
  __device__ static bool owns(const Robot& robot, std::uint32_t i, std::uint32_t j) {
    const std::uint32_t wanted = Robot::Memory::on_chip ? Robot::byte_offset(j) / 4 : j, tile = i / lanes;
    const auto* spring = robot.springs() + i % lanes;
    if constexpr (verifies) {
      const std::uint32_t last = robot.row_start()[tile + 1];
      bool found = false;
      // Without a way out of the loop, so that loads need not wait for each other.
#pragma unroll 8
      for (std::uint32_t row = robot.row_start()[tile]; row < last; ++row) {
        const std::uint32_t key = spring[std::size_t{row} * lanes].x;
        found |= key >> 16 == wanted && (key & 0xff) != air;
      }
      return found;
    } else {
      for (std::uint32_t row = robot.row_start()[tile]; row < robot.row_start()[tile + 1]; ++row) {
        const std::uint32_t key = spring[std::size_t{row} * lanes].x;
        if (key >> 16 == wanted && (key & 0xff) != air) return true;
      }
      return false;
    }
  }

  char* const memory_;
  bool has_list_ = false;
  float traveled_ = 0;  // upper bound for this thread's masses since then [m]
};

}  // namespace mercury::cuda
