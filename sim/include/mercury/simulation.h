// SPDX-License-Identifier: Apache-2.0
// A batch of robots that is stepped through time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mercury/backend.h"
#include "mercury/clock.h"
#include "mercury/configuration.h"
#include "mercury/driven_materials.h"
#include "mercury/folding.h"
#include "mercury/material.h"
#include "mercury/perturbation.h"
#include "mercury/robot.h"
#include "mercury/shared_array.h"
#include "mercury/state.h"
#include "mercury/telemetry.h"
#include "mercury/vec3.h"
#include "mercury/work_watch.h"

namespace mercury {

// Owns the robots, their materials, the configuration, the clock and a backend that does the stepping.
//
//     mercury::Simulation simulation({.dt = 1e-3, .environment = mercury::Land{}}, robots);
//     simulation.step(1000);
//     for (const mercury::Telemetry& robot : simulation.telemetry()) use(robot.center_of_mass);
//
// Robots of a batch do not meet: each lives in its own space, in the coordinates of its file. On land, each starts with
// its lowest mass at z = 0.
//
// Results are reproducible. On one backend a robot's trajectory is the same bit for bit from run to run, alone or in
// any batch, in any order and with any number of threads. The CPU and CUDA agree within rounding.
//
// Functions that take the index of a robot throw std::out_of_range if there is no such robot. One thread at a time may
// use a simulation. Those of a simulation on a CUDA device make it the current device of the calling thread.
class Simulation {
 public:
  // Throws InputError for a configuration or robot that breaks a rule ("robot 3 (eel): /springs/7: ..."), and
  // DeviceError if the device does not exist.
  explicit Simulation(const Configuration& configuration = {}, std::span<const Robot> robots = {});
  // Shares the robots instead of copying them. One robot may appear many times; it is checked once. No pointer is null.
  // The watch sees how loading goes on, here and in the first step(); an exception of it passes through.
  Simulation(const Configuration& configuration, std::span<const std::shared_ptr<const Robot>> robots,
             const WorkWatch& watch = {});
  // Uses the given backend. The configuration's device has no effect.
  Simulation(const Configuration& configuration, std::span<const Robot> robots, std::unique_ptr<Backend> backend);
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  // Adds robots, at rest at the current time; the others keep their states, materials and perturbations. Returns the
  // index of the first new robot. Throws InputError as the constructor does.
  std::size_t add(std::span<const Robot> robots);
  std::size_t add(const Robot& robot) { return add(std::span(&robot, 1)); }
  // Shares the robots instead of copying them, as the constructor does.
  std::size_t add(std::span<const std::shared_ptr<const Robot>> robots);

  // Keeps these robots, in this order, with their states and materials, and removes the others and all perturbations.
  // Time does not change. Throws std::invalid_argument if an index appears twice.
  void keep(std::span<const std::size_t> robots);

  std::size_t size() const;                     // number of robots
  const Robot& robot(std::size_t index) const;  // as it was added
  const Configuration& configuration() const;
  double time() const;         // [s]
  std::int64_t steps() const;  // since the start or the last reset()

  // The exact instant. After set_clock() the simulation goes on as it would have at that instant; robots keep their
  // state. Throws std::invalid_argument unless clock.dt is the configuration's dt and 0 <= base_step <= step.
  const Clock& clock() const;
  void set_clock(const Clock& clock);

  // What runs the simulation, for people: "CPU, 2 threads, AVX2" or "NVIDIA H100 80GB HBM3".
  std::string device_name() const;
  // Lines worth showing to the user, such as that a robot is too large for the chip. Usually empty.
  std::vector<std::string> notes() const;

  // How many of its robots the device steps at the same time. Batches of a multiple of this leave no core idle.
  std::size_t robots_at_once() const;
  // Springs per second that the device could evaluate if only its busiest unit limited it (docs/performance.md); 0 if
  // unknown.
  double spring_limit() const;
  // How long all calls of step() have taken so far, by the device's own clock [s]. Those of step_in_stream() on a CUDA
  // device do not count.
  double busy_seconds() const;
  // How long the constructor and all calls of add() have taken so far, part by part. A part that the backend does not
  // measure is 0.
  LoadTimes load_times() const;

  // Advances every robot that has not exploded by `steps` >= 0 time steps. Returns when done.
  void step(std::int64_t steps = 1);
  // The same with the telemetry after every `every` steps: [steps / every][robot], computed on the device. Throws
  // std::invalid_argument unless `every` > 0 divides `steps` >= 0.
  std::vector<Telemetry> step_and_sample(std::int64_t steps, std::int64_t every);
  // The same with visit(samples), [sample][robot], for all samples in turn, one or more at a time. With `from_now` the
  // first one is that of telemetry(), which itself waits long for a busy GPU. A GPU steps on meanwhile, so visit() must
  // not call the simulation, or throw.
  void step_and_sample(std::int64_t steps, std::int64_t every,
                       const std::function<void(std::span<const Telemetry>)>& visit, bool from_now = false);

  // The same as step(), queued in a CUDA stream (a cudaStream_t) of cuda_device(), after what is there. What follows
  // in the stream comes after the steps. Returns at once. Robots that no CUDA device holds, or several, are stepped at
  // once, and the stream has no effect.
  void step_in_stream(std::int64_t steps, void* cuda_stream);

  // Puts every robot back to its rest pose at time 0; none has exploded. Materials keep their changes.
  void reset();
  // The same with the masses of all robots elsewhere: `positions` has one per mass, robot after robot [m]. With ground,
  // a robot is set down on it with its lowest mass. Throws std::invalid_argument for another number of positions.
  void reset_to(std::span<const Vec3> positions);
  // Puts some robots back to their rest pose: those whose element of `mask`, one per robot, is not 0. Time goes on.
  void reset(std::span<const std::uint8_t> mask);
  // The same with a mask in the memory of cuda_device(), queued as step_in_stream() does.
  void reset_in_stream(const std::uint8_t* mask, void* cuda_stream);
  // Changes solver, environment, dt or damping from now on. State and time stay, except that robots that come to land
  // are set down on the floor. Throws InputError for a bad value, std::invalid_argument if the device differs.
  void configure(const Configuration& configuration);

  // From now on robots[i] lives in environments[i], of the same parts as the configuration's; gravity and the values of
  // water and ground may differ. It lasts until the next call for the robot or configure(). Robots in environments of
  // their own step somewhat slower, and small ones on a CPU, where each then steps alone, at up to a third. Throws
  // InputError for what else differs, and for another flow of a robot that senses the flow; std::out_of_range for a
  // robot that does not exist, std::invalid_argument for one that is given twice.
  void set_environments(std::span<const std::size_t> robots, std::span<const Environment> environments);
  const Environment& environment(std::size_t robot) const;

  State state(std::size_t robot) const;
  std::vector<Vec3> positions(std::size_t robot) const;  // one per mass [m]

  std::size_t mass_count() const;                     // of all robots together
  std::span<const std::size_t> mass_offsets() const;  // size() + 1 elements; robot i's masses begin at element i
  // All robots in order: `out` has mass_count() elements, otherwise they throw std::invalid_argument.
  void read_positions(std::span<Vec3> out) const;
  void read_velocities(std::span<Vec3> out) const;
  // The CUDA device that holds all robots; -1 = none, or several.
  int cuda_device() const;
  // Like read_positions(), into memory of that device (3 * mass_count() floats). Queues the copy in the device's legacy
  // default stream and does not wait for it. Returns false, and queues nothing, if the last steps have left them there
  // (copy_positions_with_steps()). Throws std::logic_error if cuda_device() is -1.
  bool copy_positions(float* device_out) const;
  // From now on, step() and step_and_sample() leave the positions in this memory before they return, as
  // copy_positions() would. On a device that also draws, a copy after the steps would have to wait for its turn; this
  // one belongs to the steps. It ends with nullptr and when robots come or go. Throws like copy_positions().
  void copy_positions_with_steps(std::shared_ptr<float> device_out) const;

  // Shared arrays, in the memory of cuda_device(), or of the host if that is -1. The first call makes the array. Every
  // function that steps or changes robots updates it before it returns, and the functions with a stream before what
  // follows in the stream. What a program writes into it has no effect on the robots. add() and keep() make other
  // arrays; the old ones stay as they are. On a CUDA device, functions without a stream use shared arrays as if they
  // were queued in its legacy default stream.
  SharedArray<float> shared_state(StateArray which);
  SharedArray<std::uint8_t> shared_exploded();  // [robot][1], 1 = has exploded
  // What drives the actuators of all robots. At first, every actuator has the values that its materials have in common,
  // NaN where they differ, and is not driven. Every step() and step_in_stream() reads the arrays when it begins. add()
  // and keep() make other arrays with the same values for the robots that stay.
  const Actuation& actuation();
  // Drives these actuators, on every backend, in place of their sines and brains, until a call leaves them out. In
  // actuation(), the amplitude, frequency and phase of all actuators become NaN: materials keep their own. Throws
  // std::out_of_range for an actuator that its robot does not have.
  void hold_drives(std::span<const HeldDrive> held);
  // What drives the materials now. It copies five arrays of actuation() to the host, or nothing if none is there.
  DrivenMaterials driven_materials() const;

  // Brains (mercury/brain.h) think by themselves while the simulation steps: on the device if that is one CUDA device,
  // else on the host. They drive their actuators through actuation(), where what a program writes for these lasts until
  // the brain thinks again.
  bool has_brains() const;
  BrainState brain_state(std::size_t robot) const;  // empty without a brain
  std::vector<BrainState> brain_states() const;     // of all robots
  // The senses as they were sampled last, and the neurons, robot after robot in the order of BrainLayout: a copy of
  // less than the states. Each span has as many elements as the brains of all robots together, otherwise it throws
  // std::invalid_argument.
  void read_brains(std::span<float> senses, std::span<float> neurons) const;
  // Weights and states of all brains as shared arrays, which a program may also write: the weights of a population are
  // replaced, and its senses read, without leaving the device. Throws InputError unless all robots have brains with as
  // many weights, neurons and senses.
  const BrainArrays& shared_brains();
  // Throws std::invalid_argument if the numbers are not as many as the robot's brain has.
  void set_brain_state(std::size_t robot, const BrainState& state);
  // In the order of BrainLayout. A copy of the robot's own; reset() keeps them. Throws as set_brain_state().
  void set_brain_weights(std::size_t robot, std::span<const float> weights);
  // The neuron has this value from now on, whatever it reads; nothing = it thinks again. Throws std::out_of_range for a
  // neuron that the brain does not have.
  void clamp_neuron(std::size_t robot, std::size_t neuron, std::optional<float> value);
  // The target of one robot [m]; nothing = the environment's.
  void set_target(std::size_t robot, std::optional<Vec3> target);
  // Of the noise in a robot's senses, together with the seed of its brain; 0 at first.
  void set_noise_seed(std::size_t robot, std::uint64_t seed);

  // One element per mass, otherwise throws std::invalid_argument. The robot has not exploded afterward.
  void set_state(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities);
  // Restores an explosion as well, and its brain's state if that is known. Throws as set_brain_state().
  void set_state(std::size_t robot, const State& state);

  // The state of all robots, and a return to it: what follows is bit for bit what followed before. Robots,
  // configuration, environments of robots, materials, perturbations and actuation are not part of it. restore() throws
  // std::invalid_argument, and changes nothing, if the state has another number of masses, an explosion of no robot,
  // brains of another size, or a clock that set_clock() refuses.
  BatchState save() const;
  void restore(const BatchState& state);

  // One element per robot, computed on the device.
  std::vector<Telemetry> telemetry() const;
  Telemetry telemetry(std::size_t robot) const;
  // Whether telemetry, samples included, has Telemetry::inverted and overlap, of all robots or as `of` says of each.
  // They take all positions from the device and some work on the host's cores, so this is off at first.
  // Several threads call `of` at the same time, about once per robot.
  void measure_folding(bool on);
  void measure_folding(std::function<MeasuredFolding(const Robot&)> of);
  bool measures_folding() const;  // of any robot
  // The same of Telemetry::upright, of all robots.
  void measure_upright(bool on);
  bool measures_upright() const;
  // FNV-1a over the bytes of all positions, then all velocities. Equal hashes mean equal states, bit for bit.
  std::uint64_t hash(std::size_t robot) const;
  // Of all robots, on all cores.
  std::vector<std::uint64_t> hashes() const;

  // A robot's current material, without what actuation() changes (driven_materials()). Throws std::out_of_range if the
  // robot's table has no such id.
  Material material(std::size_t robot, MaterialId id) const;
  // Applies to all springs of that material from the next step on. Throws InputError if the material is not valid.
  void set_material(std::size_t robot, MaterialId id, const Material& material);
  // The tables of all robots: size() * max_materials elements, all materials of robot 0 first. Ids that a robot does
  // not use are ignored. Throws std::invalid_argument for another size, InputError if a material is not valid.
  void set_materials(std::span<const Material> tables);
  std::vector<Material> materials() const;

  // Replaces all perturbations; an empty span removes them. Throws std::out_of_range for a mass that does not exist.
  void set_perturbations(std::span<const Perturbation> perturbations);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
