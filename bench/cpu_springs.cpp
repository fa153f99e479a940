// Springs evaluated a second on one core, everything that a step does included: every instruction set of this machine
// against the plain loop, in turns within one run, the best of many short turns (others may use the machine).
//
//   bench_cpu_springs [SECONDS] [FILTER]     time for each line; only lines that hold FILTER
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
#include "sim/cpu/backend.h"

namespace mercury::bench {
namespace {

using Time = std::chrono::steady_clock;

// Of this thread, which does all the work: time that others take from the core does not count.
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

struct Subject {
  std::string name;
  std::function<void(std::int64_t)> step;
  double best = 1e9;  // seconds of one turn
};

struct Body {
  std::string name;
  Robot robot;
  std::size_t copies = 1;
};

Subject plain(const Body& body, const Configuration& configuration) {
  auto loops = std::make_shared<std::vector<PlainLoop>>();
  for (std::size_t i = 0; i < body.copies; ++i) loops->emplace_back(body.robot, configuration);
  return {"plain", [loops](std::int64_t steps) {
            for (PlainLoop& loop : *loops) loop.step(steps);
          }};
}

Subject vectorised(const Body& body, const Configuration& configuration, const cpu::Kernel& kernel) {
  std::shared_ptr<Backend> backend = cpu::make_backend({.threads = 1}, kernel);
  const std::vector<const Robot*> robots(body.copies, &body.robot);
  backend->load(robots, configuration);
  auto clock = std::make_shared<Clock>(Clock{.dt = configuration.dt});
  return {std::string(kernel.name), [backend, clock](std::int64_t steps) {
            backend->step(*clock, steps);
            clock->step += steps;
          }};
}

void compare(const Body& body, const Configuration& configuration, double seconds, const char* filter) {
  const std::string name = body.name + ", " + std::string(name_of(configuration.solver)) + ", " +
                           std::string(name_of(configuration.environment));
  if (std::strstr(name.c_str(), filter) == nullptr) return;
  std::vector<Subject> subjects{plain(body, configuration)};
  for (const cpu::Kernel& kernel : cpu::kernels()) subjects.push_back(vectorised(body, configuration, kernel));
  const double springs = static_cast<double>(body.robot.springs.size() * body.copies);
  const auto steps = std::max<std::int64_t>(4, static_cast<std::int64_t>(6e5 / springs));
  for (Subject& subject : subjects) subject.step(200);
  const auto end = Time::now() + std::chrono::duration<double>(seconds);
  while (Time::now() < end)
    for (Subject& subject : subjects)
      subject.best = std::min(subject.best, seconds_of([&] { subject.step(steps); }));
  std::printf("%-42s", name.c_str());
  for (const Subject& subject : subjects)
    std::printf("  %s %.2e (%.2fx)", subject.name.c_str(), springs * static_cast<double>(steps) / subject.best,
                subjects.front().best / subject.best);
  std::printf("\n");
  std::fflush(stdout);
}

void run(double seconds, const char* filter) {
  const Robot large = lattice(10);
  const std::vector<Body> bodies = {{"1331 masses", large},
                                    {"1331 masses x8", large, 8},
                                    {"216 masses x16", lattice(5), 16},
                                    {"27 masses x64", lattice(2), 64},
                                    {"1331 masses, scrambled", scrambled(large)},
                                    {"10 voxels, 30 % holes", lattice_with_holes(10, 0.3)},
                                    {"5 voxels, 30 % holes x16", lattice_with_holes(5, 0.3), 16}};
  for (const Body& body : bodies)
    for (const Solver solver : {Solver::force, Solver::xpbd})
      for (const std::string_view environment : {Ocean::name, OceanSimple::name, Land::name})
        compare(body, {.solver = solver, .environment = environment_named(environment)}, seconds, filter);
}

}  // namespace
}  // namespace mercury::bench

int main(int argc, char** argv) {
  mercury::bench::run(argc > 1 ? std::atof(argv[1]) : 2.0, argc > 2 ? argv[2] : "");
}
