// SPDX-License-Identifier: Apache-2.0
// Contacts: masses of a robot that are near each other without a spring between them repel (land).
//
//   every step        |  list of near pairs  -> which of them touch -> forces
//   now and then      |  how far has each mass moved since it was listed?
//   if too far        |  comparisons, or a cell grid -> list of near pairs, without those that a spring joins
//
//   0          contact distance          list radius (block_layout.h)
//   |--------------- touch -----------------|------- listed --------|
//                                           |<------ margin ------->|
//
// 1. Making a list costs far more than reading it, which is short or empty unless the robot folds up. Most pairs that
//    are near may be joined by springs, as in water, where masses touch at nearly the distance of neighbors in a
//    lattice. Small robots compare all of their masses with each other, and have a bit for each pair that is joined.
//    Large ones search a grid and write down all near pairs; then each thread looks up the springs of one pair.
// 2. The list can miss a pair only after one of its masses has moved half the margin, its reach. Each thread subtracts
//    from that the farthest that one of its masses moved in each step, which costs nothing but is often too much: what
//    swings comes back, and the whole robot travels. So when nothing is left, the true ways are computed, relative to
//    the mean way of some masses, from the positions at which the masses were listed. They replace the sums if all are
//    below half the reach, lest the list is stale again soon. They are computed after a report and when a launch
//    begins, too, since the steps have stopped; then all that is below the reach will do.
// 3. If there are more pairs than the list holds, every step finds them and adds their forces at once.
// 4. All ways find exactly the pairs that touch, and forces are summed as integers. So when the list was made does
//    not change a bit.
// 5. The list is in device memory, as is what it is verified by. So it outlives a launch, and the state may be changed
//    between two of them. A new one is made if robots or what they collide by have changed (SizeClass::keeps_lists()).
#pragma once

#include "sim/cuda/block_robot.cuh"
#include "sim/physics/contact.h"
#include "sim/physics/environments.h"

namespace mercury::cuda {

// Slots sorted by their cells. A row of cells along x has consecutive buckets, so that the masses of three neighbors
// follow one another:
//
//   bucket of a cell = x + row y + row^2 z, modulo the number of buckets
//
// Other cells may share a bucket; the distance test rejects their masses. The 27 buckets around a cell differ, so that
// each pair is found once. The order in a bucket depends on timing, which does not matter, as sums are integers.
struct ContactGrid {
  std::uint32_t* ends;     // [bucket], in `sorted`
  std::uint32_t* of_warp;  // [warp], while buckets are summed
  std::uint16_t* sorted;   // [mass], slots by bucket
  std::uint32_t mask, row;

  __device__ ContactGrid(char* at, std::uint32_t buckets)
      : ends(reinterpret_cast<std::uint32_t*>(at)), of_warp(ends + buckets),
        sorted(reinterpret_cast<std::uint16_t*>(of_warp + lanes)), mask(buckets - 1), row(3) {
    while ((row + 1) * (row + 1) * (row + 1) <= buckets) ++row;
  }
  __device__ std::uint32_t bucket_at(Vec3 x, float inverse_size) const {
    const Cell cell = cell_of(x, inverse_size);
    return (static_cast<std::uint32_t>(cell.x) + static_cast<std::uint32_t>(cell.y) * row +
            static_cast<std::uint32_t>(cell.z) * row * row) &
           mask;
  }
  __device__ std::uint32_t start_of(std::uint32_t bucket) const { return bucket == 0 ? 0 : ends[bucket - 1]; }
};

// Cells are wider than the radius, so that no pair within it is in cells further apart by rounding.
__device__ inline float inverse_cell_size(float radius) { return 1 / (1.01f * radius); }

// Calls visit(j) for every slot j within `radius` of slot i at x that comes after i, so each pair is visited once. The
// grid has `masses` slots.
template <class Position, class Visit>
__device__ void for_each_near(const ContactGrid& grid, std::uint32_t masses, float radius, std::uint32_t i, Vec3 x,
                              const Position& position, const Visit& visit) {
  const std::uint32_t own = grid.bucket_at(x, inverse_cell_size(radius));
  // The cell itself and the next one, then the rows at (y + 1, z), (y - 1, z + 1), (y, z + 1), (y + 1, z + 1).
  for (std::uint32_t n = 0; n < 5; ++n) {
    const std::uint32_t middle = own + (n == 0 ? 0 : n == 1 ? grid.row : (grid.row + n - 3) * grid.row);
    const std::uint32_t first = (n == 0 ? middle : middle - 1) & grid.mask, last = (middle + 1) & grid.mask;
    const std::uint32_t start = grid.start_of(first);
    const std::uint32_t count = grid.ends[last] + (first <= last ? 0 : masses) - start;
    const std::uint32_t of_own = n == 0 ? grid.ends[own] - start : 0;
    for (std::uint32_t k = 0; k < count; ++k) {
      const std::uint32_t at = start + k, j = grid.sorted[at < masses ? at : at - masses];
      if (k < of_own && j <= i) continue;
      if (squared_length(position(j) - x) < radius * radius) visit(j);
    }
  }
}

// A robot in parts (parts.h) has one grid for all of its parts, in device memory: of slots of the whole robot, and of
// the positions at which masses were listed. Each part lists the pairs whose first mass is its own. If the second one
// is another part's, the part reads and adds to that part's memory.

// What is rarely needed is not inline, so that it takes no registers from the steps.
template <class Robot>
class ContactPass {
 public:
  // Before everything else, by all threads; a barrier follows.
  __device__ static void begin(const Robot& robot, RobotRecord& record) {
    if (robot.thread() != 0) return;
    const bool finds = buckets(robot) > 0;
    record.pairs = finds ? listed_pairs(robot) : nullptr;
    record.pair_count = !finds ? 0 : robot.arguments().lists_kept ? *kept_count(robot) : not_listed;
    record.votes[0] = record.votes[1] = 0;
  }
  // After everything else: leaves the list to the next launch.
  __device__ static void keep_list(const Robot& robot, const RobotRecord& record) {
    if (robot.thread() == 0) *kept_count(robot) = collides(robot, record) ? record.pair_count : not_listed;
  }

  // Before a step: makes the list of near pairs, or makes sure that it is still complete. Returns how far the masses of
  // this thread may go from now on [m]: below 0 if the list is too short for all pairs, whose forces have been added
  // then. All threads of the block must call it, since it has barriers.
  __device__ static float update_list(const Robot& robot, RobotRecord& record, std::uint32_t step) {
    return update_list_apart(robot.arguments(), robot.context(), record, step);
  }
  __device__ void use_list(float reach) { left_ = reach; }
  // No mass of this thread moved farther than this in a step [m].
  __device__ void moved(float farthest) { left_ -= farthest; }
  // Whether the list of some thread may miss a pair in the next step.
  __device__ bool stale(const Robot& robot, RobotRecord& record, std::uint32_t step) const {
    return any(robot, left_ < 0, record.votes[0], step);
  }

  // Adds the forces of all listed pairs that touch.
  __device__ static void add(const Robot& robot, const RobotRecord& record) {
    const std::uint32_t count = record.pair_count;
    if (count > most_pairs(robot)) return;  // update_list() has added them
    for (std::uint32_t p = robot.thread(); p < count; p += robot.threads()) add_pair(robot, record.pairs[p]);
  }

 private:
  static constexpr bool in_parts = Robot::Memory::in_parts;
  static constexpr std::uint32_t not_listed = 0xffffffff;
  using Context = ThreadContext<typename Robot::Memory>;

  // Whether masses are compared with each other, not found by the grid.
  __device__ static bool compares(const Robot& robot) {
    if constexpr (Robot::Memory::on_chip && !in_parts)
      return robot.arguments().batch.tile_stride <= most_compared_tiles;
    else
      return false;
  }
  __device__ static bool collides(const Robot& robot, const RobotRecord& record) {
    return robot.stored_header().contact_distance > 0 && !record.failure.happened();
  }

  __device__ static float list_radius(const Robot& robot) { return robot.stored_header().list_radius; }
  // How far a mass may go before the list must be made again [m]: half the margin, less 1 % for rounding.
  __device__ static float reach(const Robot& robot) {
    return 0.99f * (list_radius(robot) - robot.header().contact_distance) / 2;
  }

  // As many as can be written down, or listed.
  __device__ static std::uint32_t most_pairs(const Robot& robot) {
    return near_pairs_per_slot * robot.arguments().batch.tile_stride * lanes;
  }

  __device__ __noinline__ static float update_list_apart(const StepArguments& arguments, Context context,
                                                         RobotRecord& record, std::uint32_t step) {
    const Robot robot(arguments, context);
    const bool collides = ContactPass::collides(robot, record);
    float farthest = 0;
    bool complete = !collides || count_of(record) != not_listed;
    if (complete && collides) {
      farthest = farthest_since_listed(robot);
      const bool is_stale = step > 0 && !arguments.reports.follow(step);
      complete = farthest < reach(robot) * (is_stale ? 0.5f : 1.0f) && count_of(record) <= most_pairs(robot);
    }
    if (any(robot, !complete, record.votes[1], step)) {
      if (compares(robot))
        list_by_comparing(robot, record, collides);
      else
        make_list(robot, record, collides);
      farthest = 0;
    }
    if (!collides) return __builtin_huge_valf();
    if (count_of(record) <= most_pairs(robot)) return reach(robot) - farthest;
    if (compares(robot))
      for_each_unjoined(robot, robot.header().contact_distance,
                        [&](std::uint32_t i, std::uint32_t j) { add_pair(robot, packed(robot, i, j)); });
    else
      add_by_search(robot);
    return -1;
  }
  __device__ static std::uint32_t count_of(const RobotRecord& record) {
    return *static_cast<const volatile std::uint32_t*>(&record.pair_count);
  }

  // Of this thread's masses, relative to the mean way of 32 masses from all over the robot [m].
  __device__ static float farthest_since_listed(const Robot& robot) {
    const auto way_of = [&](std::uint32_t slot, Vec3 x) { return x - listed_position(robot, slot); };
    const std::uint32_t sample = robot.context().lane * robot.stored_header().masses / lanes;
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

  __device__ static void add_by_search(const Robot& robot) {
    for_each_near_pair(robot, [&](std::uint32_t i, Vec3 x, std::uint32_t j) {
      if (touches(robot, position_in_grid(robot, j) - x) && !joined(robot, i, j)) add_pair(robot, packed(robot, i, j));
    });
  }

  // Robots of a block meet at the same barriers, here and in make_list(), whatever they have found.
  __device__ static void list_by_comparing(const Robot& robot, RobotRecord& record, bool collides) {
    const bool marks = collides && count_of(record) == not_listed;
    if (marks)
      for (std::uint32_t k = robot.thread(); k < words_of_pairs(robot); k += robot.threads())
        joined_pairs(robot)[k] = 0;
    __syncthreads();
    if (marks) mark_joined(robot);
    if (robot.thread() == 0) record.pair_count = 0;
    if (collides) store_positions(robot);
    __syncthreads();
    const std::uint32_t most = most_pairs(robot);
    if (collides)
      for_each_unjoined(robot, list_radius(robot), [&](std::uint32_t i, std::uint32_t j) {
        const std::uint32_t index = atomicAdd(&record.pair_count, 1u);
        if (index < most) record.pairs[index] = packed(robot, i, j);
      });
    __syncthreads();
  }

  // Sets the bits of the pairs that springs join, in both orders: bit j mod 32 of [j / 32][i].
  __device__ static void mark_joined(const Robot& robot) {
    const std::uint32_t slots = robot.arguments().batch.tile_stride * lanes;
    const auto mark = [&](std::uint32_t i, std::uint32_t j) {
      atomicOr(joined_pairs(robot) + j / lanes * slots + i, 1u << j % lanes);
    };
    for (std::uint32_t tile = robot.first_tile(); tile < robot.last_tile(); ++tile)
      robot.for_each_spring_of(robot.own_slot(tile), [&](const auto& record) {
        const std::uint32_t i = robot.own_slot(tile), j = robot.partner_slot_of(record);
        mark(i, j);
        mark(j, i);
      });
  }

  // Calls visit(i, j) for every pair of slots i < j within `radius` that no spring joins. A warp compares the masses of
  // two tiles: each lane one mass of the first with all of the second, which all lanes read together.
  template <class Visit>
  __device__ static void for_each_unjoined(const Robot& robot, float radius, const Visit& visit) {
    if constexpr (Robot::Memory::on_chip && !in_parts) {
      const std::uint32_t masses = robot.stored_header().masses, tiles = robot.stored_header().tiles,
                          slots = robot.arguments().batch.tile_stride * lanes, lane = robot.context().lane;
      const auto masses_of = [&](std::uint32_t tile) {  // a bit for each
        const std::uint32_t count = masses - tile * lanes;
        return count >= lanes ? ~0u : (1u << count) - 1;
      };
      for (std::uint32_t first = 0, second = robot.context().warp;; second += robot.warps()) {
        while (first < tiles && second >= tiles) second += ++first - tiles;  // pairs (first, second >= first) in turn
        if (first >= tiles) return;
        const std::uint32_t i = first * lanes + lane;
        std::uint32_t open = masses_of(second) & ~__ldcg(joined_pairs(robot) + second * slots + i);
        if (first == second) open &= lane == lanes - 1 ? 0 : ~0u << (lane + 1);
        if (!(masses_of(first) >> lane & 1)) open = 0;
        const Vec3 x = robot.mass_at(i).vector(field_x);
        const std::uint32_t others = robot.mass_at(second * lanes).at;
        std::uint32_t near = 0;
#pragma unroll 4
        for (std::uint32_t k = 0; k < lanes; k += 4) {
          const float4 xs = load_four(others + 4 * k), ys = load_four(others + 4 * k + field_bytes),
                       zs = load_four(others + 4 * k + 2 * field_bytes);
          const auto test = [&](std::uint32_t bit, float x2, float y2, float z2) {
            if (squared_length(Vec3{x2, y2, z2} - x) < radius * radius) near |= 1u << (k + bit);
          };
          test(0, xs.x, ys.x, zs.x);
          test(1, xs.y, ys.y, zs.y);
          test(2, xs.z, ys.z, zs.z);
          test(3, xs.w, ys.w, zs.w);
        }
        for (near &= open; near != 0; near &= near - 1)
          visit(i, second * lanes + static_cast<std::uint32_t>(__ffs(static_cast<int>(near)) - 1));
      }
    }
  }

  __device__ static void make_list(const Robot& robot, RobotRecord& record, bool collides) {
    fill_grid(robot, record, collides);
    if (collides) write_near_pairs(robot, record);
    __syncthreads();
    const std::uint32_t found = count_of(record), most = most_pairs(robot);
    __syncthreads();
    if (robot.thread() == 0) record.pair_count = 0;
    __syncthreads();
    const auto list = [&](std::uint32_t i, std::uint32_t j) {
      if (joined(robot, i, j)) return;
      const std::uint32_t index = atomicAdd(&record.pair_count, 1u);
      if (index < most) record.pairs[index] = packed(robot, i, j);
    };
    const std::uint32_t* const near = near_pairs(robot);
    if (found <= most)
      for (std::uint32_t p = robot.thread(); p < found; p += robot.threads()) list(near[p] >> 16, near[p] & 0xffff);
    else
      for_each_near_pair(robot, [&](std::uint32_t i, Vec3, std::uint32_t j) { list(i, j); });
    robot_barrier<typename Robot::Memory>();
  }

  // Writes down all pairs within the list radius, as many as there is room for.
  __device__ static void write_near_pairs(const Robot& robot, RobotRecord& record) {
    std::uint32_t* const near = near_pairs(robot);
    const std::uint32_t most = most_pairs(robot);
    const auto write = [&](std::uint32_t i, std::uint32_t j) {
      const std::uint32_t index = atomicAdd(&record.pair_count, 1u);
      if (index < most) near[index] = i << 16 | j;
    };
    if constexpr (in_parts) {
      for_each_near_pair(robot, [&](std::uint32_t i, Vec3, std::uint32_t j) { write(i, j); });
    } else {
      // Lanes take masses in the order of cells, so that most of them visit the same ones.
      const ContactGrid grid = grid_of(robot);
      const std::uint32_t masses = robot.stored_header().masses;
      for (std::uint32_t k = robot.thread(); k < masses; k += robot.threads()) {
        const std::uint32_t i = grid.sorted[k];
        for_each_near(grid, masses, list_radius(robot), i, position_in_grid(robot, i), position_in(robot),
                      [&](std::uint32_t j) { write(i, j); });
      }
    }
  }

  // Of this thread's masses, as they are when the list is made.
  __device__ static void store_positions(const Robot& robot) {
    for (std::uint32_t tile = robot.first_tile(); tile < robot.last_tile(); ++tile) {
      if (!robot.has_mass(tile)) continue;
      float* const listed = listed_positions(robot) + 3 * robot.slot_in_robot(robot.own_slot(tile));
      const Vec3 x = robot.own_mass(tile).vector(field_x);
      listed[0] = x.x;
      listed[1] = x.y;
      listed[2] = x.z;
    }
  }

  // Between barriers.
  __device__ static void fill_grid(const Robot& robot, RobotRecord& record, bool collides) {
    const ContactGrid grid = grid_of(robot);
    const std::uint32_t parts = in_parts ? robot.arguments().launch.parts : 1;
    for (std::uint32_t b = robot.part() * robot.threads() + robot.thread(); b < buckets(robot);
         b += parts * robot.threads())
      grid.ends[b] = 0;
    if (robot.thread() == 0) record.pair_count = 0;
    robot_barrier<typename Robot::Memory>();
    const float inverse_size = inverse_cell_size(list_radius(robot));
    const auto for_each_own = [&](const auto& visit) {
      for (std::uint32_t tile = robot.first_tile(); collides && tile < robot.last_tile(); ++tile)
        if (robot.has_mass(tile))
          visit(robot.slot_in_robot(robot.own_slot(tile)), robot.own_mass(tile).vector(field_x));
    };
    if (collides) store_positions(robot);
    for_each_own([&](std::uint32_t, Vec3 x) { atomicAdd(grid.ends + grid.bucket_at(x, inverse_size), 1u); });
    robot_barrier<typename Robot::Memory>();
    sum_buckets(robot, grid);
    robot_barrier<typename Robot::Memory>();
    for_each_own([&](std::uint32_t slot, Vec3 x) {
      const std::uint32_t at = atomicAdd(grid.ends + grid.bucket_at(x, inverse_size), 1u);
      grid.sorted[at] = static_cast<std::uint16_t>(slot);
    });
    robot_barrier<typename Robot::Memory>();
  }

  // Replaces the number of masses in each bucket by that in all buckets before it. Of a robot in parts, the first does.
  __device__ static void sum_buckets(const Robot& robot, const ContactGrid& grid) {
    const std::uint32_t lane = robot.context().lane, warp = robot.context().warp;
    const std::uint32_t each = divide_up(buckets(robot) / lanes, robot.warps()) * lanes;
    const std::uint32_t first = warp * each, last = robot.part() == 0 ? min(first + each, buckets(robot)) : 0;
    std::uint32_t sum = 0;
    for (std::uint32_t b = first; b < last; b += lanes) sum += grid.ends[b + lane];
    sum = sum_of_warp(sum);
    if (robot.part() == 0 && lane == 0) grid.of_warp[warp] = sum;
    __syncthreads();
    std::uint32_t before = robot.part() == 0 && lane < warp ? grid.of_warp[lane] : 0;
    before = sum_of_warp(before);
    for (std::uint32_t b = first; b < last; b += lanes) {
      const std::uint32_t count = grid.ends[b + lane];
      std::uint32_t up_to = count;
      for (std::uint32_t distance = 1; distance < lanes; distance *= 2) {
        const std::uint32_t below = __shfl_up_sync(0xffffffffu, up_to, distance);
        if (lane >= distance) up_to += below;
      }
      grid.ends[b + lane] = before + up_to - count;
      before += __shfl_sync(0xffffffffu, up_to, lanes - 1);
    }
  }

  // Whether the predicate of any thread of the block is true, or of all parts of the robot. These vote by the number of
  // the step, plus 1; between two votes of a kind, there is another barrier.
  __device__ static bool any(const Robot& robot, bool predicate, std::uint32_t& votes, std::uint32_t step) {
    const bool in_block = __syncthreads_or(predicate);
    if constexpr (in_parts) {
      using Memory = typename Robot::Memory;
      const std::uint32_t vote = shared_address(&votes);
      if (in_block && robot.thread() < robot.arguments().launch.parts)
        Memory::raise_there(Memory::of_part(vote, robot.thread()), step + 1);
      robot_barrier<Memory>();
      return *static_cast<volatile std::uint32_t*>(&votes) == step + 1;
    }
    return in_block;
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
  // In device memory: a grid that does not fit on the chip, or that of a robot in parts; then
  // contact_workspace_bytes().
  __device__ static char* workspace(const Robot& robot) {
    const BatchView& batch = robot.arguments().batch;
    char* const begin = batch.workspace + std::size_t{robot.context().robot} * batch.workspace_stride;
    return begin + (Robot::Memory::on_chip ? 0 : batch.tile_stride * Robot::tile_bytes);
  }
  __device__ static ContactGrid grid_of(const Robot& robot) {
    const LaunchConfiguration& launch = robot.arguments().launch;
    if (in_parts || !launch.contacts_on_chip) return {workspace(robot), buckets(robot)};
    const std::uint32_t tiles = robot.arguments().batch.tile_stride;
    const std::uint32_t number = threadIdx.x / lanes / launch.warps_per_robot;
    return {shared_memory + block_layout(launch, tiles, Robot::fields).relaxation_times +
                number * contact_grid_bytes(launch.contact_buckets, tiles),
            buckets(robot)};
  }
  // [slot of the grid][3], when the list was made [m].
  __device__ static float* listed_positions(const Robot& robot) {
    const BatchView& batch = robot.arguments().batch;
    std::uint32_t before = 0;
    if constexpr (in_parts)
      before = contact_grid_bytes(buckets(robot), batch.parts.robot_tile_stride);
    else if (!robot.arguments().launch.contacts_on_chip)
      before = contact_grid_bytes(buckets(robot), batch.tile_stride);
    return reinterpret_cast<float*>(workspace(robot) + before);
  }
  // What comes after listed_positions(): the three kinds of pairs, and kept_count().
  __device__ static std::uint32_t* words(const Robot& robot) {
    const BatchView& batch = robot.arguments().batch;
    const std::uint32_t tiles = in_parts ? batch.parts.robot_tile_stride : batch.tile_stride;
    return reinterpret_cast<std::uint32_t*>(listed_positions(robot) + 3 * tiles * lanes);
  }
  // [tile][slot] if masses are compared: a bit for each slot of the tile, whether a spring joins the two.
  __device__ static std::uint32_t* joined_pairs(const Robot& robot) { return words(robot); }
  __device__ static std::uint32_t words_of_pairs(const Robot& robot) {
    const std::uint32_t tiles = robot.arguments().batch.tile_stride;
    return tiles * tiles * lanes;
  }
  // [most_pairs()] of this robot or part if there is a grid: i << 16 | j, with i one of its slots and j of the grid.
  __device__ static std::uint32_t* near_pairs(const Robot& robot) {
    return words(robot) + 2 * robot.part() * most_pairs(robot);
  }
  // [most_pairs()], those that springs do not join, packed().
  __device__ static std::uint32_t* listed_pairs(const Robot& robot) {
    return compares(robot) ? words(robot) + words_of_pairs(robot) : near_pairs(robot) + most_pairs(robot);
  }
  // RobotRecord::pair_count between launches.
  __device__ static std::uint32_t* kept_count(const Robot& robot) {
    if (compares(robot)) return listed_pairs(robot) + most_pairs(robot);
    return words(robot) + 2 * (in_parts ? robot.arguments().launch.parts : 1) * most_pairs(robot) + robot.part();
  }

  // Calls visit(i, x_i, j) for every pair within the list radius whose slot i is one of this thread's; j is a slot of
  // the grid.
  template <class Visit>
  __device__ static void for_each_near_pair(const Robot& robot, const Visit& visit) {
    const ContactGrid grid = grid_of(robot);
    for (std::uint32_t tile = robot.first_tile(); tile < robot.last_tile(); ++tile) {
      if (!robot.has_mass(tile)) continue;
      const std::uint32_t i = robot.own_slot(tile);
      const Vec3 x = robot.own_mass(tile).vector(field_x);
      for_each_near(grid, robot.stored_header().masses, list_radius(robot), robot.slot_in_robot(i), x,
                    position_in(robot), [&](std::uint32_t j) { visit(i, x, j); });
    }
  }
  __device__ static auto position_in(const Robot& robot) {
    return [&](std::uint32_t j) { return position_in_grid(robot, j); };
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
    bool found = false;
    robot.for_each_spring_of(
        i, [&](const auto& record) { found |= robot.slot_in_robot(robot.partner_slot_of(record)) == j; });
    return found;
  }

  // Whether slot i owns a spring to slot j.
  __device__ static bool owns(const Robot& robot, std::uint32_t i, std::uint32_t j) {
    const std::uint32_t wanted = Robot::Memory::on_chip ? Robot::byte_offset(j) / 4 : j;
    bool found = false;
    robot.for_each_spring_of(i, [&](const auto& record) { found |= record.x >> 16 == wanted; });
    return found;
  }

  float left_ = 0;  // of the reach, at least, for this thread's masses [m]
};

}  // namespace mercury::cuda
