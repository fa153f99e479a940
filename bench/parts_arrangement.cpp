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
      random_nn_robots({}, 1, 20), std::vector<Robot>{lattice(10)}};
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

void whole(State& state) {
  for_each_robot(state, [](const Robot& robot) { benchmark::DoNotOptimize(cuda::arrange(robot)); });
  double springs = 0, rows = 0, tiles = 0, passes = 0, fewest = 0;
  for (const Robot& robot : robots_of(state)) {
    const cuda::Arrangement arrangement = cuda::arrange(robot);
    springs += static_cast<double>(robot.springs.size());
    rows += arrangement.schedule.rows();
    tiles += static_cast<double>(arrangement.faces.size() / cuda::lanes);
    cuda::CornerBanks banks;
    std::size_t pairs = 0;
    for (std::size_t first = 0; first < arrangement.faces.size(); first += cuda::lanes) {
      std::array<std::array<int, cuda::lanes>, 4> uses{};
      for (std::size_t i = first; i < first + cuda::lanes; ++i) {
        const FacePair& p = arrangement.faces[i];
        if (p == cuda::padding_faces) continue;
        banks.add(p), ++pairs;
        ++uses[0][p.a % cuda::lanes], ++uses[1][p.b % cuda::lanes];
        ++uses[2][p.c % cuda::lanes], ++uses[3][p.d % cuda::lanes];
      }
      for (const auto& column : uses) passes += std::ranges::max(column);
    }
    fewest += banks.fewest_passes(pairs);
  }
  const auto count = static_cast<double>(robots_of(state).size());
  state.counters["springs"] = springs / count;
  state.counters["rows"] = rows / count;
  state.counters["full"] = springs / cuda::lanes / rows;  // share of the entries that hold a spring
  state.counters["face_tiles"] = tiles / count;
  state.counters["passes"] = passes / count;  // of the face tiles' columns
  state.counters["fewest"] = fewest / count;
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
BENCHMARK(schedule)->Name("  owners, colours and padding")->Apply(all_kinds);

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
