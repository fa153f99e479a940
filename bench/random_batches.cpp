// SPDX-License-Identifier: Apache-2.0
// Measures how fast batches of random voxel robots, no two alike, are stepped, and what sampling and an Evaluator leave
// of it: bench_random_batches [device] [paper|real] [environment] [robots] [seconds of simulation]
//
// All rows make the same steps, twice, and the faster time counts. An Evaluator's includes the time while it loads some
// robots and steps others.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/timing.h"
#include "mercury/evaluator.h"
#include "mercury/parallel.h"
#include "mercury/random_voxel.h"
#include "mercury/real_body.h"
#include "mercury/simulation.h"

namespace mercury {
namespace {

constexpr std::int64_t sample_every = 50;

using Robots = std::vector<std::shared_ptr<const Robot>>;

Robots random_robots(std::size_t count, bool real) {
  Robots robots(count);
  parallel_for(0, count, [&](std::size_t i) {
    Robot robot = random_voxel_robot({}, 1, i);
    if (real) robot = with_real_body(robot, {});
    robots[i] = std::make_shared<const Robot>(std::move(robot));
  });
  return robots;
}

double seconds_of_evaluator(const Configuration& configuration, const Robots& robots, std::int64_t steps,
                            bool measures_folding) {
  EvaluationRequest request;
  request.configuration = configuration;
  request.steps = steps;
  request.sample_every = sample_every;
  if (measures_folding) request.folding = [](const Robot&) { return MeasuredFolding::inverted; };
  Evaluator evaluator(request, source_of(robots), robots.size());
  while (evaluator.next()) {
  }
  return evaluator.progress().stepping;
}

void measure(const Configuration& configuration, const Robots& robots, std::int64_t steps) {
  Simulation simulation(configuration, robots);
  std::vector<std::uint64_t> hashes;
  const auto seconds_to = [&](const auto& make_steps) {
    simulation.reset();
    const double seconds = seconds_of(make_steps);
    const std::vector<std::uint64_t> now = simulation.hashes();
    if (!hashes.empty() && hashes != now) throw std::runtime_error("the rows do not make the same steps");
    hashes = now;
    return seconds;
  };
  const auto sampled = [&] {
    std::size_t seen = 0;
    simulation.step_and_sample(steps, sample_every,
                               [&](std::span<const Telemetry> samples) { seen += samples.size(); });
    if (seen != robots.size() * static_cast<std::size_t>(steps / sample_every))
      throw std::runtime_error("some samples are missing");
  };
  const auto one_by_one = [&] {
    for (std::int64_t left = steps; left > 0; left -= sample_every) {
      simulation.step(sample_every);
      (void)simulation.telemetry();
    }
  };
  constexpr const char* names[] = {"one call", "samples every 50 steps", "calls of 50 steps and telemetry",
                                   "an evaluator", "an evaluator that measures folding"};
  std::vector<double> times[std::size(names)];
  for (int turn = 0; turn < 2; ++turn) {
    times[0].push_back(seconds_to([&] { simulation.step(steps); }));
    times[1].push_back(seconds_to(sampled));
    times[2].push_back(seconds_to(one_by_one));
    times[3].push_back(seconds_of_evaluator(configuration, robots, steps, false));
    times[4].push_back(seconds_of_evaluator(configuration, robots, steps, true));
  }
  std::size_t springs = 0;
  for (const auto& robot : robots) springs += robot->springs.size();
  std::printf("%s, %zu robots of %zu springs on average, %s, %lld steps\n", simulation.device_name().c_str(),
              robots.size(), springs / robots.size(), std::string(name_of(configuration.environment)).c_str(),
              static_cast<long long>(steps));
  for (std::size_t row = 0; row < std::size(names); ++row) {
    const double best = std::ranges::min(times[row]);
    std::printf("%-36s %8.4f s, %.3e springs/s, %6.3f\n", names[row], best,
                static_cast<double>(springs) * static_cast<double>(steps) / best, std::ranges::min(times[0]) / best);
  }
}

}  // namespace
}  // namespace mercury

int main(int argc, char** argv) try {
  using namespace mercury;
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const auto argument = [&](std::size_t i, const char* usual) { return i < arguments.size() ? arguments[i] : usual; };
  const bool real = argument(1, "paper") == "real";
  Environment environment = environment_named(argument(2, real ? "water" : "ocean"));
  if (real) environment.stiffness_scale = 1;
  const Configuration configuration{.environment = environment, .device = device_named(argument(0, "auto"))};
  const double samples = std::stod(argument(4, "10")) / configuration.dt / static_cast<double>(sample_every);
  measure(configuration, random_robots(std::stoul(argument(3, "4000")), real), sample_every * std::llround(samples));
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_random_batches: %s\n", error.what());
  return 1;
}
