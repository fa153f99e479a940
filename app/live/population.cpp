// SPDX-License-Identifier: Apache-2.0
#include "app/live/population.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_map>

#include "mercury/parallel.h"
#include "robots/carried_points.h"

namespace mercury {
namespace {

// Whether two entries need the same simulated robot. Names and materials may differ.
bool same_body(const LiveRobot& a, const LiveRobot& b) { return a.id == b.id && a.robot == b.robot; }

using Shapes = std::vector<std::shared_ptr<const RobotShape>>;

// Reuses the previous shapes. Makes the others on all cores.
Shapes shapes_of(const std::vector<LiveRobot>& robots, const LiveRobots& before) {
  std::map<const Robot*, std::shared_ptr<const RobotShape>> known;
  for (std::size_t i = 0; i < before.shapes.size(); ++i) known[before.robots[i].robot.get()] = before.shapes[i];
  std::vector<const Robot*> added;
  for (const LiveRobot& robot : robots)
    if (known.emplace(robot.robot.get(), nullptr).second) added.push_back(robot.robot.get());
  Shapes made(added.size());
  parallel_for(0, added.size(), [&](std::size_t i) { made[i] = shape_of(*added[i]); });
  for (std::size_t i = 0; i < added.size(); ++i) known[added[i]] = made[i];
  Shapes shapes;
  for (const LiveRobot& robot : robots) shapes.push_back(known[robot.robot.get()]);
  return shapes;
}

std::shared_ptr<const LiveRobots> listed(const std::vector<LiveRobot>& robots, const LiveRobots& before, bool changed) {
  auto list = std::make_shared<LiveRobots>(
      LiveRobots{.revision = before.revision + (changed ? 1 : 0), .robots = robots, .mass_offsets = {0}});
  for (const LiveRobot& robot : robots) {
    list->indices.emplace(robot.id, list->indices.size());
    list->mass_offsets.push_back(list->mass_offsets.back() + robot.robot->masses.size());
    list->springs += robot.robot->springs.size();
  }
  list->shapes = changed ? shapes_of(robots, before) : before.shapes;
  list->bodies = changed ? bodies_of(list->shapes) : before.bodies;
  return list;
}

}  // namespace

bool Population::follow(const std::vector<LiveRobot>& wanted) {
  const bool changed = !std::ranges::equal(robots_->robots, wanted, same_body);
  if (changed) {
    keep_states(wanted);
    arrange(wanted);
  }
  follow_materials(wanted, changed);
  follow_drives(wanted, changed);
  follow_neurons(wanted);
  robots_ = listed(wanted, *robots_, changed);
  return changed;
}

void Population::keep_states(const std::vector<LiveRobot>& wanted) {
  std::unordered_map<RobotId, const LiveRobot*> stay;
  for (const LiveRobot& robot : wanted) stay.emplace(robot.id, &robot);
  for (std::size_t i = 0; i < robots_->size(); ++i) {
    const LiveRobot& old = robots_->robots[i];
    if (const auto found = stay.find(old.id); found != stay.end() && same_body(*found->second, old)) continue;
    forget(old.id);
    departed_[old.id] = {old.robot, simulation_.state(i)};
    departed_masses_ += old.robot->masses.size();
  }
  // Ids grow, so the oldest robots go first.
  while (departed_masses_ > most_departed) forget(departed_.begin()->first);
}

void Population::forget(RobotId id) {
  const auto found = departed_.find(id);
  if (found == departed_.end()) return;
  departed_masses_ -= found->second.robot->masses.size();
  departed_.erase(found);
}

void Population::forget_departed() {
  departed_.clear();
  departed_masses_ = 0;
  surroundings_.clear();
}

void Population::keep_surroundings(std::uint64_t number) {
  constexpr std::size_t most = 8;  // numbers
  std::map<RobotId, Departed> states;
  std::size_t masses = 0;
  for (std::size_t i = 0; i < robots_->size(); ++i) {
    const LiveRobot& robot = robots_->robots[i];
    states[robot.id] = {robot.robot, simulation_.state(i)};
    masses += robot.robot->masses.size();
  }
  surroundings_[number] = {simulation_.clock(), std::move(states)};
  const std::size_t fitting = masses > 0 ? std::max<std::size_t>(1, most_departed / masses) : most;
  while (surroundings_.size() > std::min(most, fitting))
    surroundings_.erase(surroundings_.begin()->first == number ? std::next(surroundings_.begin())
                                                               : surroundings_.begin());
}

bool Population::restore_surroundings(std::uint64_t number) {
  const auto found = surroundings_.find(number);
  if (found == surroundings_.end()) return false;
  simulation_.set_clock(found->second.clock);
  for (const auto& [id, kept] : found->second.states)
    if (const auto index = robots_->index_of(id); index && robots_->robots[*index].robot == kept.robot)
      simulation_.set_state(*index, kept.state);
  surroundings_.erase(found);
  return true;
}

void Population::settle() {
  for (std::size_t i = 0; i < robots_->size(); ++i) {
    State state = simulation_.state(i);
    if (state.exploded) continue;
    std::ranges::fill(state.velocities, Vec3{});
    simulation_.set_state(i, state);
  }
}

void Population::start_over() {
  forget_departed();
  robots_ = listed({}, *robots_, true);
  held_ = false;
}

// Keeps the robots that stay, adds the new ones after them, then sorts all into the wanted order.
void Population::arrange(const std::vector<LiveRobot>& wanted) {
  std::vector<std::size_t> staying, indices(wanted.size()), added;
  std::vector<std::shared_ptr<const Robot>> robots;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto old = robots_->index_of(wanted[i].id);
    if (old && same_body(robots_->robots[*old], wanted[i])) {
      indices[i] = staying.size();
      staying.push_back(*old);
    } else {
      added.push_back(i);
      robots.push_back(wanted[i].robot);
    }
  }
  simulation_.keep(staying);
  if (added.empty()) return;
  const std::size_t first = simulation_.add(robots);
  for (std::size_t k = 0; k < added.size(); ++k) {
    indices[added[k]] = first + k;
    const auto before = departed_.find(wanted[added[k]].id);
    if (before == departed_.end()) {
      begin_at(simulation_, first + k, start_);
      begin_as(wanted, indices, added[k]);
      continue;
    }
    const Robot &then = *before->second.robot, &now = *wanted[added[k]].robot;
    if (&then == &now)
      simulation_.set_state(first + k, before->second.state);
    else if (const auto carried = carried_state(then, before->second.state, now))
      simulation_.set_state(first + k, *carried);
    else
      begin_at(simulation_, first + k, start_);
    forget(wanted[added[k]].id);
  }
  if (!std::ranges::is_sorted(indices)) simulation_.keep(indices);
}

// A new robot that is a copy of another takes its state. `indices`: of the wanted robots in the simulation so far.
void Population::begin_as(const std::vector<LiveRobot>& wanted, const std::vector<std::size_t>& indices,
                          std::size_t robot) {
  if (wanted[robot].begins_as == 0) return;
  for (std::size_t i = 0; i < robot; ++i)
    if (wanted[i].id == wanted[robot].begins_as && wanted[i].robot == wanted[robot].robot)
      simulation_.set_state(indices[robot], simulation_.state(indices[i]));
}

void Population::follow_materials(const std::vector<LiveRobot>& wanted, bool arranged) {
  // Robots that stay keep their materials in the simulation, and new ones bring their own. Writing the tables of all
  // robots prepares all of them again, so it is done only if one differs.
  const auto differs = [&](std::size_t i) {
    const auto materials = materials_of(wanted[i]);
    const std::size_t count = std::min(materials.size(), materials_of(simulation_.robot(i)).size());
    for (std::size_t id = 0; id < count; ++id)
      if (simulation_.material(i, static_cast<MaterialId>(id)) != materials[id]) return true;
    return false;
  };
  std::vector<Material> tables;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const bool known = !arranged && robots_->robots[i].materials == wanted[i].materials;
    if (known || !differs(i)) continue;
    if (tables.empty()) tables = simulation_.materials();
    const auto table = std::span(tables).subspan(i * max_materials, max_materials);
    const auto materials = materials_of(wanted[i]);
    std::ranges::copy(materials.first(std::min(materials.size(), table.size())), table.begin());
  }
  if (!tables.empty()) simulation_.set_materials(tables);
}

// New robots have values of their materials in the shared arrays, which hold_drives() takes out.
void Population::follow_drives(const std::vector<LiveRobot>& wanted, bool arranged) {
  bool any = false, same = !arranged;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    any = any || wanted[i].by_hand;
    same = same && robots_->robots[i].by_hand == wanted[i].by_hand;
  }
  if (same || !(any || held_)) return;
  held_ = true;
  simulation_.hold_drives(held_drives(wanted));
}

// `robots_` are still those before: the same body keeps its clamps in the simulation.
void Population::follow_neurons(const std::vector<LiveRobot>& wanted) {
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto before = robots_->index_of(wanted[i].id);
    const bool stays = before && robots_->robots[*before].robot == wanted[i].robot;
    if (!wanted[i].by_hand && !(stays && robots_->robots[*before].by_hand)) continue;
    clamp_neurons(simulation_, i, stays ? held_neurons(robots_->robots[*before]) : std::span<const float>(),
                  held_neurons(wanted[i]));
  }
}

std::vector<Perturbation> Population::perturbations_of(std::span<const LivePerturbation> perturbations) const {
  std::vector<Perturbation> known;
  for (const LivePerturbation& perturbation : perturbations) {
    const auto index = robots_->index_of(perturbation.robot);
    if (index && perturbation.mass < robots_->robots[*index].robot->masses.size())
      known.push_back({*index, perturbation.mass, perturbation.target, perturbation.stiffness});
  }
  return known;
}

std::optional<State> carried_state(const Robot& before, const State& state, const Robot& after) {
  if (state.exploded || state.positions.size() != before.masses.size()) return std::nullopt;
  std::map<MassPlace, std::size_t> places;
  for (std::size_t i = 0; i < before.masses.size(); ++i) places.emplace(mass_place_of(before.masses[i]), i);
  State carried{.positions = after.masses, .velocities = std::vector<Vec3>(after.masses.size())};
  std::vector<std::size_t> kept, added;
  const auto take = [&](std::size_t mass, std::size_t from) {
    carried.positions[mass] = after.masses[mass] + (state.positions[from] - before.masses[from]);
    carried.velocities[mass] = state.velocities[from];
  };
  for (std::size_t i = 0; i < after.masses.size(); ++i) {
    const auto found = places.find(mass_place_of(after.masses[i]));
    (found == places.end() ? added : kept).push_back(i);
    if (found == places.end()) continue;
    carried.positions[i] = state.positions[found->second];
    carried.velocities[i] = state.velocities[found->second];
  }
  if (kept.empty()) return std::nullopt;
  for (const std::size_t mass : added) {
    std::size_t nearest = 0;
    float least = INFINITY;
    for (std::size_t i = 0; i < before.masses.size(); ++i)
      if (const float distance = length(before.masses[i] - after.masses[mass]); distance < least) {
        least = distance;
        nearest = i;
      }
    take(mass, nearest);
  }
  return carried;
}

}  // namespace mercury
