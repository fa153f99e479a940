// SPDX-License-Identifier: Apache-2.0
// Evaluations and what a simulation gives instead.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "bodies.h"
#include "mercury/evaluator.h"
#include "mercury/simulation.h"
#include "mercury/trial_measures.h"
#include "same_telemetry.h"

namespace mercury {

using Robots = std::vector<std::shared_ptr<const Robot>>;

// Robots of several sizes.
inline Robots mixed(std::size_t count) {
  Robots robots;
  for (std::size_t i = 0; i < count; ++i) {
    const int n = static_cast<int>(i);
    robots.push_back(
        std::make_shared<Robot>(bodies::random_voxels({.x = 1 + n % 3, .y = 1 + n % 2, .z = 1 + n / 3 % 3}, i)));
  }
  return robots;
}

inline std::vector<Evaluation> rest_of(Evaluator& evaluator) {
  std::vector<Evaluation> all;
  while (std::optional<Evaluation> one = evaluator.next()) all.push_back(*std::move(one));
  return all;
}

inline std::vector<Evaluation> evaluate(const EvaluationRequest& request, const Robots& robots,
                                        const std::vector<Evaluator::MakeBackend>& devices = {}) {
  Evaluator evaluator(request, source_of(robots), robots.size(), devices);
  return rest_of(evaluator);
}

inline std::vector<Evaluator::MakeBackend> cpus(std::size_t count) {
  return std::vector<Evaluator::MakeBackend>(count, [] { return make_cpu_backend({.threads = 1}); });
}

// Times are sums of periods in one place and products in another.
inline void expect_near(Vec3 a, Vec3 b) { EXPECT_LE(length(a - b), 1e-6f * (1 + length(a))); }

inline void expect_equal(const std::vector<Evaluation>& a, const std::vector<Evaluation>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].index, b[i].index);
    EXPECT_EQ(a[i].robot, b[i].robot);
    EXPECT_EQ(a[i].failure, b[i].failure);
    EXPECT_EQ(a[i].steps, b[i].steps);
    expect_equal(a[i].start, b[i].start);
    expect_equal(a[i].end, b[i].end);
    EXPECT_EQ(a[i].path, b[i].path);
    EXPECT_EQ(a[i].work, b[i].work);
    EXPECT_NEAR(a[i].positive_work, b[i].positive_work, 1e-12 * (1 + a[i].absolute_work()));
    EXPECT_EQ(a[i].highest, b[i].highest);
    EXPECT_EQ(a[i].largest_strain, b[i].largest_strain);
    EXPECT_EQ(a[i].strained_share, b[i].strained_share);
    if (!std::isnan(a[i].third) && !std::isnan(b[i].third)) {
      EXPECT_NEAR(a[i].third, b[i].third, 1e-9);
      expect_near(a[i].at_third, b[i].at_third);
      expect_near(a[i].at_two_thirds, b[i].at_two_thirds);
    }
    EXPECT_EQ(a[i].hash, b[i].hash);
    EXPECT_EQ(a[i].state.positions, b[i].state.positions);
    EXPECT_EQ(a[i].state.velocities, b[i].state.velocities);
  }
}

// What a simulation of all robots gives, step by step.
inline std::vector<Evaluation> simulated(const EvaluationRequest& request, const Robots& robots) {
  Simulation simulation(request.configuration, robots);
  if (request.start) {
    std::vector<Vec3> positions;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      positions.insert(positions.end(), robots[i]->masses.begin(), robots[i]->masses.end());
      request.start(i, *robots[i], std::span(positions).last(robots[i]->masses.size()));
    }
    simulation.reset_to(positions);
  }
  simulation.step(request.settling);
  const std::vector<Telemetry> start = simulation.telemetry();
  std::vector<Evaluation> expected(robots.size());
  std::vector<Telemetry> last = start;
  for (std::size_t i = 0; i < robots.size(); ++i)
    expected[i] = {.index = i,
                   .robot = robots[i],
                   .steps = request.steps,
                   .start = start[i],
                   .highest = start[i].center_of_mass.z,
                   .largest_strain = start[i].largest_strain,
                   .strained_share = start[i].strained_share};
  std::vector<double> times{0};                    // of the samples
  std::vector<std::vector<Telemetry>> all{start};  // [sample][robot]
  std::int64_t sampled = 0;
  for (std::int64_t step = 1; step <= request.steps; ++step) {
    simulation.step();
    if (step < request.steps && (request.sample_every == 0 || step % request.sample_every != 0)) continue;
    const std::vector<Telemetry> now = simulation.telemetry();
    const double seconds = request.configuration.dt * static_cast<double>(step - std::exchange(sampled, step));
    for (std::size_t i = 0; i < robots.size(); ++i) {
      expected[i].path += static_cast<double>(length(now[i].center_of_mass - last[i].center_of_mass));
      if (!now[i].exploded) {
        const double before = last[i].muscle_power, after = now[i].muscle_power;
        expected[i].work += seconds * 0.5 * (before + after);
        // The power crosses zero after a share before / (before - after) of the time, if at all.
        const double crossing = before * after < 0 ? before / (before - after) : 1;
        expected[i].positive_work +=
            seconds * 0.5 *
            (crossing * std::max(0.0, before) + (crossing < 1 ? 1 - crossing : 1) * std::max(0.0, after));
      }
      expected[i].highest = std::max(expected[i].highest, static_cast<double>(now[i].center_of_mass.z));
      expected[i].largest_strain = std::max(expected[i].largest_strain, static_cast<double>(now[i].largest_strain));
      expected[i].strained_share = std::max(expected[i].strained_share, static_cast<double>(now[i].strained_share));
    }
    last = now;
    times.push_back(request.configuration.dt * static_cast<double>(step));
    all.push_back(now);
  }
  const auto place_at = [&](double time, std::size_t robot) {
    if (times.size() == 1) return start[robot].center_of_mass;
    std::size_t after = 1;
    while (after + 1 < times.size() && times[after] < time) ++after;
    const Vec3 a = all[after - 1][robot].center_of_mass, b = all[after][robot].center_of_mass;
    return a + static_cast<float>((time - times[after - 1]) / (times[after] - times[after - 1])) * (b - a);
  };
  for (std::size_t i = 0; i < robots.size(); ++i) {
    expected[i].end = last[i];
    expected[i].third = times.size() <= TrialMeasures::longest_way ? times.back() / 3 : NAN;  // not compared
    expected[i].at_third = place_at(times.back() / 3, i);
    expected[i].at_two_thirds = place_at(2 * times.back() / 3, i);
    if (request.hashes) expected[i].hash = simulation.hash(i);
    if (request.states) expected[i].state = simulation.state(i);
  }
  return expected;
}

inline EvaluationRequest usual(Environment environment = Land{}) {
  return {.configuration = {.environment = environment, .device = {.kind = DeviceKind::cpu}},
          .settling = 20,
          .steps = 130,
          .sample_every = 30,
          .hashes = true,
          .states = true};
}

}  // namespace mercury
