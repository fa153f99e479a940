// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/grouping/group_plan.h"

#include <algorithm>
#include <utility>

namespace mercury::cpu {
namespace {

// One member's spring or face pair. `item` is its index in the robot.
struct Item {
  std::uint64_t slots = 0;  // packed
  std::uint32_t member = 0, item = 0;
};

// Sorts by slots. Items between the same slots keep their order. One pass per slot of an item, the least significant
// first; a pass counts how many items have each slot.
void sort_by_slots(std::vector<Item>& items, int slots_per_item, std::size_t slots) {
  std::vector<Item> sorted(items.size());
  std::vector<std::uint32_t> next(slots + 1);
  for (int digit = 0; digit < slots_per_item; ++digit) {
    const auto slot_of = [&](const Item& item) { return item.slots >> 16 * digit & 0xffff; };
    std::ranges::fill(next, 0u);
    for (const Item& item : items) ++next[slot_of(item) + 1];
    for (std::size_t slot = 0; slot < slots; ++slot) next[slot + 1] += next[slot];
    for (const Item& item : items) sorted[next[slot_of(item)]++] = item;
    std::swap(items, sorted);
  }
}

// Numbers the items, which are sorted by slots, then by member: those of different members between the same slots get
// the same number, those of one member different numbers. Calls start(slots) for each number and visit(item, number)
// for each item.
template <class Start, class Visit>
void number_items(const std::vector<Item>& items, const Start& start, const Visit& visit) {
  std::uint32_t numbers = 0;
  for (auto first = items.begin(); first != items.end();) {
    std::uint32_t copy = 0, copies = 0;  // of the current member; at most of any member
    auto i = first;
    for (; i != items.end() && i->slots == first->slots; ++i) {
      copy = i != first && i->member == (i - 1)->member ? copy + 1 : 0;
      visit(*i, numbers + copy);
      if (copy == copies) {
        start(first->slots);
        ++copies;
      }
    }
    numbers += copies;
    first = i;
  }
}

std::uint64_t packed(std::uint32_t owner, std::uint32_t partner) { return std::uint64_t{owner} << 16 | partner; }
std::uint64_t packed(const FacePair& p, const std::vector<std::uint32_t>& slot) {
  return packed(slot[p.a], slot[p.b]) << 32 | packed(slot[p.c], slot[p.d]);
}
FacePair unpacked(std::uint64_t slots) {
  const auto corner = [&](int n) { return static_cast<std::uint16_t>(slots >> (48 - 16 * n)); };
  return {corner(0), corner(1), corner(2), corner(3)};
}

void merge_springs(const std::vector<Item>& springs, Topology& topology, std::vector<IndexMap>& index_maps) {
  const auto add_entry = [&](std::uint64_t slots) {
    const auto owner = static_cast<std::uint32_t>(slots >> 16), partner = static_cast<std::uint32_t>(slots & 0xffff);
    topology.partners.push_back(partner);
    ++topology.slots[owner].owned;
    ++topology.slots[owner].valence;
    ++topology.slots[partner].valence;
  };
  number_items(springs, add_entry,
               [&](const Item& item, std::uint32_t entry) { index_maps[item.member].entries[item.item] = entry; });
}

void merge_face_pairs(const std::vector<Item>& pairs, Topology& topology, std::vector<IndexMap>& index_maps) {
  number_items(
      pairs, [&](std::uint64_t corners) { topology.face_pairs.push_back(unpacked(corners)); },
      [&](const Item& item, std::uint32_t pair) { index_maps[item.member].face_pairs[item.item] = pair; });
}

}  // namespace

MergedTopology merge_topologies(std::span<const Member> members, std::size_t slots) {
  Topology topology;
  topology.slots.resize(slots);
  std::vector<IndexMap> index_maps;
  std::vector<Item> springs, pairs;
  std::size_t all_springs = 0, all_pairs = 0;
  for (const Member& member : members) {
    all_springs += member.robot->springs.size();
    all_pairs += member.face_pairs.size();
  }
  springs.reserve(all_springs);
  pairs.reserve(all_pairs);
  for (std::uint32_t m = 0; m < members.size(); ++m) {
    const auto& [robot, face_pairs, slot] = members[m];
    index_maps.push_back(
        {slot, std::vector<std::uint32_t>(robot->springs.size()), std::vector<std::uint32_t>(face_pairs.size())});
    for (std::uint32_t i = 0; i < robot->springs.size(); ++i) {
      const auto [owner, partner] = std::minmax(slot[robot->springs[i].a], slot[robot->springs[i].b]);
      springs.push_back({packed(owner, partner), m, i});
    }
    for (std::uint32_t i = 0; i < face_pairs.size(); ++i) pairs.push_back({packed(face_pairs[i], slot), m, i});
  }
  sort_by_slots(springs, 2, slots);
  sort_by_slots(pairs, 4, slots);
  merge_springs(springs, topology, index_maps);
  merge_face_pairs(pairs, topology, index_maps);
  MergedTopology merged{std::make_shared<const Topology>(std::move(topology)), {}};
  for (IndexMap& map : index_maps) merged.index_maps.push_back(std::make_shared<const IndexMap>(std::move(map)));
  return merged;
}

}  // namespace mercury::cpu
