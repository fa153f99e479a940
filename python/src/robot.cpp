// SPDX-License-Identifier: Apache-2.0
// Robot: a robot as plain data.
#include "mercury/robot.h"

#include <nanobind/operators.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "mercury/body_properties.h"
#include "mercury/error.h"
#include "mercury/generator.h"
#include "mercury/import.h"
#include "mercury/inspect.h"
#include "mercury/physics.h"
#include "mercury/real_body.h"
#include "mercury/robot_file.h"
#include "mercury/run_robots.h"
#include "python/src/bindings.h"
#include "python/src/robot_arrays.h"
#include "python/src/values.h"

namespace mercury::python {
namespace {

SharedRobot shared(Robot robot) { return {std::make_shared<const Robot>(std::move(robot))}; }

Robot robot_from(nb::handle masses, nb::handle springs, nb::handle faces, nb::handle materials, nb::handle mass,
                 nb::handle velocity, nb::handle fixed, nb::handle actuators, nb::handle name) {
  Robot robot;
  robot.name = text_from("name", name);
  robot.masses = masses_from(masses);
  if (!materials.is_none()) robot.materials = materials_from(materials);
  robot.springs = springs_from(springs, robot);
  if (!faces.is_none()) robot.faces = faces_from(faces, robot);
  if (!mass.is_none()) robot.mass = mass_from(mass, robot);
  if (!velocity.is_none()) robot.velocity = velocity_from(velocity, robot);
  if (!fixed.is_none()) robot.fixed = fixed_from(fixed, robot);
  validate(robot);
  if (!actuators.is_none()) add_actuators(robot, actuators);
  return robot;
}

// Of a run of mercury evolve: champions, elites, the best one, or individuals by their numbers.
std::vector<Robot> robots_of_run(const std::filesystem::path& folder, const std::vector<std::string>& choices) {
  const RunHistory run(folder);
  std::vector<Robot> robots;
  for (const std::string& choice : choices)
    if (choice == champions_of_run)
      for (const std::filesystem::path& file : champion_files(folder)) robots.push_back(load_robot(file));
    else
      for (const std::uint64_t id : individuals_named(run, choice)) robots.push_back(run.grow(id));
  return robots;
}

// A number, a word, or several of them; empty = none was given.
std::vector<std::string> choices_from(nb::handle given) {
  if (given.is_none()) return {};
  if (nb::isinstance<nb::str>(given) || nb::hasattr(given, "__index__")) return {nb::cast<std::string>(nb::str(given))};
  std::vector<std::string> choices;
  for (const nb::handle one : nb::iter(given)) choices.push_back(nb::cast<std::string>(nb::str(one)));
  return choices;
}

nb::object load(nb::handle given, nb::handle robot) {
  const std::filesystem::path path = path_from("path", given);
  const std::vector<std::string> choices = choices_from(robot);
  const bool is_one =
      nb::hasattr(robot, "__index__") || (nb::isinstance<nb::str>(robot) && choices.front() == best_of_run);
  std::vector<Robot> robots;
  bool is_folder = false;
  {
    const ReleasedGil released;
    std::error_code ignored;
    is_folder = std::filesystem::is_directory(path, ignored);
    const bool is_run = is_run_folder(path);
    if (!robot.is_none() && !is_run)
      throw InputError(path.string(), "robot chooses robots of a run of mercury evolve, and this is none");
    if (is_run)
      robots = robots_of_run(path, robot.is_none() ? std::vector{std::string(champions_of_run)} : choices);
    else if (is_folder)
      robots = load_robots(std::span(&path, 1));
    else if (const ImportFormat* format = import_format_of(path))
      robots = import_file(path, *format).robots;
    else
      robots.push_back(load_robot(path));
  }
  if (!is_folder && robots.empty()) throw InputError(path.string(), "holds no robot, only what cannot move");
  if ((!is_folder || is_one) && robots.size() == 1) return nb::cast(shared(std::move(robots.front())));
  nb::list list;
  for (Robot& one : robots) list.append(shared(std::move(one)));
  return list;
}

nb::object origin(const SharedRobot& self) {
  if (self.robot->origin.empty()) return nb::none();
  return nb::module_::import_("json").attr("loads")(self.robot->origin);
}

nb::dict actuators(const SharedRobot& self) {
  nb::dict found;
  for (const Actuator& actuator : actuators_of(*self.robot)) {
    nb::list materials;
    for (const MaterialId id : actuator.materials) materials.append(int{id});
    found[actuator.name.c_str()] = materials;
  }
  return found;
}

std::string name_from(nb::handle given, const std::string& otherwise) {
  return given.is_none() ? otherwise : text_from("name", given);
}

SharedRobot mutated(const SharedRobot& self, nb::handle strength, nb::handle muscles, nb::handle seed,
                    nb::handle name) {
  const MutationRequest request{.strength = number_from("strength", strength),
                                .seed = seed_from("seed", seed),
                                .muscles = number_from("muscles", muscles)};
  validate(request);
  if (request.strength == 0 && request.muscles == 0)
    throw InputError("strength, muscles", "both are 0, which changes nothing; give one of them above 0");
  const std::string child = name_from(name, self.robot->name + "-m" + std::to_string(request.seed));
  const ReleasedGil released;
  return shared(mutate_robot(*self.robot, request, child));
}

SharedRobot crossed(const SharedRobot& self, nb::handle other, nb::handle seed, nb::handle name) {
  SharedRobot second;
  if (!nb::try_cast(other, second)) refuse_type("other", "a Robot", other);
  const std::uint64_t number = seed_from("seed", seed);
  const std::string child = name_from(name, self.robot->name + "-x" + std::to_string(number));
  const ReleasedGil released;
  return shared(cross_robots(*self.robot, *second.robot, number, child));
}

SharedRobot with_actuators(const SharedRobot& self, nb::handle given) {
  Robot robot = *self.robot;
  robot.actuators.clear();
  add_actuators(robot, given);
  return shared(std::move(robot));
}

// One number, or one per material.
std::vector<float> amounts_from(const std::string& parameter, nb::handle value, std::size_t materials) {
  if (!nb::hasattr(value, "__len__") || nb::isinstance<nb::str>(value))
    return std::vector<float>(materials, static_cast<float>(number_from(parameter, value)));
  std::vector<float> amounts;
  for (const nb::handle each : value)
    amounts.push_back(static_cast<float>(number_from(parameter + "[" + std::to_string(amounts.size()) + "]", each)));
  if (amounts.size() != materials)
    throw InputError(parameter, std::to_string(amounts.size()) + " numbers, and the robot has " +
                                    std::to_string(materials) + " materials; give one number or one per material");
  return amounts;
}

SharedRobot with_real_body(const SharedRobot& self, nb::handle modulus, nb::handle body_density,
                           nb::handle relaxation_time) {
  const std::size_t materials = materials_of(*self.robot).size();
  const std::vector<float> moduli = amounts_from("modulus", modulus, materials),
                           densities = amounts_from("body_density", body_density, materials),
                           times = amounts_from("relaxation_time", relaxation_time, materials);
  // The first stands for air.
  const std::size_t usual = std::min<std::size_t>(1, materials - 1);
  RealMaterial material{moduli[usual], densities[usual], times[usual], {}};
  const auto is_list = [](nb::handle value) { return nb::hasattr(value, "__len__"); };
  if (is_list(modulus))
    for (std::size_t i = 0; i < materials; ++i) material.each.push_back({moduli[i], densities[i], times[i]});
  else if (is_list(body_density) || is_list(relaxation_time))
    throw InputError("modulus", "one number beside a list; give one per material, too");
  return shared(mercury::with_real_body(*self.robot, material));
}

nb::tuple to_tuple(Vec3 value) { return nb::make_tuple(value.x, value.y, value.z); }

nb::dict info(const SharedRobot& self) {
  const Inspection found = inspect(*self.robot);
  nb::list materials;
  for (const MaterialUse& use : found.materials) {
    nb::dict entry;
    entry["id"] = int{use.id};
    entry["name"] = use.name;
    entry["stiffness"] = use.material.stiffness;
    entry["amplitude"] = use.material.amplitude;
    entry["frequency"] = use.material.frequency;
    entry["phase"] = use.material.phase;
    entry["half_wave"] = use.material.half_wave;
    entry["relaxation_time"] = use.material.relaxation_time;
    entry["springs"] = use.springs;
    materials.append(entry);
  }
  nb::dict entry;
  entry["masses"] = found.masses;
  entry["springs"] = found.springs;
  entry["faces"] = found.faces;
  entry["muscles"] = found.muscles;
  entry["materials"] = materials;
  entry["lowest"] = to_tuple(found.lowest);
  entry["highest"] = to_tuple(found.highest);
  entry["extent"] = to_tuple(found.extent);
  entry["length"] = found.length;
  entry["shortest_spring"] = found.shortest_spring;
  entry["longest_spring"] = found.longest_spring;
  entry["springs_per_mass"] = found.springs_a_mass;
  entry["components"] = found.components;
  entry["loose_masses"] = found.loose_masses;
  entry["closed"] = found.closed;
  entry["open_edges"] = found.open_edges;
  entry["crowded_edges"] = found.crowded_edges;
  entry["euler_characteristic"] = found.euler_characteristic;
  entry["area"] = found.area;
  entry["volume"] = found.volume;
  const BodyProperties body = body_properties(*self.robot);
  entry["mass"] = body.mass;
  entry["density"] = body.density;
  entry["physics"] = std::string(name_of(physics_of(*self.robot)));
  entry["stiffness_scale"] = 1.0;
  entry["modulus"] = body.modulus;
  entry["lowest_frequency"] = body.lowest_frequency;
  entry["largest_dt"] = body.largest_dt;
  return entry;
}

nb::object repr(const SharedRobot& self) {
  const Robot& robot = *self.robot;
  return nb::str("Robot {!r}: {:,} masses, {:,} springs, {:,} faces, {:,} actuators")
      .attr("format")(robot.name, robot.masses.size(), robot.springs.size(), robot.faces.size(),
                      actuators_of(robot).size());
}

nb::bytes state(const SharedRobot& self) {
  const std::string document = serialize_robot(*self.robot, RobotFormat::cbor);
  return nb::bytes(document.data(), document.size());
}

void restore(SharedRobot& self, const nb::bytes& document) {
  new (&self) SharedRobot(shared(parse_robot({document.c_str(), document.size()}, RobotFormat::cbor)));
}

template <nb::object view(nb::handle, const Robot&)>
nb::object view_of(nb::handle_t<SharedRobot> self) {
  const SharedRobot* robot = nullptr;
  if (!nb::try_cast(self, robot)) throw nb::type_error("this Robot was never initialized");
  return view(self, *robot->robot);
}

constexpr const char* about_robot =
    R"(A robot as plain data: point masses, springs that join them, and a skin of triangles. It never changes.

masses     (n, 3): positions at rest [m], within 1e6 m of the origin; 1 to 65,535 of them
springs    (m, 3) or (m, 4): the indices of two masses, a material, and the rest length [m] (default: their distance);
           or a structured array with the fields a, b, material, rest_length
faces      (k, 3): indices of masses, counter-clockwise seen from outside
materials  (l, 4) to (l, 6): stiffness [N/m], amplitude [1], frequency [rad/s], phase [rad]; 1 for muscles that move
           by the negative half of the sine alone, else 0; relaxation time [s]; or a structured array with the fields
           stiffness, amplitude, frequency, phase, half_wave, relaxation_time. Row 0 stands for air, which no spring
           has. Default: the 254 default materials
mass       (n,): the mass of each point [kg], or one number for all. Default: 1 kg each
velocity   (n, 3): of each point at the start [m/s], or (3,) for all. Default: at rest
fixed      indices of masses that never move, or a mask with one bool per mass. Default: none
actuators  {name: springs}: groups of springs that a program drives together, as indices or as a mask with one bool
           per spring. Default: muscles of the same frequency, phase and half wave belong together
name       a text

Everything that NumPy makes an array of is accepted, and copied. Raises InputError for a robot that breaks a rule.)";

}  // namespace

SharedRobots robots_of(nb::handle robots) {
  if (SharedRobot one; nb::try_cast(robots, one)) return {one.robot};
  const std::string wanted = "a Robot or a sequence of them";
  if (!nb::isinstance<nb::iterable>(robots)) refuse_type("robots", wanted, robots);
  SharedRobots all;
  for (const nb::handle robot : robots) {
    SharedRobot one;
    if (!nb::try_cast(robot, one)) refuse_type("robots[" + std::to_string(all.size()) + "]", "a Robot", robot);
    all.push_back(one.robot);
  }
  return all;
}

void bind_robot(nb::module_& module) {
  nb::class_<SharedRobot>(module, "Robot", about_robot)
      .def(
          "__init__",
          [](SharedRobot* self, nb::handle masses, nb::handle springs, nb::handle faces, nb::handle materials,
             nb::handle mass, nb::handle velocity, nb::handle fixed, nb::handle actuators, nb::handle name) {
            new (self) SharedRobot(
                shared(robot_from(masses, springs, faces, materials, mass, velocity, fixed, actuators, name)));
          },
          nb::arg("masses").none(), nb::arg("springs").none(), nb::arg("faces") = nb::none(),
          nb::arg("materials") = nb::none(), nb::kw_only(), nb::arg("mass") = nb::none(),
          nb::arg("velocity") = nb::none(), nb::arg("fixed") = nb::none(), nb::arg("actuators") = nb::none(),
          nb::arg("name").none() = "",
          nb::sig("def __init__(self, masses: numpy.typing.ArrayLike, springs: numpy.typing.ArrayLike, "
                  "faces: numpy.typing.ArrayLike | None = None, materials: numpy.typing.ArrayLike | None = None, *, "
                  "mass: numpy.typing.ArrayLike | None = None, velocity: numpy.typing.ArrayLike | None = None, "
                  "fixed: numpy.typing.ArrayLike | None = None, "
                  "actuators: dict[str, numpy.typing.ArrayLike] | None = None, name: str = '') -> None"))
      .def_prop_ro(
          "name", [](const SharedRobot& self) { return self.robot->name; }, "The robot's name, possibly empty.")
      .def_prop_ro("masses", &view_of<masses_view>, nb::sig("def masses(self) -> numpy.typing.NDArray[numpy.float32]"),
                   "Positions at rest, (masses, 3) float32 [m]. Read-only; shares memory with the robot.")
      .def_prop_ro("springs", &view_of<springs_view>, nb::sig("def springs(self) -> numpy.typing.NDArray[numpy.void]"),
                   "Springs, (springs,) with the fields a, b (indices of masses), material and rest_length [m]. "
                   "Read-only; shares memory with the robot.")
      .def_prop_ro("faces", &view_of<faces_view>, nb::sig("def faces(self) -> numpy.typing.NDArray[numpy.uint16]"),
                   "Triangles of the skin, (faces, 3) uint16: indices of masses, counter-clockwise seen from outside. "
                   "Read-only; shares memory with the robot.")
      .def_prop_ro("materials", &view_of<materials_view>,
                   nb::sig("def materials(self) -> numpy.typing.NDArray[numpy.float32]"),
                   "Materials, (materials, 4) float32: stiffness [N/m], amplitude [1], frequency [rad/s], phase [rad]. "
                   "Row 0 is air. Read-only; shares memory with the robot.")
      .def_prop_ro("half_wave", &view_of<half_wave_view>,
                   nb::sig("def half_wave(self) -> numpy.typing.NDArray[numpy.bool_]"),
                   "Whether only the negative half of the sine moves a material, (materials,) bool. Read-only; shares "
                   "memory with the robot.")
      .def_prop_ro("relaxation_time", &view_of<relaxation_time_view>,
                   nb::sig("def relaxation_time(self) -> numpy.typing.NDArray[numpy.float32]"),
                   "How much a spring of a material resists its rate of length, (materials,) float32 [s]. Read-only; "
                   "shares memory with the robot.")
      .def_prop_ro("mass", &view_of<mass_view>, nb::sig("def mass(self) -> numpy.typing.NDArray[numpy.float32]"),
                   "The mass of each point, (masses,) float32 [kg]. Read-only; shares memory with the robot, unless "
                   "it says nothing of it: then an array of ones.")
      .def_prop_ro("velocity", &view_of<velocity_view>,
                   nb::sig("def velocity(self) -> numpy.typing.NDArray[numpy.float32]"),
                   "The velocity of each point at the start, (masses, 3) float32 [m/s]. Read-only; shares memory with "
                   "the robot, unless it says nothing of it: then an array of zeros.")
      .def_prop_ro("fixed", &view_of<fixed_view>, nb::sig("def fixed(self) -> numpy.typing.NDArray[numpy.uint16]"),
                   "Indices of the masses that never move, (fixed,) uint16. Read-only; shares memory with the robot.")
      .def_prop_ro("origin", &origin, nb::sig("def origin(self) -> dict[str, typing.Any] | None"),
                   "How the robot was made; None if that is unknown.")
      .def_prop_ro("actuators", &actuators, nb::sig("def actuators(self) -> dict[str, list[int]]"),
                   "Actuators in their order, by name: the materials whose springs each drives.")
      .def_prop_ro(
          "body_hash", [](const SharedRobot& self) { return body_hash(*self.robot); },
          "FNV-1a over masses, springs, faces, materials, velocities and fixed points, bit for bit, whatever the "
          "names and the origin.")
      .def(
          "save",
          [](const SharedRobot& self, nb::handle given) {
            const std::filesystem::path path = path_from("path", given);
            const ReleasedGil released;
            save_robot(path, *self.robot);
          },
          nb::arg("path").none(), nb::sig("def save(self, path: str | os.PathLike[str]) -> None"),
          "Writes a file, .json or .cbor, whole or not at all. Raises InputError if it cannot be written.")
      .def("mutate", &mutated, nb::arg("strength").none() = 1.0, nb::arg("muscles").none() = 0.0,
           nb::arg("seed").none() = 1, nb::arg("name").none() = nb::none(),
           nb::sig("def mutate(self, strength: float = 1, muscles: float = 0, seed: int = 1, "
                   "name: str | None = None) -> Robot"),
           "A changed copy of a robot that a generator made. `strength` says how much the body changes (1 = a little, "
           "as in a search), `muscles` how much its muscles do. Its name is NAME-mSEED by default. The same arguments "
           "give the same child on every machine. Raises InputError if no generator made the robot.")
      .def("cross", &crossed, nb::arg("other").none(), nb::arg("seed").none() = 1, nb::arg("name").none() = nb::none(),
           nb::sig("def cross(self, other: Robot, seed: int = 1, name: str | None = None) -> Robot"),
           "A child of two robots that one generator made; body and muscles are mixed. Its name is NAME-xSEED by "
           "default. The same arguments give the same child on every machine. Raises InputError for two robots that "
           "cannot be mixed.")
      .def("with_real_body", &python::with_real_body, nb::arg("modulus") = 1e5, nb::kw_only(),
           nb::arg("body_density") = 1070, nb::arg("relaxation_time") = 0.01,
           nb::sig("def with_real_body(self, modulus: numpy.typing.ArrayLike = 1e5, *, "
                   "body_density: numpy.typing.ArrayLike = 1070, "
                   "relaxation_time: numpy.typing.ArrayLike = 0.01) -> Robot"),
           "The robot with masses and springs of a real material: Young's modulus of its muscles [Pa], density "
           "[kg/m3] and relaxation time of the damping inside it [s]. Its materials keep the ratios of their "
           "stiffnesses. With lists, one value per material (row 0 is air), each is made of its own. Raises InputError "
           "for a robot that has a real body, and for a network without a closed skin.")
      .def("info", &info, nb::sig("def info(self) -> dict[str, typing.Any]"),
           "Measures: counts, the materials in use, sizes [m], whether the skin is closed, its area [m2] and volume "
           "[m3], "
           "the physics (\"paper\" or \"real\"), and the body's mass [kg], density [kg/m3], modulus [Pa], slowest "
           "vibration [Hz] and largest stable dt [s], "
           "None where there is none.")
      .def(
          "with_actuators", &with_actuators, nb::arg("actuators").none(),
          nb::sig("def with_actuators(self, actuators: dict[str, numpy.typing.ArrayLike]) -> Robot"),
          "A copy with these actuators in place of its own: {name: springs}, as in Robot(). Springs of an actuator get "
          "materials of their own, with the same values.")
      .def(
          "__eq__",
          [](const SharedRobot& self, nb::handle other) -> nb::object {
            SharedRobot second;
            if (!nb::try_cast(other, second)) return nb::borrow(nb::handle(Py_NotImplemented));
            return nb::bool_(self.robot == second.robot || *self.robot == *second.robot);
          },
          nb::arg("other").none(), nb::sig("def __eq__(self, other: object, /) -> bool"))
      .def("__hash__", [](const SharedRobot& self) { return static_cast<Py_ssize_t>(body_hash(*self.robot) >> 1); })
      .def("__repr__", &repr, nb::sig("def __repr__(self) -> str"))
      .def("__copy__", [](nb::handle_t<SharedRobot> self) { return self; })
      .def(
          "__deepcopy__", [](nb::handle_t<SharedRobot> self, nb::handle) { return self; }, nb::arg("memo"))
      .def("__getstate__", &state)
      .def("__setstate__", &restore);
  const std::string documentation =
      "The Robot of a file (.json, .cbor) or a sample (\"sample:eel\", where the sources or an installed program have "
      "them), "
      "or a list of the robots of a folder, sorted by the names of the files. "
      "Files of " +
      import_sources() +
      " are imported without their worlds; one that holds several robots gives a list. "
      "The folder of a run of `mercury evolve` gives the list of its champions, and with `robot` others: \"elites\", "
      "all "
      "that live, the best first; \"best\" or a number, one Robot; or several of them, a list. "
      "Raises InputError with the place: \"eel.json: /springs/7: mass 912 is out of range, the robot has 300\".";
  module.def(
      "load", &load, nb::arg("path").none(), nb::arg("robot").none() = nb::none(),
      nb::sig("def load(path: str | os.PathLike[str], robot: int | str | typing.Iterable[int | str] | None = None) "
              "-> typing.Any"),
      documentation.c_str());
}

}  // namespace mercury::python
