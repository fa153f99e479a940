// SPDX-License-Identifier: Apache-2.0
// What a Simulation requires of the code that steps its robots.
//
// The library has a backend for CPUs and one for CUDA devices, and Simulation chooses one by Configuration::device. A
// program can bring its own: derive from Backend and pass it to Simulation's constructor. The program `mercury` plays
// recordings this way.
//
//     Simulation   checks arguments, owns robots, materials, configuration and clock
//         |
//         v        load, add, keep, configure, step, read, write, report
//     Backend      owns the state: positions and velocities of all masses, the status of each robot
//
// Simulation checks every argument before it calls a backend: indices are in range and spans have the right sizes. One
// thread calls at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "mercury/clock.h"
#include "mercury/configuration.h"
#include "mercury/material.h"
#include "mercury/perturbation.h"
#include "mercury/robot.h"
#include "mercury/shared_array.h"
#include "mercury/telemetry.h"
#include "mercury/vec3.h"
#include "mercury/work_watch.h"

namespace mercury {

inline constexpr std::uint32_t no_mass = 0xffffffffu;

// Whether a robot has exploded.
struct RobotStatus {
  std::int64_t exploded_step = -1;   // Clock::step at which the failed step began; -1 = the robot has not exploded
  std::uint32_t bad_mass = no_mass;  // a mass whose position or force left the accepted range, if one is known
};

// Shared arrays that publish() fills (Simulation::shared_state()); null pointers are left out.
struct PublishedArrays {
  float *positions = nullptr, *velocities = nullptr;       // [mass][3]
  float *centers = nullptr, *center_velocities = nullptr;  // [robot][3]
  std::uint8_t* exploded = nullptr;                        // [robot]
  bool empty() const { return !positions && !velocities && !centers && !center_velocities && !exploded; }
};

// Where a program writes what drives the actuators (Simulation::actuation()), and what they drive.
struct ActuationSources {
  static constexpr std::uint8_t no_actuator = 255;
  const float *amplitude = nullptr, *frequency = nullptr, *phase = nullptr;  // [robot][columns]
  float* drive = nullptr;                                                    // the same; brains write it
  std::uint8_t* driven = nullptr;                                            // the same; steps write it
  std::size_t columns = 0;
  std::span<const std::uint8_t>
      actuator_of;  // [robot][max_materials], the material's column or no_actuator; host memory
};

// Of the library's own backends (sim/physics/brain_plan.h).
class BodyCells;
struct BrainPlan;
struct PackedBrains;

// What a batch is given besides its robots.
struct BatchSettings {
  Configuration configuration;
  std::vector<Material> materials;  // [robot][max_materials]
  std::vector<Perturbation> perturbations;
};

// Wall time of the parts of loading and adding robots [s].
struct LoadTimes {
  double check = 0;     // robots are validated
  double schedule = 0;  // springs and faces are arranged for the device, robots are grouped
  double upload = 0;    // data go to the device
};

class Backend {
 public:
  virtual ~Backend() = default;

  // For people: "CPU, 2 threads, AVX2". See Simulation::device_name().
  virtual std::string device_name() const = 0;
  // Lines for the user, see Simulation::notes().
  virtual std::vector<std::string> notes() const = 0;
  // See the functions of the same names in Simulation.
  virtual std::size_t robots_at_once() const = 0;
  virtual double spring_limit() const = 0;  // [1/s], 0 = unknown
  virtual double busy_seconds() const = 0;  // [s]
  // Watches load() and what the first step() prepares, then no more. An exception of the watch passes through them;
  // the backend can then only be destroyed. The default ignores the watch.
  virtual void set_watch(const WorkWatch& /*watch*/) {}
  // Of all robots so far, as far as the backend measures it; `check` is Simulation's.
  virtual LoadTimes load_times() const { return {}; }

  // Replaces all robots. Each begins with the positions of its `masses`, at rest, not exploded, with its own materials,
  // and without perturbations. The robots outlive the backend or the next load(). Throws DeviceError if they do not
  // fit.
  virtual void load(std::span<const Robot* const> robots, const Configuration& configuration) = 0;
  // Adds robots after those that the backend has. `robots` are all robots of the batch; those from `first_new` on are
  // new and begin as after load(). The others keep states, statuses, materials and perturbations. The default reads
  // everything back, loads all robots and writes everything again. Throws DeviceError if the robots do not fit.
  virtual void add(std::span<const Robot* const> robots, std::size_t first_new);
  // Keeps the robots with these indices, in this order, with their states, statuses and materials. The others go, and
  // so do all perturbations. `robots` are those that remain, in the new order. No index appears twice. The default
  // reads, loads and writes all robots that remain.
  virtual void keep(std::span<const Robot* const> robots, std::span<const std::size_t> indices);
  // As they are now. Only the defaults of add() and keep() call this; a backend that uses neither need not override it.
  virtual BatchSettings settings() const;
  // Applies to all later steps, in which every robot lives in the configuration's environment. The device does not
  // change.
  virtual void configure(const Configuration& configuration) = 0;
  // From the next step on robots[i] lives in environments[i]; no robot appears twice. It has the parts, contacts,
  // stiffness scale and all else but gravity, water and ground of the configuration's environment. It lasts until the
  // next call for this robot, configure(), load(), add() or keep(). The default throws std::logic_error.
  virtual void set_environments(std::span<const std::size_t> robots, std::span<const Environment> environments);
  // Advances every robot that has not exploded by `steps` > 0 steps; the first begins at `clock`. A robot that explodes
  // is frozen in the step that failed, and the others go on. Returns when all are done.
  virtual void step(const Clock& clock, std::int64_t steps) = 0;

  // State of one robot, one element per mass.
  virtual void read(std::size_t robot, std::span<Vec3> positions, std::span<Vec3> velocities) const = 0;
  virtual void write(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities) = 0;
  // Puts consecutive robots at rest where the masses of robots[i] are, but lifts[i] [m] higher. They have not exploded.
  // The default writes each robot's state and status.
  virtual void put_at_rest(std::span<const Robot* const> robots, std::size_t first, std::span<const float> lifts);
  // All robots in order, one element per mass.
  virtual void read_positions(std::span<Vec3> out) const = 0;
  virtual void read_velocities(std::span<Vec3> out) const = 0;

  // See the functions of the same names in Simulation. The defaults are right unless one CUDA device holds all robots.
  virtual int cuda_device() const { return -1; }
  virtual bool copy_positions(float* /*device_out*/) const {
    throw std::logic_error("these robots are on no CUDA device");
  }
  virtual void copy_positions_with_steps(std::shared_ptr<float> /*device_out*/) const {
    throw std::logic_error("these robots are on no CUDA device");
  }

  // Zeros in the memory that shared arrays are in, and a copy between any two places of it and of the host's memory,
  // which is done when the function returns. The defaults are right unless one CUDA device holds all robots.
  virtual std::shared_ptr<void> allocate_shared(std::size_t bytes) const;
  virtual void copy_shared(void* to, const void* from, std::size_t bytes) const;
  // Writes the current state of all robots of the batch into shared arrays. Returns when it is done. The default reads
  // everything back.
  virtual void publish(std::span<const Robot* const> robots, const PublishedArrays& arrays) const;
  // From now on every step begins with reading these, and explodes robots whose drives have failed. They stay valid
  // until the next call, load(), add() or keep(), after which there are none. Returns false if the backend does not;
  // Simulation then changes materials instead.
  virtual bool set_actuation(const ActuationSources& /*sources*/) { return false; }
  // From now on the backend lets these brains think between its steps, one per robot, null = none, and drives the
  // actuators of set_actuation() by them. It has their states, which write_brains() sets, with weights if there are
  // any. The plans stay valid until the next call, load(), add(), keep() or set_actuation(), after which there are no
  // brains. Returns false if the backend does not; Simulation then lets them think.
  virtual bool set_brains(std::span<const BrainPlan* const> /*plans*/) { return false; }
  virtual void write_brains(const PackedBrains& /*brains*/) {
    throw std::logic_error("no brains think in this backend");
  }
  // Neurons, senses, thoughts, and weights on request.
  virtual PackedBrains read_brains(bool weights) const;
  // The memory of those brains, which all have as many numbers: arrays with a row per robot. read_brains() and
  // write_brains() then follow what programs have queued in the legacy default stream.
  virtual BrainArrays share_brains();
  // step() and publish(), or put_at_rest() of the robots whose element of `mask` (shared memory, one per robot) is not
  // 0 and publish(), in a stream as Simulation::step_in_stream() says. Called only if cuda_device() is not -1.
  virtual void step_in_stream(const Clock& /*clock*/, std::int64_t /*steps*/, const PublishedArrays& /*arrays*/,
                              void* /*cuda_stream*/) {
    throw std::logic_error("these robots are on no CUDA device");
  }
  virtual void put_at_rest_in_stream(std::span<const Robot* const> /*robots*/, std::span<const float> /*lifts*/,
                                     const std::uint8_t* /*mask*/, const PublishedArrays& /*arrays*/,
                                     void* /*cuda_stream*/) {
    throw std::logic_error("these robots are on no CUDA device");
  }

  virtual RobotStatus status(std::size_t robot) const = 0;
  virtual std::vector<RobotStatus> statuses() const = 0;  // one per robot
  // A robot whose exploded_step is not negative is not stepped.
  virtual void set_status(std::size_t robot, const RobotStatus& status) = 0;

  // Material tables by id. All robots: max_materials elements per robot; one robot: max_materials elements. Ids that no
  // spring uses are ignored.
  virtual void write_materials(std::span<const Material> tables) = 0;
  virtual void write_materials(std::size_t robot, std::span<const Material> table) = 0;

  // Replaces all perturbations.
  virtual void set_perturbations(std::span<const Perturbation> perturbations) = 0;

  // From now on report() and step_and_report() fill in Telemetry::inverted as folding() of these cells does, one per
  // robot; null = it stays NaN. It lasts until the next call, load(), add() or keep(). Returns false if it has no
  // effect, as the default.
  virtual bool measure_inversion(std::span<const BodyCells* const> cells);

  // Fills one element per robot: its telemetry except `exploded`, `exploded_at` and `culprit_spring`, which Simulation
  // derives from the status, and its status.
  virtual void report(const Clock& clock, std::span<Telemetry> telemetry, std::span<RobotStatus> statuses) const = 0;

  // step() with a report after every `every` > 0 steps, of which `steps` is a multiple, and with `from_now` one before
  // the first step, to which drives of the caller's may already apply. Calls visit() with all reports in turn, one or
  // more at a time: both are [report][robot]. Robots step on meanwhile, but an exploded one can be read. The default
  // calls step() and report() in turn.
  using VisitReports = std::function<void(std::span<Telemetry> samples, std::span<const RobotStatus> statuses)>;
  virtual void step_and_report(const Clock& clock, std::int64_t steps, std::int64_t every, bool from_now,
                               const VisitReports& visit);
};

// The backend that a configuration asks for. Throws DeviceError if this build or machine does not have the device.
std::unique_ptr<Backend> make_backend(const Device& device);

// The same with the kind of device given; `device.kind` is ignored.
std::unique_ptr<Backend> make_cpu_backend(const Device& device);
std::unique_ptr<Backend> make_cuda_backend(const Device& device);  // one device, by index

// Several backends as one. Each robot goes to the part that has the least springs, where it stays, and all parts step
// at the same time. A robot gives the same results bit for bit as in its part alone. `parts` is not empty.
std::unique_ptr<Backend> make_split_backend(std::vector<std::unique_ptr<Backend>> parts);

}  // namespace mercury
