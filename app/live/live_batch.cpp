// SPDX-License-Identifier: Apache-2.0
#include "app/live/live_batch.h"

#include <algorithm>
#include <utility>

#include "mercury/error.h"

namespace mercury {
namespace {

bool joined_alike(const Robot& a, const Robot& b) {
  return &a == &b || (a.masses.size() == b.masses.size() &&
                      std::ranges::equal(a.springs, b.springs,
                                         [](const Spring& s, const Spring& t) { return s.a == t.a && s.b == t.b; }));
}

// The robot of the same id in `robots`, if it is joined in the same way.
std::optional<std::size_t> partner_of(const LiveRobot& robot, const LiveRobots& robots) {
  const auto partner = robots.index_of(robot.id);
  return partner && joined_alike(*robot.robot, *robots.robots[*partner].robot) ? partner : std::nullopt;
}

bool comes_to_ground(const Configuration& before, const Configuration& after) {
  return has_ground(after.environment) && !has_ground(before.environment);
}

}  // namespace

LiveBatch::LiveBatch(const Configuration& configuration, Measurements& measurements, Messages& messages,
                     std::uint64_t revision)
    : simulation_(configuration), population_(simulation_, revision), measurements_(measurements), messages_(messages) {
}

void LiveBatch::configure(Configuration configuration) {
  configuration.device = this->configuration().device;
  if (configuration == this->configuration()) return;
  const bool other_parts = !same_parts(configuration.environment, this->configuration().environment);
  simulation_.configure(configuration);
  if (other_parts) observe_details();
}

bool LiveBatch::follow(const std::vector<LiveRobot>& wanted) {
  if (wanted == robots()->robots) return false;
  simulation_.set_perturbations({});
  bool changed = false;
  try {
    changed = population_.follow(wanted);
  } catch (...) {  // it is left half changed
    details_.reset();
    simulation_ = Simulation(configuration());
    population_.start_over();
    telemetry_.clear();
    ++jumps_;
    throw;
  }
  if (changed) observe_details();
  return changed;
}

bool LiveBatch::move(const std::vector<LiveRobot>& wanted, const Configuration& configuration,
                     std::uint64_t surroundings) {
  const bool moves = surroundings != surroundings_, to_ground = comes_to_ground(this->configuration(), configuration);
  if (moves) population_.keep_surroundings(surroundings_);
  configure(configuration);
  const bool changed = follow(wanted);
  if (moves && !population_.restore_surroundings(surroundings) && to_ground) population_.settle();
  surroundings_ = surroundings;
  sample();
  return changed;
}

void LiveBatch::perturb(std::vector<LivePerturbation> perturbations) {
  perturbations_ = std::move(perturbations);
  simulation_.set_perturbations(population_.perturbations_of(perturbations_));
}

bool LiveBatch::copy(const LiveBatch& first, const std::vector<LiveRobot>& wanted, const Configuration& configuration) {
  set_start(first.start());
  configure(first.configuration());
  const bool changed = follow(wanted);
  population_.forget_departed();
  surroundings_ = first.surroundings_;
  population_.return_to_start();
  // Also before the first step: a target that was moved since leaves robots where they are.
  const bool began = first.steps() > 0 || start().is_elsewhere();
  if (began) {
    simulation_.set_clock(first.simulation_.clock());
    for (std::size_t i = 0; i < robots()->size(); ++i)
      if (const auto partner = partner_of(robots()->robots[i], *first.robots()))
        simulation_.set_state(i, first.simulation_.state(*partner));
  }
  configure(configuration);
  if (!began)
    population_.return_to_start();
  else if (comes_to_ground(first.configuration(), configuration))
    population_.settle();
  sample();
  ++jumps_;
  return changed;
}

void LiveBatch::reset() {
  population_.return_to_start();
  population_.forget_departed();
  ++jumps_;
}

void LiveBatch::begin(const Clock& clock, const State& state) {
  simulation_.set_clock(clock);
  simulation_.set_state(0, state);
}

void LiveBatch::restore(const BatchState& state, bool jumps) {
  simulation_.restore(state);
  sample();
  if (jumps) ++jumps_;
}

void LiveBatch::restart_measures() { measurements_.restart(*robots(), time(), steps(), configuration(), telemetry_); }
void LiveBatch::measure_robots() {
  measurements_.set_robots(*robots(), time(), configuration().environment, telemetry_);
}
void LiveBatch::measure(std::int64_t step) { measurements_.observe(time(), step, telemetry_); }

void LiveBatch::branch_measures(const LiveBatch& first) {
  std::vector<RobotId> shared;
  for (const LiveRobot& robot : robots()->robots)
    if (partner_of(robot, *first.robots())) shared.push_back(robot.id);
  measurements_.branch(first.measurements_, shared);
  measure_robots();
}

void LiveBatch::watch(const ViewSettings& view) {
  view_ = view;
  observe_details();
}

// Observes the details of the view that exist in this environment.
void LiveBatch::observe_details() {
  simulation_.measure_folding(view_ && view_->folding);
  details_.reset();
  if (view_) details_.emplace(simulation_, known_in(*view_, configuration().environment));
}

void LiveBatch::take_positions(SnapshotPositions& positions) {
  const std::size_t masses = simulation_.mass_count();
  try {
    if (bridge_ && masses > 0) return positions.set_on_device(bridge_->take(simulation_), masses);
  } catch (const DeviceError& error) {
    messages_.add(Severity::note, std::string("positions are copied through the host: ") + error.what());
    bridge_.reset();
  }
  simulation_.read_positions(positions.set_on_host(masses));
}

std::optional<BrainActivity> LiveBatch::brain_of(RobotId robot) const {
  const auto index = robots()->index_of(robot);
  if (!index || !robots()->robots[*index].robot->brain) return std::nullopt;
  BrainState state = simulation_.brain_state(*index);
  state.senses.resize(brain_layout(*robots()->robots[*index].robot).senses.size());  // without older samples
  return BrainActivity{robot, std::move(state.senses), std::move(state.neurons)};
}

std::shared_ptr<Snapshot> LiveBatch::snapshot(bool with_velocities) {
  std::shared_ptr<Snapshot> next = pool_.take();
  next->robots = robots();
  next->configuration = configuration();
  next->time = time();
  next->steps = steps();
  next->resets = jumps_;
  next->velocities.resize(with_velocities ? simulation_.mass_count() : 0);
  take_positions(next->positions);
  if (with_velocities) simulation_.read_velocities(next->velocities);
  next->telemetry = telemetry_;
  next->details = details_ ? details_->observe(telemetry_) : SceneDetails{.driven = simulation_.driven_materials()};
  next->color = details_ ? &details_->color() : &material_color();
  next->perturbations.clear();
  for (const LivePerturbation& perturbation : perturbations_)
    if (!population_.perturbations_of({&perturbation, 1}).empty()) next->perturbations.push_back(perturbation);
  next->brain.reset();
  next->brain_history.reset();
  next->second.reset();
  next->ghosts.reset();
  next->timeline = {};
  next->stops = next->failed_seconds = next->failed_ghosts = 0;
  next->achieved_speed = next->springs_per_second = next->step_seconds = next->gathering_seconds = 0;
  return next;
}

}  // namespace mercury
