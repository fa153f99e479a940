// SPDX-License-Identifier: Apache-2.0
#include "mercury/simulation.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <stdexcept>

#include "mercury/error.h"
#include "sim/backend.h"
#include "sim/physics/measures.h"
#include "sim/split_backend.h"

namespace mercury {
namespace {

std::unique_ptr<Backend> make_backend(const Device& device) {
  const bool cuda =
      device.kind == DeviceKind::cuda || (device.kind == DeviceKind::automatic && cuda_device_count() > device.index);
  if (!cuda) return make_cpu_backend(device);
  if (device.index != Device::all_devices) return make_cuda_backend(device);
  std::vector<std::unique_ptr<Backend>> parts;
  for (int index = 0; index < std::max(1, cuda_device_count()); ++index)
    parts.push_back(make_cuda_backend({.kind = DeviceKind::cuda, .index = index}));
  return make_split_backend(std::move(parts));
}

void validate_named(const Robot& robot, std::size_t index) {
  try {
    validate(robot);
  } catch (const InputError& error) {
    const std::string name = robot.name.empty() ? "" : " (" + robot.name + ")";
    throw InputError("robot " + std::to_string(index) + name, error.what());
  }
}

// On land a robot starts with its lowest mass at z = 0.
float set_down(std::span<const Vec3> positions, const Environment& environment) {
  if (!std::holds_alternative<Land>(environment)) return 0;
  return -std::ranges::min(positions, {}, &Vec3::z).z;
}

std::uint64_t fnv1a(std::span<const Vec3> values, std::uint64_t hash) {
  const auto add = [&](float value) {
    auto bits = std::bit_cast<std::uint32_t>(value);
    for (int byte = 0; byte < 4; ++byte, bits >>= 8) hash = (hash ^ (bits & 0xff)) * 0x100000001b3u;
  };
  for (const Vec3 value : values) {
    add(value.x);
    add(value.y);
    add(value.z);
  }
  return hash;
}

struct Snapshot {
  std::vector<State> states;
  std::vector<RobotStatus> statuses;
};

// When and where a robot exploded, found out when somebody first asks: its state and status stay from then on.
struct KnownExplosion {
  std::int64_t step = -1;  // of the status that it belongs to; -1 = none is known
  double at = 0;           // [s]
  std::uint32_t culprit_spring = no_spring;
};

}  // namespace

struct Simulation::Parts {
  Configuration configuration;
  Clock clock;
  std::vector<std::unique_ptr<Robot>> robots;
  std::vector<std::size_t> offsets{0};
  std::vector<Material> materials;
  mutable std::vector<KnownExplosion> explosions;  // one a robot
  mutable std::vector<RobotStatus> reported;       // statuses, filled by telemetry()
  std::unique_ptr<Backend> backend;

  std::size_t size() const { return robots.size(); }
  std::size_t masses(std::size_t robot) const { return offsets[robot + 1] - offsets[robot]; }
  void require(std::size_t robot) const {
    if (robot >= size()) throw std::out_of_range("robot " + std::to_string(robot) + " of " + std::to_string(size()));
  }
  void require_material(std::size_t robot, MaterialId id) const {
    require(robot);
    const std::size_t count = materials_of(*robots[robot]).size();
    if (id >= count)
      throw std::out_of_range("material " + std::to_string(id) + ", the robot has " + std::to_string(count));
  }
  std::span<Material> table(std::size_t robot) {
    return std::span(materials).subspan(robot * max_materials, max_materials);
  }

  State state(std::size_t robot) const {
    State state{std::vector<Vec3>(masses(robot)), std::vector<Vec3>(masses(robot))};
    backend->read(robot, state.positions, state.velocities);
    return state;
  }

  Snapshot take_snapshot() const {
    Snapshot snapshot;
    for (std::size_t i = 0; i < size(); ++i) {
      snapshot.states.push_back(state(i));
      snapshot.statuses.push_back(backend->status(i));
    }
    return snapshot;
  }

  void put_at_rest(std::size_t robot) {
    std::vector<Vec3> positions = robots[robot]->masses;
    const Vec3 up{0, 0, set_down(positions, configuration.environment)};
    for (Vec3& x : positions) x += up;
    const std::vector<Vec3> velocities(positions.size());
    backend->write(robot, positions, velocities);
    backend->set_status(robot, {});
    explosions[robot] = {};
  }

  void restore(const Snapshot& snapshot) {
    for (std::size_t i = 0; i < snapshot.states.size(); ++i) {
      backend->write(i, snapshot.states[i].positions, snapshot.states[i].velocities);
      backend->set_status(i, snapshot.statuses[i]);
    }
  }

  void load() {
    std::vector<const Robot*> pointers;
    pointers.reserve(size());
    for (const auto& robot : robots) pointers.push_back(robot.get());
    backend->load(pointers, configuration);
  }

  const KnownExplosion& explosion(std::size_t robot, const RobotStatus& status) const {
    KnownExplosion& known = explosions[robot];
    if (known.step == status.exploded_step) return known;
    Clock clock_then = clock;
    clock_then.step = status.exploded_step;
    const State frozen = state(robot);
    const std::uint32_t bad_mass = culprit_mass(*robots[robot], frozen, status.bad_mass);
    known = {status.exploded_step, time_of(clock_then), culprit_spring(*robots[robot], frozen.positions, bad_mass)};
    return known;
  }

  void complete(auto& told, std::size_t robot, const RobotStatus& status) const {
    if (status.exploded_step < 0) return;
    const KnownExplosion& known = explosion(robot, status);
    told.exploded = true;
    told.exploded_at = known.at;
    told.culprit_spring = known.culprit_spring;
  }

  // Steps of before are told by the clock of before.
  void change_clock(const Clock& changed) {
    const std::vector<RobotStatus> statuses = backend->statuses();
    for (std::size_t i = 0; i < statuses.size(); ++i)
      if (statuses[i].exploded_step >= 0) explosion(i, statuses[i]);
    clock = changed;
  }
};

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
  const Snapshot before = parts_->take_snapshot();
  for (const Robot& robot : robots) {
    parts_->robots.push_back(std::make_unique<Robot>(robot));
    parts_->offsets.push_back(parts_->offsets.back() + robot.masses.size());
    parts_->explosions.emplace_back();
    parts_->materials.resize(parts_->robots.size() * max_materials);
    std::ranges::copy(materials_of(robot), parts_->table(size() - 1).begin());
  }
  parts_->load();
  parts_->backend->write_materials(parts_->materials);
  parts_->restore(before);
  if (std::holds_alternative<Land>(parts_->configuration.environment))
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
  Snapshot after;
  std::vector<std::unique_ptr<Robot>> bodies;
  std::vector<Material> materials;
  std::vector<KnownExplosion> explosions;
  std::vector<std::size_t> offsets{0};
  for (const std::size_t i : robots) {
    explosions.push_back(parts_->explosions[i]);
    after.states.push_back(parts_->state(i));
    after.statuses.push_back(parts_->backend->status(i));
    const auto table = parts_->table(i);
    materials.insert(materials.end(), table.begin(), table.end());
    offsets.push_back(offsets.back() + parts_->masses(i));
    bodies.push_back(std::move(parts_->robots[i]));
  }
  // The robots that leave live on until the backend has let them go.
  std::swap(parts_->robots, bodies);
  parts_->materials = std::move(materials);
  parts_->explosions = std::move(explosions);
  parts_->offsets = std::move(offsets);
  parts_->load();
  parts_->backend->write_materials(parts_->materials);
  parts_->restore(after);
}

std::size_t Simulation::size() const { return parts_->size(); }
const Robot& Simulation::robot(std::size_t index) const {
  parts_->require(index);
  return *parts_->robots[index];
}
const Configuration& Simulation::configuration() const { return parts_->configuration; }
double Simulation::time() const { return time_of(parts_->clock); }
std::int64_t Simulation::steps() const { return parts_->clock.step; }
const Clock& Simulation::clock() const { return parts_->clock; }
void Simulation::set_clock(const Clock& clock) {
  if (clock.dt != parts_->clock.dt || clock.step < clock.base_step || clock.base_step < 0)
    throw std::invalid_argument("a clock has the configuration's time step, and stands at its base or later");
  parts_->change_clock(clock);
}
std::string Simulation::device_name() const { return parts_->backend->device_name(); }
std::vector<std::string> Simulation::notes() const { return parts_->backend->notes(); }

std::size_t Simulation::robots_at_once() const { return parts_->backend->robots_at_once(); }
double Simulation::spring_limit() const { return parts_->backend->spring_limit(); }
double Simulation::busy_seconds() const { return parts_->backend->busy_seconds(); }

void Simulation::step(std::int64_t steps) {
  if (steps < 0) throw std::invalid_argument("a number of steps is at least 0");
  if (steps > 0 && size() > 0) parts_->backend->step(parts_->clock, steps);
  parts_->clock.step += steps;
}

void Simulation::reset() {
  parts_->clock = Clock{.dt = parts_->configuration.dt};
  for (std::size_t i = 0; i < size(); ++i) parts_->put_at_rest(i);
}

void Simulation::configure(const Configuration& configuration) {
  validate(configuration);
  if (configuration.device != parts_->configuration.device)
    throw std::invalid_argument("the device of a simulation cannot change");
  if (configuration.dt != parts_->clock.dt) {
    const Clock& clock = parts_->clock;
    parts_->change_clock(
        {.dt = configuration.dt, .base_time = time_of(clock), .base_step = clock.step, .step = clock.step});
  }
  const bool lands = std::holds_alternative<Land>(configuration.environment) &&
                     !std::holds_alternative<Land>(parts_->configuration.environment);
  parts_->configuration = configuration;
  parts_->backend->configure(configuration);
  if (!lands) return;
  for (std::size_t i = 0; i < size(); ++i) {
    State now = parts_->state(i);
    const Vec3 up{0, 0, set_down(now.positions, configuration.environment)};
    for (Vec3& x : now.positions) x += up;
    parts_->backend->write(i, now.positions, now.velocities);
  }
}

State Simulation::state(std::size_t robot) const {
  parts_->require(robot);
  State state = parts_->state(robot);
  parts_->complete(state, robot, parts_->backend->status(robot));
  return state;
}
std::vector<Vec3> Simulation::positions(std::size_t robot) const {
  parts_->require(robot);
  return parts_->state(robot).positions;
}

void Simulation::read_positions(std::span<Vec3> out) const {
  if (out.size() != mass_count()) throw std::invalid_argument("one position a mass is needed");
  parts_->backend->read_positions(out);
}
int Simulation::cuda_device() const { return parts_->backend->cuda_device(); }
void Simulation::copy_positions(float* device_out) const { parts_->backend->copy_positions(device_out); }
void Simulation::read_velocities(std::span<Vec3> out) const {
  if (out.size() != mass_count()) throw std::invalid_argument("one velocity a mass is needed");
  parts_->backend->read_velocities(out);
}
std::size_t Simulation::mass_count() const { return parts_->offsets.back(); }
std::span<const std::size_t> Simulation::mass_offsets() const { return parts_->offsets; }

void Simulation::set_state(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities) {
  parts_->require(robot);
  const std::size_t masses = parts_->masses(robot);
  if (positions.size() != masses || velocities.size() != masses)
    throw std::invalid_argument("one position and one velocity a mass are needed");
  parts_->backend->write(robot, positions, velocities);
  parts_->backend->set_status(robot, {});
  parts_->explosions[robot] = {};
}

void Simulation::set_state(std::size_t robot, const State& state) {
  set_state(robot, state.positions, state.velocities);
  if (!state.exploded) return;
  parts_->explosions[robot] = {parts_->clock.step, state.exploded_at, state.culprit_spring};
  parts_->backend->set_status(robot, {.exploded_step = parts_->clock.step});
}

std::vector<Telemetry> Simulation::telemetry() const {
  std::vector<Telemetry> all(parts_->size());
  std::vector<RobotStatus>& statuses = parts_->reported;
  statuses.resize(all.size());
  parts_->backend->report(parts_->clock, all, statuses);
  for (std::size_t i = 0; i < all.size(); ++i) parts_->complete(all[i], i, statuses[i]);
  return all;
}
Telemetry Simulation::telemetry(std::size_t robot) const {
  parts_->require(robot);
  return telemetry()[robot];
}

std::uint64_t Simulation::hash(std::size_t robot) const {
  const State now = parts_->state(robot);
  constexpr std::uint64_t offset_basis = 0xcbf29ce484222325u;
  return fnv1a(now.velocities, fnv1a(now.positions, offset_basis));
}

Material Simulation::material(std::size_t robot, MaterialId id) const {
  parts_->require_material(robot, id);
  return parts_->table(robot)[id];
}

void Simulation::set_material(std::size_t robot, MaterialId id, const Material& material) {
  parts_->require_material(robot, id);
  validate(material, "material " + std::to_string(id));
  parts_->table(robot)[id] = material;
  parts_->backend->write_materials(robot, parts_->table(robot));
}

void Simulation::set_materials(std::span<const Material> tables) {
  if (tables.size() != size() * max_materials)
    throw std::invalid_argument("a table of 256 materials a robot is needed");
  for (std::size_t i = 0; i < tables.size(); ++i)
    if (!is_valid(tables[i]))
      validate(tables[i],
               "robot " + std::to_string(i / max_materials) + ", material " + std::to_string(i % max_materials));
  std::ranges::copy(tables, parts_->materials.begin());
  parts_->backend->write_materials(parts_->materials);
}

std::vector<Material> Simulation::materials() const { return parts_->materials; }

void Simulation::set_perturbations(std::span<const Perturbation> perturbations) {
  for (const Perturbation& perturbation : perturbations) {
    parts_->require(perturbation.robot);
    if (perturbation.mass >= parts_->masses(perturbation.robot))
      throw std::out_of_range("a pull on a mass that the robot lacks");
  }
  parts_->backend->set_perturbations(perturbations);
}

}  // namespace mercury
