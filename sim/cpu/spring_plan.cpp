// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/spring_plan.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "mercury/telemetry.h"
#include "sim/physics/fixed_point.h"

namespace mercury::cpu {
namespace {

struct Link {
  std::uint32_t owner, partner;  // places
  std::uint32_t spring;
};

// What a row costs in runs, and what it costs every block that a robot has rows at all: masses are then kept in rows
// too.
constexpr double row_cost = 2.5, rows_cost = 1.5;
// Springs in rows a lane, about.
constexpr double row_fill = 0.9;

class Planner {
 public:
  Planner(const Robot& robot, const Places& places) : robot_(robot), places_(places), lanes_(places.lanes) {
    find_runs();
    choose_runs();
    share_out_rest();
    plan_.blocks.resize(places.blocks());
    plan_.bias.assign(places.padded(), 0);
    for (std::uint32_t block = 0; block < places.blocks(); ++block) {
      append_runs(block);
      append_rows(block);
    }
    plan_.hardness.resize(plan_.rest_length.size());
    plan_.factor.resize(plan_.rest_length.size());
  }

  SpringPlan take() { return std::move(plan_); }

 private:
  std::uint32_t block_of(std::uint32_t place) const { return place / static_cast<std::uint32_t>(lanes_); }
  std::size_t lane_of(std::uint32_t place) const { return place % lanes_; }

  // Springs of one block with the same way from owner to partner could make a run.
  void find_runs() {
    links_.reserve(robot_.springs.size());
    for (std::uint32_t s = 0; s < robot_.springs.size(); ++s) {
      const auto [low, high] = std::minmax(places_.of_mass[robot_.springs[s].a], places_.of_mass[robot_.springs[s].b]);
      links_.push_back({low, high, s});
    }
    // Two springs between the same masses cannot share a run.
    const auto key = [&](const Link& link) { return std::tuple(block_of(link.owner), link.partner - link.owner); };
    std::ranges::sort(links_, {},
                      [&](const Link& link) { return std::tuple_cat(key(link), std::tuple(link.owner, link.spring)); });
    for (auto first = links_.begin(); first != links_.end();) {
      const auto last = std::find_if(first, links_.end(), [&](const Link& link) { return key(link) != key(*first); });
      const auto again = std::stable_partition(first, last, [&, before = ~0u](const Link& link) mutable {
        return std::exchange(before, link.owner) != link.owner;
      });
      for (const auto& [begin, end] : {std::pair(first, again), std::pair(again, last)})
        if (begin != end) candidates_.push_back({begin, end});
      first = last;
    }
  }

  // Runs only where so many lanes of a block are in use that this is cheapest.
  void choose_runs() {
    std::size_t fewest = 1;
    double cheapest = cost(1);
    for (std::size_t n = 2; n <= lanes_ + 1; ++n)
      if (const double c = cost(n); c < cheapest) {
        cheapest = c;
        fewest = n;
      }
    for (const std::span<const Link> candidate : candidates_) {
      if (candidate.size() >= fewest)
        runs_.push_back(candidate);
      else
        in_rows_.insert(in_rows_.end(), candidate.begin(), candidate.end());
    }
  }
  double cost(std::size_t fewest_in_run) const {
    double runs = 0, rest = 0;
    for (const std::span<const Link> candidate : candidates_)
      (candidate.size() >= fewest_in_run ? runs : rest) +=
          candidate.size() >= fewest_in_run ? 1 : static_cast<double>(candidate.size());
    if (rest == 0) return runs;
    return runs + row_cost * rest / (row_fill * static_cast<double>(lanes_)) +
           rows_cost * static_cast<double>(places_.blocks());
  }

  // The longest lane sets how many rows a block has: springs go to the end that has fewer.
  void share_out_rest() {
    std::vector<std::uint32_t> load(places_.padded());
    for (const Link& link : in_rows_) ++load[link.owner];
    constexpr int sweeps = 8;
    for (int sweep = 0; sweep < sweeps; ++sweep)
      for (Link& link : in_rows_) {
        const std::uint32_t here = load[link.owner], there = load[link.partner] + 1;
        if (there > here || (there == here && sweep % 2 == 0)) continue;
        --load[link.owner];
        std::swap(link.owner, link.partner);
        ++load[link.owner];
      }
    std::ranges::stable_sort(in_rows_, {}, [&](const Link& link) { return block_of(link.owner); });
  }

  // Appends an empty slot of a block; its first place in the arrays a lane.
  std::size_t append_slot(std::uint32_t block) {
    const std::size_t first = plan_.rest_length.size();
    plan_.rest_length.resize(first + lanes_, 0.0f);
    plan_.spring.resize(first + lanes_, no_spring);
    for (std::size_t lane = 0; lane < lanes_; ++lane)
      plan_.bias[block * lanes_ + lane] += std::uint32_t{rounding_magic_bits};
    return first;
  }
  void fill(std::size_t slot, const Link& link) {
    plan_.rest_length[slot + lane_of(link.owner)] = robot_.springs[link.spring].rest_length;
    plan_.spring[slot + lane_of(link.owner)] = link.spring;
  }
  // A lane's force will be added at this place.
  void expect(std::uint32_t place) { plan_.bias[place] -= std::uint32_t{rounding_magic_bits}; }

  void append_runs(std::uint32_t block) {
    const auto stride = static_cast<std::uint32_t>(places_.padded());
    for (; next_run_ < runs_.size() && block_of(runs_[next_run_].front().owner) == block; ++next_run_) {
      const Link& first = runs_[next_run_].front();
      const auto partner = static_cast<std::uint32_t>(block * lanes_) + (first.partner - first.owner);
      const std::size_t slot = append_slot(block);
      for (const Link& link : runs_[next_run_]) fill(slot, link);
      for (std::uint32_t lane = 0; lane < lanes_; ++lane) expect(partner + lane);
      plan_.runs.push_back({partner, plan_.blocks[block].runs++ % reaction_arrays * stride + partner});
    }
  }

  void append_rows(std::uint32_t block) {
    std::vector<std::vector<Link>> of_lane(lanes_);
    for (; next_in_rows_ < in_rows_.size() && block_of(in_rows_[next_in_rows_].owner) == block; ++next_in_rows_)
      of_lane[lane_of(in_rows_[next_in_rows_].owner)].push_back(in_rows_[next_in_rows_]);
    const std::size_t rows = std::ranges::max(of_lane, {}, &std::vector<Link>::size).size();
    for (std::size_t row = 0; row < rows; ++row) {
      const std::size_t slot = append_slot(block);
      for (std::uint32_t lane = 0; lane < lanes_; ++lane) {
        auto partner = static_cast<std::uint32_t>(block * lanes_) + lane;  // an empty lane joins the mass to itself
        if (row < of_lane[lane].size()) {
          fill(slot, of_lane[lane][row]);
          partner = of_lane[lane][row].partner;
        }
        expect(partner);
        plan_.partners.push_back(4 * partner);
      }
    }
    plan_.blocks[block].rows = static_cast<std::uint32_t>(rows);
  }

  const Robot& robot_;
  const Places& places_;
  const std::size_t lanes_;
  std::vector<Link> links_;
  std::vector<std::span<const Link>> candidates_, runs_;
  std::vector<Link> in_rows_;
  std::size_t next_run_ = 0, next_in_rows_ = 0;
  SpringPlan plan_;
};

}  // namespace

SpringPlan plan_springs(const Robot& robot, const Places& places) { return Planner(robot, places).take(); }

std::vector<std::uint32_t> plan_faces(std::span<const FacePair> pairs, const Places& places) {
  std::vector<std::uint32_t> corners;
  for (std::size_t first = 0; first < pairs.size(); first += places.lanes)
    for (const auto corner : {&FacePair::a, &FacePair::b, &FacePair::c, &FacePair::d})
      for (std::size_t p = first; p < first + places.lanes; ++p)
        corners.push_back(4 * places.of_mass[p < pairs.size() ? pairs[p].*corner : 0]);
  return corners;
}

}  // namespace mercury::cpu
