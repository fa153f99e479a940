// SPDX-License-Identifier: Apache-2.0
#include "python/src/batch.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "mercury/cuda_devices.h"
#include "mercury/error.h"
#include "mercury/host_memory.h"
#include "mercury/stopwatch.h"
#include "mercury/threads.h"
#include "python/src/arguments.h"

namespace mercury::python {
namespace {

double springs_of(const SharedRobots& robots) {
  double springs = 0;
  for (const auto& robot : robots) springs += static_cast<double>(robot->springs.size());
  return springs;
}

// Of a portion of steps: Ctrl-C has to wait for about a tenth of a second. The CPU begins with a guess.
constexpr double cuda_springs_at_once = 3e10, cpu_springs_at_once = 2e7, cpu_seconds_at_once = 0.1;
constexpr std::int64_t most_cuda_steps_at_once = 20000;

std::int64_t portion_of(double springs_at_once, double springs, std::int64_t most) {
  return static_cast<std::int64_t>(
      std::clamp(springs_at_once / std::max(1.0, springs), 1.0, static_cast<double>(most)));
}

// Raises MemoryError if the robots of a simulation that are there already would not fit with what it takes for them.
// On a GPU, DeviceError says so.
void require_memory_for(const SharedRobots& robots, const Configuration& configuration) {
  constexpr std::size_t few = 16;  // are always tried
  const bool on_gpu = configuration.device.kind == DeviceKind::cuda ||
                      (configuration.device.kind == DeviceKind::automatic && cuda_device_count() > 0);
  if (robots.size() <= few || on_gpu) return;
  constexpr MemoryUse beside_robots{.per_robot = simulated_memory.per_robot,
                                    .per_content = simulated_memory.per_content - 1};
  double needed = 0;
  for (const auto& robot : robots) needed += beside_robots.of(*robot);
  const std::size_t usable = usable_host_memory();
  if (needed <= static_cast<double>(usable)) return;
  PyErr_SetString(PyExc_MemoryError, memory_line(static_cast<std::size_t>(needed), usable).c_str());
  throw nb::python_error();
}

}  // namespace

// All batches of the process. Mutexes are locked without the GIL, which threads within a batch may wait for.
class LiveBatches {
 public:
  static LiveBatches& get() {
    static LiveBatches all;
    return all;
  }
  void add(Batch& batch) {
    const std::lock_guard lock(mutex_);
    batches_.insert(&batch);
  }
  void remove(Batch& batch) {
    const std::lock_guard lock(mutex_);
    batches_.erase(&batch);
  }
  void before_fork() {
    const ReleasedGil released;
    ++forks_;
    mutex_.lock();
    for (Batch* const batch : batches_) batch->mutex_.lock();
  }
  // In both processes, by the thread that forked.
  void after_fork_in_parent() {
    unlock();
    --forks_;
    forks_.notify_all();
  }
  void after_fork_in_child() {
    unlock();
    forks_ = 0;  // the other threads that were about to fork are not here
  }
  // A mutex goes to whom it finds awake: threads that do nothing but step would keep one that forks waiting forever.
  void let_forks_pass() const {
    for (int forks; (forks = forks_) > 0;) forks_.wait(forks);
  }

 private:
  void unlock() {
    for (Batch* const batch : batches_) batch->mutex_.unlock();
    mutex_.unlock();
  }

  std::atomic<int> forks_ = 0;  // begun and not over
  std::mutex mutex_;
  std::set<Batch*> batches_;
};

void watch_forks() {
  nb::module_::import_("os").attr("register_at_fork")(
      nb::arg("before") = nb::cpp_function([] { LiveBatches::get().before_fork(); }),
      nb::arg("after_in_parent") = nb::cpp_function([] { LiveBatches::get().after_fork_in_parent(); }),
      nb::arg("after_in_child") = nb::cpp_function([] { LiveBatches::get().after_fork_in_child(); }));
}

Configuration configuration_of(nb::handle environment, const std::string& solver, double dt, double damping,
                               nb::handle device, int threads) {
  Configuration configuration{.dt = dt,
                              .damping = damping,
                              .solver = solver_named(solver),
                              .environment = environment_of(environment),
                              .device = device_named(nb::str(device).c_str())};
  configuration.device.threads = threads;
  require_possible_threads(configuration.device);
  return configuration;
}

Batch::Batch(const Configuration& configuration, SharedRobots robots) : robots_(std::move(robots)) {
  require_memory_for(robots_, configuration);
  const ReleasedGil released;
  simulation_ = std::make_unique<Simulation>(configuration, robots_);
  change_robots();
  LiveBatches::get().add(*this);
}

// Waits for what is queued on the device.
Batch::~Batch() {
  const ReleasedGil released;
  LiveBatches::get().remove(*this);
  simulation_.reset();
}

std::unique_lock<std::mutex> Batch::lock() const {
  LiveBatches::get().let_forks_pass();
  return std::unique_lock(mutex_);
}

void Batch::leave_stream() {
  if (const int device = simulation_->cuda_device(); device >= 0 && last_stream_->exchange(nullptr))
    synchronize_cuda_device(device);
}

void Batch::change_robots() {
  springs_ = springs_of(robots_);
  steps_at_once_ = simulation_->cuda_device() >= 0
                       ? portion_of(cuda_springs_at_once, springs_, most_cuda_steps_at_once)
                       : portion_of(cpu_springs_at_once, springs_, std::numeric_limits<std::int32_t>::max());
  ++version_;
}

void Batch::forget_arrays() { arrays_ = {}; }

void Batch::step(std::int64_t steps, nb::handle stream) {
  if (steps < 0) throw InputError("n", std::to_string(steps) + " is not accepted; give 0 or more steps");
  void* const cuda_stream = stream_from(stream);
  for (bool first = true; first || steps > 0; first = false) {
    if (!first && PyErr_CheckSignals() != 0) throw nb::python_error();
    const ReleasedGil released;
    const std::unique_lock lock = this->lock();
    if (steps > std::numeric_limits<std::int64_t>::max() - simulation_->steps())
      throw InputError("n", std::to_string(steps) + " is too large; a batch counts up to 2^63 steps");
    const std::int64_t count = std::min(steps, steps_at_once_);
    if (const int device = simulation_->cuda_device(); device >= 0) {
      if (!first) synchronize_cuda_device(device);
      simulation_->step_in_stream(count, cuda_stream);
      *last_stream_ = cuda_stream;
    } else {
      const double start = wall_now();
      simulation_->step(count);
      const double seconds = wall_now() - start;
      if (seconds > cpu_seconds_at_once)
        steps_at_once_ = std::max<std::int64_t>(1, count / 2);
      else if (count == steps_at_once_ && seconds < cpu_seconds_at_once / 4)
        steps_at_once_ *= 2;
    }
    steps -= count;
  }
}

void Batch::reset(nb::handle mask, nb::handle stream) {
  void* const cuda_stream = stream_from(stream);
  if (mask.is_none()) {
    change([](Simulation& simulation) { simulation.reset(); });
    return;
  }
  const auto check_size = [](std::size_t size, std::size_t robots) {
    if (size != robots)
      throw InputError("mask", std::to_string(size) + " elements are not accepted; the batch has " +
                                   std::to_string(robots) + " robots");
  };
  const int device = cuda_device_of(mask);
  if (device < 0) {
    const std::vector<std::uint8_t> values = mask_from(mask);
    change([&](Simulation& simulation) {
      check_size(values.size(), simulation.size());
      simulation.reset(values);
    });
    return;
  }
  const DeviceMask on_device = device_mask_from(mask, cuda_stream);
  const ReleasedGil released;
  const std::unique_lock lock = this->lock();
  if (simulation_->cuda_device() != device)
    throw InputError("mask", "memory of cuda:" + std::to_string(device) + " is not accepted; the batch is on " +
                                 name_of(simulation_->configuration().device));
  check_size(on_device.size, simulation_->size());
  simulation_->reset_in_stream(on_device.data, cuda_stream);
  *last_stream_ = cuda_stream;
}

std::size_t Batch::add(const SharedRobots& robots) {
  require_memory_for(robots, use([](const Simulation& simulation) { return simulation.configuration(); }));
  const std::size_t first = change([&](Simulation& simulation) {
    const std::size_t index = simulation.add(robots);
    robots_.insert(robots_.end(), robots.begin(), robots.end());
    change_robots();
    return index;
  });
  forget_arrays();
  return first;
}

void Batch::keep(nb::handle robots) {
  const std::vector<std::int64_t> indices = indices_from(robots);
  change([&](Simulation& simulation) {
    std::vector<std::size_t> kept;
    for (const std::int64_t index : indices) kept.push_back(checked_index(index, robots_.size()));
    simulation.keep(kept);
    SharedRobots remaining;
    for (const std::size_t index : kept) remaining.push_back(robots_[index]);
    robots_.swap(remaining);
    change_robots();
  });
  forget_arrays();
}

// Another thread may exchange the robots before the array is kept here; then it is not kept.
template <class Make>
nb::object Batch::cached(std::size_t place, const Make& make) {
  if (arrays_[place].is_valid()) return arrays_[place];
  std::uint64_t version = 0;
  auto made = use([&](Simulation& simulation) {
    version = version_;
    return make(simulation);
  });
  if (arrays_[place].is_valid() && version == version_) return arrays_[place];
  nb::object object = nb::cast(std::move(made));
  if (version == version_) arrays_[place] = object;
  return object;
}

nb::object Batch::state_array(StateArray which) {
  return cached(static_cast<std::size_t>(which), [&](Simulation& simulation) {
    return array_of<float>(simulation.shared_state(which), last_stream_, false);
  });
}

nb::object Batch::exploded() {
  return cached(exploded_place, [&](Simulation& simulation) {
    return array_of<bool>(simulation.shared_exploded(), last_stream_, false, true);
  });
}

nb::object Batch::actuation() {
  if (arrays_[actuation_place].is_valid()) return arrays_[actuation_place];
  std::uint64_t version = 0;
  SharedRobots robots;
  const Actuation shared = use([&](Simulation& simulation) {
    version = version_;
    robots = robots_;
    return simulation.actuation();
  });
  const auto array = [&](const SharedArray<float>& from) {
    return nb::cast(array_of<float>(from, last_stream_, true));
  };
  nb::object object = nb::cast(ActuationArrays{.amplitude = array(shared.amplitude),
                                               .frequency = array(shared.frequency),
                                               .phase = array(shared.phase),
                                               .drive = array(shared.drive),
                                               .driven = nb::cast(array_of<bool>(shared.driven, last_stream_, true)),
                                               .robots = std::move(robots)});
  if (arrays_[actuation_place].is_valid() && version == version_) return arrays_[actuation_place];
  if (version == version_) arrays_[actuation_place] = object;
  return object;
}

nb::object Batch::brain_arrays() {
  if (arrays_[brains_place].is_valid()) return arrays_[brains_place];
  std::uint64_t version = 0;
  const BrainArrays shared = use([&](Simulation& simulation) {
    version = version_;
    return simulation.shared_brains();
  });
  const auto array = [&](const SharedArray<float>& from) {
    return nb::cast(array_of<float>(from, last_stream_, true));
  };
  nb::object object = nb::cast(BrainArraysInPython{
      .weights = array(shared.weights), .neurons = array(shared.neurons), .senses = array(shared.senses)});
  if (arrays_[brains_place].is_valid() && version == version_) return arrays_[brains_place];
  if (version == version_) arrays_[brains_place] = object;
  return object;
}

void Batch::synchronize() const {
  use([](const Simulation& simulation) {
    if (const int device = simulation.cuda_device(); device >= 0) synchronize_cuda_device(device);
  });
}

SharedRobots Batch::robots() const {
  return use([&](const Simulation&) { return robots_; });
}

std::string Batch::device() const {
  return use([](const Simulation& simulation) -> std::string {
    if (const int device = simulation.cuda_device(); device >= 0) return "cuda:" + std::to_string(device);
    return simulation.configuration().device.kind == DeviceKind::cuda ? "cuda:all" : "cpu";
  });
}

nb::list actuator_names(const Robot& robot) {
  nb::list names;
  for (const Actuator& actuator : actuators_of(robot))
    names.append(nb::str(actuator.name.c_str(), actuator.name.size()));
  return names;
}

}  // namespace mercury::python
