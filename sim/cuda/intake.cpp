// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/intake.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <optional>

#include "mercury/parallel.h"
#include "mercury/stopwatch.h"
#include "mercury/work_counter.h"

namespace mercury::cuda {
namespace {

// Pinned memory takes long to make, so a portion is small; but not so small that it leaves cores idle.
constexpr std::size_t portion_bytes = std::size_t{4} << 20, min_portion = 256, max_portion = 4096;

// The largest number of tiles in the class of robots with this many: classes of 1, 2, ... 8, 10, ... 16, 20, ... tiles.
std::uint32_t class_limit(std::uint32_t tiles) {
  const std::uint32_t width = std::max(1u, std::bit_ceil(tiles) / 8);
  return (tiles + width - 1) / width * width;
}

struct NewRobot {
  const Robot* robot = nullptr;
  RobotFindings findings;
  Place place{};
  std::uint32_t first_of_topology = 0;
};

class Intake {
 public:
  Intake(SizeClasses& classes, std::span<const Robot* const> robots, const Configuration& configuration,
         ArrangedRobots* arranged, LoadTimes& times, const WorkWatch& watch)
      : classes_(classes), configuration_(configuration), times_(times), watch_(watch), new_robots_(robots.size()),
        arrangements_(robots.size()), users_(robots.size()), order_(robots.size()) {
    const Stopwatch stopwatch(times_.schedule);
    std::vector<std::optional<ArrangedRobots::Entry>> known(robots.size());
    if (arranged) known = arranged->take(robots);
    const auto is_repeated = [&](std::size_t i) { return i > 0 && robots[i] == robots[i - 1]; };
    parallel_for(0, robots.size(), [&](std::size_t i) {
      if (!is_repeated(i)) new_robots_[i] = {robots[i], known[i] ? known[i]->findings : look_at(*robots[i])};
    });
    std::vector<std::uint64_t> keys(robots.size());
    for (std::size_t i = 0; i < robots.size(); ++i) {
      if (is_repeated(i)) new_robots_[i] = new_robots_[i - 1];
      keys[i] = new_robots_[i].findings.topology;
    }
    const std::vector<std::uint32_t> first = first_of_topology(robots, keys);
    for (std::size_t i = 0; i < robots.size(); ++i) {
      new_robots_[i].first_of_topology = first[i];
      ++users_[first[i]];
      if (known[i] && known[i]->arrangement) arrangements_[first[i]] = std::move(known[i]->arrangement);
    }
    assign_places();
  }

  void upload() {
    try {
      for (std::size_t first = 0; first < order_.size();) {
        const std::size_t last = end_of_portion(first);
        upload_portion(std::span(order_).subspan(first, last - first));
        first = last;
        if (watch_) watch_("uploading robots", first, order_.size());
      }
      int device = 0;
      check(cudaGetDevice(&device), "querying the current device");
      parallel_tasks(0, first_new_.size(), [&](std::size_t c) {
        check(cudaSetDevice(device), "choosing the device");
        classes_[c].publish(first_new_[c], configuration_);
      });
    } catch (...) {
      for (std::size_t c = 0; c < first_new_.size(); ++c) classes_[c].truncate(first_new_[c]);
      throw;
    }
  }

  std::vector<Place> places() const {
    std::vector<Place> places;
    places.reserve(new_robots_.size());
    for (const NewRobot& entry : new_robots_) places.push_back(entry.place);
    return places;
  }

 private:
  // Sorts the new robots by class, then by descending springs, and gives them the next places of their classes.
  void assign_places() {
    for (NewRobot& entry : new_robots_)
      entry.place.size_class = classes_.class_for(tiles_for(entry.robot->masses.size()), entry.findings.record_words);
    std::iota(order_.begin(), order_.end(), 0u);
    std::ranges::stable_sort(order_, [&](std::uint32_t a, std::uint32_t b) {
      const NewRobot &one = new_robots_[a], &other = new_robots_[b];
      return std::pair(one.place.size_class, other.robot->springs.size()) <
             std::pair(other.place.size_class, one.robot->springs.size());
    });
    std::vector<std::uint32_t> counts(classes_.size());
    for (const NewRobot& entry : new_robots_) ++counts[entry.place.size_class];
    std::vector<std::uint32_t> next;
    for (std::size_t c = 0; c < classes_.size(); ++c) next.push_back(classes_[c].append(counts[c]));
    first_new_ = next;
    for (const std::uint32_t i : order_) new_robots_[i].place.number = next[new_robots_[i].place.size_class]++;
  }

  // About as many robots as fit into a portion.
  std::size_t end_of_portion(std::size_t first) const {
    std::size_t bytes = 0, last = first;
    const auto most_bytes = [&] { return last - first < min_portion ? 16 * portion_bytes : portion_bytes; };
    while (last < order_.size() && last - first < max_portion && (last == first || bytes < most_bytes())) {
      const Robot& robot = *new_robots_[order_[last++]].robot;
      bytes += 40 * robot.masses.size() + 6 * robot.springs.size() + 4 * robot.faces.size();
    }
    return last;
  }

  void upload_portion(std::span<const std::uint32_t> portion) {
    arrange_topologies(portion);
    upload_chunks(portion);
    for (const std::uint32_t i : portion) {
      const std::uint32_t first = new_robots_[i].first_of_topology;
      if (--users_[first] == 0) arrangements_[first].reset();
    }
  }

  void arrange_topologies(std::span<const std::uint32_t> portion) {
    const Stopwatch stopwatch(times_.schedule);
    std::vector<std::uint32_t> wanted;
    for (const std::uint32_t i : portion)
      if (!arrangements_[new_robots_[i].first_of_topology]) wanted.push_back(new_robots_[i].first_of_topology);
    std::ranges::sort(wanted);
    wanted.erase(std::ranges::unique(wanted).begin(), wanted.end());
    WorkCounter counter(watch_, "arranging robots", wanted.size());
    parallel_for(0, wanted.size(), [&](std::size_t k) {
      arrangements_[wanted[k]] = std::make_unique<const Arrangement>(arrange(*new_robots_[wanted[k]].robot));
      counter.add_one();
    });
  }

  // Robots of a portion in consecutive places of a class.
  struct Run {
    SizeClass& to;
    std::span<const std::uint32_t> robots;
  };

  std::vector<Run> runs_of(std::span<const std::uint32_t> portion) const {
    const auto class_of = [&](std::size_t k) { return new_robots_[portion[k]].place.size_class; };
    std::vector<Run> runs;
    for (std::size_t first = 0, last = 0; first < portion.size(); first = last) {
      while (last < portion.size() && class_of(last) == class_of(first)) ++last;
      runs.push_back({classes_[class_of(first)], portion.subspan(first, last - first)});
    }
    return runs;
  }

  // Those before it are filled.
  std::uint32_t first_place_of(const Run& run) const { return new_robots_[run.robots.front()].place.number; }

  void upload_chunks(std::span<const std::uint32_t> portion) {
    const Stopwatch stopwatch(times_.upload);
    const std::vector<Run> runs = runs_of(portion);
    std::size_t bytes = 0;
    for (const Run& run : runs) {
      run.to.make_room(sizes_of(run), first_place_of(run), configuration_.solver);
      bytes += run.robots.size() * run.to.sizes().bytes();
    }
    if (bytes > memory_.bytes()) memory_ = PinnedBuffer(bytes);
    std::byte* memory = memory_.data();
    for (const Run& run : runs) {
      Chunks chunks(run.to.sizes(), run.robots.size(), memory, run.to.address_fields());
      memory += run.robots.size() * run.to.sizes().bytes();
      parallel_for(0, run.robots.size(), [&](std::size_t k) {
        const NewRobot& entry = new_robots_[run.robots[k]];
        const Arrangement& arrangement = arrangement_of(run.robots[k]);
        run.to.set_robot(entry.place.number, *entry.robot, entry.findings.measures, arrangement);
        chunks.fill(k, *entry.robot, arrangement);
      });
      run.to.write_chunks(first_place_of(run), chunks);
    }
    for (const Run& run : runs) run.to.urgent().synchronize();  // `memory_` is free again
  }

  ChunkSizes sizes_of(const Run& run) const {
    ChunkSizes sizes;
    for (const std::uint32_t i : run.robots) {
      const Arrangement& arrangement = arrangement_of(i);
      sizes.tiles = std::max(sizes.tiles, arrangement.schedule.tiles());
      sizes.groups = std::max(sizes.groups, groups_of(arrangement.schedule));
      sizes.face_pairs = std::max(sizes.face_pairs, static_cast<std::uint32_t>(arrangement.faces.size()));
    }
    return sizes;
  }

  const Arrangement& arrangement_of(std::uint32_t i) const { return *arrangements_[new_robots_[i].first_of_topology]; }

  SizeClasses& classes_;
  const Configuration& configuration_;
  LoadTimes& times_;
  const WorkWatch& watch_;
  PinnedBuffer memory_;  // the chunks of a portion, on their way
  std::vector<NewRobot> new_robots_;
  std::vector<std::unique_ptr<const Arrangement>> arrangements_;  // [new robot], at the first of each topology
  std::vector<std::uint32_t> users_;      // [new robot], of its arrangement, still to be uploaded
  std::vector<std::uint32_t> order_;      // new robots by class and place
  std::vector<std::uint32_t> first_new_;  // [class], the place of its first new robot
};

}  // namespace

std::uint32_t SizeClasses::class_for(std::uint32_t tiles, std::uint32_t record_words) {
  const auto [at, is_new] =
      index_.try_emplace({class_limit(tiles), record_words}, static_cast<std::uint32_t>(classes_.size()));
  if (is_new) classes_.push_back(std::make_unique<SizeClass>(record_words));
  return at->second;
}

void SizeClasses::free_empty() {
  for (auto& robots : classes_)
    if (robots->size() == 0) robots = std::make_unique<SizeClass>(robots->sizes().record_words);
}

std::vector<Place> add_robots(SizeClasses& classes, std::span<const Robot* const> robots,
                              const Configuration& configuration, ArrangedRobots* arranged, LoadTimes& times,
                              const WorkWatch& watch) {
  Intake intake(classes, robots, configuration, arranged, times, watch);
  intake.upload();
  return intake.places();
}

}  // namespace mercury::cuda
