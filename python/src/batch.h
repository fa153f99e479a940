// SPDX-License-Identifier: Apache-2.0
// Batch: robots that are stepped through time, as Python has them.
#pragma once

#include <nanobind/nanobind.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "mercury/simulation.h"
#include "python/src/array.h"
#include "python/src/bindings.h"

namespace mercury::python {

// Several threads of Python may use a batch; one at a time does, the others wait. The functions are called with the
// GIL and release it while they wait or work.
class Batch {
 public:
  Batch(const Configuration& configuration, SharedRobots robots);
  ~Batch();
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;

  // Returns use(simulation), called while no other thread uses the batch, and without the GIL.
  template <class Use>
  auto use(const Use& use) const {
    const ReleasedGil released;
    const std::unique_lock lock = this->lock();
    return use(*simulation_);
  }
  // The same for what changes the robots. Without a stream, that is in the legacy default stream of a CUDA device: what
  // the batch has queued in another one is done before.
  template <class Change>
  auto change(const Change& change) {
    const ReleasedGil released;
    const std::unique_lock lock = this->lock();
    leave_stream();
    return change(*simulation_);
  }

  // In portions between which Ctrl-C ends it.
  void step(std::int64_t steps, nb::handle stream);
  void reset(nb::handle mask, nb::handle stream);
  std::size_t add(const SharedRobots& robots);
  void keep(nb::handle robots);
  void synchronize() const;

  // The same Python object until robots come or go.
  nb::object state_array(StateArray which);
  nb::object exploded();
  nb::object actuation();
  nb::object brain_arrays();

  SharedRobots robots() const;
  std::string device() const;  // "cpu", "cuda:0", "cuda:all"

 private:
  static constexpr std::size_t exploded_place = 4, actuation_place = 5, brains_place = 6;

  std::unique_lock<std::mutex> lock() const;  // to be called without the GIL
  template <class Make>
  nb::object cached(std::size_t place, const Make& make);
  void leave_stream();   // to be called with the lock
  void change_robots();  // to be called with the lock, without the GIL
  void forget_arrays();  // to be called with the GIL

  friend class LiveBatches;

  mutable std::mutex mutex_;
  std::unique_ptr<Simulation> simulation_;
  SharedRobots robots_;
  double springs_ = 0;                      // of all robots
  std::int64_t steps_at_once_ = 1;          // in a portion, adapted to the speed on the CPU
  std::atomic<std::uint64_t> version_ = 0;  // how often robots have come or gone
  LastStream last_stream_ = std::make_shared<std::atomic<void*>>(nullptr);
  std::array<nb::object, 7> arrays_;
};

// What drives the actuators of a batch, as Python has it.
struct ActuationArrays {
  nb::object amplitude, frequency, phase, drive, driven;  // Array
  SharedRobots robots;
};

// Weights and states of the brains of a batch, as Python has them.
struct BrainArraysInPython {
  nb::object weights, neurons, senses;  // Array
};

// Lets os.fork() wait until no thread is within a batch, so that the child finds all of them as they are between two
// portions of steps.
void watch_forks();

// Names of the actuators of a robot.
nb::list actuator_names(const Robot& robot);

}  // namespace mercury::python
