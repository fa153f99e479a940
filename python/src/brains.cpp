// SPDX-License-Identifier: Apache-2.0
// Senses and brains: of a Robot as what its file says, of a Batch as arrays (docs/brains.md).
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mercury/brain.h"
#include "mercury/error.h"
#include "mercury/robot_file.h"
#include "python/src/arguments.h"
#include "python/src/array.h"
#include "python/src/batch.h"
#include "python/src/bindings.h"
#include "python/src/robot_arrays.h"
#include "python/src/values.h"

namespace mercury::python {
namespace {

nb::object from_json(const std::string& text) { return nb::module_::import_("json").attr("loads")(text); }

std::string to_json(nb::handle value) {
  return nb::cast<std::string>(nb::module_::import_("json").attr("dumps")(value, nb::arg("allow_nan") = false));
}

nb::object sensors(const SharedRobot& self) { return from_json(sensors_as_json(*self.robot)); }

nb::object brain(const SharedRobot& self) {
  return self.robot->brain ? from_json(brain_as_json(*self.robot->brain)) : nb::none();
}

SharedRobot with_brain(const SharedRobot& self, nb::handle given, nb::handle senses) {
  Robot robot = *self.robot;
  if (!senses.is_none()) set_sensors(robot, to_json(senses));
  robot.brain.reset();
  if (!given.is_none()) set_brain(robot, to_json(given));
  validate_brain(robot);
  return {std::make_shared<const Robot>(std::move(robot))};
}

nb::dict layout(const SharedRobot& self) {
  const BrainLayout found = brain_layout(*self.robot);
  nb::dict dict;
  const auto texts = [](const std::vector<std::string>& all) {
    nb::list list;
    for (const std::string& text : all) list.append(text);
    return list;
  };
  dict["senses"] = texts(found.senses);
  dict["neurons"] = texts(found.neurons);
  dict["weights"] = found.weights;
  return dict;
}

// The brains of a batch.
struct Brains {
  nb::object owner;
  Batch* batch;
};

// A row per robot, NaN beyond what its brain has.
nb::object rows_of(const Brains& self, std::vector<float> BrainState::*numbers, bool one_sample) {
  const auto [values, rows] = self.batch->use([&](const Simulation& simulation) {
    std::vector<std::vector<float>> all;
    std::vector<BrainState> states = simulation.brain_states();
    const Robot* last = nullptr;
    std::size_t senses = 0;  // of `last`
    for (std::size_t i = 0; i < simulation.size(); ++i) {
      const Robot& robot = simulation.robot(i);
      all.push_back(std::move(states[i].*numbers));
      if (one_sample && &robot != last) senses = brain_layout(robot).senses.size();
      if (one_sample) all.back().resize(senses);
      last = &robot;
    }
    std::size_t columns = 0;
    for (const auto& row : all) columns = std::max(columns, row.size());
    std::vector<float> padded(all.size() * columns, std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < all.size(); ++i)
      std::ranges::copy(all[i], padded.begin() + static_cast<std::ptrdiff_t>(i * columns));
    return std::pair(std::move(padded), all.size());
  });
  const std::size_t columns = rows > 0 ? values.size() / rows : 0;
  return owned_array(values, {rows, columns});
}

void set_weights(Brains& self, nb::handle given) {
  using Numbers = nb::ndarray<nb::numpy, const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
  Numbers numbers;
  const nb::object array = nb::module_::import_("numpy").attr("ascontiguousarray")(given, nb::arg("dtype") = "float32");
  if (!nb::try_cast(array, numbers)) throw InputError("weights", "must be numbers, (robots, weights)");
  const std::vector<float> values(numbers.data(), numbers.data() + numbers.size());
  const std::size_t rows = numbers.shape(0), columns = numbers.shape(1);
  self.batch->change([&](Simulation& simulation) {
    if (rows != simulation.size())
      throw InputError("weights",
                       std::to_string(rows) + " rows, the batch has " + std::to_string(simulation.size()) + " robots");
    std::vector<std::size_t> counts;
    for (std::size_t i = 0; i < rows; ++i) {
      counts.push_back(simulation.brain_state(i).weights.size());
      if (counts[i] > columns)
        throw InputError("weights", std::to_string(columns) + " columns, and robot " + std::to_string(i) + " has " +
                                        std::to_string(counts[i]) + " weights");
      const std::span<const float> row = std::span(values).subspan(i * columns, counts[i]);
      if (!std::ranges::all_of(row, [](float weight) { return std::isfinite(weight); }))
        throw InputError("weights", "those of robot " + std::to_string(i) + " are not all finite");
    }
    for (std::size_t i = 0; i < rows; ++i)
      simulation.set_brain_weights(i, std::span(values).subspan(i * columns, counts[i]));
  });
}

void set_targets(Brains& self, nb::handle places) {
  if (places.is_none()) {
    self.batch->change([](Simulation& simulation) {
      for (std::size_t i = 0; i < simulation.size(); ++i) simulation.set_target(i, std::nullopt);
    });
    return;
  }
  const std::size_t robots = self.batch->robots().size();
  const std::vector<Vec3> targets = vectors_from(places, robots, "targets");
  for (const Vec3& target : targets)
    if (!(std::isfinite(target.x) && std::isfinite(target.y) && std::isfinite(target.z)))
      throw InputError("targets", "must be finite");
  self.batch->change([&](Simulation& simulation) {
    for (std::size_t i = 0; i < std::min(targets.size(), simulation.size()); ++i) simulation.set_target(i, targets[i]);
  });
}

void clamp(Brains& self, std::int64_t robot, std::int64_t neuron, std::optional<float> value) {
  self.batch->change([&](Simulation& simulation) {
    const std::size_t index = checked_index(robot, simulation.size());
    if (value && !std::isfinite(*value)) throw InputError("value", "must be finite");
    if (neuron < 0) throw std::out_of_range("neuron " + std::to_string(neuron));
    simulation.clamp_neuron(index, static_cast<std::size_t>(neuron), value);
  });
}

}  // namespace

void bind_brains(nb::module_& module) {
  nb::cast<nb::class_<SharedRobot>>(module.attr("Robot"))
      .def_prop_ro("sensors", &sensors, nb::sig("def sensors(self) -> list[dict[str, typing.Any]]"),
                   "What the robot senses, as in its file.")
      .def_prop_ro("brain", &brain, nb::sig("def brain(self) -> dict[str, typing.Any] | None"),
                   "What drives its actuators from what it senses, as in its file; None without a brain.")
      .def(
          "with_brain", &with_brain, nb::arg("brain").none(), nb::arg("sensors") = nb::none(),
          nb::sig("def with_brain(self, brain: dict[str, typing.Any] | None, "
                  "sensors: list[dict[str, typing.Any]] | None = None) -> Robot"),
          "A copy with this brain, as a robot file has it, in place of its own; sensors=None keeps the robot's. Raises "
          "InputError with the place, \"/brain/layers/0/inputs/0: ...\", for a brain that does not fit.")
      .def_prop_ro(
          "brain_layout", &layout, nb::sig("def brain_layout(self) -> dict[str, typing.Any]"),
          "The numbering of Batch.brain: names of the senses and of the neurons, and how many weights there "
          "are. Weights are those of layer after layer: biases, then the inputs in their order, row after row.");

  nb::class_<BrainArraysInPython>(
      module, "BrainArrays",
      R"(Weights and states of all brains of a batch: writable Arrays of float32 on its device.

    arrays = batch.brain.arrays
    torch.from_dlpack(arrays.weights)[:] = population         # counts from the next thought on
    batch.reset()                                             # keeps weights
    batch.step(10000)

All robots have brains with as many weights, neurons and senses. On CUDA, a program that writes in a stream of its own
gives this stream to step(); functions of the batch without a stream follow what is queued in the legacy default stream.
add() and keep() make other arrays.)")
      .def_ro("weights", &BrainArraysInPython::weights, nb::sig("def weights(self) -> Array"),
              "(robots, weights), in the order of Robot.brain_layout.")
      .def_ro("neurons", &BrainArraysInPython::neurons, nb::sig("def neurons(self) -> Array"),
              "Activations, (robots, neurons). What is written there is where the next thought begins.")
      .def_ro(
          "senses", &BrainArraysInPython::senses, nb::sig("def senses(self) -> Array"),
          "Senses as sampled last, with gain and noise and without delay, (robots, senses); then the samples before,\n"
          "if senses have delays.");

  nb::class_<Brains>(module, "Brains",
                     "The brains of a batch. Arrays have a row per robot, padded with NaN, and are copies.")
      .def_prop_ro(
          "neurons", [](const Brains& self) { return rows_of(self, &BrainState::neurons, false); },
          nb::sig("def neurons(self) -> numpy.typing.NDArray[numpy.float32]"), "Activations, (robots, neurons).")
      .def_prop_ro(
          "senses", [](const Brains& self) { return rows_of(self, &BrainState::senses, true); },
          nb::sig("def senses(self) -> numpy.typing.NDArray[numpy.float32]"),
          "Senses as sampled last, with gain and noise and without delay, (robots, senses).")
      .def_prop_rw(
          "weights", [](const Brains& self) { return rows_of(self, &BrainState::weights, false); }, &set_weights,
          nb::for_getter(nb::sig("def weights(self) -> numpy.typing.NDArray[numpy.float32]")),
          nb::for_setter(nb::sig("def weights(self, value: numpy.typing.ArrayLike, /) -> None")),
          "Weights, (robots, weights), in the order of Robot.brain_layout; may be set. Batch.reset() keeps them.")
      .def_prop_ro(
          "arrays", [](const Brains& self) { return self.batch->brain_arrays(); },
          nb::sig("def arrays(self) -> BrainArrays"),
          "The same on the device, without a copy, for robots with equal brains: a BrainArrays. Raises InputError for\n"
          "others.")
      .def("set_targets", &set_targets, nb::arg("places").none(),
           nb::sig("def set_targets(self, places: numpy.typing.ArrayLike | None) -> None"),
           "The target of each robot, (robots, 3) [m]; None = that of the environment.")
      .def("clamp", &clamp, nb::arg("robot"), nb::arg("neuron"), nb::arg("value").none(),
           "Gives a neuron this value from now on, whatever it reads; None = it thinks again.");
  nb::cast<nb::class_<Batch>>(module.attr("Batch"))
      .def_prop_ro(
          "brain",
          [](nb::handle_t<Batch> self) {
            return Brains{nb::borrow(self), nb::cast<Batch*>(self)};
          },
          nb::sig("def brain(self) -> Brains"), "The brains of all robots.");
}

}  // namespace mercury::python
