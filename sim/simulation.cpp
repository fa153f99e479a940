// SPDX-License-Identifier: Apache-2.0
// Robots, configuration and time of a Simulation.
#include "mercury/simulation.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "mercury/error.h"
#include "mercury/parallel.h"
#include "mercury/stopwatch.h"
#include "mercury/work_counter.h"
#include "sim/robot_notes.h"
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

bool is_sound(const Robot& robot) {
  try {
    validate(robot);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

// Checks robots on all cores, and one that appears several times in a row only once. `first` = the index of the first.
void validate_all(std::span<const std::shared_ptr<const Robot>> robots, std::size_t first, const WorkWatch& watch) {
  std::atomic<std::size_t> bad = robots.size();
  WorkCounter counter(watch, "checking robots", robots.size());
  parallel_for(0, robots.size(), [&](std::size_t i) {
    counter.add_one();
    if ((i > 0 && robots[i] == robots[i - 1]) || is_sound(*robots[i])) return;
    for (std::size_t known = bad; i < known && !bad.compare_exchange_weak(known, i);) {
    }
  });
  if (bad < robots.size()) validate_named(*robots[bad], first + bad);
}

std::vector<std::shared_ptr<const Robot>> copies_of(std::span<const Robot> robots) {
  std::vector<std::shared_ptr<const Robot>> copies(robots.size());
  parallel_for(0, robots.size(), [&](std::size_t i) { copies[i] = std::make_shared<const Robot>(robots[i]); });
  return copies;
}

}  // namespace

float lift_to_floor(std::span<const Vec3> positions, const Environment& environment) {
  return has_ground(environment) ? -std::ranges::min(positions, {}, &Vec3::z).z : 0;
}

void require_clock(const Clock& clock, const Configuration& configuration) {
  if (clock.dt != configuration.dt || clock.step < clock.base_step || clock.base_step < 0)
    throw std::invalid_argument("a clock needs the configuration's time step, and a step at or after its base");
}

void Simulation::Parts::require(std::size_t robot) const {
  if (robot >= size()) throw std::out_of_range("robot " + std::to_string(robot) + " of " + std::to_string(size()));
}

void Simulation::Parts::append(std::span<const std::shared_ptr<const Robot>> added, const WorkWatch& watch) {
  {
    const Stopwatch stopwatch(check_seconds);
    validate_all(added, size(), watch);
  }
  for (const std::shared_ptr<const Robot>& robot : added) {
    robots.push_back(robot);
    pointers.push_back(robot.get());
    offsets.push_back(offsets.back() + robot->masses.size());
  }
  changed_tables.resize(size());
  environments.resize(size());
  explosions.resize(size());
  cells.resize(size());
  brains.append(added);
}

void Simulation::Parts::truncate(std::size_t size) {
  robots.resize(size);
  pointers.resize(size);
  offsets.resize(size + 1);
  changed_tables.resize(size);
  environments.resize(size);
  explosions.resize(size);
  cells.resize(size);
  lifts.resize(std::min(lifts.size(), size));
  brains.truncate(size);
}

std::span<const float> Simulation::Parts::rest_lifts() {
  if (lifts.size() == size()) return lifts;
  const std::size_t known = std::min(lifts.size(), size());
  lifts.resize(size());
  if (has_ground(configuration.environment))
    parallel_for(known, size(),
                 [&](std::size_t i) { lifts[i] = lift_to_floor(robots[i]->masses, configuration.environment); });
  return lifts;
}

void Simulation::Parts::put_at_rest(std::size_t first) {
  backend->put_at_rest(std::span(pointers).subspan(first), first, rest_lifts().subspan(first));
}

void Simulation::Parts::after_exchange(std::span<const std::size_t> kept) {
  shared_state.forget();
  write_environments();
  shared_actuation.rearrange(*backend, robots, changed_tables, kept);
}

Simulation::Simulation(const Configuration& configuration, std::span<const Robot> robots)
    : Simulation(configuration, robots, (validate(configuration), make_backend(configuration.device))) {}

Simulation::Simulation(const Configuration& configuration, std::span<const Robot> robots,
                       std::unique_ptr<Backend> backend)
    : parts_(std::make_unique<Parts>(configuration, std::move(backend), copies_of(robots))) {}

Simulation::Simulation(const Configuration& configuration, std::span<const std::shared_ptr<const Robot>> robots,
                       const WorkWatch& watch)
    : parts_(std::make_unique<Parts>(configuration, (validate(configuration), make_backend(configuration.device)),
                                     robots, watch)) {}

Simulation::Parts::Parts(const Configuration& initial, std::unique_ptr<Backend> stepped_by,
                         std::span<const std::shared_ptr<const Robot>> first_robots, const WorkWatch& watch)
    : configuration(initial), clock{.dt = initial.dt}, backend(std::move(stepped_by)) {
  validate(configuration);
  append(first_robots, watch);
  if (watch) backend->set_watch(watch);
  backend->load(pointers, configuration);
  if (has_ground(configuration.environment)) put_at_rest(0);
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

std::size_t Simulation::add(std::span<const Robot> robots) { return add(copies_of(robots)); }

std::size_t Simulation::add(std::span<const std::shared_ptr<const Robot>> robots) {
  const std::size_t first = size();
  parts_->brains.leave_backend();
  parts_->backend_measures.reset();
  parts_->append(robots);
  if (robots.empty()) return first;
  try {
    parts_->backend->add(parts_->pointers, first);
  } catch (...) {
    parts_->truncate(first);
    parts_->shared_actuation.attach(*parts_->backend);
    throw;
  }
  if (has_ground(parts_->configuration.environment)) parts_->put_at_rest(first);
  std::vector<std::size_t> kept(first);
  std::iota(kept.begin(), kept.end(), std::size_t{0});
  parts_->after_exchange(kept);
  return first;
}

void Simulation::keep(std::span<const std::size_t> robots) {
  std::vector<bool> kept(size());
  for (const std::size_t i : robots) {
    parts_->require(i);
    if (kept[i]) throw std::invalid_argument("a robot can be kept only once");
    kept[i] = true;
  }
  if (robots.size() == size() && std::ranges::is_sorted(robots)) {
    parts_->backend->set_perturbations({});
    return;
  }
  parts_->brains.leave_backend();
  std::vector<std::shared_ptr<const Robot>> remaining;
  std::vector<const Robot*> pointers;
  std::vector<KnownExplosion> explosions;
  std::vector<std::optional<std::shared_ptr<const BodyCells>>> cells;
  std::vector<std::optional<Environment>> environments;
  for (const std::size_t i : robots) {
    environments.push_back(parts_->environments[i]);
    remaining.push_back(parts_->robots[i]);
    pointers.push_back(parts_->pointers[i]);
    explosions.push_back(parts_->explosions[i]);
    cells.push_back(parts_->cells[i]);
  }
  parts_->backend_measures.reset();
  parts_->backend->keep(pointers, robots);  // refers to the robots that go until it returns
  std::vector<std::size_t> offsets{0};
  std::vector<std::unique_ptr<MaterialTable>> tables;
  for (const std::size_t i : robots) {
    offsets.push_back(offsets.back() + parts_->masses(i));
    tables.push_back(std::move(parts_->changed_tables[i]));
  }
  parts_->robots = std::move(remaining);
  parts_->pointers = std::move(pointers);
  parts_->environments = std::move(environments);
  parts_->explosions = std::move(explosions);
  parts_->cells = std::move(cells);
  parts_->offsets = std::move(offsets);
  parts_->changed_tables = std::move(tables);
  parts_->brains.keep(robots);
  parts_->lifts.clear();
  parts_->after_exchange(robots);
}

std::size_t Simulation::size() const { return parts_->size(); }
const Robot& Simulation::robot(std::size_t index) const {
  parts_->require(index);
  return *parts_->robots[index];
}
std::size_t Simulation::mass_count() const { return parts_->offsets.back(); }
std::span<const std::size_t> Simulation::mass_offsets() const { return parts_->offsets; }

std::string Simulation::device_name() const { return parts_->backend->device_name(); }
std::vector<std::string> Simulation::notes() const {
  std::vector<std::string> notes = parts_->backend->notes();
  std::ranges::move(robot_notes(parts_->robots, parts_->configuration), std::back_inserter(notes));
  return notes;
}

std::size_t Simulation::robots_at_once() const { return parts_->backend->robots_at_once(); }
double Simulation::spring_limit() const { return parts_->backend->spring_limit(); }
double Simulation::busy_seconds() const { return parts_->backend->busy_seconds(); }
LoadTimes Simulation::load_times() const {
  LoadTimes times = parts_->backend->load_times();
  times.check = parts_->check_seconds;
  return times;
}

double Simulation::time() const { return time_of(parts_->clock); }
std::int64_t Simulation::steps() const { return parts_->clock.step; }
const Clock& Simulation::clock() const { return parts_->clock; }
void Simulation::set_clock(const Clock& clock) {
  require_clock(clock, parts_->configuration);
  parts_->change_clock(clock);
}

void Simulation::step(std::int64_t steps) {
  if (steps < 0) throw std::invalid_argument("the number of steps must be 0 or more");
  if (steps > 0 && size() > 0) {
    parts_->advance(steps);
    parts_->after_change();
  } else {
    parts_->clock.step += steps;
  }
}

bool Simulation::Parts::host_thinks() {
  if (brains.empty()) return false;
  shared_actuation.arrays(*backend, robots, changed_tables);
  return !brains.think_in_backend(*backend);
}

std::optional<std::int64_t> Simulation::Parts::push_step() const {
  const Environment& environment = configuration.environment;
  if (environment.push == Vec3{}) return std::nullopt;
  const double steps = (static_cast<double>(environment.push_at) - clock.base_time) / clock.dt;
  if (!(steps > -0.5 && steps < 1e15)) return std::nullopt;
  const std::int64_t step = clock.base_step + std::llround(steps);
  return step < clock.step ? std::nullopt : std::optional(step);
}

bool Simulation::Parts::pushes_within(std::int64_t steps) const {
  const std::optional<std::int64_t> at = push_step();
  return at && *at < clock.step + steps;
}

void Simulation::Parts::push() {
  std::vector<Vec3> positions(offsets.back()), velocities(offsets.back());
  backend->read_positions(positions);
  backend->read_velocities(velocities);
  const std::vector<RobotStatus> statuses = backend->statuses();
  for (std::size_t i = 0; i < size(); ++i) {
    if (statuses[i].exploded_step >= 0) continue;
    const auto own = [&](std::vector<Vec3>& all) { return std::span(all).subspan(offsets[i], masses(i)); };
    const std::span<Vec3> moving = own(velocities);
    std::vector<bool> is_fixed(moving.size());
    for (const std::uint16_t mass : robots[i]->fixed) is_fixed[mass] = true;
    for (std::size_t k = 0; k < moving.size(); ++k)
      if (!is_fixed[k]) moving[k] = moving[k] + configuration.environment.push;
    backend->write(i, own(positions), moving);
  }
}

std::int64_t Simulation::Parts::before_step() {
  std::int64_t steps = std::numeric_limits<std::int64_t>::max();
  const std::optional<std::int64_t> pushed_at = push_step();
  if (pushed_at == clock.step) push();
  const bool on_host = host_thinks();
  if (!brains.empty()) {
    if (on_host && brains.steps_until_thought(clock) == 0) {
      std::vector<Vec3> positions, velocities;
      if (brains.need_state(clock)) {
        positions.resize(offsets.back());
        velocities.resize(offsets.back());
        backend->read_positions(positions);
        backend->read_velocities(velocities);
      }
      brains.think(clock, robots, offsets, positions, velocities, configuration.environment);
    }
    shared_actuation.set_drives(*backend, brains.take_drives());
    brains.expect_thoughts();
    if (on_host) {
      Clock next = clock;
      ++next.step;
      steps = brains.steps_until_thought(next) + 1;
    }
  }
  shared_actuation.apply(*backend, clock.step, robots, changed_tables);
  if (pushed_at && *pushed_at > clock.step) steps = std::min(steps, *pushed_at - clock.step);
  return steps;
}

void Simulation::Parts::advance(std::int64_t steps) {
  while (steps > 0) {
    const std::int64_t at_once = std::min(steps, before_step());
    backend->step(clock, at_once);
    clock.step += at_once;
    steps -= at_once;
  }
}

void Simulation::step_in_stream(std::int64_t steps, void* cuda_stream) {
  if (cuda_device() < 0 || parts_->host_thinks() || parts_->pushes_within(steps)) return step(steps);
  if (steps < 0) throw std::invalid_argument("the number of steps must be 0 or more");
  if (steps > 0 && size() > 0) {
    parts_->before_step();
    parts_->backend->step_in_stream(parts_->clock, steps, parts_->shared_state.targets(), cuda_stream);
  }
  parts_->clock.step += steps;
}

std::vector<Telemetry> Simulation::step_and_sample(std::int64_t steps, std::int64_t every) {
  std::vector<Telemetry> all;
  if (every > 0 && steps > 0) all.reserve(static_cast<std::size_t>(steps / every) * size());
  step_and_sample(steps, every,
                  [&](std::span<const Telemetry> samples) { all.insert(all.end(), samples.begin(), samples.end()); });
  return all;
}

void Simulation::step_and_sample(std::int64_t steps, std::int64_t every,
                                 const std::function<void(std::span<const Telemetry>)>& visit, bool from_now) {
  if (every <= 0 || steps < 0 || steps % every != 0)
    throw std::invalid_argument("samples need a number of steps that is a multiple of their distance");
  // These may need the positions between samples.
  const bool one_by_one =
      size() > 0 && (parts_->reads_posture() || parts_->host_thinks() || parts_->pushes_within(steps));
  // Shared drives take effect before the first step, and so before the report that belongs to it.
  if (from_now && size() > 0 && (one_by_one || steps == 0 || parts_->shared_actuation.is_made())) {
    visit(telemetry());
    from_now = false;
  }
  if (one_by_one) {
    for (std::int64_t left = steps; left > 0; left -= every) {
      step(every);
      visit(telemetry());
    }
    return;
  }
  if (size() > 0 && steps > 0) {
    parts_->before_step();
    parts_->backend->step_and_report(parts_->clock, steps, every, from_now,
                                     [&](std::span<Telemetry> samples, std::span<const RobotStatus> statuses) {
                                       for (std::size_t first = 0; first < samples.size(); first += size())
                                         for (std::size_t i = 0; i < size(); ++i)
                                           parts_->add_explosion(samples[first + i], i, statuses[first + i]);
                                       visit(samples);
                                     });
    parts_->after_change();
  }
  parts_->clock.step += steps;
}

void Simulation::reset() {
  parts_->clock = Clock{.dt = parts_->configuration.dt};
  parts_->explosions.assign(size(), {});
  parts_->change_brains([&](Brains& brains) {
    for (std::size_t i = 0; i < size(); ++i) brains.reset(i);
  });
  parts_->put_at_rest(0);
  parts_->after_change();
}

void Simulation::reset_to(std::span<const Vec3> positions) {
  if (positions.size() != mass_count()) throw std::invalid_argument("one position per mass is needed");
  parts_->clock = Clock{.dt = parts_->configuration.dt};
  parts_->explosions.assign(size(), {});
  parts_->change_brains([&](Brains& brains) {
    for (std::size_t i = 0; i < size(); ++i) brains.reset(i);
  });
  // Robots of which backends use nothing but the start.
  std::vector<Robot> starts(size());
  std::vector<const Robot*> pointers(size());
  std::vector<float> lifts(size());
  parallel_for(0, size(), [&](std::size_t i) {
    const auto own = positions.subspan(parts_->offsets[i], parts_->masses(i));
    starts[i].masses.assign(own.begin(), own.end());
    starts[i].velocity = parts_->robots[i]->velocity;
    starts[i].fixed = parts_->robots[i]->fixed;
    pointers[i] = &starts[i];
    lifts[i] = lift_to_floor(own, parts_->configuration.environment);
  });
  parts_->backend->put_at_rest(pointers, 0, lifts);
  parts_->after_change();
}

// A run of robots at a time.
void Simulation::reset(std::span<const std::uint8_t> mask) {
  if (mask.size() != size()) throw std::invalid_argument("one element per robot is needed");
  const std::span<const float> lifts = parts_->rest_lifts();
  parts_->change_brains([&](Brains& brains) {
    for (std::size_t i = 0; i < size(); ++i)
      if (mask[i]) brains.reset(i);
  });
  for (std::size_t begin = 0, end = 0; begin < size(); begin = end + 1) {
    while (begin < size() && !mask[begin]) ++begin;
    for (end = begin; end < size() && mask[end]; ++end) parts_->explosions[end] = {};
    if (begin < end)
      parts_->backend->put_at_rest(std::span(parts_->pointers).subspan(begin, end - begin), begin,
                                   lifts.subspan(begin, end - begin));
  }
  parts_->after_change();
}

// What is known of an explosion ends with the next one, which is at a later step.
void Simulation::reset_in_stream(const std::uint8_t* mask, void* cuda_stream) {
  if (cuda_device() < 0) return reset(std::span(mask, size()));
  if (has_brains()) {
    std::vector<std::uint8_t> copy(size());
    parts_->backend->copy_shared(copy.data(), mask, copy.size());
    return reset(copy);
  }
  if (size() > 0)
    parts_->backend->put_at_rest_in_stream(parts_->pointers, parts_->rest_lifts(), mask, parts_->shared_state.targets(),
                                           cuda_stream);
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
  const bool comes_to_ground = has_ground(configuration.environment) && !has_ground(parts_->configuration.environment);
  parts_->configuration = configuration;
  parts_->lifts.clear();
  std::ranges::fill(parts_->environments, std::nullopt);
  parts_->backend->configure(configuration);
  if (!comes_to_ground) return;
  for (std::size_t i = 0; i < size(); ++i) {
    State now = parts_->state(i);
    const Vec3 up{0, 0, lift_to_floor(now.positions, configuration.environment)};
    for (Vec3& x : now.positions) x += up;
    parts_->backend->write(i, now.positions, now.velocities);
  }
  parts_->after_change();
}

}  // namespace mercury
