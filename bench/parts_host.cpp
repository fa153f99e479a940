// SPDX-License-Identifier: Apache-2.0
// The parts of the host's work before and between steps: schedules, muscles, near pairs, files, growing.
#include <benchmark/benchmark.h>

#include <array>
#include <string>
#include <vector>

#include "bench/cpu_lattice.h"
#include "mercury/nn_robot.h"
#include "mercury/random.h"
#include "mercury/random_voxel.h"
#include "mercury/real_body.h"
#include "mercury/robot_file.h"
#include "robots/nn/tetrahedra.h"
#include "sim/cpu/kernels/kernel.h"
#include "sim/physics/face_pairs.h"

namespace mercury::bench {
namespace {

using State = benchmark::State;

// The argument is the number of voxels per side.
Robot lattice_of(const State& state) { return lattice(static_cast<int>(state.range(0))); }

void schedule_of_springs(State& state) {
  const Robot robot = lattice_of(state);
  const cpu::Slots slots = cpu::assign_slots(robot, cpu::kernels().front().lanes);
  for (auto _ : state) benchmark::DoNotOptimize(cpu::schedule_springs(robot, slots));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(robot.springs.size()));
}
BENCHMARK(schedule_of_springs)->Name("schedule of springs")->Arg(5)->Arg(10)->Unit(benchmark::kMicrosecond);

void pairs_of_faces(State& state) {
  const Robot robot = lattice_of(state);
  for (auto _ : state) benchmark::DoNotOptimize(pair_faces(robot));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(robot.faces.size()));
}
BENCHMARK(pairs_of_faces)->Name("pairs of faces")->Arg(5)->Arg(10)->Unit(benchmark::kMicrosecond);

void make_body(State& state) {
  const Robot robot = lattice_of(state);
  for (auto _ : state) benchmark::DoNotOptimize(cpu::make_body(robot, cpu::kernels().front().lanes));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(robot.springs.size()));
}
BENCHMARK(make_body)->Name("body for the CPU")->Arg(5)->Arg(10)->Unit(benchmark::kMicrosecond);

void near_pairs(State& state) {
  const Robot robot = lattice_of(state);
  cpu::Body body = cpu::make_body(robot, cpu::kernels().front().lanes);
  cpu::set_state(body, robot.masses, std::vector<Vec3>(robot.masses.size()));
  for (auto _ : state) body.near_pairs.search_grid(body.x.x, body.x.y, body.x.z, body.contact_distance);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(robot.masses.size()));
}
BENCHMARK(near_pairs)->Name("search for near pairs")->Arg(5)->Arg(10)->Unit(benchmark::kMicrosecond);

// All materials of the default table.
cpu::Muscles all_muscles() {
  std::vector<Material> materials(max_materials);
  std::ranges::copy(default_materials(), materials.begin());
  std::array<bool, max_materials> wanted;
  wanted.fill(true);
  cpu::Muscles muscles;
  std::array<cpu::FactorId, max_materials> factors{};
  muscles.add(materials, wanted, factors);
  return muscles;
}

void muscle_factors(State& state) {
  constexpr std::int64_t steps = 32;
  cpu::Muscles muscles = all_muscles();
  muscles.move_to({});
  cpu::Aligned<float> factors(muscles.amplitude.size() * steps);
  for (auto _ : state) {
    cpu::kernels().front().fill_factors(muscles, factors.data(), steps);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * steps * static_cast<std::int64_t>(max_materials));
}
BENCHMARK(muscle_factors)->Name("muscles of 32 steps")->Unit(benchmark::kMicrosecond);

void phases(State& state) {
  cpu::Muscles muscles = all_muscles();
  Clock clock{.step = 123456789};
  for (auto _ : state) {
    muscles.move_to(clock);
    ++clock.step;  // so that the phases are not current
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(max_materials));
}
BENCHMARK(phases)->Name("table of phases")->Unit(benchmark::kMicrosecond);

template <RobotFormat format>
void read(State& state) {
  const std::string document = serialize_robot(lattice_of(state), format);
  for (auto _ : state) benchmark::DoNotOptimize(parse_robot(document, format));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(document.size()));
}
BENCHMARK(read<RobotFormat::json>)->Name("read JSON")->Arg(5)->Arg(10)->Unit(benchmark::kMicrosecond);
BENCHMARK(read<RobotFormat::cbor>)->Name("read CBOR")->Arg(5)->Arg(10)->Unit(benchmark::kMicrosecond);

template <RobotFormat format>
void write(State& state) {
  const Robot robot = lattice_of(state);
  for (auto _ : state) benchmark::DoNotOptimize(serialize_robot(robot, format));
}
BENCHMARK(write<RobotFormat::json>)->Name("write JSON")->Arg(10)->Unit(benchmark::kMicrosecond);
BENCHMARK(write<RobotFormat::cbor>)->Name("write CBOR")->Arg(10)->Unit(benchmark::kMicrosecond);

void draw_voxels(State& state, const RandomVoxelOptions& options) {
  std::uint64_t index = 0;
  for (auto _ : state) benchmark::DoNotOptimize(random_voxel_robot(options, 1, index++));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(draw_voxels, default, {})->Name("draw a voxel robot")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(draw_voxels, ten, {.smallest = {10, 10, 10}, .largest = {10, 10, 10}})
    ->Name("draw a voxel robot of 10x10x10")
    ->Unit(benchmark::kMicrosecond);

void make_real_bodies(State& state) {
  const std::vector<Robot> robots = random_voxel_robots({}, 1, 200);
  std::size_t next = 0;
  for (auto _ : state) benchmark::DoNotOptimize(with_real_body(robots[next++ % robots.size()], {}));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(make_real_bodies)->Name("real body of a voxel robot")->Unit(benchmark::kMicrosecond);

// The argument is the number of points in the cloud, here and below.
std::size_t points_of(const State& state) { return static_cast<std::size_t>(state.range(0)); }

void draw_genome(State& state) {
  std::uint64_t index = 0;
  for (auto _ : state) benchmark::DoNotOptimize(random_nn_genome({}, 1, index++));
}
BENCHMARK(draw_genome)->Name("draw a network")->Unit(benchmark::kMicrosecond);

void evaluate_network(State& state) {
  const Network network = random_nn_genome({}, 1).network;
  Random random(1);
  std::vector<float> points(3 * points_of(state));
  for (float& x : points) x = static_cast<float>(random.normal());
  for (auto _ : state) benchmark::DoNotOptimize(evaluate(network, points));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(evaluate_network)->Name("evaluate a network")->Arg(512)->Unit(benchmark::kMicrosecond);

#if MERCURY_NN
// Bodies of many shapes, half of them mirrored.
void find_alpha_body(State& state) {
  std::vector<std::vector<Vec3>> clouds;
  for (const Robot& robot : random_nn_robots({.points = points_of(state)}, 1, 16)) clouds.push_back(robot.masses);
  std::size_t next = 0;
  for (auto _ : state) benchmark::DoNotOptimize(alpha_body(clouds[next++ % clouds.size()]));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(find_alpha_body)->Name("alpha shape of a cloud")->Arg(512)->Arg(4096)->Unit(benchmark::kMicrosecond);

// Network, alpha shape, springs and skin, of another robot each time.
void grow_robot(State& state) {
  std::uint64_t index = 0;
  for (auto _ : state) benchmark::DoNotOptimize(random_nn_robot({.points = points_of(state)}, 1, index++));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(grow_robot)->Name("grow a network robot")->Arg(512)->Arg(2048)->Unit(benchmark::kMicrosecond);

// The argument is the number of robots. On all cores; the time is that of the clock.
void grow_population(State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(random_nn_robots({}, 1, static_cast<std::size_t>(state.range(0))));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(grow_population)->Name("grow network robots")->Arg(1000)->UseRealTime()->Unit(benchmark::kMillisecond);
#endif

}  // namespace
}  // namespace mercury::bench
