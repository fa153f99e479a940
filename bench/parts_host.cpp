// SPDX-License-Identifier: Apache-2.0
// The parts of the host's work before and between steps: schedules, muscles, near pairs, files, growing.
#include <benchmark/benchmark.h>

#include <array>
#include <string>

#include "bench/cpu_lattice.h"
#include "mercury/error.h"
#include "mercury/nn_robot.h"
#include "mercury/random_voxel.h"
#include "mercury/robot_file.h"
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
  for (auto _ : state) body.near_pairs.search_grid(body.x.x, body.x.y, body.x.z, body.measures.contact_distance());
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

void draw_voxels(State& state) {
  std::uint64_t index = 0;
  for (auto _ : state) benchmark::DoNotOptimize(random_voxel_robot({}, 1, index++));
}
BENCHMARK(draw_voxels)->Name("draw a voxel robot")->Unit(benchmark::kMicrosecond);

// Network, alpha shape, springs and skin. The argument is the number of points in the cloud.
void grow_robot(State& state) {
  const NnGenome genome = random_nn_genome({.points = static_cast<std::size_t>(state.range(0))}, 1);
  try {
    for (auto _ : state) benchmark::DoNotOptimize(grow(genome));
  } catch (const InputError& error) {
    state.SkipWithError(error.what());
  }
}
BENCHMARK(grow_robot)->Name("grow a network robot")->Arg(512)->Arg(2048)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mercury::bench
