// SPDX-License-Identifier: Apache-2.0
// Small robots of different builds that are stepped side by side: each has the bits that it has alone, whatever becomes
// of the others.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <set>

#include "bench/cpu_lattice.h"
#include "bench/cpu_plain_loop.h"
#include "bodies.h"
#include "kernel_cases.h"
#include "sim/cpu/backend.h"
#include "sim/cpu/lockstep.h"
#include "sim/cpu/party.h"
#include "sim/cpu/similar.h"

namespace mercury {
namespace {

// No two built alike: voxels left out here and there, other sizes, some numbered in another order, some with materials
// of their own; one that is no lattice.
std::vector<Robot> crowd(std::size_t lanes) {
  std::vector<Robot> robots;
  for (std::uint64_t seed = 1; seed <= 2 * lanes + 3; ++seed) {
    const int n = seed % 5 == 0 ? 3 : 2;
    robots.push_back(bench::lattice_with_holes(n, 0.3, seed));
    Robot& robot = robots.back();
    if (seed % 3 == 0) robot = bench::scrambled(robot, seed);
    if (seed % 4 == 0) {
      robot.materials.assign(materials_of(robot).begin(), materials_of(robot).end());
      for (Material& material : robot.materials) {
        material.stiffness *= 1 + 0.01f * static_cast<float>(seed);
        material.phase += 0.1f * static_cast<float>(seed);
      }
    }
  }
  robots.push_back(bodies::random_voxels({.x = 3, .y = 2, .z = 1}, 1));
  robots.push_back(bodies::random_voxels({.x = 1, .y = 1, .z = 1}, 2));
  bodies::rotate(robots[4], bodies::random_rotation(1));
  return robots;
}

using test::KernelCase;

// A backend with robots, its clock, and what became of them.
class Batch {
 public:
  Batch(const KernelCase& of, std::span<const Robot> robots, std::int64_t threads = 1)
      : robots_(robots),
        backend_(cpu::make_backend({.threads = static_cast<int>(threads)}, of.kernel)), clock_{
                                                                                            .dt =
                                                                                                of.configuration().dt} {
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

void expect_same(const State& got, const State& wanted, std::size_t robot) {
  EXPECT_TRUE(got.positions == wanted.positions && got.velocities == wanted.velocities) << "robot " << robot;
}

class MixedBatch : public testing::TestWithParam<KernelCase> {
 protected:
  void SetUp() override {
    for (std::size_t i = 0; i < robots.size(); ++i) {
      starts.push_back(bodies::shaken(robots[i], 0.01f, 0.5f, i));
      for (Vec3& x : starts.back().positions) x.z += 0.02f * static_cast<float>(i % 5);
    }
  }

  // All in one batch, calls of 1 to 45 steps, beside the plain loop.
  void expect_the_plain_loop(std::span<const Perturbation> perturbations = {}, Vec3 flow = {}) const {
    KernelCase of = GetParam();
    of.flow = flow;
    Batch batch(of, robots);
    for (std::size_t i = 0; i < robots.size(); ++i) batch.write(i, starts[i]);
    batch.backend().set_perturbations(perturbations);
    for (const std::int64_t call : {1, 2, 45, 7, 40, 1, 34}) batch.step(call);
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

  std::vector<Robot> robots = crowd(GetParam().kernel.lanes);
  std::vector<State> starts;
};
INSTANTIATE_TEST_SUITE_P(All, MixedBatch, testing::ValuesIn(test::every_kernel_case()), test::name_of_kernel_case);

TEST_P(MixedBatch, GivesTheBitsOfThePlainLoop) { expect_the_plain_loop(); }

TEST_P(MixedBatch, GivesTheBitsOfThePlainLoopAtSpeed) {
  for (State& start : starts)
    for (std::size_t i = 0; i < start.velocities.size(); ++i)
      start.velocities[i] += Vec3{20, 5 * static_cast<float>(i % 3), -10};
  expect_the_plain_loop();
}

TEST_P(MixedBatch, GivesTheBitsOfThePlainLoopInACurrent) { expect_the_plain_loop({}, {0.3f, -0.2f, 1.5f}); }

TEST_P(MixedBatch, WhatPullsARobotPullsNoOther) {
  const std::vector<Perturbation> perturbations = {{0, 0, {0.3f, 0.1f, 0.4f}, 20},
                                                   {0, 5, {0.3f, 0.1f, 0.4f}, 2},
                                                   {7, 3, {-1, 0, 0.5f}, 50},
                                                   {9, 1, {1e6f, 0, 0}, 1e6f}};
  expect_the_plain_loop(perturbations);
}

TEST_P(MixedBatch, AnExplosionIsItsRobotsOwn) {
  starts[2].velocities[5] += Vec3{1e10f, 0, 0};  // in the first step
  starts[7].velocities[3] += Vec3{3e3f, 0, 0};
  robots[3].materials.assign(materials_of(robots[3]).begin(), materials_of(robots[3]).end());
  for (Material& material : robots[3].materials) material.stiffness *= 2e4f;  // too stiff for the time step
  robots[3].materials[air] = {};
  expect_the_plain_loop();
}

TEST_P(MixedBatch, AnInfiniteVelocityIsItsRobotsOwn) {
  starts[2].velocities[5].x = std::numeric_limits<float>::infinity();
  starts[7].velocities[3] += Vec3{0, -1e36f, 0};
  expect_the_plain_loop();
}

// Compared as statuses, for a state that holds NaN differs from itself.
TEST_P(MixedBatch, AVelocityThatIsNoNumberExplodesItsRobotOnly) {
  starts[2].velocities[5].y = std::numeric_limits<float>::quiet_NaN();
  Batch batch(GetParam(), robots);
  for (std::size_t i = 0; i < robots.size(); ++i) batch.write(i, starts[i]);
  for (const std::int64_t call : {1, 40}) batch.step(call);
  for (std::size_t i = 0; i < robots.size(); ++i)
    EXPECT_EQ(batch.backend().status(i).exploded_step, i == 2 ? 0 : -1) << i;
}

// Everything that can be done to a robot, done to some of the batch, and to each of them alone.
TEST_P(MixedBatch, EditsReachTheirRobotOnly) {
  using Edit = std::function<void(Batch&, const std::function<bool(std::size_t)>& is_there, std::size_t first)>;
  const auto table_of = [&](std::size_t i, float stiffness) {
    std::vector<Material> table(max_materials);
    std::ranges::copy(materials_of(robots[i]), table.begin());
    for (Material& material : table) {
      material.stiffness *= stiffness;
      material.frequency += 2 * stiffness;
    }
    return table;
  };
  const Edit script = [&](Batch& batch, const auto& is_there, std::size_t first) {
    for (std::size_t i = 0; i < robots.size(); ++i)
      if (is_there(i)) batch.write(i - first, starts[i]);
    batch.step(5);
    for (const std::size_t i : {1u, 4u})
      if (is_there(i)) batch.backend().write_materials(i - first, table_of(i, 0.3f));
    batch.step(3);
    for (const std::size_t i : {0u, 5u})
      if (is_there(i)) batch.write(i - first, starts[i]);
    batch.step(40);
    for (const std::size_t i : {2u, 6u})
      if (is_there(i)) {
        State broken = batch.state(i - first);
        (i == 2 ? broken.velocities : broken.positions)[1].x = 1e10f;  // at once, or before the next step
        batch.write(i - first, broken);
      }
    batch.step(2);
    batch.step(3);
    if (is_there(2)) {
      batch.write(2 - first, starts[2]);
      batch.backend().set_status(2 - first, {});
    }
    batch.step(10);
    std::vector<Material> tables;
    for (std::size_t i = 0; i < robots.size(); ++i)
      if (is_there(i)) std::ranges::copy(table_of(i, 1 + 0.1f * static_cast<float>(i)), std::back_inserter(tables));
    batch.backend().write_materials(tables);
    batch.step(4);
    KernelCase other = GetParam();
    other.solver = other.solver == Solver::force ? Solver::xpbd : Solver::force;
    batch.backend().configure(other.configuration());
    batch.step(6);
    other.environment = other.environment == Land::name ? Ocean::name : Land::name;
    batch.backend().configure(other.configuration());
    batch.step(6);
  };
  Batch all(GetParam(), robots);
  script(
      all, [](std::size_t) { return true; }, 0);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    Batch alone(GetParam(), std::span(robots).subspan(i, 1));
    script(
        alone, [&](std::size_t j) { return j == i; }, i);
    expect_same(all.state(i), alone.state(0), i);
    EXPECT_EQ(all.backend().status(i).exploded_step, alone.backend().status(0).exploded_step) << i;
    EXPECT_EQ(all.backend().status(i).bad_mass, alone.backend().status(0).bad_mass) << i;
  }
  EXPECT_GE(all.backend().status(6).exploded_step, 0);
}

// What is reported while states are in lanes is what was reported of them alone, and all masses are read from there.
TEST_P(MixedBatch, IsReadAndReportedAsEachAlone) {
  Batch all(GetParam(), robots);
  for (std::size_t i = 0; i < robots.size(); ++i) all.write(i, starts[i]);
  all.step(20);
  const Clock clock{.dt = GetParam().configuration().dt, .step = 20};
  std::vector<Telemetry> reports(robots.size());
  std::vector<RobotStatus> statuses(robots.size());
  all.backend().report(clock, reports, statuses);
  std::size_t masses = 0;
  for (const Robot& robot : robots) masses += robot.masses.size();
  std::vector<Vec3> positions(masses), velocities(masses);
  all.backend().read_positions(positions);
  all.backend().read_velocities(velocities);
  std::size_t first = 0;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    Batch alone(GetParam(), std::span(robots).subspan(i, 1));
    alone.write(0, starts[i]);
    alone.step(20);
    Telemetry wanted;
    alone.backend().report(clock, {&wanted, 1}, {&statuses[i], 1});
    EXPECT_EQ(reports[i].center_of_mass, wanted.center_of_mass) << i;
    EXPECT_EQ(reports[i].kinetic_energy, wanted.kinetic_energy) << i;
    EXPECT_EQ(reports[i].elastic_energy, wanted.elastic_energy) << i;
    EXPECT_EQ(reports[i].largest_strain, wanted.largest_strain) << i;
    const State state = alone.state(0);
    EXPECT_TRUE(std::ranges::equal(state.positions, std::span(positions).subspan(first, state.positions.size()))) << i;
    EXPECT_TRUE(std::ranges::equal(state.velocities, std::span(velocities).subspan(first, state.velocities.size())))
        << i;
    first += state.positions.size();
  }
}

TEST_P(MixedBatch, AnyNumberOfThreadsGivesTheSameBits) {
  Batch one(GetParam(), robots), many(GetParam(), robots, 3);
  for (Batch* batch : {&one, &many}) {
    for (std::size_t i = 0; i < robots.size(); ++i) batch->write(i, starts[i]);
    batch->step(3);
    batch->step(50);
  }
  for (std::size_t i = 0; i < robots.size(); ++i) expect_same(many.state(i), one.state(i), i);
}

// The tests above would show nothing if each robot were stepped by itself.
TEST(Parties, AreMadeOfRobotsOfDifferentBuilds) {
  for (const cpu::Kernel& kernel : cpu::kernels()) {
    const std::vector<Robot> robots = crowd(kernel.lanes);
    std::vector<cpu::Body> bodies;
    for (const Robot& robot : robots) bodies.push_back(cpu::make_body(robot, kernel.lanes));
    const std::vector<cpu::Party> parties = cpu::find_parties(bodies, 1, {});
    std::set<std::size_t> in_parties;
    for (const cpu::Party& party : parties) in_parties.insert(party.bodies.begin(), party.bodies.end());
    EXPECT_GE(in_parties.size(), kernel.lanes) << kernel.name;
    std::size_t mixed = 0;
    for (const cpu::Party& party : parties)
      mixed += party.bodies.size() > 1 && !same_topology(robots[party.bodies[0]], robots[party.bodies[1]]);
    EXPECT_GE(mixed, 1u) << kernel.name;
  }
}

// Long and flat robots by turns, 1,100 of them, which is more than are looked at at once: only what is left over at the
// end goes together.
TEST(Parties, AreMadeOfRobotsOfOneKind) {
  constexpr std::size_t robots = 1100, group_size = 8;
  const Robot kinds[] = {bodies::random_voxels({.x = 8, .y = 1, .z = 1}, 1),
                         bodies::random_voxels({.x = 3, .y = 1, .z = 4}, 2)};
  std::vector<cpu::Cell> cells[2];
  std::vector<FacePair> faces[2];
  for (int kind = 0; kind < 2; ++kind) {
    cells[kind] = cpu::cells_of(kinds[kind]);
    faces[kind] = pair_faces(kinds[kind]);
  }
  std::vector<cpu::Outline> outlines;
  for (std::size_t i = 0; i < robots; ++i) outlines.push_back({cells[i % 2], kinds[i % 2].springs, faces[i % 2]});
  std::set<std::size_t> seen;
  std::size_t mixed = 0, small = 0;
  for (const std::vector<std::size_t>& group : cpu::similar_groups(outlines, group_size)) {
    EXPECT_LE(group.size(), group_size);
    small += group.size() < group_size;
    mixed += std::ranges::any_of(group, [&](std::size_t i) { return i % 2 != group.front() % 2; });
    for (const std::size_t i : group) EXPECT_TRUE(seen.insert(i).second) << i;
  }
  EXPECT_EQ(seen.size(), robots);
  EXPECT_LE(mixed, 1u);
  EXPECT_LE(small, 2u);
}

TEST(Parties, SeatEveryMassSpringAndFaceOnce) {
  const std::vector<Robot> robots = crowd(8);
  std::vector<cpu::Body> bodies;
  for (const Robot& robot : robots) bodies.push_back(cpu::make_body(robot, 8));
  for (const cpu::Party& party : cpu::find_parties(bodies, 1, {})) {
    const cpu::Build& build = *party.assembly.build;
    std::vector<std::uint32_t> owners;
    for (std::uint32_t seat = 0; seat < build.joints.size(); ++seat)
      owners.insert(owners.end(), build.joints[seat].owned, seat);
    for (std::size_t lane = 0; lane < party.bodies.size(); ++lane) {
      const cpu::Body& body = bodies[party.bodies[lane]];
      const auto& [seats, slots, faces] = *party.assembly.seatings[lane];
      const auto distinct = [](const auto& values) { return std::set(values.begin(), values.end()).size(); };
      EXPECT_EQ(distinct(seats), body.robot->masses.size());
      EXPECT_EQ(distinct(slots), body.robot->springs.size());
      EXPECT_EQ(distinct(faces), body.face_pairs.size());
      for (std::size_t s = 0; s < slots.size(); ++s) {
        const Spring& spring = body.robot->springs[s];
        EXPECT_EQ(std::minmax(owners[slots[s]], build.partners[slots[s]]),
                  std::minmax(seats[spring.a], seats[spring.b]));
      }
      for (std::size_t p = 0; p < faces.size(); ++p) {
        const FacePair &own = body.face_pairs[p], &seat = build.faces[faces[p]];
        EXPECT_TRUE(seat.a == seats[own.a] && seat.b == seats[own.b] && seat.c == seats[own.c] &&
                    seat.d == seats[own.d]);
      }
    }
  }
}

// The corners that a lane's half of a slot holds are those of its robot's pair of faces, also where two pairs share a
// slot.
TEST(Parties, PairsOfFacesThatShareASlotAreTheirRobotsOwn) {
  for (const std::size_t lanes : {4u, 8u, 16u}) {
    const std::vector<Robot> robots = crowd(lanes);
    std::vector<cpu::Body> bodies;
    for (const Robot& robot : robots) bodies.push_back(cpu::make_body(robot, lanes));
    std::size_t shared = 0;
    for (const cpu::Party& party : cpu::find_parties(bodies, 1, {})) {
      const cpu::Lockstep group = cpu::make_lockstep(bodies, party.bodies, party.assembly, false);
      shared += group.split_faces.size();
      for (std::size_t lane = 0; lane < party.bodies.size(); ++lane) {
        const cpu::Seating& seating = *group.seatings[lane];
        const std::vector<FacePair>& pairs = bodies[party.bodies[lane]].face_pairs;
        std::set<std::uint32_t> slots;
        for (std::size_t p = 0; p < pairs.size(); ++p) {
          const std::uint32_t slot = group.face_slots[seating.faces[p]];
          EXPECT_TRUE(slots.insert(slot).second) << "two pairs of a robot in one slot";
          std::array<std::uint32_t, 4> corners{};
          if (slot < group.faces.size()) {
            const auto& [a, b, c, d] = group.faces[slot];
            corners = {a, b, c, d};
          } else {
            const auto& [a, b, c, d] = group.split_faces[slot - group.faces.size()];
            const auto mine = [&](cpu::Lockstep::Halves seats) { return 2 * lane < lanes ? seats.lower : seats.upper; };
            corners = {mine(a), mine(b), mine(c), mine(d)};
          }
          const auto start = [&](std::uint16_t mass) { return group.start_of(seating.seats[mass]); };
          EXPECT_EQ(corners, (std::array{start(pairs[p].a), start(pairs[p].b), start(pairs[p].c), start(pairs[p].d)}));
        }
      }
    }
    EXPECT_EQ(shared > 0, lanes > 4) << lanes << " lanes";
  }
}

}  // namespace
}  // namespace mercury
