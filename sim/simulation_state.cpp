// SPDX-License-Identifier: Apache-2.0
// States, explosions and telemetry of a Simulation.

#include <stdexcept>
#include <utility>

#include "mercury/fnv.h"
#include "mercury/parallel.h"
#include "mercury/simulation.h"
#include "sim/physics/measures.h"
#include "sim/senses.h"
#include "sim/simulation_parts.h"

namespace mercury {
namespace {

std::uint64_t fnv1a(std::span<const Vec3> values, std::uint64_t so_far = Fnv1a::empty) {
  Fnv1a hash(so_far);
  for (const Vec3& value : values) hash.add(value);
  return hash.value();
}

}  // namespace

State Simulation::Parts::state(std::size_t robot) const {
  State state{std::vector<Vec3>(masses(robot)), std::vector<Vec3>(masses(robot))};
  backend->read(robot, state.positions, state.velocities);
  return state;
}

const KnownExplosion& Simulation::Parts::explosion(std::size_t robot, const RobotStatus& status) const {
  KnownExplosion& known = explosions[robot];
  if (known.step == status.exploded_step) return known;
  Clock then = clock;
  then.step = status.exploded_step;
  const State frozen = state(robot);
  const std::uint32_t mass = culprit_mass(*robots[robot], frozen, status.bad_mass);
  known = {status.exploded_step, time_of(then), culprit_spring(*robots[robot], frozen.positions, mass)};
  return known;
}

// Steps before the change have their times by the old clock, so explosions are looked up while it is still there.
void Simulation::Parts::change_clock(const Clock& changed) {
  const std::vector<RobotStatus> statuses = backend->statuses();
  for (std::size_t i = 0; i < statuses.size(); ++i)
    if (statuses[i].exploded_step >= 0) explosion(i, statuses[i]);
  clock = changed;
}

State Simulation::state(std::size_t robot) const {
  parts_->require(robot);
  State state = parts_->state(robot);
  parts_->add_explosion(state, robot, parts_->backend->status(robot));
  if (has_brains()) state.brain = brain_state(robot);
  return state;
}

std::vector<Vec3> Simulation::positions(std::size_t robot) const {
  parts_->require(robot);
  return parts_->state(robot).positions;
}

void Simulation::read_positions(std::span<Vec3> out) const {
  if (out.size() != mass_count()) throw std::invalid_argument("one position per mass is needed");
  parts_->backend->read_positions(out);
}
void Simulation::read_velocities(std::span<Vec3> out) const {
  if (out.size() != mass_count()) throw std::invalid_argument("one velocity per mass is needed");
  parts_->backend->read_velocities(out);
}
int Simulation::cuda_device() const { return parts_->backend->cuda_device(); }
bool Simulation::copy_positions(float* device_out) const { return parts_->backend->copy_positions(device_out); }
void Simulation::copy_positions_with_steps(std::shared_ptr<float> device_out) const {
  parts_->backend->copy_positions_with_steps(std::move(device_out));
}

void Simulation::set_state(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities) {
  parts_->require(robot);
  const std::size_t masses = parts_->masses(robot);
  if (positions.size() != masses || velocities.size() != masses)
    throw std::invalid_argument("one position and one velocity per mass are needed");
  parts_->backend->write(robot, positions, velocities);
  parts_->backend->set_status(robot, {});
  parts_->explosions[robot] = {};
  parts_->after_change();
}

void Simulation::set_state(std::size_t robot, const State& state) {
  parts_->require(robot);
  const bool thinks = !(state.brain == BrainState{});
  if (thinks) parts_->brains.require_state(robot, state.brain);
  set_state(robot, state.positions, state.velocities);
  if (thinks) set_brain_state(robot, state.brain);
  if (!state.exploded) return;
  parts_->explosions[robot] = {parts_->clock.step, state.exploded_at, state.culprit_spring};
  parts_->backend->set_status(robot, {.exploded_step = parts_->clock.step});
  parts_->after_change();
}

BatchState Simulation::save() const {
  BatchState state{.clock = parts_->clock,
                   .positions = std::vector<Vec3>(mass_count()),
                   .velocities = std::vector<Vec3>(mass_count()),
                   .explosions = {},
                   .brains = {}};
  parts_->backend->read_positions(state.positions);
  parts_->backend->read_velocities(state.velocities);
  const std::vector<RobotStatus> statuses = parts_->backend->statuses();
  for (std::size_t i = 0; i < statuses.size(); ++i) {
    if (statuses[i].exploded_step < 0) continue;
    const KnownExplosion& known = parts_->explosion(i, statuses[i]);
    state.explosions.push_back({i, known.step, known.at, known.culprit_spring});
  }
  if (has_brains()) state.brains = brain_states();
  return state;
}

void Simulation::restore(const BatchState& state) {
  if (state.positions.size() != mass_count() || state.velocities.size() != mass_count())
    throw std::invalid_argument("one position and one velocity per mass are needed");
  if (!state.brains.empty() && state.brains.size() != size())
    throw std::invalid_argument("the state of one brain per robot is needed, or none");
  for (std::size_t i = 0; i < state.brains.size(); ++i) parts_->brains.require_state(i, state.brains[i]);
  std::vector<RobotStatus> wanted(size());
  std::vector<KnownExplosion> known(size());
  for (const BatchState::Explosion& explosion : state.explosions) {
    if (explosion.robot >= size() || explosion.step < 0)
      throw std::invalid_argument("an explosion of no robot or step");
    wanted[explosion.robot].exploded_step = explosion.step;
    known[explosion.robot] = {explosion.step, explosion.at, explosion.culprit_spring};
  }
  require_clock(state.clock, parts_->configuration);
  parts_->clock = state.clock;
  parts_->explosions = std::move(known);
  parts_->change_brains([&](Brains& brains) {
    for (std::size_t i = 0; i < size(); ++i)
      state.brains.empty() ? brains.reset(i) : brains.set_state(i, state.brains[i]);
  });
  const std::vector<RobotStatus> present = parts_->backend->statuses();
  for (std::size_t i = 0; i < size(); ++i) {
    const std::size_t first = parts_->offsets[i], masses = parts_->masses(i);
    parts_->backend->write(i, std::span(state.positions).subspan(first, masses),
                           std::span(state.velocities).subspan(first, masses));
    if (present[i].exploded_step != wanted[i].exploded_step) parts_->backend->set_status(i, wanted[i]);
  }
  parts_->after_change();
}

std::vector<Telemetry> Simulation::telemetry() const {
  const bool reads_posture = parts_->reads_posture();
  std::vector<Telemetry> all(size());
  std::vector<RobotStatus>& statuses = parts_->reported;
  statuses.resize(all.size());
  parts_->backend->report(parts_->clock, all, statuses);
  for (std::size_t i = 0; i < all.size(); ++i) parts_->add_explosion(all[i], i, statuses[i]);
  if (reads_posture) parts_->add_posture(all);
  return all;
}

void Simulation::measure_folding(bool on) {
  measure_folding(on ? std::function([](const Robot&) { return MeasuredFolding::all; }) : nullptr);
}

void Simulation::measure_folding(std::function<MeasuredFolding(const Robot&)> of) {
  parts_->folding_of = std::move(of);
  parts_->cells.assign(size(), {});
  parts_->backend_measures.reset();
  parts_->backend->measure_inversion({});
}

bool Simulation::measures_folding() const { return parts_->find_cells(); }

void Simulation::measure_upright(bool on) { parts_->upright = on; }
bool Simulation::measures_upright() const { return parts_->upright; }

bool Simulation::Parts::find_cells() const {
  if (!folding_of) return false;
  const auto is_repeated = [&](std::size_t i) { return i > 0 && robots[i] == robots[i - 1]; };
  parallel_for(0, size(), [&](std::size_t i) {
    if (cells[i] || is_repeated(i)) return;
    const MeasuredFolding measured = folding_of(*robots[i]);
    cells[i] = measured == MeasuredFolding::none ? nullptr : std::make_shared<const BodyCells>(*robots[i], measured);
  });
  for (std::size_t i = 0; i < size(); ++i)
    if (!cells[i]) cells[i] = cells[i - 1];
  return std::ranges::any_of(cells, [](const auto& of_robot) { return *of_robot != nullptr; });
}

bool Simulation::Parts::reads_posture() const {
  if (!find_cells()) return upright;
  if (!backend_measures) {
    std::vector<const BodyCells*> of_robots;
    for (const auto& of_robot : cells) of_robots.push_back(of_robot->get());
    const auto is_enough = [](const BodyCells* c) { return !c || c->measured() == MeasuredFolding::inverted; };
    backend_measures = std::ranges::all_of(of_robots, is_enough) && backend->measure_inversion(of_robots);
  }
  return upright || !*backend_measures;
}

void Simulation::Parts::add_posture(std::span<Telemetry> telemetry) const {
  if (telemetry.empty()) return;
  std::vector<Vec3> positions(offsets.back());
  backend->read_positions(positions);
  parallel_for(0, telemetry.size(), [&](std::size_t i) {
    if (telemetry[i].exploded) return;
    const auto own = std::span<const Vec3>(positions).subspan(offsets[i], masses(i));
    if (upright) telemetry[i].upright = static_cast<float>(body_frame(*robots[i], own).up());
    const BodyCells* of_robot = folding_of ? cells[i]->get() : nullptr;
    if (!of_robot) return;
    const Folding folding = of_robot->folding(own);
    telemetry[i].inverted = folding.inverted;
    telemetry[i].overlap = folding.overlap;
  });
}

Telemetry Simulation::telemetry(std::size_t robot) const {
  parts_->require(robot);
  return telemetry()[robot];
}

std::uint64_t Simulation::hash(std::size_t robot) const {
  const State now = parts_->state(robot);
  return fnv1a(now.velocities, fnv1a(now.positions));
}

std::vector<std::uint64_t> Simulation::hashes() const {
  std::vector<std::uint64_t> all(size(), Fnv1a::empty);
  std::vector<Vec3> values(mass_count());
  const auto take_values = [&] {
    parallel_for(0, all.size(), [&](std::size_t i) {
      all[i] = fnv1a(std::span(values).subspan(parts_->offsets[i], parts_->masses(i)), all[i]);
    });
  };
  parts_->backend->read_positions(values);
  take_values();
  parts_->backend->read_velocities(values);
  take_values();
  return all;
}

}  // namespace mercury
