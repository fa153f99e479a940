// SPDX-License-Identifier: Apache-2.0
// The items that several robots of a partition have (partition.h), found by hashing.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace mercury::cpu {

// One robot's cell, spring or face pair.
struct Item {
  std::uint64_t key;
  std::uint32_t robot;
};

// Numbers the keys that several items have, in ascending order: the `most` lowest. A hash table counts the items of
// each key.
class CommonItems {
 public:
  CommonItems(std::span<const Item> items, std::size_t most) : items_(items) {
    std::size_t keys = 0;
    for (const Item& item : items) {
      Entry& entry = find(item.key);
      entry.key = item.key;
      if (++entry.count == 2) common_.push_back(item.key);
      if (entry.count == 1 && 2 * ++keys > entries_.size()) grow();
    }
    std::ranges::sort(common_);
    common_.resize(std::min(common_.size(), most));
    for (std::uint32_t number = 0; number < common_.size(); ++number) find(common_[number]).number = number;
  }

  std::size_t size() const { return common_.size(); }

  // Calls visit(item, number) for each item that has a number.
  template <class Visit>
  void for_each(const Visit& visit) {
    for (const Item& item : items_)
      if (const std::uint32_t number = find(item.key).number; number != none) visit(item, number);
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffu;
  struct Entry {
    std::uint64_t key = 0;
    std::uint32_t count = 0, number = none;
  };

  void grow() {
    const std::vector<Entry> before = std::exchange(entries_, std::vector<Entry>(4 * entries_.size()));
    for (const Entry& entry : before)
      if (entry.count != 0) find(entry.key) = entry;
  }

  // The entry of the key, or the free one where it belongs.
  Entry& find(std::uint64_t key) {
    const std::size_t mask = entries_.size() - 1;
    std::size_t i = (key * 0x9e3779b97f4a7c15u) >> 32 & mask;
    while (entries_[i].count != 0 && entries_[i].key != key) i = (i + 1) & mask;
    return entries_[i];
  }

  std::span<const Item> items_;
  std::vector<Entry> entries_ = std::vector<Entry>(4096);
  std::vector<std::uint64_t> common_;
};

}  // namespace mercury::cpu
