// SPDX-License-Identifier: Apache-2.0
// Springs per second on one core, with all that a step does: each instruction set of this machine against the plain
// loop, small robots against large ones.
//
//   bench_cpu_springs [SECONDS] [FILTER] [KERNEL]
//     SECONDS   time per line
//     FILTER    only lines that contain this text, and the first line, which ratios refer to
//     KERNEL    only the kernel of this name
//
// All of them take turns within one run. The best of many short turns counts, since others may use the machine.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "bench/cpu_lattice.h"
#include "bench/cpu_plain_loop.h"
#include "bench/timing.h"
#include "mercury/random_voxel.h"
#include "sim/cpu/backend.h"

namespace mercury::bench {
namespace {

using Time = std::chrono::steady_clock;

// CPU time of this thread, which does all the work: time that others take from the core does not count.
double core_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds_of(const std::function<void()>& work) {
  const double start = core_seconds();
  work();
  return core_seconds() - start;
}

struct Workload {
  std::string name;
  std::vector<Robot> robots;
  std::int64_t steps_per_call = 0;  // 0 = a call is a whole turn

  double springs() const {
    double sum = 0;
    for (const Robot& robot : robots) sum += static_cast<double>(robot.springs.size());
    return sum;
  }
};

struct Subject {
  std::function<void(std::int64_t)> step;
  double best = 1e9;  // seconds of one turn
};

Subject plain(const Workload& workload, const Configuration& configuration) {
  auto loops = std::make_shared<std::vector<PlainLoop>>();
  for (const Robot& robot : workload.robots) loops->emplace_back(robot, configuration);
  return {[loops](std::int64_t steps) {
    for (PlainLoop& loop : *loops) loop.step(steps);
  }};
}

Subject vectorized(const Workload& workload, const Configuration& configuration, const cpu::Kernel& kernel) {
  std::shared_ptr<Backend> backend = cpu::make_backend({.threads = 1}, kernel);
  std::vector<const Robot*> robots;
  for (const Robot& robot : workload.robots) robots.push_back(&robot);
  backend->load(robots, configuration);
  auto clock = std::make_shared<Clock>(Clock{.dt = configuration.dt});
  return {[backend, clock](std::int64_t steps) {
    backend->step(*clock, steps);
    clock->step += steps;
  }};
}

// A workload and the subjects that step it in turns.
struct Line {
  const Workload& workload;
  std::int64_t steps_per_call, calls;  // per turn
  std::vector<Subject> subjects;       // the plain loop, then the kernels

  Line(const Workload& robots, const Configuration& configuration, const std::vector<cpu::Kernel>& kernels)
      : workload(robots) {
    constexpr double springs_per_turn = 1.5e6;
    const auto steps = std::max<std::int64_t>(4, static_cast<std::int64_t>(springs_per_turn / workload.springs()));
    steps_per_call = workload.steps_per_call == 0 ? steps : workload.steps_per_call;
    calls = std::max<std::int64_t>(1, steps / steps_per_call);
    subjects.push_back(plain(workload, configuration));
    for (const cpu::Kernel& kernel : kernels) subjects.push_back(vectorized(workload, configuration, kernel));
    for (Subject& subject : subjects) subject.step(200);
  }

  void take_turns() {
    for (Subject& subject : subjects)
      subject.best = std::min(subject.best, seconds_of([&] {
                                for (std::int64_t call = 0; call < calls; ++call) subject.step(steps_per_call);
                              }));
  }
  double rate(const Subject& subject) const {
    return workload.springs() * static_cast<double>(steps_per_call * calls) / subject.best;
  }
};

void compare(const std::vector<Workload>& workloads, const Configuration& configuration, double seconds,
             const char* filter, const std::vector<cpu::Kernel>& kernels) {
  const std::string what =
      std::string(name_of(configuration.solver)) + ", " + std::string(name_of(configuration.environment));
  std::vector<Line> lines;
  for (const Workload& workload : workloads) {
    const bool wanted = std::strstr((workload.name + ", " + what).c_str(), filter) != nullptr;
    if (wanted || &workload == &workloads.front()) lines.emplace_back(workload, configuration, kernels);
  }
  if (lines.size() == 1 && std::strstr((workloads.front().name + ", " + what).c_str(), filter) == nullptr) return;
  const auto end = Time::now() + std::chrono::duration<double>(seconds * static_cast<double>(lines.size()));
  while (Time::now() < end)
    for (Line& line : lines) line.take_turns();

  std::printf("\n%-46s %9s", what.c_str(), "plain");
  for (const cpu::Kernel& kernel : kernels) std::printf("  %8s /plain /large", std::string(kernel.name).c_str());
  std::printf("\n");
  for (const Line& line : lines) {
    std::printf("%-46s  %.2e", line.workload.name.c_str(), line.rate(line.subjects.front()));
    for (std::size_t i = 1; i < line.subjects.size(); ++i)
      std::printf("  %.2e  %5.2f  %5.2f", line.rate(line.subjects[i]),
                  line.rate(line.subjects[i]) / line.rate(line.subjects.front()),
                  line.rate(line.subjects[i]) / lines.front().rate(lines.front().subjects[i]));
    std::printf("\n");
  }
  std::fflush(stdout);
}

std::vector<Robot> with_holes(int n, std::size_t count) {
  std::vector<Robot> robots;
  for (std::uint64_t seed = 1; seed <= count; ++seed) robots.push_back(lattice_with_holes(n, 0.3, seed));
  return robots;
}

// Gives each robot its own table of materials.
std::vector<Robot> with_own_tables(std::vector<Robot> robots) {
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const std::span<const Material> defaults = materials_of(robots[i]);
    robots[i].materials.assign(defaults.begin(), defaults.end());
    for (Material& material : robots[i].materials) {
      material.stiffness *= 1 + 0.001f * static_cast<float>(i);
      material.frequency *= 1 + 0.001f * static_cast<float>(i);
    }
  }
  return robots;
}

std::vector<Robot> scrambled_each(std::vector<Robot> robots) {
  for (std::size_t i = 0; i < robots.size(); ++i) robots[i] = scrambled(robots[i], i);
  return robots;
}

// With the lowest mass at z = 0, as the simulation does on land.
std::vector<Robot> voxel_robots(std::array<int, 3> smallest, std::array<int, 3> largest, std::size_t count) {
  std::vector<Robot> robots = random_voxel_robots({.smallest = smallest, .largest = largest}, 1, count);
  for (Robot& robot : robots) {
    const float lowest = std::ranges::min(robot.masses, {}, &Vec3::z).z;
    for (Vec3& mass : robot.masses) mass.z -= lowest;
  }
  return robots;
}

std::vector<Workload> workloads() {
  const auto copies = [](int n, std::size_t count) { return std::vector<Robot>(count, lattice(n)); };
  return {{"1 of 1331 masses", copies(10, 1)},
          {"8 of 1331 masses", copies(10, 8)},
          {"16 of 512 masses", copies(7, 16)},
          {"16 of 216 masses", copies(5, 16)},
          {"32 of 125 masses", copies(4, 32)},
          {"32 of 64 masses", copies(3, 32)},
          {"64 of 27 masses", copies(2, 64)},
          {"256 of 8 masses", copies(1, 256)},
          {"64 of 27 masses, calls of 1 step", copies(2, 64), 1},
          {"64 of 27 masses, calls of 4 steps", copies(2, 64), 4},
          {"64 of 27 masses, own tables", with_own_tables(copies(2, 64))},
          {"16 of 216 masses, calls of 4 steps", copies(5, 16), 4},
          {"16 of 216 masses, own tables", with_own_tables(copies(5, 16))},
          {"30 % air: 1 of 10^3", with_holes(10, 1)},
          {"30 % air, mixed: 16 of 7^3", with_holes(7, 16)},
          {"30 % air, mixed: 32 of 5^3", with_holes(5, 32)},
          {"30 % air, mixed: 64 of 4^3", with_holes(4, 64)},
          {"30 % air, mixed: 64 of 3^3", with_holes(3, 64)},
          {"30 % air, mixed: 64 of 2^3", with_holes(2, 64)},
          {"random voxel robots: 1 of 10^3", voxel_robots({10, 10, 10}, {10, 10, 10}, 1)},
          {"random voxel robots: 64", voxel_robots({4, 3, 3}, {7, 5, 4}, 64)},
          {"random voxel robots: 1000, calls of 16 steps", voxel_robots({4, 3, 3}, {7, 5, 4}, 1000), 16},
          {"random voxel robots: 64, calls of 4 steps", voxel_robots({4, 3, 3}, {7, 5, 4}, 64), 4},
          {"random voxel robots: 64, own tables", with_own_tables(voxel_robots({4, 3, 3}, {7, 5, 4}, 64))},
          {"scrambled: 1 of 1331 masses", scrambled_each(copies(10, 1))},
          {"scrambled: 16 of 216 masses", scrambled_each(copies(5, 16))},
          {"scrambled: 64 of 27 masses", scrambled_each(copies(2, 64))},
          {"scrambled: random voxel robots, 64", scrambled_each(voxel_robots({4, 3, 3}, {7, 5, 4}, 64))}};
}

void run(double seconds, const char* filter, const char* kernel_name) {
  std::vector<cpu::Kernel> kernels;
  for (const cpu::Kernel& kernel : cpu::kernels())
    if (*kernel_name == 0 || kernel.name == kernel_name) kernels.push_back(kernel);
  const std::vector<Workload> all = workloads();
  for (const Solver solver : {Solver::force, Solver::xpbd})
    for (const std::string_view environment : environment_names())
      compare(all, {.solver = solver, .environment = environment_named(environment)}, seconds, filter, kernels);
}

}  // namespace
}  // namespace mercury::bench

int main(int argc, char** argv) {
  mercury::bench::run(argc > 1 ? mercury::seconds_from(argv[1]) : 1.0, argc > 2 ? argv[2] : "",
                      argc > 3 ? argv[3] : "");
}
