// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/layout/spring_schedule.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "mercury/telemetry.h"
#include "sim/physics/fixed_point.h"

namespace mercury::cpu {
namespace {

struct ScheduledSpring {
  std::uint32_t owner, partner;  // slots
  std::uint32_t spring;
  std::uint32_t repetition = 0;  // springs before it that join the same masses
};

// What a step of one robot costs, in runs.
constexpr double gathered_row_cost = 2.5;
constexpr double aos_cost_per_tile = 1.5;  // of keeping x_aos, which only gathered rows need
// The part of a gathered row's lanes that have a spring, about.
constexpr double gathered_row_fill = 0.9;

class Scheduler {
 public:
  Scheduler(const Robot& robot, const Slots& slots) : robot_(robot), slots_(slots), lanes_(slots.lanes) {
    find_runs();
    choose_runs();
    balance_owners();
    schedule_.tiles.resize(slots.tiles());
    schedule_.bias.assign(slots.size_with_spare(), 0);
    for (std::uint32_t tile = 0; tile < slots.tiles(); ++tile) {
      append_runs(tile);
      append_gathered_rows(tile);
    }
    schedule_.stiffness.resize(schedule_.rest_length.size());
    schedule_.relaxation_time.resize(schedule_.rest_length.size());
    schedule_.factor.resize(schedule_.rest_length.size());
  }

  SpringSchedule take() { return std::move(schedule_); }

 private:
  std::uint32_t tile_of(std::uint32_t slot) const { return slot / static_cast<std::uint32_t>(lanes_); }
  std::size_t lane_of(std::uint32_t slot) const { return slot % lanes_; }

  // Springs of one tile with the same distance from owner slot to partner slot could form a run.
  void find_runs() {
    scheduled_.reserve(robot_.springs.size());
    for (std::uint32_t s = 0; s < robot_.springs.size(); ++s) {
      const auto [low, high] = std::minmax(slots_.of_mass[robot_.springs[s].a], slots_.of_mass[robot_.springs[s].b]);
      scheduled_.push_back({low, high, s});
    }
    const auto key = [&](const ScheduledSpring& s) { return std::tuple(tile_of(s.owner), s.partner - s.owner); };
    std::ranges::sort(scheduled_, {},
                      [&](const ScheduledSpring& s) { return std::tuple_cat(key(s), std::tuple(s.owner, s.spring)); });
    // Springs between the same masses cannot share a run: the first of each is in one, the second in another, ...
    for (std::size_t i = 1; i < scheduled_.size(); ++i)
      if (const ScheduledSpring& before = scheduled_[i - 1];
          before.owner == scheduled_[i].owner && before.partner == scheduled_[i].partner)
        scheduled_[i].repetition = before.repetition + 1;
    const auto run_key = [&](const ScheduledSpring& s) { return std::tuple_cat(key(s), std::tuple(s.repetition)); };
    std::ranges::stable_sort(scheduled_, {}, run_key);
    for (auto first = scheduled_.begin(); first != scheduled_.end();) {
      const auto last = std::find_if(first, scheduled_.end(),
                                     [&](const ScheduledSpring& s) { return run_key(s) != run_key(*first); });
      candidates_.push_back({first, last});
      first = last;
    }
  }

  // A run needs a minimum number of springs; takes the minimum that makes all springs cheapest.
  void choose_runs() {
    std::size_t min_springs = 1;
    double cheapest = cost(1);
    for (std::size_t n = 2; n <= lanes_ + 1; ++n)
      if (const double c = cost(n); c < cheapest) {
        cheapest = c;
        min_springs = n;
      }
    for (const std::span<const ScheduledSpring> candidate : candidates_) {
      if (candidate.size() >= min_springs)
        runs_.push_back(candidate);
      else
        gathered_.insert(gathered_.end(), candidate.begin(), candidate.end());
    }
  }
  double cost(std::size_t min_springs_in_run) const {
    double runs = 0, rest = 0;
    for (const std::span<const ScheduledSpring> candidate : candidates_)
      (candidate.size() >= min_springs_in_run ? runs : rest) +=
          candidate.size() >= min_springs_in_run ? 1 : static_cast<double>(candidate.size());
    if (rest == 0) return runs;
    return runs + gathered_row_cost * rest / (gathered_row_fill * static_cast<double>(lanes_)) +
           aos_cost_per_tile * static_cast<double>(slots_.tiles());
  }

  // The busiest lane of a tile sets its number of gathered rows: springs go to the end that owns fewer.
  void balance_owners() {
    std::vector<std::uint32_t> load(slots_.size_with_spare());
    for (const ScheduledSpring& s : gathered_) ++load[s.owner];
    constexpr int sweeps = 8;
    for (int sweep = 0; sweep < sweeps; ++sweep)
      for (ScheduledSpring& s : gathered_) {
        const std::uint32_t here = load[s.owner], there = load[s.partner] + 1;
        if (there > here || (there == here && sweep % 2 == 0)) continue;
        --load[s.owner];
        std::swap(s.owner, s.partner);
        ++load[s.owner];
      }
    std::ranges::stable_sort(gathered_, {}, [&](const ScheduledSpring& s) { return tile_of(s.owner); });
  }

  // Appends a row of padding to a tile. Returns its first entry.
  std::size_t append_row(std::uint32_t tile) {
    const std::size_t first = schedule_.rest_length.size();
    schedule_.rest_length.resize(first + lanes_, 0.0f);
    schedule_.spring.resize(first + lanes_, no_spring);
    for (std::size_t lane = 0; lane < lanes_; ++lane)
      schedule_.bias[tile * lanes_ + lane] += std::uint32_t{rounding_magic_bits};
    return first;
  }
  void fill(std::size_t first_entry, const ScheduledSpring& s) {
    schedule_.rest_length[first_entry + lane_of(s.owner)] = robot_.springs[s.spring].rest_length;
    schedule_.spring[first_entry + lane_of(s.owner)] = s.spring;
  }
  // Each step, one entry's force will be added to this slot's sum.
  void expect_force_at(std::uint32_t slot) { schedule_.bias[slot] -= std::uint32_t{rounding_magic_bits}; }

  void append_runs(std::uint32_t tile) {
    const auto stride = static_cast<std::uint32_t>(slots_.size_with_spare());
    const std::size_t first_run = next_run_;
    while (next_run_ < runs_.size() && tile_of(runs_[next_run_].front().owner) == tile) ++next_run_;
    for (std::size_t i = first_run; i < next_run_; ++i) {
      const std::uint32_t array = choose_next_run(i, next_run_, tile);
      const std::uint32_t partner = first_partner(runs_[i], tile);
      const std::size_t first_entry = append_row(tile);
      for (const ScheduledSpring& s : runs_[i]) fill(first_entry, s);
      for (std::uint32_t lane = 0; lane < lanes_; ++lane) expect_force_at(partner + lane);
      schedule_.runs.push_back({partner, array * stride + partner});
      latest_[latest_count_++ % runs_in_flight] = {partner, array};
      ++schedule_.tiles[tile].runs;
    }
  }
  // The slot of the first lane's partner.
  std::uint32_t first_partner(std::span<const ScheduledSpring> run, std::uint32_t tile) const {
    return tile * static_cast<std::uint32_t>(lanes_) + (run.front().partner - run.front().owner);
  }
  // Moves that one of the runs from `next` to `end` to `next` which goes best with the latest ones. Returns the
  // reaction array that it adds to.
  std::uint32_t choose_next_run(std::size_t next, std::size_t end, std::uint32_t tile) {
    std::size_t best = next, largest_distance = 0;
    std::uint32_t best_array = 0;
    for (std::size_t i = next; i < end && largest_distance < runs_in_flight; ++i)
      for (std::uint32_t array = 0; array < reaction_arrays && largest_distance < runs_in_flight; ++array)
        if (const std::size_t distance = runs_since_overlap(first_partner(runs_[i], tile), array);
            distance > largest_distance) {
          best = i;
          best_array = array;
          largest_distance = distance;
        }
    std::swap(runs_[next], runs_[best]);
    return best_array;
  }
  // How many runs ago one was added to a part of these slots in this array, or `runs_in_flight`. Exactly the same slots
  // do not count: what was stored is there to be loaded at once.
  std::size_t runs_since_overlap(std::uint32_t partner, std::uint32_t array) const {
    const auto lanes = static_cast<std::uint32_t>(lanes_);
    for (std::size_t ago = 1; ago < runs_in_flight && ago <= latest_count_; ++ago) {
      const auto& [other, other_array] = latest_[(latest_count_ - ago) % runs_in_flight];
      if (other_array == array && other != partner && other < partner + lanes && partner < other + lanes) return ago;
    }
    return runs_in_flight;
  }

  void append_gathered_rows(std::uint32_t tile) {
    std::vector<std::vector<ScheduledSpring>> by_lane(lanes_);
    for (; next_gathered_ < gathered_.size() && tile_of(gathered_[next_gathered_].owner) == tile; ++next_gathered_)
      by_lane[lane_of(gathered_[next_gathered_].owner)].push_back(gathered_[next_gathered_]);
    const std::size_t rows = std::ranges::max(by_lane, {}, &std::vector<ScheduledSpring>::size).size();
    for (std::size_t row = 0; row < rows; ++row) {
      const std::size_t first_entry = append_row(tile);
      for (std::uint32_t lane = 0; lane < lanes_; ++lane) {
        auto partner = static_cast<std::uint32_t>(tile * lanes_) + lane;  // padding joins the mass to itself
        if (row < by_lane[lane].size()) {
          fill(first_entry, by_lane[lane][row]);
          partner = by_lane[lane][row].partner;
        }
        expect_force_at(partner);
        schedule_.partners.push_back(4 * partner);
      }
    }
    schedule_.tiles[tile].gathered_rows = static_cast<std::uint32_t>(rows);
  }

  const Robot& robot_;
  const Slots& slots_;
  const std::size_t lanes_;
  std::vector<ScheduledSpring> scheduled_;
  std::vector<std::span<const ScheduledSpring>> candidates_, runs_;
  std::vector<ScheduledSpring> gathered_;
  std::size_t next_run_ = 0, next_gathered_ = 0;
  static constexpr std::size_t runs_in_flight = 12;  // about as many as a processor has in hand at a time
  struct RunTarget {
    std::uint32_t partner = 0, array = 0;
  };
  std::array<RunTarget, runs_in_flight> latest_;  // runs, the latest at latest_count_ - 1, modulo `runs_in_flight`
  std::size_t latest_count_ = 0;
  SpringSchedule schedule_;
};

struct FaceRunPairs {
  std::array<std::uint32_t, 4> first{};  // slots of the corners of the first pair
  std::vector<std::uint32_t> pairs;      // by number; each in the lane that its corner a has from there
  std::size_t before = 0;                // runs of the same side
};

// Pairs whose corners b, c and d are equally far from a are of one side, and can be in one run. A run with fewer pairs
// than the limit costs more than to gather them. `others`: all pairs that are in no run, ascending.
std::vector<FaceRunPairs> face_runs(std::span<const FacePair> pairs, const Slots& slots,
                                    std::vector<std::uint32_t>& others) {
  const std::size_t min_pairs = (3 * slots.lanes + 7) / 8;
  const auto corners_of = [&](const FacePair& pair) {
    return std::array{slots.of_mass[pair.a], slots.of_mass[pair.b], slots.of_mass[pair.c], slots.of_mass[pair.d]};
  };
  using Side = std::array<std::uint32_t, 3>;                         // distances of b, c and d from a, modulo 2^32
  std::vector<std::tuple<Side, std::uint32_t, std::uint32_t>> keys;  // corner a, number
  keys.reserve(pairs.size());
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    const auto [a, b, c, d] = corners_of(pairs[i]);
    keys.emplace_back(Side{b - a, c - a, d - a}, a, i);
  }
  std::ranges::sort(keys);
  std::vector<FaceRunPairs> runs;
  std::size_t of_side = 0;
  for (auto key = keys.begin(); key != keys.end();) {
    const auto [side, first, number] = *key;
    if (key != keys.begin() && std::get<0>(*(key - 1)) != side) of_side = 0;
    FaceRunPairs run{.first = corners_of(pairs[number]), .pairs = {}, .before = of_side};
    std::uint32_t lanes = 0;
    for (; key != keys.end() && std::get<0>(*key) == side && std::get<1>(*key) < first + slots.lanes; ++key) {
      const std::uint32_t lane = 1u << (std::get<1>(*key) - first);
      ((lanes & lane) != 0 ? others : run.pairs).push_back(std::get<2>(*key));
      lanes |= lane;
    }
    if (run.pairs.size() >= min_pairs) {
      runs.push_back(std::move(run));
      ++of_side;
    } else {
      others.insert(others.end(), run.pairs.begin(), run.pairs.end());
    }
  }
  std::ranges::sort(others);
  // Runs of one side add to sums that overlap, so sides take turns: a load then waits for no store (spring_schedule.h).
  std::ranges::stable_sort(runs, {}, &FaceRunPairs::before);
  return runs;
}

}  // namespace

SpringSchedule schedule_springs(const Robot& robot, const Slots& slots) { return Scheduler(robot, slots).take(); }

FaceSchedule schedule_faces(std::span<const FacePair> pairs, std::span<const PairBacks> backs, const Slots& slots) {
  FaceSchedule schedule;
  const auto add_entries = [&] {
    const std::size_t entries = schedule.dither.size();
    schedule.dither.resize(entries + slots.lanes);
    if (!backs.empty()) schedule.backs.resize(2 * schedule.dither.size());
    return entries;
  };
  const auto set_pair = [&](std::size_t entries, std::size_t lane, std::uint32_t pair) {
    schedule.dither[entries + lane] = dither_of_pair(pair);
    if (backs.empty()) return;
    schedule.backs[2 * entries + lane] = 4 * slots.of_mass[backs[pair].first];
    schedule.backs[2 * entries + slots.lanes + lane] = 4 * slots.of_mass[backs[pair].second];
  };
  std::vector<std::uint32_t> gathered;
  for (const auto& [first, numbers, before] : face_runs(pairs, slots, gathered)) {
    FaceSchedule::Run run{.corners = first};
    const std::size_t entries = add_entries();
    for (const std::uint32_t pair : numbers) {
      const std::uint32_t lane = slots.of_mass[pairs[pair].a] - first[0];
      run.lanes |= 1u << lane;
      set_pair(entries, lane, pair);
    }
    schedule.runs.push_back(run);
  }
  for (std::size_t first = 0; first < gathered.size(); first += slots.lanes) {
    for (const auto corner : {&FacePair::a, &FacePair::b, &FacePair::c, &FacePair::d})
      for (std::size_t i = first; i < first + slots.lanes; ++i)
        schedule.tiles.push_back(4 * slots.of_mass[i < gathered.size() ? pairs[gathered[i]].*corner : 0]);
    const std::size_t entries = add_entries();
    for (std::size_t i = first; i < std::min(first + slots.lanes, gathered.size()); ++i)
      set_pair(entries, i - first, gathered[i]);
  }
  return schedule;
}

}  // namespace mercury::cpu
