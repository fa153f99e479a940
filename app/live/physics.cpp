#include "app/live/physics.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "app/face_forces.h"
#include "app/live/moment_pool.h"
#include "app/live/pace.h"
#include "app/live/population.h"

namespace mercury {
namespace {

constexpr double slice_seconds = 0.006;  // of wall time between two looks at what is asked for

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// What is asked for and not yet carried out.
struct Orders {
  std::optional<std::pair<std::vector<LiveRobot>, Configuration>> scene;
  std::optional<ViewSettings> view;
  std::optional<std::vector<LivePull>> pulls;
  std::optional<bool> playing, pause_on_explosion;
  std::optional<double> speed;
  std::int64_t steps = 0;
  bool drop_steps = false, reset = false, quit = false;
  std::uint64_t ticket = 0;  // of the last who waits until all is done; 0 = nobody

  bool any() const {
    return scene || view || pulls || playing || pause_on_explosion || speed || steps > 0 || reset || quit || ticket > 0;
  }
};

}  // namespace

struct Physics::Parts {
  Parts(const Configuration& configuration, Messages& all)
      : messages(all), simulation(configuration), population(simulation), device(simulation.device_name()) {}

  // Shared by both threads, under the mutex.
  std::mutex mutex;
  std::condition_variable asked, done;
  Orders orders;
  std::shared_ptr<const Moment> moment;
  std::vector<Explosion> explosions;
  bool looked_at = true;  // newest() was called since the last moment
  std::uint64_t tickets = 0, tickets_done = 0;

  Messages& messages;
  Measurements measurements;

  // The physics thread's own.
  Simulation simulation;
  Population population;
  const std::string device;
  MomentPool pool;
  ViewSettings view;
  std::optional<DetailObserver> details;
  std::vector<LivePull> pulls;
  std::vector<Telemetry> telemetry;
  std::set<RobotId> exploded;
  std::set<std::string> told_notes;
  Pace pace;
  SpeedGauge gauge;
  bool playing = false, stop_at_explosion = false;
  double speed = 1, step_seconds = 0;
  std::int64_t steps_left = 0;  // asked for one by one
  std::uint64_t ticket = 0;     // the last one taken
  std::uint64_t resets = 0, stops = 0;
  bool dirty = true;            // something changed since the last moment told
  std::thread thread;           // last: begins when all else is there

  void run();
  bool take_orders(Orders& taken);
  void carry_out(Orders& taken);
  void guarded(auto work);
  bool set_scene(const std::vector<LiveRobot>& robots, const Configuration& configuration);
  void start_over();
  void watch();
  void begin_pace();
  void advance();
  void take_steps(std::int64_t count);
  void note_explosions();
  void tell();
};

void Physics::Parts::run() {
  begin_pace();
  Orders taken;
  while (take_orders(taken)) {
    guarded([&] { carry_out(taken); });
    guarded([&] { advance(); });
    bool wanted;
    {
      const std::lock_guard lock(mutex);
      wanted = looked_at || ticket > tickets_done;
    }
    if (!dirty || !wanted) continue;
    dirty = false;  // also when it fails: not again before something else changes
    guarded([&] { tell(); });
  }
}

// Waits for orders, or for the next step's time. False when it is time to go.
bool Physics::Parts::take_orders(Orders& taken) {
  const auto due = std::chrono::steady_clock::time_point(
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(
          playing && std::isfinite(speed) ? std::min(pace.next_due(), now() + 1) : 0)));
  std::unique_lock lock(mutex);
  const auto ready = [&] { return orders.any() || (dirty && (looked_at || ticket > tickets_done)); };
  if (steps_left == 0 && !ready()) {
    tickets_done = ticket;
    done.notify_all();
    if (playing)
      asked.wait_until(lock, due, ready);
    else
      asked.wait(lock, ready);
  }
  taken = std::exchange(orders, {});
  ticket = std::max(ticket, taken.ticket);
  return !taken.quit;
}

// The window must not end because physics failed: it is told, and physics rests.
void Physics::Parts::guarded(auto work) {
  try {
    work();
  } catch (const std::exception& error) {
    messages.add(Severity::error, error.what());
    playing = false;
    steps_left = 0;
    ++stops;
  }
}

void Physics::Parts::carry_out(Orders& taken) {
  if (!taken.any()) return;
  dirty = true;
  if (taken.pause_on_explosion) stop_at_explosion = *taken.pause_on_explosion;
  const bool other_dt = taken.scene && taken.scene->second.dt != simulation.configuration().dt;
  const bool others = taken.scene && set_scene(taken.scene->first, taken.scene->second);
  if (taken.view) view = *taken.view;
  if (taken.view || others) watch();
  if (taken.reset) {
    simulation.reset();
    population.forget_departed();
    telemetry = simulation.telemetry();
    exploded.clear();
    steps_left = 0;
    ++resets;
    measurements.restart(*population.robots(), 0, 0, simulation.configuration().dt, telemetry);
    measurements.observe(0, 0, telemetry);
  }
  if (taken.pulls) pulls = std::move(*taken.pulls);
  if (taken.pulls || taken.scene) simulation.set_pulls(population.pulls_of(pulls));
  if (taken.speed) speed = *taken.speed;
  if (taken.playing) playing = *taken.playing;
  if (taken.drop_steps) steps_left = 0;
  steps_left += taken.steps;
  if (taken.playing || taken.speed || taken.reset || others || other_dt) begin_pace();
}

// Whether there are other robots now, or another kind of environment.
bool Physics::Parts::set_scene(const std::vector<LiveRobot>& robots, const Configuration& configuration) {
  const bool first = simulation.size() == 0 && simulation.steps() == 0;
  const bool other_dt = configuration.dt != simulation.configuration().dt;
  const bool moved = configuration.environment.index() != simulation.configuration().environment.index();
  simulation.configure(configuration);
  simulation.set_pulls({});
  bool changed = false;
  try {
    changed = population.follow(robots);
  } catch (...) {
    start_over();
    throw;
  }
  telemetry = simulation.telemetry();
  if (first || (other_dt && simulation.steps() == 0))
    measurements.restart(*population.robots(), simulation.time(), simulation.steps(), configuration.dt, telemetry);
  else
    measurements.set_robots(*population.robots(), simulation.time(), telemetry);
  if (first) measurements.observe(simulation.time(), simulation.steps(), telemetry);
  if (!changed) return moved;
  std::erase_if(exploded, [&](RobotId id) { return !population.robots()->index_of(id); });
  note_explosions();
  for (const std::string& note : simulation.notes())
    if (told_notes.insert(note).second) messages.add(Severity::note, note);
  return true;
}

// A simulation that could not take its robots, as for want of memory, is left half changed: an empty one takes its place.
void Physics::Parts::start_over() {
  details.reset();
  simulation = Simulation(simulation.configuration());
  population.start_over();
  telemetry.clear();
  exploded.clear();
  ++resets;
  measurements.restart(*population.robots(), 0, 0, simulation.configuration().dt, telemetry);
}

// Details that this environment knows.
void Physics::Parts::watch() {
  details.reset();
  const Environment& environment = simulation.configuration().environment;
  ViewSettings known = view;
  if (!has_face_forces(environment)) {
    known.shown.arrows.drag = known.shown.arrows.lift = false;
    if (known.color == ColorBy::pressure) known.color = ColorBy::material;
  }
  details.emplace(simulation, known);
}

void Physics::Parts::begin_pace() {
  pace.start(now(), speed, simulation.configuration().dt);
  gauge.clear();
  gauge.mark(now(), simulation.time());
}

// One slice, of what is due.
void Physics::Parts::advance() {
  if (steps_left == 0 && !playing) return;
  const auto affordable = step_seconds > 0 ? static_cast<std::int64_t>(std::clamp(slice_seconds / step_seconds, 1.0, 1e6)) : 1;
  if (steps_left > 0) {
    const std::int64_t count = std::min(affordable, steps_left);
    take_steps(count);
    steps_left = std::max<std::int64_t>(0, steps_left - count);
    return;
  }
  const std::int64_t count = std::min(affordable, pace.due(now()));
  if (count <= 0) return;
  take_steps(count);
  pace.done(count);
  gauge.mark(now(), simulation.time());
}

// Samples are taken on the way, at steps of their own.
void Physics::Parts::take_steps(std::int64_t count) {
  const std::int64_t target = simulation.steps() + count;
  double spent = 0;
  while (simulation.steps() < target) {
    const std::int64_t sample = std::max(measurements.next_step(), simulation.steps() + 1);
    const std::int64_t stop = std::min(target, sample);
    const double start = now();
    simulation.step(stop - simulation.steps());
    spent += now() - start;
    if (stop != sample && stop != target) continue;
    telemetry = simulation.telemetry();
    measurements.observe(simulation.time(), simulation.steps(), telemetry);
    note_explosions();
    if (!playing && steps_left == 0) break;  // stopped by an explosion
  }
  const double each = spent / static_cast<double>(count);
  step_seconds = step_seconds > 0 ? 0.8 * step_seconds + 0.2 * each : each;
  dirty = true;
}

void Physics::Parts::note_explosions() {
  const LiveRobots& robots = *population.robots();
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (!telemetry[i].exploded || !exploded.insert(robots.robots[i].id).second) continue;
    if (stop_at_explosion) {
      playing = false;
      steps_left = 0;
      ++stops;
    }
    const std::lock_guard lock(mutex);
    explosions.push_back({robots.robots[i].id, telemetry[i].exploded_at, telemetry[i].first_bad_spring});
  }
}

void Physics::Parts::tell() {
  const double start = now();
  std::shared_ptr<Moment> next = pool.take();
  next->robots = population.robots();
  next->configuration = simulation.configuration();
  next->time = simulation.time();
  next->steps = simulation.steps();
  next->resets = resets;
  next->stops = stops;
  next->positions.resize(simulation.mass_count());
  next->velocities.resize(simulation.mass_count());
  simulation.read_positions(next->positions);
  simulation.read_velocities(next->velocities);
  telemetry = simulation.telemetry();
  next->telemetry = telemetry;
  next->details = details ? details->observe(telemetry) : SceneDetails{};
  next->color = details ? details->color() : ColorBy::material;
  next->pulls.clear();
  for (const LivePull& pull : pulls)
    if (!population.pulls_of({&pull, 1}).empty()) next->pulls.push_back(pull);
  next->playing = playing;
  next->speed = speed;
  next->achieved_speed = playing ? gauge.speed() : 0;
  next->step_seconds = step_seconds;
  next->springs_per_second =
      step_seconds > 0 && (playing || steps_left > 0) ? static_cast<double>(population.robots()->springs) / step_seconds : 0;
  next->telling_seconds = now() - start;
  const std::lock_guard lock(mutex);
  moment = std::move(next);
  looked_at = false;
}

Physics::Physics(const Configuration& configuration, Messages& messages)
    : parts_(std::make_unique<Parts>(configuration, messages)) {
  parts_->tell();
  parts_->thread = std::thread([parts = parts_.get()] { parts->run(); });
}

Physics::~Physics() {
  {
    const std::lock_guard lock(parts_->mutex);
    parts_->orders.quit = true;
    parts_->asked.notify_all();
  }
  parts_->thread.join();
}

namespace {

template <class Change>
void order(auto& parts, Change change) {
  const std::lock_guard lock(parts.mutex);
  change(parts.orders);
  parts.asked.notify_all();
}

}  // namespace

void Physics::set_scene(std::vector<LiveRobot> robots, const Configuration& configuration) {
  order(*parts_, [&](Orders& orders) { orders.scene.emplace(std::move(robots), configuration); });
}
void Physics::set_view(const ViewSettings& settings) {
  order(*parts_, [&](Orders& orders) { orders.view = settings; });
}
void Physics::set_pulls(std::vector<LivePull> pulls) {
  order(*parts_, [&](Orders& orders) { orders.pulls = std::move(pulls); });
}
void Physics::play() {
  order(*parts_, [](Orders& orders) {
    orders.playing = orders.drop_steps = true;
    orders.steps = 0;
  });
}
void Physics::pause() {
  order(*parts_, [](Orders& orders) {
    orders.playing = false;
    orders.drop_steps = true;
    orders.steps = 0;
  });
}
void Physics::set_speed(double speed) {
  if (!(speed > 0)) return;
  order(*parts_, [&](Orders& orders) { orders.speed = speed; });
}
void Physics::step(std::int64_t count) {
  order(*parts_, [&](Orders& orders) {
    orders.playing = false;
    orders.steps += std::max<std::int64_t>(0, count);
  });
}
void Physics::reset() {
  order(*parts_, [](Orders& orders) {
    orders.reset = true;
    orders.steps = 0;
  });
}
void Physics::pause_on_explosion(bool pause) {
  order(*parts_, [&](Orders& orders) { orders.pause_on_explosion = pause; });
}

std::shared_ptr<const Moment> Physics::newest() {
  const std::lock_guard lock(parts_->mutex);
  parts_->looked_at = true;
  parts_->asked.notify_all();
  return parts_->moment;
}

std::vector<Explosion> Physics::take_explosions() {
  const std::lock_guard lock(parts_->mutex);
  return std::exchange(parts_->explosions, {});
}

const Measurements& Physics::measurements() const { return parts_->measurements; }
std::string Physics::device_name() const { return parts_->device; }

void Physics::wait_until_done() {
  std::unique_lock lock(parts_->mutex);
  const std::uint64_t ticket = parts_->orders.ticket = ++parts_->tickets;
  parts_->looked_at = true;
  parts_->asked.notify_all();
  parts_->done.wait(lock, [&] { return parts_->tickets_done >= ticket; });
}

}  // namespace mercury
