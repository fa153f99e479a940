// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/arrangement.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <unordered_map>

namespace mercury::cuda {
namespace {

std::vector<OwnedSpring> in_slots(std::span<const Spring> springs, std::span<const std::uint16_t> slot) {
  std::vector<OwnedSpring> moved;
  moved.reserve(springs.size());
  for (const Spring& s : springs) moved.push_back({slot[s.a], slot[s.b]});
  return moved;
}

struct Shift {
  std::uint32_t shift, passes;  // CornerBanks::fewest_passes() with this shift
};

// Some shifts, first those that spread the corners of the faces over the banks most evenly.
std::array<Shift, 12> shifts_by_passes(std::uint32_t masses, std::span<const FacePair> pairs) {
  std::vector<std::uint32_t> shared(masses), outer(masses);  // how often each mass is a or c, b or d
  for (const FacePair& p : pairs) {
    ++shared[p.a], ++shared[p.c];
    ++outer[p.b], ++outer[p.d];
  }
  std::array<Shift, 12> shifts{{{0}, {1}, {2}, {3}, {5}, {6}, {7}, {13}, {16}, {25}, {27}, {29}}};
  for (Shift& shift : shifts) {
    CornerBanks banks;
    TileRotation{masses, shift.shift}.for_each_run([&](std::uint32_t mass, std::uint32_t slot, std::uint32_t count) {
      for (std::uint32_t i = 0; i < count; ++i) banks.shared[slot % lanes + i] += shared[mass + i];
      for (std::uint32_t i = 0; i < count; ++i) banks.outer[slot % lanes + i] += outer[mass + i];
    });
    shift.passes = banks.fewest_passes(pairs.size());
  }
  std::ranges::stable_sort(shifts, {}, &Shift::passes);
  return shifts;
}

// The shift with the fewest passes through shared memory. Rows of springs are estimated for small robots only: in
// these, shifts differ by more, and an estimate takes less time.
TileRotation choose_rotation(const Robot& robot, std::span<const FacePair> pairs) {
  const auto masses = static_cast<std::uint32_t>(robot.masses.size());
  const std::array<Shift, 12> shifts = shifts_by_passes(masses, pairs);
  constexpr std::size_t max_estimated = 4000;  // springs, of all estimates together
  const std::size_t estimates = std::clamp<std::size_t>(max_estimated / (robot.springs.size() + 1), 1, 4);
  TileRotation best{masses, shifts.front().shift};
  std::uint32_t fewest = ~0u;
  for (std::size_t i = 0; i < estimates && estimates > 1; ++i) {
    const TileRotation rotation{masses, shifts[i].shift};
    constexpr std::uint32_t per_row = 10, per_column = 9;  // docs/performance.md; x, v and sum of a corner
    const std::uint32_t passes = per_row * estimate_rows(masses, in_slots(robot.springs, rotation.order().slots)) +
                                 per_column * shifts[i].passes;
    if (passes < fewest) best = rotation, fewest = passes;
  }
  return best;
}

}  // namespace

Arrangement arrange(const Robot& robot) {
  std::vector<FacePair> pairs = pair_faces(robot);
  const TileRotation rotation = choose_rotation(robot, pairs);
  auto order = std::make_shared<const SlotOrder>(rotation.order());
  const std::vector<std::uint16_t>& slot = order->slots;
  for (FacePair& p : pairs) p = {slot[p.a], slot[p.b], slot[p.c], slot[p.d]};
  return {std::move(order), schedule_springs(rotation.masses, in_slots(robot.springs, slot)), make_face_tiles(pairs)};
}

std::vector<std::uint32_t> first_of_topology(std::span<const Robot* const> robots) {
  std::vector<std::uint64_t> keys(robots.size());
  oneapi::tbb::parallel_for(std::size_t{0}, robots.size(), [&](std::size_t i) { keys[i] = topology_key(*robots[i]); });
  std::unordered_map<std::uint64_t, std::uint32_t> first_of_key;
  for (std::uint32_t i = 0; i < robots.size(); ++i) first_of_key.try_emplace(keys[i], i);
  std::vector<std::uint32_t> first(robots.size());
  oneapi::tbb::parallel_for(std::size_t{0}, robots.size(), [&](std::size_t i) {
    const std::uint32_t candidate = first_of_key.at(keys[i]);
    const bool same = candidate == i || same_topology(*robots[candidate], *robots[i]);
    first[i] = same ? candidate : static_cast<std::uint32_t>(i);
  });
  return first;
}

}  // namespace mercury::cuda
