// SPDX-License-Identifier: Apache-2.0
// Robots on a kernel of the CPU, and what the plain loop makes of them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <span>
#include <vector>

#include "bench/cpu_plain_loop.h"
#include "kernel_cases.h"
#include "sim/cpu/backend.h"

namespace mercury::test {

// A backend with robots and its clock.
class KernelBatch {
 public:
  KernelBatch(const KernelCase& of, std::span<const Robot> robots, int threads = 1)
      : robots_(robots), backend_(cpu::make_backend({.threads = threads}, of.kernel)) {
    clock_.dt = of.configuration().dt;
    std::vector<const Robot*> pointers;
    for (const Robot& robot : robots) pointers.push_back(&robot);
    backend_->load(pointers, of.configuration());
  }

  void write(std::size_t robot, const State& state) { backend_->write(robot, state.positions, state.velocities); }
  void step(std::int64_t steps) {
    backend_->step(clock_, steps);
    clock_.step += steps;
  }
  State state(std::size_t robot) const {
    State state{std::vector<Vec3>(robots_[robot].masses.size()), std::vector<Vec3>(robots_[robot].masses.size())};
    backend_->read(robot, state.positions, state.velocities);
    return state;
  }
  Backend& backend() { return *backend_; }
  std::int64_t steps() const { return clock_.step; }

 private:
  std::span<const Robot> robots_;
  std::unique_ptr<Backend> backend_;
  Clock clock_;
};

inline void expect_same(const State& got, const State& wanted, std::size_t robot) {
  std::size_t different = 0;
  for (std::size_t i = 0; i < wanted.positions.size(); ++i)
    different += got.positions[i] != wanted.positions[i] || got.velocities[i] != wanted.velocities[i];
  EXPECT_EQ(different, 0u) << "robot " << robot << ": masses that differ, of " << wanted.positions.size();
}

// Steps all robots in one batch, in these calls, and compares each with the plain loop.
inline void expect_the_plain_loop(const KernelCase& of, std::span<const Robot> robots, std::span<const State> starts,
                                  std::initializer_list<std::int64_t> calls,
                                  std::span<const Perturbation> perturbations = {}) {
  KernelBatch batch(of, robots);
  for (std::size_t i = 0; i < robots.size(); ++i) batch.write(i, starts[i]);
  batch.backend().set_perturbations(perturbations);
  for (const std::int64_t call : calls) batch.step(call);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    bench::PlainLoop loop(robots[i], of.configuration());
    loop.set_state(starts[i]);
    std::vector<Perturbation> own;
    std::ranges::copy_if(perturbations, std::back_inserter(own),
                         [&](const Perturbation& perturbation) { return perturbation.robot == i; });
    loop.set_perturbations(own);
    loop.step(batch.steps());
    expect_same(batch.state(i), loop.state(), i);
    EXPECT_EQ(batch.backend().status(i).exploded_step, loop.exploded_step()) << i;
    EXPECT_EQ(batch.backend().status(i).bad_mass, loop.bad_mass()) << i;
  }
}

}  // namespace mercury::test
