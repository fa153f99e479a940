// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/grouping/partition.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "mercury/parallel.h"
#include "mercury/work_counter.h"
#include "sim/cpu/grouping/cost_model.h"

namespace mercury::cpu {
namespace {

using Group = std::vector<std::size_t>;
using Word = std::uint64_t;

// One robot's cell, spring or face pair.
struct KeyedItem {
  std::uint64_t key;
  std::uint32_t robot;
};

// Numbers the keys that several items have, in ascending order: the `most` lowest. A hash table counts the items of
// each key.
class CommonItems {
 public:
  CommonItems(std::span<const KeyedItem> items, std::size_t most) : items_(items) {
    std::size_t keys = 0;
    for (const KeyedItem& item : items) {
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
    for (const KeyedItem& item : items_)
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

  std::span<const KeyedItem> items_;
  std::vector<Entry> entries_ = std::vector<Entry>(4096);
  std::vector<std::uint64_t> common_;
};

std::uint32_t index_of(LatticeCell c) {
  return static_cast<std::uint32_t>(c.x + max_cells_across * (c.y + max_cells_across * c.z));
}

// Bits that `robot` has and `to` does not, of one block of words. Counts in all bytes at once: there are at most 64 in
// each.
constexpr std::size_t block = 8;
std::uint64_t count_new_bits(const Word* to, const Word* robot) {
  Word bytes = 0;
  for (std::size_t w = 0; w < block; ++w) {
    Word x = robot[w] & ~to[w];
    x -= x >> 1 & 0x5555555555555555u;
    x = (x & 0x3333333333333333u) + (x >> 2 & 0x3333333333333333u);
    bytes += (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fu;
  }
  constexpr Word even = 0x00ff00ff00ff00ffu;
  return ((bytes & even) + (bytes >> 8 & even)) * 0x0001000100010001u >> 48;
}

// The robots' sets: bits of cells, then of springs, then of face pairs, each in whole blocks.
class ItemSets {
 public:
  explicit ItemSets(std::span<const RobotItems> robots, std::span<const std::size_t> members) {
    std::size_t all_cells = 0, all_springs = 0;
    for (const std::size_t i : members) {
      const auto& [cells, springs, face_pairs] = robots[i];
      all_cells += cells.size();
      all_springs += springs.size();
      costs_.push_back(costs.slot * static_cast<double>(cells.size()) +
                       costs.entry * static_cast<double>(springs.size()) +
                       costs.face_pair * static_cast<double>(face_pairs.size()));
    }
    const bool few_springs = all_springs <= limits.springs_per_robot * members.size();
    cell_cost_ = costs.slot +
                 (few_springs ? 0 : costs.entry * static_cast<double>(all_springs) / static_cast<double>(all_cells));
    std::vector<KeyedItem> cells, springs, pairs;
    for (std::uint32_t m = 0; m < members.size(); ++m)
      append_items(robots[members[m]], m, few_springs, cells, springs, pairs);
    CommonItems common_cells(cells, limits.items_distinguished), common_springs(springs, limits.items_distinguished),
        common_pairs(pairs, limits.items_distinguished);
    const auto words_of = [](const CommonItems& items) {
      return (items.size() + 64 * block - 1) / (64 * block) * block;
    };
    springs_start_ = words_of(common_cells);
    pairs_start_ = springs_start_ + words_of(common_springs);
    words_ = pairs_start_ + words_of(common_pairs);
    bits_.resize(words_ * members.size());
    set_bits(common_cells, 0);
    set_bits(common_springs, springs_start_);
    set_bits(common_pairs, pairs_start_);
  }

  std::size_t words() const { return words_; }
  const Word* of(std::size_t robot) const { return bits_.data() + words_ * robot; }
  double cost(std::size_t robot) const { return costs_[robot]; }
  // What a robot adds to the cost of a union; infinity if that is more than `limit`.
  double added(const Word* to, const Word* robot, double limit = std::numeric_limits<double>::infinity()) const {
    std::uint64_t cells = 0, springs = 0, pairs = 0;
    const auto cost_so_far = [&] {
      return cell_cost_ * static_cast<double>(cells) + costs.entry * static_cast<double>(springs) +
             costs.face_pair * static_cast<double>(pairs);
    };
    const auto count = [&](std::uint64_t& items, std::size_t first, std::size_t last) {
      for (std::size_t w = first; w < last; w += block) {
        items += count_new_bits(to + w, robot + w);
        if (cost_so_far() > limit) return false;
      }
      return true;
    };
    const bool within = count(cells, 0, springs_start_) && count(pairs, pairs_start_, words_) &&
                        count(springs, springs_start_, pairs_start_);
    return within ? cost_so_far() : std::numeric_limits<double>::infinity();
  }
  void unite(Word* with, const Word* robot) const {
    for (std::size_t w = 0; w < words_; ++w) with[w] |= robot[w];
  }

 private:
  static void append_items(const RobotItems& items, std::uint32_t robot, bool with_springs,
                           std::vector<KeyedItem>& cells, std::vector<KeyedItem>& springs,
                           std::vector<KeyedItem>& pairs) {
    const auto index = [&](std::uint16_t mass) { return std::uint64_t{index_of(items.cells[mass])}; };
    for (const LatticeCell c : items.cells) cells.push_back({index_of(c), robot});
    if (with_springs)
      for (const Spring& spring : items.springs) {
        const auto [low, high] = std::minmax({index(spring.a), index(spring.b)});
        springs.push_back({low << 16 | high, robot});
      }
    for (const auto& [a, b, c, d] : items.face_pairs)
      pairs.push_back({((index(a) << 16 | index(b)) << 16 | index(c)) << 16 | index(d), robot});
  }

  void set_bits(CommonItems& items, std::size_t first_word) {
    items.for_each([&](const KeyedItem& item, std::uint32_t number) {
      bits_[words_ * item.robot + first_word + number / 64] |= Word{1} << number % 64;
    });
  }

  std::size_t springs_start_ = 0, pairs_start_ = 0, words_ = 0;
  double cell_cost_ = 0;
  std::vector<Word> bits_;
  std::vector<double> costs_;
};

// Robots are sorted by size, largest first. Each group takes candidates from the next in size.
std::vector<Group> greedy_groups(const ItemSets& sets, std::size_t robots, std::size_t group_size) {
  Group left(robots);
  std::iota(left.begin(), left.end(), std::size_t{0});
  std::vector<Group> groups;
  while (!left.empty()) {
    std::vector<Word> all_items(sets.words());
    Group group;
    const auto take = [&](Group::iterator chosen) {
      sets.unite(all_items.data(), sets.of(*chosen));
      group.push_back(*chosen);
      left.erase(chosen);
    };
    // Infinity if it is more than `limit`.
    const auto price = [&](std::size_t robot, double limit) {
      const double worth = costs.worth_of_size * sets.cost(robot);
      return sets.added(all_items.data(), sets.of(robot), limit + worth) - worth;
    };
    take(left.begin());
    while (group.size() < group_size && !left.empty()) {
      const auto end = left.begin() + static_cast<std::ptrdiff_t>(std::min(limits.candidates_compared, left.size()));
      auto best = left.begin();
      double least = std::numeric_limits<double>::infinity();
      for (auto i = left.begin(); i != end; ++i)
        if (const double p = price(*i, least); p < least) {
          least = p;
          best = i;
        }
      take(best);
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

class Exchange {
 public:
  Exchange(const ItemSets& sets, std::vector<Group>& groups)
      : sets_(sets), groups_(groups), others_(groups.size()), own_(groups.size()), changed_(groups.size()),
        searched_(groups.size()) {
    for (std::size_t g = 0; g < groups.size(); ++g) update(g);
  }

  void run() {
    for (int round = 0; round < limits.exchange_rounds; ++round) {
      bool any = false;
      for (std::size_t g = 0; g < groups_.size(); ++g) {
        const std::size_t now = changes_;
        for (std::size_t i = 0; i < groups_[g].size(); ++i) any |= exchange(g, i);
        searched_[g] = now;
      }
      if (!any) return;
    }
  }

 private:
  // Exchanges member i of group g for the member of the next groups that gains most, if one does.
  bool exchange(std::size_t g, std::size_t i) {
    double most = costs.min_gain;
    std::size_t best_group = 0, best = 0;
    const Word* const mine = sets_.of(groups_[g][i]);
    for (std::size_t h = g + 1; h < std::min(groups_.size(), g + 1 + limits.groups_in_reach); ++h) {
      if (std::max(changed_[g], changed_[h]) <= searched_[g]) continue;  // nothing gained then
      for (std::size_t j = 0; j < groups_[h].size(); ++j) {
        double gain = own_[g][i] + own_[h][j];
        if (gain <= most) continue;
        gain -= sets_.added(others(g, i), sets_.of(groups_[h][j]), gain - most);
        if (gain <= most) continue;
        gain -= sets_.added(others(h, j), mine, gain - most);
        if (gain <= most) continue;
        most = gain;
        best_group = h;
        best = j;
      }
    }
    if (most == costs.min_gain) return false;
    std::swap(groups_[g][i], groups_[best_group][best]);
    update(g);
    update(best_group);
    return true;
  }

  void update(std::size_t g) {
    changed_[g] = ++changes_;
    const Group& group = groups_[g];
    others_[g].assign(group.size() * sets_.words(), 0);
    own_[g].resize(group.size());
    std::vector<Word> before(sets_.words()), after(sets_.words());  // unions of the members before and after i
    const auto take = [&](std::size_t i, std::vector<Word>& with) {
      sets_.unite(others_[g].data() + i * sets_.words(), with.data());
      sets_.unite(with.data(), sets_.of(group[i]));
    };
    for (std::size_t i = 0; i < group.size(); ++i) take(i, before);
    for (std::size_t i = group.size(); i-- > 0;) take(i, after);
    for (std::size_t i = 0; i < group.size(); ++i) own_[g][i] = sets_.added(others(g, i), sets_.of(group[i]));
  }
  const Word* others(std::size_t g, std::size_t i) const { return others_[g].data() + i * sets_.words(); }

  const ItemSets& sets_;
  std::vector<Group>& groups_;
  std::vector<std::vector<Word>> others_;  // by group and member: the union of the other members
  std::vector<std::vector<double>> own_;   // by group and member: what it adds to that union
  // Exchanges are numbered: by group, the last one that changed it, and the last one before it was searched.
  std::size_t changes_ = 0;
  std::vector<std::size_t> changed_, searched_;
};

std::vector<Group> groups_of(std::span<const RobotItems> robots, std::span<const std::size_t> members,
                             std::size_t group_size) {
  const ItemSets sets(robots, members);
  std::vector<Group> groups = greedy_groups(sets, members.size(), group_size);
  Exchange(sets, groups).run();
  for (Group& group : groups)
    for (std::size_t& robot : group) robot = members[robot];
  return groups;
}

}  // namespace

std::vector<std::vector<std::size_t>> partition_by_similarity(std::span<const RobotItems> robots,
                                                              std::size_t group_size, const WorkWatch& watch) {
  Group by_size(robots.size());
  std::iota(by_size.begin(), by_size.end(), std::size_t{0});
  std::ranges::stable_sort(by_size, std::greater{}, [&](std::size_t i) { return robots[i].cells.size(); });
  std::vector<std::vector<Group>> parts((robots.size() + limits.robots_compared - 1) / limits.robots_compared);
  WorkCounter counter(watch, "comparing robots", parts.size());
  parallel_for(0, parts.size(), [&](std::size_t p) {
    const std::span<const std::size_t> members = std::span(by_size).subspan(p * limits.robots_compared);
    parts[p] = groups_of(robots, members.first(std::min(limits.robots_compared, members.size())), group_size);
    counter.add_one();
  });
  std::vector<Group> groups;
  for (std::vector<Group>& part : parts) std::ranges::move(part, std::back_inserter(groups));
  return groups;
}

}  // namespace mercury::cpu
