// SPDX-License-Identifier: Apache-2.0
// A batch of robots that is stepped through time: owns backend, time and configuration.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/robot.h"
#include "mercury/telemetry.h"

namespace mercury {

class Backend;
struct Clock;

// One robot's state as it stood at the last step: no reference into the simulation.
struct State {
  std::vector<Vec3> positions;   // [m], one a mass
  std::vector<Vec3> velocities;  // [m/s]
  // As in Telemetry.
  bool exploded = false;
  double exploded_at = 0;
  std::uint32_t culprit_spring = no_spring;
};

// A pull on one mass by a spring of rest length 0 to a point in the robot's own frame, as a hand on a mouse does.
struct Perturbation {
  std::size_t robot = 0;
  std::uint16_t mass = 0;
  Vec3 target;           // [m]
  float stiffness = 50;  // [N/m]
};

// Robots of a batch do not meet: each lives in its own space, at the coordinates of its file.
// On land, a robot is set down with its lowest mass at z = 0.
//
// On one backend a robot's trajectory is bit for bit the same from run to run, alone or in any batch, in any order and
// with any number of threads; the CPU and CUDA agree within rounding.
class Simulation {
 public:
  // Throws InputError for a configuration or robot that breaks a rule ("robot 3 (eel): /springs/7: ..."), DeviceError
  // when the device asked for is not there.
  explicit Simulation(const Configuration& configuration = {}, std::span<const Robot> robots = {});
  // Stepped by a backend of the caller's (sim/backend.h), as a recording that is played back; the configuration's
  // device counts for nothing.
  Simulation(const Configuration& configuration, std::span<const Robot> robots, std::unique_ptr<Backend> backend);
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  // Adds robots at the present time; the others keep their state. Returns the index of the first one added.
  std::size_t add(std::span<const Robot> robots);
  std::size_t add(const Robot& robot) { return add(std::span(&robot, 1)); }

  // Keeps these robots, in this order, with their state, materials and explosions; the others leave, pulls let go, and
  // time stays. Throws std::out_of_range for one that is not there, std::invalid_argument for one named twice.
  void keep(std::span<const std::size_t> robots);

  std::size_t size() const;                     // robots
  const Robot& robot(std::size_t index) const;  // as it was added
  const Configuration& configuration() const;
  double time() const;         // [s]
  std::int64_t steps() const;  // since the start or the last reset
  // The instant, exactly (sim/physics/muscle.h). Set, all goes on from there as it would have there; robots keep their
  // state.
  const Clock& clock() const;
  void set_clock(const Clock& clock);

  // What runs it, for people: "CPU, 2 threads, AVX2" or "NVIDIA H100 80GB HBM3".
  std::string device_name() const;
  // Things worth a line to the user, such as a robot too large for the chip; empty = nothing.
  std::vector<std::string> notes() const;

  // How many of its robots the device steps at the same time; batches of a multiple of that leave nothing idle.
  std::size_t robots_at_once() const;
  // Springs a second that the device could evaluate if nothing but its busiest pipe counted (docs/performance.md), or 0
  // where that is not known.
  double spring_limit() const;
  // How long all calls of step() took so far [s], by the device's own clock.
  double busy_seconds() const;

  // Advances every robot that has not exploded by `steps` time steps. Returns when done.
  void step(std::int64_t steps = 1);

  // Every robot back to its rest pose at time 0, nothing exploded; materials keep their changes.
  void reset();
  // Changes solver, environment, dt or damping from here on; state and time stay. The device must be the same.
  void configure(const Configuration& configuration);

  State state(std::size_t robot) const;
  std::vector<Vec3> positions(std::size_t robot) const;
  // Positions of all robots, one after the other, robot i's first at offsets()[i]. `out` has mass_count() elements.
  void read_positions(std::span<Vec3> out) const;
  void read_velocities(std::span<Vec3> out) const;
  // The CUDA device that holds all robots, -1 = none or several.
  int cuda_device() const;
  // As read_positions(), into memory of that device, 3 * mass_count() floats: queued in its legacy default stream and
  // not waited for. Throws std::logic_error where cuda_device() is -1.
  void copy_positions(float* device_out) const;
  std::size_t mass_count() const;                     // of all robots together
  std::span<const std::size_t> mass_offsets() const;  // size() + 1 elements
  // Throws std::invalid_argument unless both have one element a mass.
  // The robot has not exploded then.
  void set_state(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities);
  // The same, with the explosion if it had exploded.
  void set_state(std::size_t robot, const State& state);

  // One a robot, reduced on the device.
  std::vector<Telemetry> telemetry() const;
  Telemetry telemetry(std::size_t robot) const;
  // FNV-1a over the bits of the positions and velocities.
  std::uint64_t hash(std::size_t robot) const;

  // A robot's material as it is now. Springs of that material change at the next step.
  Material material(std::size_t robot, MaterialId id) const;
  void set_material(std::size_t robot, MaterialId id, const Material& material);
  // All robots' tables in one call: `tables` has size() * max_materials elements, robot-major; unused ids are ignored.
  void set_materials(std::span<const Material> tables);
  std::vector<Material> materials() const;  // the same shape

  // Replaces all pulls of before; empty = let go.
  void set_perturbations(std::span<const Perturbation> perturbations);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// Whether a CUDA device can be used, how many, and their names; 0 in a build without CUDA.
int cuda_device_count();
std::string cuda_device_name(int index);
bool built_with_cuda();

}  // namespace mercury
