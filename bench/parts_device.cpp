// SPDX-License-Identifier: Apache-2.0
// Measures the parts of a step and its surroundings on one core, and on a CUDA device if there is one: springs, faces,
// floor, contact, telemetry, loading a batch. Each part has a robot or a configuration in which little else happens.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "bench/cpu_lattice.h"
#include "mercury/backend.h"
#include "mercury/cuda_devices.h"

namespace mercury::bench {
namespace {

constexpr std::int64_t steps_per_call = 100;

std::unique_ptr<Backend> backend_of(DeviceKind kind) {
  return kind == DeviceKind::cuda ? make_cuda_backend({.kind = kind}) : make_cpu_backend({.kind = kind, .threads = 1});
}

// Robots: enough to fill a device, one for a core.
std::size_t batch_size(DeviceKind kind) { return kind == DeviceKind::cuda ? 528 : 1; }

Robot without_springs(Robot robot) {
  robot.springs.clear();
  return robot;
}
Robot without_faces(Robot robot) {
  robot.faces.clear();
  return robot;
}

// Two lattices in the same place, half a voxel apart: every mass has neighbors without a spring to it.
Robot entangled(const Robot& robot) {
  Robot result = robot;
  const auto masses = static_cast<std::uint16_t>(robot.masses.size());
  for (const Vec3 x : robot.masses) result.masses.push_back(x + Vec3{0.03f, 0.02f, 0.04f});
  for (Spring spring : robot.springs) {
    spring.a = static_cast<std::uint16_t>(spring.a + masses);
    spring.b = static_cast<std::uint16_t>(spring.b + masses);
    result.springs.push_back(spring);
  }
  return result;
}

struct Loaded {
  std::vector<const Robot*> robots;
  std::unique_ptr<Backend> backend;
  Configuration configuration;
};

Loaded loaded(DeviceKind kind, const Robot& robot, const Configuration& configuration) {
  Loaded result{std::vector<const Robot*>(batch_size(kind), &robot), backend_of(kind), configuration};
  result.backend->load(result.robots, configuration);
  return result;
}

// Counts steps per robot times `things`, the number of springs, faces or masses that it has.
void step(benchmark::State& state, DeviceKind kind, const Robot& robot, const Configuration& configuration,
          std::size_t things) {
  const Loaded batch = loaded(kind, robot, configuration);
  Clock clock{.dt = configuration.dt};
  for (auto _ : state) {
    batch.backend->step(clock, steps_per_call);
    clock.step += steps_per_call;
  }
  state.SetItemsProcessed(state.iterations() * steps_per_call *
                          static_cast<std::int64_t>(batch.robots.size() * things));
}

void telemetry(benchmark::State& state, DeviceKind kind, const Robot& robot) {
  const Loaded batch = loaded(kind, robot, {});
  std::vector<Telemetry> telemetry(batch.robots.size());
  std::vector<RobotStatus> statuses(telemetry.size());
  for (auto _ : state) {
    batch.backend->set_status(0, {});  // without a change, report() would return the last report
    batch.backend->report({}, telemetry, statuses);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(batch.robots.size()));
}

void load(benchmark::State& state, DeviceKind kind, const Robot& robot) {
  const std::vector<const Robot*> robots(64, &robot);
  const auto backend = backend_of(kind);
  for (auto _ : state) backend->load(robots, {});
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(robots.size()));
}

void add_device(DeviceKind kind, const std::string& device) {
  const auto add = [&](const std::string& name, auto work) {
    auto* const part = benchmark::RegisterBenchmark((device + "/" + name).c_str(), work)->Unit(benchmark::kMicrosecond);
    if (kind == DeviceKind::cuda) part->UseRealTime();  // a core is measured by its CPU time, since it may be shared
  };
  const Robot lattice = bench::lattice(10), two = entangled(bench::lattice(5));
  Configuration still{.environment = OceanSimple{.point_drag = 0}};
  Configuration land{.environment = Land{}}, untouching{.environment = Land{.self_collision = false}};
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    const std::string name(name_of(solver));
    still.solver = land.solver = untouching.solver = solver;
    add("springs/" + name, [=, robot = without_faces(lattice)](benchmark::State& state) {
      step(state, kind, robot, still, robot.springs.size());
    });
    add("springs and contact/" + name,
        [=](benchmark::State& state) { step(state, kind, two, land, two.springs.size()); });
    add("springs without contact/" + name,
        [=](benchmark::State& state) { step(state, kind, two, untouching, two.springs.size()); });
  }
  add("faces", [=, robot = without_springs(lattice)](benchmark::State& state) {
    step(state, kind, robot, {}, robot.faces.size());
  });
  add("masses", [=, robot = without_faces(without_springs(lattice))](benchmark::State& state) {
    step(state, kind, robot, still, robot.masses.size());
  });
  add("telemetry", [=](benchmark::State& state) { telemetry(state, kind, lattice); });
  add("load 64 robots", [=](benchmark::State& state) { load(state, kind, lattice); });
}

[[maybe_unused]] const bool added = [] {
  add_device(DeviceKind::cpu, "CPU, one core");
  if (cuda_device_count() > 0)
    add_device(DeviceKind::cuda, "CUDA");
  else
    std::fprintf(stderr, "no CUDA device: its parts are skipped\n");
  return true;
}();

}  // namespace
}  // namespace mercury::bench
