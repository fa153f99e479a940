// SPDX-License-Identifier: Apache-2.0
// What it costs on one core of the CPU that a program drives the muscles: 64 voxel robots, 20 steps per call, with new
// drives of all actuators before each call, against the same robots without.
//
//   bench_actuation_cpu [SECONDS]     time per line
//
// All take turns within one run. The best of many short turns counts, since others may use the machine.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "bench/timing.h"
#include "mercury/random_voxel.h"
#include "mercury/simulation.h"

namespace mercury::bench {
namespace {

// CPU time of this thread, which does all the work: time that others take from the core does not count.
double core_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

enum class Drives { none, unchanged, changed };

class Subject {
 public:
  Subject(const std::vector<Robot>& robots, Configuration configuration, Drives drives)
      : simulation_(configuration, robots), drives_(drives) {
    if (drives != Drives::none) actuation_ = simulation_.actuation();
  }

  void turn() {
    constexpr int calls = 4;
    double seconds = 0;
    for (int call = 0; call < calls; ++call) {
      if (drives_ == Drives::changed) change();
      const double start = core_seconds();
      simulation_.step(20);
      seconds += core_seconds() - start;
    }
    best_ = std::min(best_, seconds / calls);
  }
  double best() const { return best_; }
  std::size_t actuators() const { return actuation_.drive.columns; }

 private:
  void change() {
    ++changes_;
    for (std::size_t i = 0; i < actuation_.drive.rows * actuation_.drive.columns; ++i)
      actuation_.drive.data.get()[i] = std::sin(static_cast<float>(i) + 0.1f * static_cast<float>(changes_));
  }

  Simulation simulation_;
  Drives drives_;
  Actuation actuation_;
  int changes_ = 0;
  double best_ = 1e9;  // seconds of one call
};

void compare(const char* name, const std::vector<Robot>& robots, Solver solver, double seconds) {
  const Configuration configuration{.solver = solver, .device = {.kind = DeviceKind::cpu, .threads = 1}};
  std::array<Subject, 3> subjects{Subject(robots, configuration, Drives::none),
                                  Subject(robots, configuration, Drives::unchanged),
                                  Subject(robots, configuration, Drives::changed)};
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < end)
    for (Subject& subject : subjects) subject.turn();
  std::printf("%-34s %-6s %6zu %10.3f %10.3f %10.3f\n", name, std::string(name_of(solver)).c_str(),
              subjects.back().actuators(), 1e3 * subjects[0].best(), subjects[1].best() / subjects[0].best(),
              subjects[2].best() / subjects[0].best());
}

}  // namespace

void run(double seconds) {
  std::printf("%-34s %-6s %6s %10s %10s %10s\n", "", "", "most", "without", "unchanged", "all new");
  std::printf("%-34s %-6s %6s %10s %10s %10s\n", "64 robots, 20 steps", "solver", "drives", "[ms]", "/without",
              "/without");
  const auto voxels = [](std::array<int, 3> smallest, std::array<int, 3> largest, double air) {
    return random_voxel_robots({.smallest = smallest, .largest = largest, .air = air}, 1, 64);
  };
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    compare("5x5x5 voxels, 216 masses", voxels({5, 5, 5}, {5, 5, 5}, 0), solver, seconds);
    compare("random bodies of 4x3x3 to 7x5x4", voxels({4, 3, 3}, {7, 5, 4}, 0.3), solver, seconds);
    compare("2x2x2 voxels, 27 masses", voxels({2, 2, 2}, {2, 2, 2}, 0), solver, seconds);
  }
}

}  // namespace mercury::bench

int main(int argc, char** argv) { mercury::bench::run(argc > 1 ? mercury::seconds_from(argv[1]) : 2.0); }
