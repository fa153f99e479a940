// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/similar.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

namespace mercury::cpu {
namespace {

using Group = std::vector<std::size_t>;
using Word = std::uint64_t;

// What a step costs, in slots of springs.
constexpr double seat_cost = 1.4, pair_cost = 3;

constexpr std::size_t most_at_once = 1024;  // robots that are compared
constexpr std::size_t most_places = 4096;   // of masses, of springs and of pairs of faces, that are told apart
constexpr std::size_t most_springs = 128;   // a robot; where there are more, masses stand for them

std::uint32_t index_of(Cell c) {
  return static_cast<std::uint32_t>(c.x + most_cells_across * (c.y + most_cells_across * c.z));
}

// Robots as sets of what they ask for, one bit for each that two of them or more have.
class Sets {
 public:
  explicit Sets(std::span<const Outline> robots, std::span<const std::size_t> members) {
    std::size_t all_masses = 0, all_springs = 0;
    for (const std::size_t i : members) {
      const auto& [masses, springs, faces] = robots[i];
      all_masses += masses.size();
      all_springs += springs.size();
      costs_.push_back(seat_cost * static_cast<double>(masses.size()) + static_cast<double>(springs.size()) +
                       pair_cost * static_cast<double>(faces.size()));
    }
    const bool few_springs = all_springs <= most_springs * members.size();
    mass_cost_ = seat_cost + (few_springs ? 0 : static_cast<double>(all_springs) / static_cast<double>(all_masses));
    std::vector<Item> cells, springs, pairs;
    for (std::uint32_t m = 0; m < members.size(); ++m) {
      const auto& [masses, own_springs, faces] = robots[members[m]];
      for (const Cell c : masses) cells.push_back({index_of(c), m});
      for (const Spring& spring : own_springs.first(few_springs ? own_springs.size() : 0)) {
        const std::uint64_t a = index_of(masses[spring.a]), b = index_of(masses[spring.b]);
        springs.push_back({std::min(a, b) << 16 | std::max(a, b), m});
      }
      for (const auto& [a, b, c, d] : faces)
        pairs.push_back(
            {((std::uint64_t{index_of(masses[a])} << 16 | index_of(masses[b])) << 16 | index_of(masses[c])) << 16 |
                 index_of(masses[d]),
             m});
    }
    const auto words_of = [](std::vector<Item>& items) { return (count_common(items) + 63) / 64; };
    springs_start_ = words_of(cells);
    pairs_start_ = springs_start_ + words_of(springs);
    words_ = pairs_start_ + words_of(pairs);
    bits_.resize(words_ * members.size());
    mark(cells, 0);
    mark(springs, springs_start_);
    mark(pairs, pairs_start_);
  }

  std::size_t words() const { return words_; }
  const Word* of(std::size_t robot) const { return bits_.data() + words_ * robot; }
  double cost(std::size_t robot) const { return costs_[robot]; }
  // What a robot adds to the cost of these.
  double added(const Word* to, const Word* robot) const {
    const auto more = [&](std::size_t first, std::size_t last) {
      int count = 0;
      for (std::size_t w = first; w < last; ++w) count += std::popcount(robot[w] & ~to[w]);
      return count;
    };
    return mass_cost_ * more(0, springs_start_) + more(springs_start_, pairs_start_) +
           pair_cost * more(pairs_start_, words_);
  }
  void unite(Word* with, const Word* robot) const {
    for (std::size_t w = 0; w < words_; ++w) with[w] |= robot[w];
  }

 private:
  struct Item {
    std::uint64_t key;
    std::uint32_t robot;
  };

  // Calls visit(number, first, last) for the items of each key that several have.
  template <class Visit>
  static void for_each_common(const std::vector<Item>& items, const Visit& visit) {
    std::size_t number = 0;
    for (auto first = items.begin(); first != items.end() && number < most_places;) {
      const auto last = std::find_if(first, items.end(), [&](const Item& item) { return item.key != first->key; });
      if (last - first > 1) visit(number++, first, last);
      first = last;
    }
  }
  static std::size_t count_common(std::vector<Item>& items) {
    std::ranges::sort(items, {}, &Item::key);
    std::size_t count = 0;
    for_each_common(items, [&](std::size_t, auto, auto) { ++count; });
    return count;
  }
  void mark(const std::vector<Item>& items, std::size_t first_word) {
    for_each_common(items, [&](std::size_t number, auto first, auto last) {
      for (; first != last; ++first) bits_[words_ * first->robot + first_word + number / 64] |= Word{1} << number % 64;
    });
  }

  std::size_t springs_start_ = 0, pairs_start_ = 0, words_ = 0;  // cells stand first
  double mass_cost_ = 0;
  std::vector<Word> bits_;
  std::vector<double> costs_;
};

// To the largest robot left, those of the next in size that add least to its group, large ones rather than small ones.
std::vector<Group> collect(const Sets& sets, std::size_t robots, std::size_t group_size) {
  constexpr std::size_t most_compared = 256;
  constexpr double worth_of_size = 0.75;
  Group left(robots);
  std::iota(left.begin(), left.end(), std::size_t{0});
  std::vector<Group> groups;
  while (!left.empty()) {
    std::vector<Word> together(sets.words());
    Group group;
    const auto take = [&](Group::iterator chosen) {
      sets.unite(together.data(), sets.of(*chosen));
      group.push_back(*chosen);
      left.erase(chosen);
    };
    const auto price = [&](std::size_t robot) {
      return sets.added(together.data(), sets.of(robot)) - worth_of_size * sets.cost(robot);
    };
    take(left.begin());
    while (group.size() < group_size && !left.empty()) {
      const auto end = left.begin() + static_cast<std::ptrdiff_t>(std::min(most_compared, left.size()));
      auto best = left.begin();
      double least = std::numeric_limits<double>::infinity();
      for (auto i = left.begin(); i != end; ++i)
        if (const double p = price(*i); p < least) {
          least = p;
          best = i;
        }
      take(best);
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

// Exchanges robots between groups of about the same size as long as that makes both together cheaper.
class Exchange {
 public:
  Exchange(const Sets& sets, std::vector<Group>& groups)
      : sets_(sets), groups_(groups), others_(groups.size()), own_(groups.size()) {
    for (std::size_t g = 0; g < groups.size(); ++g) look_at(g);
  }

  void run() {
    constexpr int most_rounds = 4;
    for (int round = 0; round < most_rounds; ++round) {
      bool any = false;
      for (std::size_t g = 0; g < groups_.size(); ++g)
        for (std::size_t i = 0; i < groups_[g].size(); ++i) any |= exchange(g, i);
      if (!any) return;
    }
  }

 private:
  // With the best of the next groups' robots, if it gains.
  bool exchange(std::size_t g, std::size_t i) {
    constexpr std::size_t reach = 8;
    constexpr double least_gain = 0.5;
    double most = least_gain;
    std::size_t best_group = 0, best = 0;
    const Word* const mine = sets_.of(groups_[g][i]);
    for (std::size_t h = g + 1; h < std::min(groups_.size(), g + 1 + reach); ++h)
      for (std::size_t j = 0; j < groups_[h].size(); ++j) {
        double gain = own_[g][i] + own_[h][j];
        if (gain <= most) continue;
        gain -= sets_.added(others(g, i), sets_.of(groups_[h][j]));
        if (gain <= most) continue;
        gain -= sets_.added(others(h, j), mine);
        if (gain <= most) continue;
        most = gain;
        best_group = h;
        best = j;
      }
    if (most == least_gain) return false;
    std::swap(groups_[g][i], groups_[best_group][best]);
    look_at(g);
    look_at(best_group);
    return true;
  }

  // Finds what all but one of a group have, and what that one adds, for each of it.
  void look_at(std::size_t g) {
    const Group& group = groups_[g];
    others_[g].assign(group.size() * sets_.words(), 0);
    own_[g].resize(group.size());
    for (std::size_t i = 0; i < group.size(); ++i) {
      for (std::size_t j = 0; j < group.size(); ++j)
        if (j != i) sets_.unite(others_[g].data() + i * sets_.words(), sets_.of(group[j]));
      own_[g][i] = sets_.added(others(g, i), sets_.of(group[i]));
    }
  }
  const Word* others(std::size_t g, std::size_t i) const { return others_[g].data() + i * sets_.words(); }

  const Sets& sets_;
  std::vector<Group>& groups_;
  std::vector<std::vector<Word>> others_;
  std::vector<std::vector<double>> own_;
};

std::vector<Group> groups_of(std::span<const Outline> robots, std::span<const std::size_t> members,
                             std::size_t group_size) {
  const Sets sets(robots, members);
  std::vector<Group> groups = collect(sets, members.size(), group_size);
  Exchange(sets, groups).run();
  for (Group& group : groups)
    for (std::size_t& robot : group) robot = members[robot];
  return groups;
}

}  // namespace

std::vector<std::vector<std::size_t>> similar_groups(std::span<const Outline> robots, std::size_t group_size) {
  Group by_size(robots.size());
  std::iota(by_size.begin(), by_size.end(), std::size_t{0});
  std::ranges::stable_sort(by_size, std::greater{}, [&](std::size_t i) { return robots[i].masses.size(); });
  std::vector<std::vector<Group>> parts((robots.size() + most_at_once - 1) / most_at_once);
  oneapi::tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t p) {
    const std::span<const std::size_t> members = std::span(by_size).subspan(p * most_at_once);
    parts[p] = groups_of(robots, members.first(std::min(most_at_once, members.size())), group_size);
  });
  std::vector<Group> groups;
  for (std::vector<Group>& part : parts) std::ranges::move(part, std::back_inserter(groups));
  return groups;
}

}  // namespace mercury::cpu
