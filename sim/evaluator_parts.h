// SPDX-License-Identifier: Apache-2.0
// The threads of an evaluator.
//
//     maker ──> waiting pieces ────> worker, worker, ... of device 0 ──> finished portions ──> next()
//       ^                       └──> worker, worker, ... of device 1 ──┘                         |
//       └────────────────────── memory of robots that were yielded ──────────────────────────────┘
//
// 1. One thread makes pieces of consecutive robots, each on all cores unless the source is serial. A piece is complete
//    when it has as many robots as usual (fewer toward the end if there are several devices), when a device has too
//    little to do and the piece is not tiny, or when its share of the memory is used up. The thread also prepares the
//    robots for a GPU, which works out what loading them needs.
// 2. Each device has several workers, each with a simulation of its own: while the robots of one are stepped, those of
//    another are loaded. A worker takes several pieces as one portion (evaluator_threads.cpp).
// 3. The order of portions is the order of the source. next() waits for the portion that comes next. It is always made
//    or in the hands of a worker, which needs no memory of others to finish it: nothing waits in a circle.
// 4. What one call of extend() added is a batch, such as a generation of an evolution. A batch may have to wait until
//    the one before it has next to no steps left (may_begin()). Side by side, both would end at the same time, and the
//    device would have nothing to do until one of the next two is there.
// 5. `end` is the index after the last result that will be yielded. Whatever goes wrong in a portion moves `end` to
//    its first robot, and whoever works on robots from there on gives up. A portion that stop() finds in the hands of
//    a worker before its first step is left out alone: later ones may have been stepped.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "mercury/evaluator.h"
#include "mercury/prepared_robots.h"
#include "mercury/simulation.h"
#include "sim/evaluator_portion.h"
#include "sim/evaluator_trial.h"

namespace mercury {

struct FinishedPortion {
  std::vector<Evaluation> results;
  std::vector<std::size_t> bytes;  // of each
  std::size_t next = 0;            // the first that is not yet yielded

  bool empty() const { return next == results.size(); }
};

struct Evaluator::Parts {
  // A portion that a worker has.
  struct InHand {
    std::size_t robots;
    std::int64_t steps = 0;  // of its trial, at the last sample
  };

  struct DeviceParts {
    std::size_t robots_in_hand() const;

    MakeBackend make_backend;
    bool is_cpu = false;
    // The rest is guarded by the mutex.
    std::string name;                       // empty = not yet started
    std::map<std::size_t, InHand> in_hand;  // by the index of the first robot
    std::size_t idle_workers = 0;           // that wait for a portion
    std::size_t portions_taken = 0;
    std::size_t robots = 0;          // stepped to the end
    std::size_t robots_at_once = 0;  // 0 = not yet known
    UnionClock stepping{};
  };

  Parts(const EvaluationRequest& wanted, RobotSource robots, std::size_t number);
  ~Parts();
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  // Starts the threads; without `given`, on the configuration's devices.
  void start(std::vector<MakeBackend> given);
  // What the threads do. These functions do not throw.
  void start_devices(const std::vector<MakeBackend>& given);
  void make_portions();
  void work(DeviceParts& device);

  // Of the maker.
  bool is_large_enough(std::size_t first, std::size_t robots) const;
  void prepare(const Portion& portion);
  bool is_made() const;             // all robots that are known so far; locked
  bool may_make() const;            // to be called with the mutex locked, as all functions below that are marked so
  std::size_t piece_bytes() const;  // locked

  // Of the workers.
  int workers_of(const DeviceParts& device) const;
  void device_started(DeviceParts& device, const Backend& backend);
  std::size_t robots_that_fill(const DeviceParts& device) const;    // locked
  std::size_t largest_portion_of(const DeviceParts& device) const;  // locked
  bool may_take(const DeviceParts& device) const;                   // locked
  Portion next_portion(const DeviceParts& device);                  // locked
  std::optional<Portion> take(DeviceParts& device);
  void wait_for_earlier_batches(const DeviceParts& device, const Portion& portion);
  bool may_begin(const DeviceParts& device, const Portion& portion) const;  // locked
  // `backend` is the simulation's.
  void evaluate(DeviceParts& device, Simulation& simulation, const Backend& backend, Portion portion, StepPace& pace);
  void loaded(DeviceParts& device, const Backend& backend);
  void add_notes(const std::vector<std::string>& lines);
  void finish(DeviceParts& device, const Portion& portion, FinishedPortion result);
  void add_load_times(const LoadTimes& before, const LoadTimes& after);

  // Of all.
  void fail(std::size_t first, std::exception_ptr exception);  // in the portion that begins there
  bool next_is_known();                                        // locked; passes over portions that were given up
  void end_at(std::size_t index);                              // locked
  void update_demand();                                        // locked
  void notify_all();                                           // locked

  const EvaluationRequest request;
  const RobotSource source;
  const std::size_t memory_limit;
  std::shared_ptr<PreparedRobots> prepared;  // null if the devices need none; set before the threads start

  std::atomic<std::size_t> count;  // changes with the mutex locked

  mutable std::mutex mutex;  // guards what follows, atomics apart
  std::condition_variable maker_may_go_on, portion_waits, portion_may_begin, result_waits, device_has_started;
  std::deque<DeviceParts> devices;  // complete once `devices_are_known`
  bool devices_are_known = false;
  std::deque<Portion> waiting;
  std::size_t waiting_robots = 0;             // of all pieces
  std::size_t next_first = 0;                 // index of the first of them
  std::vector<std::size_t> batches{0};        // index of the first robot of each
  std::size_t portion_bytes = unknown_count;  // accepted per portion because of the devices' memory
  bool all_made = false;
  std::map<std::size_t, FinishedPortion> finished;  // by the index of the first robot
  std::map<std::size_t, std::size_t> given_up;      // the same: robots of portions that were stopped before a step
  std::size_t next_index = 0;                       // of the portion that is yielded after `current`
  std::exception_ptr error;                         // thrown by next() when it comes to `end`
  std::size_t error_index = unknown_count;
  std::vector<std::string> notes;
  std::size_t made = 0, done = 0;
  LoadTimes load_times;

  std::atomic<std::size_t> end;
  std::atomic<bool> stopping = false;
  std::atomic<bool> prepares = false;          // a device may need prepared robots
  std::atomic<std::size_t> memory_in_use = 0;  // by portions and results that are not yet yielded
  std::atomic<std::size_t> largest_robot = 0;  // [bytes]
  std::atomic<std::size_t> piece_robots = 0;   // wanted per piece, at most
  std::atomic<std::size_t> device_count = 0;
  std::atomic<bool> device_is_hungry = false;  // a device has too little to do
  std::atomic<std::int64_t> robot_steps = 0;

  UnionClock starting, making, loading, stepping, reading;

  FinishedPortion current;  // of the thread that calls next()

  std::thread maker, starter;
  std::vector<std::thread> workers;  // used by the starter, until it has ended
};

}  // namespace mercury
