// SPDX-License-Identifier: Apache-2.0
// Measures what brains of 64 neurons and 32 senses that think every 20 steps add to stepping: robots without a brain,
// with actuators that a program drives, with a brain that senses its body as a whole, and with one that also senses the
// strain of each muscle group. They take turns, so that a change of the clock rate affects all: bench_brains [device]
// [voxels per edge] [robots] [turns] [population of an evolution strategy, which is measured if it is given]
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "bench/full_cube.h"
#include "bench/timing.h"
#include "mercury/brain.h"
#include "mercury/random_voxel.h"
#include "mercury/simulation.h"

namespace mercury {
namespace {

constexpr int steps = 200, thought = 20;
constexpr std::size_t senses = 32, neurons = 64;

Robot with_brain(Robot robot, bool strains) {
  const std::vector<Actuator> actuators = actuators_of(robot);
  for (const SensorKind kind :
       {SensorKind::up, SensorKind::velocity, SensorKind::turn_rate, SensorKind::target_direction, SensorKind::flow,
        SensorKind::target_distance, SensorKind::light, SensorKind::depth, SensorKind::touch})
    robot.sensors.push_back({.kind = kind});
  std::size_t width = 19;
  if (strains)
    for (const Actuator& actuator : actuators) {
      if (width == senses) break;
      robot.sensors.push_back({.kind = SensorKind::strain, .actuator = actuator.name});
      ++width;
    }
  for (; width + 2 <= senses; width += 2)
    robot.sensors.push_back({.kind = SensorKind::clock, .frequency = static_cast<float>(width)});
  if (width < senses) robot.sensors.push_back({.kind = SensorKind::height});
  const auto motors = static_cast<std::uint32_t>(actuators.size());
  const std::uint32_t hidden = neurons - motors;
  const auto weights = [](std::size_t count) {
    std::vector<float> all;
    for (std::size_t i = 0; i < count; ++i) all.push_back(0.3f * std::sin(static_cast<float>(i)));
    return all;
  };
  Brain& brain = robot.brain.emplace();
  brain.layers = {{.name = "hidden",
                   .neurons = hidden,
                   .alpha = {},
                   .bias = weights(hidden),
                   .inputs = {{"senses", weights(hidden * senses), {}, 0}}},
                  {.name = "motor",
                   .neurons = motors,
                   .alpha = {},
                   .bias = weights(motors),
                   .inputs = {{"hidden", weights(std::size_t{hidden} * motors), {}, 0}}}};
  return robot;
}

void measure(const Configuration& configuration, const std::vector<Robot>& robots, int turns) {
  std::vector<std::unique_ptr<Simulation>> variants;
  std::vector<std::vector<double>> seconds(4);
  for (int variant = 0; variant < 4; ++variant) {
    std::vector<Robot> own = robots;
    for (Robot& robot : own)
      if (variant > 1) robot = with_brain(std::move(robot), variant == 3);
    variants.push_back(std::make_unique<Simulation>(configuration, own));
    if (variant == 1) (void)variants.back()->actuation();
    variants.back()->step(steps);
  }
  for (int turn = 0; turn < turns; ++turn)
    for (std::size_t variant = 0; variant < 4; ++variant)
      seconds[variant].push_back(seconds_of([&] { variants[variant]->step(steps); }));
  const double alone = median(seconds[0]);
  std::printf("%s, %zu robots of %zu masses: %.1f us per %d steps\n", variants[0]->device_name().c_str(), robots.size(),
              robots[0].masses.size(), 1e6 * alone * thought / steps, thought);
  const char* const names[] = {"", "driven actuators", "a brain", "and strains of muscles"};
  for (std::size_t variant = 1; variant < 4; ++variant)
    std::printf("  %-24s +%.2f %%\n", names[variant], 100 * (median(seconds[variant]) / alone - 1));
}

// An evolution strategy of one robot: each generation has new weights in the shared arrays, a reset, and episodes of
// ten seconds.
void measure_episodes(const Configuration& configuration, const Robot& robot, std::size_t population) {
  std::unique_ptr<Backend> made = make_backend(configuration.device);
  const Backend& backend = *made;
  Simulation simulation(configuration, std::vector<Robot>(population, with_brain(robot, false)), std::move(made));
  const SharedArray<float> weights = simulation.shared_brains().weights;
  std::vector<float> values(weights.rows * weights.columns);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 0.3f * std::sin(static_cast<float>(i));
  const auto next = std::static_pointer_cast<float>(backend.allocate_shared(values.size() * sizeof(float)));
  backend.copy_shared(next.get(), values.data(), values.size() * sizeof(float));
  const auto steps = static_cast<std::int64_t>(10 / configuration.dt);
  const auto generation = [&] {
    backend.copy_shared(weights.data.get(), next.get(), values.size() * sizeof(float));
    simulation.reset();
    simulation.step(steps);
    (void)simulation.telemetry();
  };
  generation();
  std::vector<double> seconds;
  for (int i = 0; i < 3; ++i) seconds.push_back(seconds_of(generation));
  std::printf("%zu robots of %zu masses, %zu weights: %.2f s per generation of 10 s, %.3g episodes per minute\n",
              population, robot.masses.size(), weights.columns, median(seconds),
              60 * static_cast<double>(population) / median(seconds));
}

}  // namespace
}  // namespace mercury

int main(int argc, char** argv) {
  using namespace mercury;
  Configuration configuration;
  configuration.device = device_named(argc > 1 ? argv[1] : "auto");
  const int edge = argc > 2 ? std::stoi(argv[2]) : 10;
  const std::size_t count = argc > 3 ? std::stoul(argv[3]) : 528;
  const int turns = argc > 4 ? std::stoi(argv[4]) : 100;
  RandomVoxelOptions full = full_cube(edge);
  full.frequencies = 5;
  measure(configuration, random_voxel_robots(full, 1, count), turns);
  if (argc <= 5) return 0;
  full.smallest = full.largest = {4, 3, 3};
  measure_episodes(configuration, random_voxel_robot(full, 1), std::stoul(argv[5]));
}
