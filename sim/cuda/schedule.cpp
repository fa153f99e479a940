// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/schedule.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <random>

namespace mercury::cuda {
namespace {

struct Edge {
  std::uint16_t owner, partner;
  std::uint32_t spring;
};

// Which mass owns each spring. A row is as wide as its group, so what counts is the busiest lane and bank of a group;
// owners are chosen so that the sum of the squares of all loads is small, which evens them out.
class Ownership {
 public:
  Ownership(std::size_t masses, std::span<const Spring> springs)
      : springs_(springs), lane_load_(masses), bank_load_((masses + lanes - 1) / lanes * lanes),
        owned_by_b_(springs.size()) {
    for (std::size_t s = 0; s < springs_.size(); ++s) {
      owned_by_b_[s] = load(springs_[s].b, springs_[s].a) < load(springs_[s].a, springs_[s].b);
      change(s, 1);
    }
    constexpr int sweeps = 12, more_sweeps = 12;
    for (int sweep = 0; sweep < sweeps; ++sweep) improve(sweep);
    for (int sweep = 0; sweep < more_sweeps; ++sweep) relieve();
  }

  std::uint16_t owner(std::size_t s) const { return owned_by_b_[s] ? springs_[s].b : springs_[s].a; }
  std::uint16_t partner(std::size_t s) const { return owned_by_b_[s] ? springs_[s].a : springs_[s].b; }

 private:
  std::uint32_t& bank_load(std::uint16_t owner, std::uint16_t partner) {
    return bank_load_[owner / lanes * lanes + partner % lanes];
  }
  std::uint32_t load(std::uint16_t owner, std::uint16_t partner) {
    return lane_load_[owner] + bank_load(owner, partner);
  }
  void change(std::size_t s, std::uint32_t by) {
    lane_load_[owner(s)] += by;
    bank_load(owner(s), partner(s)) += by;
  }

  // Hands springs to their other end where that lowers the sum of squares; in odd sweeps also where it stays the same,
  // which lets loads wander to where there is room.
  void improve(int sweep) {
    for (std::size_t s = 0; s < springs_.size(); ++s) {
      const std::uint32_t here = load(owner(s), partner(s)), there = load(partner(s), owner(s)) + 2;
      if (there > here || (there == here && sweep % 2 == 0)) continue;
      change(s, static_cast<std::uint32_t>(-1));
      owned_by_b_[s] = !owned_by_b_[s];
      change(s, 1);
    }
  }

  // Only loads above the average lengthen a group: hands springs over where that lowers the sum of the squares of what
  // is above it, or, at random, where that leaves it the same.
  void relieve() {
    const auto average = static_cast<std::uint32_t>((springs_.size() + lane_load_.size() - 1) / lane_load_.size());
    const auto above = [&](std::uint32_t load) { return load > average ? (load - average) * (load - average) : 0; };
    const auto step = [&](std::uint32_t load) { return above(load + 1) - above(load); };
    for (std::size_t s = 0; s < springs_.size(); ++s) {
      const std::uint16_t from = owner(s), to = partner(s);
      const std::uint32_t relieved = step(lane_load_[from] - 1) + step(bank_load(from, to) - 1);
      const std::uint32_t burdened = step(lane_load_[to]) + step(bank_load(to, from));
      const auto chance = static_cast<std::uint32_t>(random_());
      const bool same = burdened == relieved && chance % (relieved > 0 ? 2 : 32) == 0;
      if (burdened >= relieved && !same) continue;
      change(s, static_cast<std::uint32_t>(-1));
      owned_by_b_[s] = !owned_by_b_[s];
      change(s, 1);
    }
  }

  const std::span<const Spring> springs_;
  std::minstd_rand random_;
  std::vector<std::uint32_t> lane_load_, bank_load_;
  std::vector<std::uint8_t> owned_by_b_;
};

// Colours the edges between 32 lanes and 32 banks; edges of one colour share neither lane nor bank.
class EdgeColouring {
 public:
  explicit EdgeColouring(std::span<const Edge> edges) : edges_(edges) {
    std::array<std::uint32_t, lanes> lane_degree{}, bank_degree{};
    for (const Edge& edge : edges) {
      colours_ = std::max(colours_, ++lane_degree[lane(edge)]);
      colours_ = std::max(colours_, ++bank_degree[bank(edge)]);
    }
    at_lane_.assign(std::size_t{lanes} * colours_, none);
    at_bank_.assign(std::size_t{lanes} * colours_, none);
    for (std::uint32_t e = 0; e < edges.size(); ++e) colour(e);
  }

  std::uint32_t colours() const { return colours_; }
  // The edge of a lane in a colour, or none.
  static constexpr std::uint32_t none = 0xffffffffu;
  std::uint32_t edge_at(std::uint32_t lane, std::uint32_t colour) const { return at_lane_[lane * colours_ + colour]; }

 private:
  static std::uint32_t lane(const Edge& edge) { return edge.owner % lanes; }
  static std::uint32_t bank(const Edge& edge) { return edge.partner % lanes; }
  std::uint32_t& at_lane(std::uint32_t lane, std::uint32_t colour) { return at_lane_[lane * colours_ + colour]; }
  std::uint32_t& at_bank(std::uint32_t bank, std::uint32_t colour) { return at_bank_[bank * colours_ + colour]; }

  std::uint32_t free_colour(const std::vector<std::uint32_t>& at, std::uint32_t vertex) const {
    const auto first = at.begin() + static_cast<std::ptrdiff_t>(vertex * colours_);
    return static_cast<std::uint32_t>(std::find(first, first + colours_, none) - first);
  }

  void colour(std::uint32_t e) {
    const std::uint32_t u = lane(edges_[e]), v = bank(edges_[e]);
    for (std::uint32_t c = 0; c < colours_; ++c)
      if (at_lane(u, c) == none && at_bank(v, c) == none) return place(e, c);
    const std::uint32_t free_at_lane = free_colour(at_lane_, u), free_at_bank = free_colour(at_bank_, v);
    swap_path(v, free_at_lane, free_at_bank);
    place(e, free_at_lane);
  }

  void place(std::uint32_t e, std::uint32_t c) {
    at_lane(lane(edges_[e]), c) = e;
    at_bank(bank(edges_[e]), c) = e;
  }

  // Exchanges two colours along the path that leaves bank `v` by `wanted`; that frees `wanted` at v. The path cannot
  // end at the lane of the new edge, where `wanted` is free already: it reaches lanes by `wanted` only.
  void swap_path(std::uint32_t v, std::uint32_t wanted, std::uint32_t other) {
    path_.clear();
    bool from_bank = true;
    for (std::uint32_t vertex = v, c = wanted;; c = c == wanted ? other : wanted, from_bank = !from_bank) {
      const std::uint32_t e = from_bank ? at_bank(vertex, c) : at_lane(vertex, c);
      if (e == none) break;
      path_.push_back(e);
      vertex = from_bank ? lane(edges_[e]) : bank(edges_[e]);
    }
    std::uint32_t c = wanted;
    for (const std::uint32_t e : path_) {
      if (at_lane(lane(edges_[e]), c) == e) at_lane(lane(edges_[e]), c) = none;
      if (at_bank(bank(edges_[e]), c) == e) at_bank(bank(edges_[e]), c) = none;
      c = c == wanted ? other : wanted;
    }
    c = other;
    for (const std::uint32_t e : path_) {
      place(e, c);
      c = c == wanted ? other : wanted;
    }
  }

  std::span<const Edge> edges_;
  std::uint32_t colours_ = 0;
  std::vector<std::uint32_t> at_lane_, at_bank_, path_;
};

// Springs by their owner's group.
struct Grouped {
  std::vector<std::uint32_t> start;
  std::vector<Edge> edges;
};

Grouped group_by_owner(std::size_t masses, std::span<const Spring> springs) {
  const Ownership ownership(masses, springs);
  const std::size_t groups = (masses + lanes - 1) / lanes;
  Grouped grouped;
  grouped.start.assign(groups + 1, 0);
  for (std::size_t s = 0; s < springs.size(); ++s) ++grouped.start[ownership.owner(s) / lanes + 1];
  for (std::size_t g = 0; g < groups; ++g) grouped.start[g + 1] += grouped.start[g];
  grouped.edges.resize(springs.size());
  std::vector<std::uint32_t> next(grouped.start.begin(), grouped.start.end() - 1);
  for (std::size_t s = 0; s < springs.size(); ++s)
    grouped.edges[next[ownership.owner(s) / lanes]++] = {ownership.owner(s), ownership.partner(s),
                                                         static_cast<std::uint32_t>(s)};
  return grouped;
}

// Masses that a spring joins to each mass, those of mass i at [start[i], start[i + 1]).
struct Neighbours {
  std::vector<std::uint32_t> start;
  std::vector<std::uint16_t> mass;
};

Neighbours find_neighbours(std::size_t masses, std::span<const Spring> springs) {
  Neighbours neighbours;
  neighbours.start.assign(masses + 1, 0);
  for (const Spring& spring : springs) {
    ++neighbours.start[spring.a + 1u];
    ++neighbours.start[spring.b + 1u];
  }
  for (std::size_t i = 0; i < masses; ++i) neighbours.start[i + 1] += neighbours.start[i];
  neighbours.mass.resize(neighbours.start.back());
  std::vector<std::uint32_t> next(neighbours.start.begin(), neighbours.start.end() - 1);
  for (const Spring& spring : springs) {
    neighbours.mass[next[spring.a]++] = spring.b;
    neighbours.mass[next[spring.b]++] = spring.a;
  }
  return neighbours;
}

// Masses for the empty places of one row to look at, in banks that the row leaves free; there are as many of these as
// there are empty places.
class IdlePartners {
 public:
  IdlePartners(const Neighbours& neighbours, std::uint32_t group, std::uint32_t taken_banks)
      : neighbours_(neighbours), masses_(static_cast<std::uint32_t>(neighbours.start.size() - 1)), group_(group),
        taken_(taken_banks) {}

  // A neighbour. Lanes past the last mass stand at memory that is there but belongs to no mass, and look at each
  // other's. `self` if none has a free bank.
  std::uint16_t near(std::uint16_t self) {
    if (self < masses_) {
      for (std::uint32_t k = neighbours_.start[self]; k < neighbours_.start[self + 1u]; ++k)
        if (take(neighbours_.mass[k])) return neighbours_.mass[k];
    } else {
      for (std::uint32_t mass = masses_; mass % lanes != 0; ++mass)
        if (take(mass)) return static_cast<std::uint16_t>(mass);
    }
    return self;
  }

  // Any mass of the own group or the one before; `self` if none has a free bank.
  std::uint16_t any(std::uint16_t self) {
    if (self >= masses_ || take(self)) return self;
    for (std::uint32_t mass = group_ * lanes; mass < masses_ && mass < (group_ + 1) * lanes; ++mass)
      if (take(mass)) return static_cast<std::uint16_t>(mass);
    for (std::uint32_t mass = (group_ > 0 ? group_ - 1 : 0) * lanes; mass < group_ * lanes; ++mass)
      if (take(mass)) return static_cast<std::uint16_t>(mass);
    return self;
  }

 private:
  bool take(std::uint32_t mass) {
    if (taken_ >> mass % lanes & 1) return false;
    taken_ |= 1u << mass % lanes;
    return true;
  }

  const Neighbours& neighbours_;
  const std::uint32_t masses_, group_;
  std::uint32_t taken_;
};

void append_row(Schedule& schedule, std::span<const Edge> edges, const EdgeColouring& colouring, std::uint32_t colour,
                const Neighbours& neighbours) {
  const std::uint32_t group = schedule.groups();
  std::array<ScheduledSpring, lanes> row;
  std::uint32_t taken_banks = 0;
  for (std::uint32_t lane = 0; lane < lanes; ++lane) {
    const std::uint32_t e = colouring.edge_at(lane, colour);
    if (e == EdgeColouring::none) continue;
    row[lane] = {edges[e].spring, edges[e].partner};
    taken_banks |= 1u << edges[e].partner % lanes;
  }
  IdlePartners idle(neighbours, group, taken_banks);
  const auto for_each_empty = [&](auto visit) {
    for (std::uint32_t lane = 0; lane < lanes; ++lane)
      if (row[lane].spring == no_spring) visit(row[lane].partner, static_cast<std::uint16_t>(group * lanes + lane));
  };
  for_each_empty([&](std::uint16_t& partner, std::uint16_t self) { partner = idle.near(self); });
  for_each_empty([&](std::uint16_t& partner, std::uint16_t self) {
    if (partner == self) partner = idle.any(self);
  });
  schedule.places.insert(schedule.places.end(), row.begin(), row.end());
}

void append_group(Schedule& schedule, std::span<const Edge> edges, const Neighbours& neighbours) {
  const EdgeColouring colouring(edges);
  for (std::uint32_t colour = 0; colour < colouring.colours(); ++colour)
    append_row(schedule, edges, colouring, colour, neighbours);
  schedule.row_start.push_back(schedule.row_start.back() + colouring.colours());
}

}  // namespace

Schedule schedule_springs(std::size_t masses, std::span<const Spring> springs) {
  const Grouped grouped = group_by_owner(masses, springs);
  Schedule schedule;
  schedule.row_start.push_back(0);
  schedule.places.reserve(springs.size() * 5 / 4);
  const Neighbours neighbours = find_neighbours(masses, springs);
  for (std::size_t g = 0; g + 1 < grouped.start.size(); ++g)
    append_group(schedule, std::span(grouped.edges).subspan(grouped.start[g], grouped.start[g + 1] - grouped.start[g]),
                 neighbours);
  return schedule;
}

}  // namespace mercury::cuda
