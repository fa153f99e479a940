// SPDX-License-Identifier: Apache-2.0
#include "mercury/backend.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/sim/bodies.h"

namespace mercury {
namespace {

TEST(SplitBackend, GivesTheSameResultsAsOneBackend) {
  std::vector<Robot> robots;
  for (unsigned seed = 0; seed < 5; ++seed)
    robots.push_back(bodies::random_voxels({.x = 2, .y = 2, .z = 1 + static_cast<int>(seed)}, seed));
  std::vector<const Robot*> pointers;
  for (const Robot& robot : robots) pointers.push_back(&robot);

  const auto one = make_cpu_backend({});
  std::vector<std::unique_ptr<Backend>> parts;
  for (int part = 0; part < 3; ++part) parts.push_back(make_cpu_backend({}));
  const auto split = make_split_backend(std::move(parts));

  const Clock start;
  for (Backend* backend : {one.get(), split.get()}) {
    backend->load(pointers, {});
    const Perturbation perturbation{.robot = 3, .mass = 1, .target = {1, 2, 3}, .stiffness = 10};
    backend->set_perturbations(std::span(&perturbation, 1));
    backend->step(start, 50);
  }
  std::size_t masses = 0;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const std::size_t n = robots[i].masses.size();
    masses += n;
    std::vector<Vec3> x1(n), v1(n), x2(n), v2(n);
    one->read(i, x1, v1);
    split->read(i, x2, v2);
    EXPECT_EQ(x1, x2) << i;
    EXPECT_EQ(v1, v2) << i;
  }
  std::vector<Vec3> all1(masses), all2(masses);
  one->read_positions(all1);
  split->read_positions(all2);
  EXPECT_EQ(all1, all2);
  std::vector<Telemetry> telemetry1(robots.size()), telemetry2(robots.size());
  std::vector<RobotStatus> statuses(robots.size());
  one->report(start, telemetry1, statuses);
  split->report(start, telemetry2, statuses);
  for (std::size_t i = 0; i < robots.size(); ++i) EXPECT_EQ(telemetry1[i].elastic_energy, telemetry2[i].elastic_energy);
}

TEST(SplitBackend, AnAddedRobotGoesToThePartWithTheLeastSpringsAndStaysThere) {
  std::vector<std::unique_ptr<Backend>> parts;
  for (int part = 0; part < 2; ++part) parts.push_back(make_cpu_backend({}));
  const std::array<const Backend*, 2> part{parts[0].get(), parts[1].get()};
  const auto split = make_split_backend(std::move(parts));
  const auto sizes = [&] { return std::array{part[0]->statuses().size(), part[1]->statuses().size()}; };
  using Sizes = std::array<std::size_t, 2>;

  const Robot small = bodies::random_voxels({.x = 1, .y = 1, .z = 1}, 1),
              large = bodies::random_voxels({.x = 4, .y = 4, .z = 4}, 2);
  std::vector<const Robot*> robots{&large, &small, &small};
  split->load(robots, {});
  EXPECT_EQ(sizes(), (Sizes{1, 2}));
  robots.push_back(&small);
  split->add(robots, 3);
  EXPECT_EQ(sizes(), (Sizes{1, 3}));
  robots.insert(robots.end(), {&large, &small});
  split->add(robots, 4);
  EXPECT_EQ(sizes(), (Sizes{2, 4}));
  const std::array<std::size_t, 4> kept{4, 3, 1, 5};
  split->keep(std::array{&large, &small, &small, &small}, kept);
  EXPECT_EQ(sizes(), (Sizes{1, 3}));
}

}  // namespace
}  // namespace mercury
