// SPDX-License-Identifier: Apache-2.0
// Batch and Actuation in Python.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "python/src/arguments.h"
#include "python/src/array.h"
#include "python/src/batch.h"

namespace mercury::python {
namespace {

constexpr const char* batch_description =
    R"(Robots that are stepped through time together, each in its own space.

    batch = mercurysim.Batch(mercurysim.random_voxel(64, seed=1), environment=mercurysim.Ocean())
    batch.step(1000)
    print(batch.telemetry()["center_of_mass"])

Robots of any number and shape share a batch. A robot moves the same, bit for bit, in every batch of one kind of device.

Arrays (positions, velocities, centers, center_velocities, exploded, actuation) are memory of the device that steps the
robots. They are the same objects until add() or keep(), which make new ones; the old ones keep their last values.

Several threads may use a batch; one at a time does, the others wait. The GIL is released meanwhile.)";

std::string init_description() {
  return R"(Loads robots onto a device.

robots: a Robot, or a sequence of them; none is also accepted.
environment: )" +
         environment_classes() + R"(, or the name of one; None = Ocean().
solver: "force" (Algorithm 1 of the paper) or "xpbd" (Algorithm 2, stable at longer time steps).
dt: time step [s]. damping: velocities shrink by exp(-damping dt) per step [1/s].
device: "auto" (CUDA if there is a device), "cpu", "cuda", "cuda:1", "cuda:all".
threads: of the CPU; 0 = all cores.

Raises InputError for a value or a robot that breaks a rule, DeviceError if the device is not there, MemoryError if the
robots do not fit into the memory that can be used.)";
}

constexpr const char* step_description =
    R"(Advances every robot that has not exploded by `n` time steps.

On the CPU it returns when they are done. On CUDA it returns at once: the steps are queued in `stream`, after what is
there, and what follows in the stream comes after them. stream: the handle of a CUDA stream, or an object with
__cuda_stream__, cuda_stream (PyTorch) or ptr (CuPy); None = the legacy default stream, which PyTorch uses by default.

Long runs are made in portions of about a tenth of a second. Between them Ctrl-C ends the run, and other threads that
wait for the batch may use it.)";

constexpr const char* reset_description =
    R"(Puts robots back to their rest poses; they have not exploded.

mask: one element per robot, a sequence of bools or an array of bool or uint8; the others go on, and so does time.
None = all robots, at time 0. On CUDA the mask may be in the memory of the device; the call is then queued in `stream`,
as step() is, and the memory is read in the order of that stream.

Raises InputError unless the mask has one element per robot.)";

constexpr const char* set_environments_description =
    R"(Lets robots live in water and on ground of their own, from the next step on.

    batch.set_environments(friction=rng.uniform(0.4, 1.2, len(batch)))            # one number per robot
    batch.set_environments([3, 7], gravity=(0, 0, -3.7), friction=[0.2, 0.3])     # of robots 3 and 7

robots: their indices; None = all.
parameters: gravity and those of the environment's water and ground, one value for all of these robots or one per
robot. A number has shape () or (n,), a vector (3,) or (n, 3); gravity also takes magnitudes, () or (n, 1). What is not
named stays.

It lasts until configure(). Robots with environments of their own step somewhat slower, on a CPU one by one. The call
waits for the device. save() does not keep environments.

Raises TypeError for a parameter that the environment does not have, InputError for a value or shape that is not
accepted, and for parameters that all robots share; IndexError for a robot that is not there, ValueError for
one that is given twice.)";

constexpr const char* telemetry_description =
    R"(A structured NumPy array, one element per robot, computed on the device. Fields:

center_of_mass (3,)  [m]
velocity (3,)        of the center of mass [m/s]
kinetic_energy       [J]
elastic_energy       of the springs [J]
muscle_power         that the muscles deliver now [W]
largest_strain       of a spring [1]
strained_share       of the springs: those that are strained by more than half [1]
inverted             share of the body that is inside out [1], NaN unless measure_folding is True
overlap              share of the masses that are within other parts of the body [1], the same
upright              cosine between the body's up axis and the vertical [1], NaN unless measure_upright is True
exploded             whether the robot has left the finite and is frozen
exploded_at          when [s], 0 unless exploded
culprit_spring       index of the spring that is the cause, -1 if none is known)";

constexpr const char* actuation_description =
    R"(What drives the actuators of a batch: writable arrays of (robots, actuators) on the device, `driven` of bool, the
others of float32.

Column a of row i is actuator a of robot i; names(i) lists them. A robot with fewer actuators ignores the other columns.

    L(t) = L0 (1 + amplitude sin(frequency t + phase))     while driven is False
    L    = L0 (1 + amplitude drive)                        while driven is True

Every Batch.step() reads the arrays when it begins. At first no actuator is driven; a step that reads a number in
`drive` sets `driven`, which may also be set before. From then on a drive of NaN or infinity explodes the robot, which
`exploded` shows: the policy that wrote it has diverged. To follow the sine again, an actuator takes a drive of NaN and
`driven` False.

Amplitudes are limited to (-1, 1), drives to [-1, 1]. Every actuator begins with the values that its materials have in
common, NaN where they differ: springs then keep the amplitude, frequency or phase of their materials.

    batch.actuation.drive[:] = 0.5                                   # on the CPU
    torch.from_dlpack(batch.actuation.drive)[:] = policy(state)      # on any device)";

void init(Batch* self, nb::handle robots, nb::handle environment, const std::string& solver, double dt, double damping,
          nb::handle device, int threads) {
  new (self) Batch(configuration_of(environment, solver, dt, damping, device, threads), robots_of(robots));
}

void configure(Batch& self, nb::handle environment, const std::optional<std::string>& solver, std::optional<double> dt,
               std::optional<double> damping) {
  std::optional<Environment> other;
  if (!environment.is_none()) other = environment_of(environment);
  std::optional<Solver> other_solver;
  if (solver) other_solver = solver_named(*solver);
  self.change([&](Simulation& simulation) {
    Configuration configuration = simulation.configuration();
    if (other) configuration.environment = *other;
    if (other_solver) configuration.solver = *other_solver;
    if (dt) configuration.dt = *dt;
    if (damping) configuration.damping = *damping;
    simulation.configure(configuration);
  });
}

void set_environments(Batch& self, nb::handle robots, const nb::kwargs& values) {
  std::vector<std::size_t> which;
  const std::size_t size = self.use([](const Simulation& simulation) { return simulation.size(); });
  if (robots.is_none())
    for (std::size_t i = 0; i < size; ++i) which.push_back(i);
  else
    for (const std::int64_t i : indices_from(robots)) which.push_back(checked_index(i, size));
  std::vector<Environment> environments;
  self.use([&](const Simulation& simulation) {
    for (const std::size_t i : which) environments.push_back(simulation.environment(i));
  });
  set_parameters(environments, values);
  self.change([&](Simulation& simulation) { simulation.set_environments(which, environments); });
}

nb::object environment_of_robot(const Batch& self, std::int64_t robot) {
  return object_of(self.use(
      [&](const Simulation& simulation) { return simulation.environment(checked_index(robot, simulation.size())); }));
}

void set_state(Batch& self, std::int64_t robot, nb::handle positions, nb::handle velocities) {
  const std::size_t masses = self.use([&](const Simulation& simulation) {
    return simulation.robot(checked_index(robot, simulation.size())).masses.size();
  });
  const std::vector<Vec3> x = vectors_from(positions, masses, "positions");
  const std::vector<Vec3> v =
      velocities.is_none() ? std::vector<Vec3>(masses) : vectors_from(velocities, masses, "velocities");
  self.change([&](Simulation& simulation) { simulation.set_state(checked_index(robot, simulation.size()), x, v); });
}

template <class T>
nb::object numpy_array(const std::vector<T>& values, const char* dtype) {
  return nb::module_::import_("numpy").attr("array")(nb::cast(values), nb::arg("dtype") = dtype);
}

nb::object offsets(const Batch& self) {
  return numpy_array(self.use([](const Simulation& simulation) {
    const auto offsets = simulation.mass_offsets();
    return std::vector<std::size_t>(offsets.begin(), offsets.end());
  }),
                     "int64");
}

nb::list robots(const Batch& self) {
  nb::list list;
  for (const auto& robot : self.robots()) list.append(nb::cast(SharedRobot{robot}));
  return list;
}

std::string represent_batch(const Batch& self) {
  const std::size_t robots = self.use([](const Simulation& simulation) { return simulation.size(); });
  return "<Batch of " + std::to_string(robots) + (robots == 1 ? " robot" : " robots") + " on " + self.device() + ">";
}

// A getter of something that the simulation knows.
template <class Get>
auto known(Get get) {
  return [get](const Batch& self) { return self.use([&](const Simulation& simulation) { return get(simulation); }); };
}

void bind_actuation(nb::module_& module) {
  nb::class_<ActuationArrays>(module, "Actuation", actuation_description)
      .def_ro("amplitude", &ActuationArrays::amplitude, nb::sig("def amplitude(self) -> Array"),
              "Amplitudes, (robots, actuators) [1].")
      .def_ro("frequency", &ActuationArrays::frequency, nb::sig("def frequency(self) -> Array"),
              "Angular frequencies, (robots, actuators) [rad/s].")
      .def_ro("phase", &ActuationArrays::phase, nb::sig("def phase(self) -> Array"),
              "Phases, (robots, actuators) [rad].")
      .def_ro("drive", &ActuationArrays::drive, nb::sig("def drive(self) -> Array"),
              "Drive signals u, (robots, actuators) [1].")
      .def_ro("driven", &ActuationArrays::driven, nb::sig("def driven(self) -> Array"),
              "Which actuators are driven, (robots, actuators) bool; the others follow the sine.")
      .def(
          "names",
          [](const ActuationArrays& self, std::int64_t robot) {
            return actuator_names(*self.robots[checked_index(robot, self.robots.size())]);
          },
          nb::sig("def names(self, robot: int) -> list[str]"), nb::arg("robot"),
          "Names of the actuators of a robot, in the order of the columns.");
}

void bind_properties(nb::class_<Batch>& batch) {
  using Sim = const Simulation&;
  batch.def("__len__", known([](Sim simulation) { return simulation.size(); }))
      .def_prop_ro("size", known([](Sim simulation) { return simulation.size(); }), "Number of robots.")
      .def_prop_ro("time", known([](Sim simulation) { return simulation.time(); }), "Simulated time [s].")
      .def_prop_ro("steps", known([](Sim simulation) { return simulation.steps(); }),
                   "Steps since the start or the last reset() of all robots.")
      .def_prop_ro("dt", known([](Sim simulation) { return simulation.configuration().dt; }), "Time step [s].")
      .def_prop_ro("damping", known([](Sim simulation) { return simulation.configuration().damping; }),
                   "Velocities shrink by exp(-damping dt) per step [1/s].")
      .def_prop_ro("solver",
                   known([](Sim simulation) { return std::string(name_of(simulation.configuration().solver)); }),
                   "'force' or 'xpbd'.")
      .def_prop_ro(
          "environment",
          [](const Batch& self) {
            return object_of(
                self.use([](const Simulation& simulation) { return simulation.configuration().environment; }));
          },
          nb::sig("def environment(self) -> Environment"), "A copy of the environment.")
      .def_prop_ro("device", &Batch::device, "What steps the robots: 'cpu', 'cuda:0', or 'cuda:all' if several do.")
      .def_prop_ro("device_name", known([](Sim simulation) { return simulation.device_name(); }),
                   "The same for people, as 'CPU, 2 threads, AVX2'.")
      .def_prop_ro("notes", known([](Sim simulation) { return simulation.notes(); }),
                   "Lines worth reading, as that a robot is too large for the chip; usually none.")
      .def_prop_ro("robots", &robots, nb::sig("def robots(self) -> list[Robot]"), "The robots, as they were added.")
      .def_prop_ro("offsets", &offsets, nb::sig("def offsets(self) -> numpy.typing.NDArray[numpy.int64]"),
                   "Robot i has the masses offsets[i] to offsets[i + 1] of positions; robots + 1 elements.");
}

void bind_arrays(nb::class_<Batch>& batch) {
  const auto state = [](StateArray which) { return [which](Batch& self) { return self.state_array(which); }; };
  batch
      .def_prop_ro("positions", state(StateArray::positions), nb::sig("def positions(self) -> Array"),
                   "Positions of all masses, robot after robot, (masses, 3) float32 [m]. An Array, read-only.")
      .def_prop_ro("velocities", state(StateArray::velocities), nb::sig("def velocities(self) -> Array"),
                   "Velocities, (masses, 3) float32 [m/s]; as positions.")
      .def_prop_ro("centers", state(StateArray::centers), nb::sig("def centers(self) -> Array"),
                   "Centers of mass, (robots, 3) float32 [m]. An Array, read-only.")
      .def_prop_ro("center_velocities", state(StateArray::center_velocities),
                   nb::sig("def center_velocities(self) -> Array"),
                   "Velocities of the centers of mass, (robots, 3) float32 [m/s]. An Array, read-only.")
      .def_prop_ro("exploded", &Batch::exploded, nb::sig("def exploded(self) -> Array"),
                   "Which robots have exploded and are frozen, (robots,) bool. An Array, read-only.")
      .def_prop_ro("actuation", &Batch::actuation, nb::sig("def actuation(self) -> Actuation"),
                   "What drives the actuators, an Actuation.")
      .def(
          "actuators",
          [](const Batch& self, std::int64_t robot) {
            const SharedRobots all = self.robots();
            return actuator_names(*all[checked_index(robot, all.size())]);
          },
          nb::sig("def actuators(self, robot: int) -> list[str]"), nb::arg("robot"),
          "Names of the actuators of a robot, in the order of the columns of `actuation`.");
}

void bind_reports(nb::class_<Batch>& batch) {
  batch
      .def(
          "telemetry",
          [](const Batch& self) {
            return telemetry_array(self.use([](const Simulation& simulation) { return simulation.telemetry(); }));
          },
          nb::sig("def telemetry(self) -> numpy.typing.NDArray[numpy.void]"), telemetry_description)
      .def_prop_rw(
          "measure_folding",
          [](const Batch& self) {
            return self.use([](const Simulation& simulation) { return simulation.measures_folding(); });
          },
          [](Batch& self, bool on) { self.change([&](Simulation& simulation) { simulation.measure_folding(on); }); },
          "Whether telemetry() measures how bodies are folded, inverted and overlap; it takes all positions from the "
          "device.")
      .def_prop_rw(
          "measure_upright",
          [](const Batch& self) {
            return self.use([](const Simulation& simulation) { return simulation.measures_upright(); });
          },
          [](Batch& self, bool on) { self.change([&](Simulation& simulation) { simulation.measure_upright(on); }); },
          "Whether telemetry() measures how upright bodies are; it takes all positions from the device.")
      .def(
          "hash",
          [](const Batch& self, std::int64_t robot) {
            return self.use(
                [&](const Simulation& simulation) { return simulation.hash(checked_index(robot, simulation.size())); });
          },
          nb::arg("robot"),
          "FNV-1a over the bytes of a robot's positions, then its velocities, 64 bits. Equal hashes mean equal "
          "states,\n"
          "bit for bit; `mercury run` writes the same.")
      .def(
          "hashes",
          [](const Batch& self) {
            return numpy_array(self.use([](const Simulation& simulation) { return simulation.hashes(); }), "uint64");
          },
          nb::sig("def hashes(self) -> numpy.typing.NDArray[numpy.uint64]"),
          "The hashes of all robots, (robots,) uint64.")
      .def("__repr__", &represent_batch)
      .def("__reduce_ex__", refused_pickle("a Batch cannot be pickled or copied: make another one of batch.robots"),
           refused_pickle_signature);
}

constexpr const char* saved_description =
    R"(The state of all robots of a batch, which Batch.save() makes and Batch.restore() takes. It can be pickled.)";

// Explosions and brains as plain tuples; the arrays are copied.
nb::tuple document_of(const BatchState& state) {
  nb::list explosions, brains;
  for (const auto& [robot, step, at, spring] : state.explosions)
    explosions.append(nb::make_tuple(robot, step, at, spring));
  for (const BrainState& brain : state.brains)
    brains.append(
        nb::make_tuple(nb::cast(brain.neurons), nb::cast(brain.senses), nb::cast(brain.weights), brain.thoughts));
  return nb::make_tuple(state.clock.dt, state.clock.base_time, state.clock.base_step, state.clock.step,
                        vector_array(state.positions), vector_array(state.velocities), explosions, brains);
}

BatchState state_of(const nb::tuple& document) {
  BatchState state;
  state.clock = {.dt = nb::cast<double>(document[0]),
                 .base_time = nb::cast<double>(document[1]),
                 .base_step = nb::cast<std::int64_t>(document[2]),
                 .step = nb::cast<std::int64_t>(document[3])};
  state.positions = vectors_from(document[4], nb::len(nb::object(document[4])), "positions");
  state.velocities = vectors_from(document[5], nb::len(nb::object(document[5])), "velocities");
  for (const nb::handle each : document[6])
    state.explosions.push_back({.robot = nb::cast<std::size_t>(each[0]),
                                .step = nb::cast<std::int64_t>(each[1]),
                                .at = nb::cast<double>(each[2]),
                                .culprit_spring = nb::cast<std::uint32_t>(each[3])});
  for (const nb::handle each : document[7])
    state.brains.push_back({.neurons = nb::cast<std::vector<float>>(each[0]),
                            .senses = nb::cast<std::vector<float>>(each[1]),
                            .weights = nb::cast<std::vector<float>>(each[2]),
                            .thoughts = nb::cast<std::uint64_t>(each[3])});
  return state;
}

void bind_saved_state(nb::module_& module) {
  nb::class_<BatchState>(module, "BatchState", saved_description)
      .def_prop_ro(
          "time", [](const BatchState& self) { return time_of(self.clock); }, "Simulated time [s].")
      .def_prop_ro(
          "positions", [](const BatchState& self) { return vector_array(self.positions); },
          nb::sig("def positions(self) -> numpy.typing.NDArray[numpy.float32]"),
          "Positions of all masses, robot after robot, (masses, 3) [m]. A copy.")
      .def_prop_ro(
          "velocities", [](const BatchState& self) { return vector_array(self.velocities); },
          nb::sig("def velocities(self) -> numpy.typing.NDArray[numpy.float32]"),
          "Velocities, (masses, 3) [m/s]. A copy.")
      .def("__getstate__", &document_of, nb::sig("def __getstate__(self) -> typing.Any"))
      .def(
          "__setstate__",
          [](BatchState& self, const nb::tuple& document) { new (&self) BatchState(state_of(document)); },
          nb::arg("state"), nb::sig("def __setstate__(self, state: typing.Any, /) -> None"));
}

constexpr const char* save_description =
    R"(The state of all robots, to return to it by restore().

    state = batch.save()
    batch.step(1000)
    batch.restore(state)  # what follows is, bit for bit, what followed before

It holds time, positions, velocities, explosions and what brains remember; not what the program gives: robots, settings
and `actuation`.)";

}  // namespace

void bind_batch(nb::module_& module) {
  watch_exit();
  watch_forks();
  bind_saved_state(module);
  bind_actuation(module);
  nb::class_<Batch> batch(module, "Batch", batch_description);
  batch
      .def("__init__", &init, nb::arg("robots").none(), nb::arg("environment") = nb::none(),
           nb::arg("solver") = "force", nb::arg("dt") = 1e-3, nb::arg("damping") = 0.1, nb::arg("device") = "auto",
           nb::arg("threads") = 0,
           nb::sig("def __init__(self, robots: Robot | collections.abc.Iterable[Robot], "
                   "environment: Environment | str | None = None, solver: str = 'force', dt: float = 0.001, "
                   "damping: float = 0.1, device: object = 'auto', threads: int = 0) -> None"),
           init_description().c_str())
      .def("step", &Batch::step, nb::arg("n") = 1, nb::arg("stream") = nb::none(),
           nb::sig("def step(self, n: int = 1, stream: typing.Any = None) -> None"), step_description)
      .def("reset", &Batch::reset, nb::arg("mask") = nb::none(), nb::arg("stream") = nb::none(),
           nb::sig("def reset(self, mask: typing.Any = None, stream: typing.Any = None) -> None"), reset_description)
      .def(
          "add", [](Batch& self, nb::handle robots) { return self.add(robots_of(robots)); }, nb::arg("robots").none(),
          nb::sig("def add(self, robots: Robot | collections.abc.Iterable[Robot]) -> int"),
          "Adds a Robot or a sequence of them, at rest at the current time. Returns the index of the first.")
      .def("keep", &Batch::keep, nb::arg("indices").none(),
           nb::sig("def keep(self, indices: numpy.typing.ArrayLike) -> None"),
           "Keeps the robots of these indices, in this order, with their states, and removes the others.")
      .def("set_state", &set_state, nb::arg("robot"), nb::arg("positions").none(), nb::arg("velocities") = nb::none(),
           nb::sig("def set_state(self, robot: int, positions: numpy.typing.ArrayLike, "
                   "velocities: numpy.typing.ArrayLike | None = None) -> None"),
           "Puts the masses of a robot to `positions` [m] with `velocities` [m/s], both (masses, 3); None = at rest.\n"
           "The robot has not exploded afterward. Raises InputError for another shape.")
      .def(
          "save",
          [](const Batch& self) { return self.use([](const Simulation& simulation) { return simulation.save(); }); },
          save_description)
      .def(
          "restore",
          [](Batch& self, const BatchState& state) {
            self.change([&](Simulation& simulation) { simulation.restore(state); });
          },
          nb::arg("state"),
          "Puts all robots and the time where save() has found them. Raises ValueError for the state of other robots.")
      .def("configure", &configure, nb::kw_only(), nb::arg("environment") = nb::none(), nb::arg("solver") = nb::none(),
           nb::arg("dt") = nb::none(), nb::arg("damping") = nb::none(),
           nb::sig("def configure(self, *, environment: Environment | str | None = None, solver: str | None = None, "
                   "dt: float | None = None, damping: float | None = None) -> None"),
           "Changes what is given, from now on. States and time stay, except that robots that come to land are set\n"
           "down on the floor. Raises InputError for a value that is not accepted.")
      .def("set_environments", &set_environments, nb::arg("robots") = nb::none(), nb::arg("parameters"),
           nb::sig("def set_environments(self, robots: numpy.typing.ArrayLike | None = None, "
                   "**parameters: numpy.typing.ArrayLike) -> None"),
           set_environments_description)
      .def("environment_of", &environment_of_robot, nb::arg("robot"),
           nb::sig("def environment_of(self, robot: int) -> Environment"), "Where a robot lives: a copy.")
      .def("synchronize", &Batch::synchronize, "Waits until the device has done all steps.");
  bind_properties(batch);
  bind_arrays(batch);
  bind_reports(batch);
}

}  // namespace mercury::python
