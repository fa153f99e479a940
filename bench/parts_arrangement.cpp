// SPDX-License-Identifier: Apache-2.0
// The parts of arranging a robot for CUDA, on the host: time per robot, and how good the result is.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "bench/cpu_lattice.h"
#include "mercury/nn_robot.h"
#include "mercury/random_voxel.h"
#include "sim/cuda/arrangement.h"
#include "sim/cuda/rest_lengths.h"
#include "sim/physics/measures.h"

namespace mercury::bench {
namespace {

using State = benchmark::State;

enum Kind { random_voxels, large_voxels, network, full_lattice };

const std::vector<Robot>& robots_of(const State& state) {
  static const std::array<std::vector<Robot>, 4> robots{
      random_voxel_robots({}, 1, 200), random_voxel_robots({.smallest = {10, 10, 10}, .largest = {10, 10, 10}}, 1, 20),
      random_nn_robots({.spacing = 0}, 1, 20), std::vector<Robot>{lattice(10)}};
  return robots[static_cast<std::size_t>(state.range(0))];
}

// One robot after the other.
template <class Part>
void for_each_robot(State& state, Part part) {
  const std::vector<Robot>& robots = robots_of(state);
  std::size_t next = 0;
  for (auto _ : state) {
    part(robots[next]);
    next = (next + 1) % robots.size();
  }
}

void all_kinds(benchmark::internal::Benchmark* row) {
  row->ArgName("kind")->Arg(random_voxels)->Arg(large_voxels)->Arg(network)->Arg(full_lattice);
  row->Unit(benchmark::kMicrosecond);
}

// The passes of an access to each column of a face tile: a read takes as many as the busiest bank has different masses,
// an addition as many as it has corners.
struct Passes {
  std::size_t reads = 0, additions = 0;
};

void count_face_tile(const FacePair* pairs, Passes& passes) {
  std::array<std::array<std::vector<std::uint16_t>, cuda::lanes>, 4> slots;  // [column][bank]
  for (std::uint32_t i = 0; i < cuda::lanes; ++i) {
    const FacePair& p = pairs[i];
    if (p == cuda::padding_faces) continue;
    for (const auto& [column, slot] : {std::pair(0, p.a), std::pair(1, p.b), std::pair(2, p.c), std::pair(3, p.d)})
      slots[static_cast<std::size_t>(column)][slot % cuda::lanes].push_back(slot);
  }
  for (auto& column : slots) {
    std::size_t reads = 0, additions = 0;
    for (std::vector<std::uint16_t>& bank : column) {
      additions = std::max(additions, bank.size());
      std::ranges::sort(bank);
      reads = std::max(reads, bank.size() - std::ranges::unique(bank).size());
    }
    passes.reads += reads;
    passes.additions += additions;
  }
}

void whole(State& state) {
  for_each_robot(state, [](const Robot& robot) { benchmark::DoNotOptimize(cuda::arrange(robot)); });
  double springs = 0, rows = 0, tiles = 0;
  Passes passes;
  for (const Robot& robot : robots_of(state)) {
    const cuda::Arrangement arrangement = cuda::arrange(robot);
    springs += static_cast<double>(robot.springs.size());
    rows += arrangement.schedule.rows();
    tiles += static_cast<double>(arrangement.faces.size() / cuda::lanes);
    for (std::size_t first = 0; first < arrangement.faces.size(); first += cuda::lanes)
      count_face_tile(&arrangement.faces[first], passes);
  }
  const auto count = static_cast<double>(robots_of(state).size());
  const auto reads = static_cast<double>(passes.reads), additions = static_cast<double>(passes.additions);
  state.counters["springs"] = springs / count;
  state.counters["rows"] = rows / count;
  state.counters["full"] = springs / cuda::lanes / rows;  // share of the entries that hold a spring
  state.counters["face_tiles"] = tiles / count;
  state.counters["reads"] = reads / tiles / 4;  // passes per column
  state.counters["additions"] = additions / tiles / 4;
  state.counters["passes"] = (10 * rows + 6 * reads + 3 * additions) / count;  // of a step, for springs and faces
}
BENCHMARK(whole)->Name("arrangement")->Apply(all_kinds);

std::vector<cuda::OwnedSpring> ends_of(const Robot& robot) {
  std::vector<cuda::OwnedSpring> ends;
  ends.reserve(robot.springs.size());
  for (const Spring& spring : robot.springs) ends.push_back({spring.a, spring.b});
  return ends;
}

void pairs(State& state) {
  for_each_robot(state, [](const Robot& robot) { benchmark::DoNotOptimize(pair_faces(robot)); });
}
BENCHMARK(pairs)->Name("  pairs of faces")->Apply(all_kinds);

void face_tiles(State& state) {
  std::vector<std::vector<FacePair>> all;
  for (const Robot& robot : robots_of(state)) all.push_back(pair_faces(robot));
  std::size_t next = 0;
  for (auto _ : state) benchmark::DoNotOptimize(cuda::make_face_tiles(all[next++ % all.size()]));
}
BENCHMARK(face_tiles)->Name("  face tiles")->Apply(all_kinds);

void owners(State& state) {
  for_each_robot(state, [](const Robot& robot) {
    benchmark::DoNotOptimize(cuda::choose_owners(robot.masses.size(), ends_of(robot)));
  });
}
BENCHMARK(owners)->Name("  owners of springs")->Apply(all_kinds);

void schedule(State& state) {
  for_each_robot(state, [](const Robot& robot) {
    benchmark::DoNotOptimize(cuda::schedule_springs(robot.masses.size(), ends_of(robot)));
  });
}
BENCHMARK(schedule)->Name("  owners, colors and padding")->Apply(all_kinds);

void lengths(State& state) {
  for_each_robot(state, [](const Robot& robot) { benchmark::DoNotOptimize(cuda::rest_lengths(robot)); });
}
BENCHMARK(lengths)->Name("rest lengths")->Apply(all_kinds);

void measures(State& state) {
  for_each_robot(state, [](const Robot& robot) { benchmark::DoNotOptimize(measure(robot)); });
}
BENCHMARK(measures)->Name("measures")->Apply(all_kinds);

void key(State& state) {
  for_each_robot(state, [](const Robot& robot) { benchmark::DoNotOptimize(topology_key(robot)); });
}
BENCHMARK(key)->Name("topology key")->Apply(all_kinds);

}  // namespace
}  // namespace mercury::bench
