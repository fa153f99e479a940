// SPDX-License-Identifier: Apache-2.0
#include "app/live/companion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "mercury/error.h"

namespace mercury {
namespace {

bool joined_alike(const Robot& a, const Robot& b) {
  return &a == &b || (a.masses.size() == b.masses.size() &&
                      std::ranges::equal(a.springs, b.springs,
                                         [](const Spring& s, const Spring& t) { return s.a == t.a && s.b == t.b; }));
}

bool same_list(const std::vector<LiveRobot>& a, const std::vector<LiveRobot>& b) {
  return std::ranges::equal(a, b, [](const LiveRobot& one, const LiveRobot& other) {
    return one.id == other.id && one.robot == other.robot && one.materials == other.materials && one.name == other.name;
  });
}

// A step of the robots that takes a thousand steps of the companion would hold up the window.
void require_comparable(const Configuration& own, const Configuration& first) {
  constexpr double most = 1000;
  if (own.dt * most < first.dt)
    throw InputError(
        "dt", fmt::format("{:g} s is less than 1/{:g} of the {:g} s that the robots have", own.dt, most, first.dt));
}

bool comes_to_ground(const Configuration& before, const Configuration& after) {
  return has_ground(after.environment) && !has_ground(before.environment);
}

}  // namespace

Companion::Companion(const Configuration& configuration, Measurements& measurements, std::uint64_t number)
    : simulation_(configuration), population_(simulation_, number << 32), measurements_(measurements) {}

void Companion::begin(const CompanionRobots& wanted, const Leader& leader) {
  begin_step_ = leader.simulation.steps();
  copy(wanted, leader);
  std::vector<RobotId> shared;
  for (const LiveRobot& robot : population_.robots()->robots)
    if (const auto partner = leader.population.robots()->index_of(robot.id);
        partner && joined_alike(*robot.robot, *leader.population.robots()->robots[*partner].robot))
      shared.push_back(robot.id);
  measurements_.branch(leader.measurements, shared);
  measurements_.set_robots(*population_.robots(), simulation_.time(), simulation_.configuration().environment,
                           telemetry_);
}

// Puts all robots into the states of their partners.
void Companion::copy(const CompanionRobots& wanted, const Leader& leader) {
  const Simulation& first = leader.simulation;
  require_comparable(wanted.configuration, first.configuration());
  simulation_.set_perturbations({});
  simulation_.configure(first.configuration());
  population_.follow(wanted.robots);
  population_.forget_departed();
  surroundings_ = leader.surroundings;
  const LiveRobots &own = *population_.robots(), &theirs = *leader.population.robots();
  simulation_.reset();
  if (first.steps() > 0) {
    simulation_.set_clock(first.clock());
    for (std::size_t i = 0; i < own.size(); ++i) {
      const auto partner = theirs.index_of(own.robots[i].id);
      if (partner && joined_alike(*own.robots[i].robot, *theirs.robots[*partner].robot))
        simulation_.set_state(i, first.state(*partner));
    }
  }
  const bool to_ground = comes_to_ground(first.configuration(), wanted.configuration);
  simulation_.configure(wanted.configuration);
  if (first.steps() == 0)
    simulation_.reset();
  else if (to_ground)
    population_.settle();
  perturbations_ = wanted.perturbations;
  simulation_.set_perturbations(population_.perturbations_of(perturbations_));
  telemetry_ = simulation_.telemetry();
  ++jumps_;
  observe_details();
}

void Companion::follow(const CompanionRobots& wanted, const Leader& leader) {
  require_comparable(wanted.configuration, leader.simulation.configuration());
  const Configuration& now = simulation_.configuration();
  const bool to_ground = comes_to_ground(now, wanted.configuration);
  const bool moved = leader.surroundings != surroundings_, tuned = wanted.configuration != now;
  if (moved) population_.keep_surroundings(surroundings_);
  simulation_.set_perturbations({});
  if (tuned) simulation_.configure(wanted.configuration);
  const bool others = !same_list(wanted.robots, population_.robots()->robots) && population_.follow(wanted.robots);
  if (moved && !population_.restore_surroundings(leader.surroundings) && to_ground) population_.settle();
  surroundings_ = leader.surroundings;
  perturbations_ = wanted.perturbations;
  simulation_.set_perturbations(population_.perturbations_of(perturbations_));
  if (!moved && !tuned && !others) return;
  telemetry_ = simulation_.telemetry();
  measurements_.set_robots(*population_.robots(), simulation_.time(), simulation_.configuration().environment,
                           telemetry_);
  observe_details();
}

void Companion::advance(const Leader& leader) {
  const Clock& clock = simulation_.clock();
  const double ahead = (leader.simulation.time() - clock.base_time) / clock.dt;
  const std::int64_t target = clock.base_step + std::llround(ahead);
  if (target > clock.step) simulation_.step(target - clock.step);
}

void Companion::restore(const BatchState& state) {
  simulation_.restore(state);
  telemetry_ = simulation_.telemetry();
  ++jumps_;
}

void Companion::show_common_past(const CompanionRobots& wanted, const Leader& leader) { copy(wanted, leader); }

void Companion::forget_later(const CompanionRobots& wanted, const Leader& leader) {
  if (leader.simulation.steps() < begin_step_) return begin(wanted, leader);
  measurements_.cut(simulation_.time(), leader.simulation.steps());
}

void Companion::observe(std::int64_t step) {
  telemetry_ = simulation_.telemetry();
  measurements_.observe(simulation_.time(), step, telemetry_);
}

void Companion::watch(const ViewSettings& view) {
  view_ = view;
  observe_details();
}

void Companion::observe_details() {
  details_.reset();
  if (view_) details_.emplace(simulation_, known_in(*view_, simulation_.configuration().environment));
}

std::shared_ptr<Snapshot> Companion::snapshot(bool with_velocities) {
  std::shared_ptr<Snapshot> next = pool_.take();
  next->robots = population_.robots();
  next->configuration = simulation_.configuration();
  next->time = simulation_.time();
  next->steps = simulation_.steps();
  next->resets = jumps_;
  next->stops = next->failed_seconds = next->failed_ghosts = 0;
  simulation_.read_positions(next->positions.set_on_host(simulation_.mass_count()));
  next->velocities.resize(with_velocities ? simulation_.mass_count() : 0);
  if (with_velocities) simulation_.read_velocities(next->velocities);
  next->telemetry = telemetry_ = simulation_.telemetry();
  next->details = details_ ? details_->observe(telemetry_) : SceneDetails{};
  next->color = details_ ? &details_->color() : &material_color();
  next->perturbations = perturbations_;
  next->timeline = {};
  next->achieved_speed = next->springs_per_second = next->step_seconds = next->gathering_seconds = 0;
  next->second.reset();
  next->ghosts.reset();
  return next;
}

}  // namespace mercury
