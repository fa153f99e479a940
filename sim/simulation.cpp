// SPDX-License-Identifier: Apache-2.0
// Robots, configuration and time of a Simulation.
#include "mercury/simulation.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "mercury/error.h"
#include "sim/simulation_parts.h"

namespace mercury {
namespace {

void validate_named(const Robot& robot, std::size_t index) {
  try {
    validate(robot);
  } catch (const InputError& error) {
    const std::string name = robot.name.empty() ? "" : " (" + robot.name + ")";
    throw InputError("robot " + std::to_string(index) + name, error.what());
  }
}

bool is_land(const Environment& environment) { return std::holds_alternative<Land>(environment); }

}  // namespace

float lift_to_floor(std::span<const Vec3> positions, const Environment& environment) {
  return is_land(environment) ? -std::ranges::min(positions, {}, &Vec3::z).z : 0;
}

void Simulation::Parts::require(std::size_t robot) const {
  if (robot >= size()) throw std::out_of_range("robot " + std::to_string(robot) + " of " + std::to_string(size()));
}

void Simulation::Parts::load() {
  std::vector<const Robot*> pointers;
  pointers.reserve(size());
  for (const auto& robot : robots) pointers.push_back(robot.get());
  backend->load(pointers, configuration);
}

void Simulation::Parts::put_at_rest(std::size_t robot) {
  std::vector<Vec3> positions = robots[robot]->masses;
  const Vec3 up{0, 0, lift_to_floor(positions, configuration.environment)};
  for (Vec3& x : positions) x += up;
  const std::vector<Vec3> velocities(positions.size());
  backend->write(robot, positions, velocities);
  backend->set_status(robot, {});
  explosions[robot] = {};
}

Simulation::Simulation(const Configuration& configuration, std::span<const Robot> robots)
    : Simulation(configuration, robots, (validate(configuration), make_backend(configuration.device))) {}

Simulation::Simulation(const Configuration& configuration, std::span<const Robot> robots,
                       std::unique_ptr<Backend> backend)
    : parts_(std::make_unique<Parts>()) {
  validate(configuration);
  parts_->configuration = configuration;
  parts_->clock.dt = configuration.dt;
  parts_->backend = std::move(backend);
  parts_->load();
  if (!robots.empty()) add(robots);
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

std::size_t Simulation::add(std::span<const Robot> robots) {
  const std::size_t first = size();
  for (std::size_t i = 0; i < robots.size(); ++i) validate_named(robots[i], first + i);
  const BatchState saved = parts_->save();
  for (const Robot& robot : robots) {
    parts_->robots.push_back(std::make_unique<Robot>(robot));
    parts_->offsets.push_back(parts_->offsets.back() + robot.masses.size());
    parts_->explosions.emplace_back();
    parts_->materials.resize(size() * max_materials);
    std::ranges::copy(materials_of(robot), parts_->table(size() - 1).begin());
  }
  parts_->load();
  parts_->backend->write_materials(parts_->materials);
  parts_->restore(saved);
  if (is_land(parts_->configuration.environment))
    for (std::size_t i = first; i < size(); ++i) parts_->put_at_rest(i);
  return first;
}

void Simulation::keep(std::span<const std::size_t> robots) {
  std::vector<bool> kept(size());
  for (const std::size_t i : robots) {
    parts_->require(i);
    if (kept[i]) throw std::invalid_argument("a robot can be kept only once");
    kept[i] = true;
  }
  parts_->backend->set_perturbations({});
  if (robots.size() == size() && std::ranges::is_sorted(robots)) return;
  BatchState saved;
  std::vector<std::unique_ptr<Robot>> remaining;
  std::vector<Material> materials;
  std::vector<KnownExplosion> explosions;
  std::vector<std::size_t> offsets{0};
  for (const std::size_t i : robots) {
    explosions.push_back(parts_->explosions[i]);
    saved.states.push_back(parts_->state(i));
    saved.statuses.push_back(parts_->backend->status(i));
    const auto table = parts_->table(i);
    materials.insert(materials.end(), table.begin(), table.end());
    offsets.push_back(offsets.back() + parts_->masses(i));
    remaining.push_back(std::move(parts_->robots[i]));
  }
  // After this, `remaining` holds the robots that go. The backend refers to them until it has loaded the others.
  std::swap(parts_->robots, remaining);
  parts_->materials = std::move(materials);
  parts_->explosions = std::move(explosions);
  parts_->offsets = std::move(offsets);
  parts_->load();
  parts_->backend->write_materials(parts_->materials);
  parts_->restore(saved);
}

std::size_t Simulation::size() const { return parts_->size(); }
const Robot& Simulation::robot(std::size_t index) const {
  parts_->require(index);
  return *parts_->robots[index];
}
std::size_t Simulation::mass_count() const { return parts_->offsets.back(); }
std::span<const std::size_t> Simulation::mass_offsets() const { return parts_->offsets; }

std::string Simulation::device_name() const { return parts_->backend->device_name(); }
std::vector<std::string> Simulation::notes() const { return parts_->backend->notes(); }
std::size_t Simulation::robots_at_once() const { return parts_->backend->robots_at_once(); }
double Simulation::spring_limit() const { return parts_->backend->spring_limit(); }
double Simulation::busy_seconds() const { return parts_->backend->busy_seconds(); }

double Simulation::time() const { return time_of(parts_->clock); }
std::int64_t Simulation::steps() const { return parts_->clock.step; }
const Clock& Simulation::clock() const { return parts_->clock; }
void Simulation::set_clock(const Clock& clock) {
  if (clock.dt != parts_->clock.dt || clock.step < clock.base_step || clock.base_step < 0)
    throw std::invalid_argument("a clock needs the configuration's time step, and a step at or after its base");
  parts_->change_clock(clock);
}

void Simulation::step(std::int64_t steps) {
  if (steps < 0) throw std::invalid_argument("the number of steps must be 0 or more");
  if (steps > 0 && size() > 0) parts_->backend->step(parts_->clock, steps);
  parts_->clock.step += steps;
}

void Simulation::reset() {
  parts_->clock = Clock{.dt = parts_->configuration.dt};
  for (std::size_t i = 0; i < size(); ++i) parts_->put_at_rest(i);
}

const Configuration& Simulation::configuration() const { return parts_->configuration; }

void Simulation::configure(const Configuration& configuration) {
  validate(configuration);
  if (configuration.device != parts_->configuration.device)
    throw std::invalid_argument("the device of a simulation cannot change");
  if (configuration.dt != parts_->clock.dt) {
    const Clock& clock = parts_->clock;
    parts_->change_clock(
        {.dt = configuration.dt, .base_time = time_of(clock), .base_step = clock.step, .step = clock.step});
  }
  const bool comes_to_land = is_land(configuration.environment) && !is_land(parts_->configuration.environment);
  parts_->configuration = configuration;
  parts_->backend->configure(configuration);
  if (!comes_to_land) return;
  for (std::size_t i = 0; i < size(); ++i) {
    State now = parts_->state(i);
    const Vec3 up{0, 0, lift_to_floor(now.positions, configuration.environment)};
    for (Vec3& x : now.positions) x += up;
    parts_->backend->write(i, now.positions, now.velocities);
  }
}

}  // namespace mercury
