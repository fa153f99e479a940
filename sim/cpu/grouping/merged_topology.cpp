// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/grouping/merged_topology.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace mercury::cpu {
namespace {

// One member's spring or face pair. `item` is its index in the robot; `copy` counts the member's items between the same
// slots.
struct Item {
  std::uint64_t slots = 0;  // packed
  std::uint32_t copy = 0, member = 0, item = 0;

  auto order() const { return std::tuple(slots, copy, member); }
};

// Counts copies, and sorts by order().
void sort(std::vector<Item>& items) {
  std::ranges::sort(items, {}, [](const Item& i) { return std::tuple(i.slots, i.member, i.item); });
  for (auto first = items.begin(); first != items.end();) {
    auto last = first + 1;
    bool has_copies = false;
    for (; last != items.end() && last->slots == first->slots; ++last)
      if (last->member == (last - 1)->member) {
        last->copy = (last - 1)->copy + 1;
        has_copies = true;
      }
    if (has_copies) std::sort(first, last, [](const Item& a, const Item& b) { return a.order() < b.order(); });
    first = last;
  }
}

// Numbers the items: those of different members between the same slots get the same number. Calls start(item) before
// each new number and visit(item, number) for each item.
template <class Start, class Visit>
void number_items(std::vector<Item>& items, const Start& start, const Visit& visit) {
  sort(items);
  std::uint32_t numbers = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i == 0 || items[i].slots != items[i - 1].slots || items[i].copy != items[i - 1].copy) {
      start(items[i]);
      ++numbers;
    }
    visit(items[i], numbers - 1);
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

void merge_springs(std::vector<Item>& springs, Topology& topology, std::vector<IndexMap>& index_maps) {
  const auto add_entry = [&](const Item& item) {
    const auto owner = static_cast<std::uint32_t>(item.slots >> 16),
               partner = static_cast<std::uint32_t>(item.slots & 0xffff);
    topology.partners.push_back(partner);
    ++topology.slots[owner].owned;
    ++topology.slots[owner].valence;
    ++topology.slots[partner].valence;
  };
  number_items(springs, add_entry,
               [&](const Item& item, std::uint32_t entry) { index_maps[item.member].entries[item.item] = entry; });
}

void merge_face_pairs(std::vector<Item>& pairs, Topology& topology, std::vector<IndexMap>& index_maps) {
  number_items(
      pairs, [&](const Item& item) { topology.face_pairs.push_back(unpacked(item.slots)); },
      [&](const Item& item, std::uint32_t pair) { index_maps[item.member].face_pairs[item.item] = pair; });
}

}  // namespace

MergedTopology merge_topologies(std::span<const Member> members, std::size_t slots) {
  Topology topology;
  topology.slots.resize(slots);
  std::vector<IndexMap> index_maps;
  std::vector<Item> springs, pairs;
  for (std::uint32_t m = 0; m < members.size(); ++m) {
    const auto& [robot, face_pairs, slot] = members[m];
    index_maps.push_back(
        {slot, std::vector<std::uint32_t>(robot->springs.size()), std::vector<std::uint32_t>(face_pairs.size())});
    for (std::uint32_t i = 0; i < robot->springs.size(); ++i) {
      const auto [owner, partner] = std::minmax(slot[robot->springs[i].a], slot[robot->springs[i].b]);
      springs.push_back({packed(owner, partner), 0, m, i});
    }
    for (std::uint32_t i = 0; i < face_pairs.size(); ++i) pairs.push_back({packed(face_pairs[i], slot), 0, m, i});
  }
  merge_springs(springs, topology, index_maps);
  merge_face_pairs(pairs, topology, index_maps);
  MergedTopology merged{std::make_shared<const Topology>(std::move(topology)), {}};
  for (IndexMap& map : index_maps) merged.index_maps.push_back(std::make_shared<const IndexMap>(std::move(map)));
  return merged;
}

}  // namespace mercury::cpu
