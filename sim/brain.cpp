// SPDX-License-Identifier: Apache-2.0
// Rules and numbering of sensors and brains.
#include "mercury/brain.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <unordered_map>

#include "mercury/error.h"
#include "mercury/robot.h"
#include "sim/brains.h"
#include "sim/physics/senses.h"

namespace mercury {
namespace {

std::string join(const auto& names) {
  std::string text;
  for (const auto& name : names) text.append(text.empty() ? "" : ", ").append(name);
  return text.empty() ? "none" : text;
}

std::string numbered(const char* list, std::size_t index) { return list + std::to_string(index); }

[[noreturn]] void unknown_actuator(const std::string& where, const std::string& name,
                                   const std::vector<Actuator>& actuators) {
  std::vector<std::string> names;
  for (const Actuator& actuator : actuators) names.push_back(actuator.name);
  constexpr std::size_t shown = 8;
  const std::size_t more = names.size() > shown ? names.size() - shown : 0;
  names.resize(names.size() - more);
  throw InputError(where, "no actuator is named \"" + name.substr(0, 40) + "\"; the robot has " + join(names) +
                              (more > 0 ? " and " + std::to_string(more) + " more" : ""));
}

std::size_t find_actuator(const std::vector<Actuator>& actuators, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(actuators, name, &Actuator::name) - actuators.begin());
}

// The layers of a brain by their names.
class Layers {
 public:
  explicit Layers(const Brain& brain) : brain_(brain) {
    for (std::size_t i = 0; i < brain.layers.size(); ++i) index_.try_emplace(brain.layers[i].name, i);
  }
  std::size_t index(const std::string& name) const { return index_.at(name); }
  const NeuronLayer& require(const std::string& name, const std::string& where) const {
    if (const auto found = index_.find(name); found != index_.end()) return brain_.layers[found->second];
    std::vector<std::string> names;
    for (const NeuronLayer& layer : brain_.layers)
      if (names.size() < 8) names.push_back(layer.name);
    throw InputError(where, "no layer is named \"" + name.substr(0, 40) + "\"; the brain has " + join(names));
  }

 private:
  const Brain& brain_;
  std::unordered_map<std::string_view, std::size_t> index_;
};

void require_neuron(const NeuronLayer& layer, std::uint32_t neuron, const std::string& where) {
  if (neuron >= layer.neurons)
    throw InputError(where, "neuron " + std::to_string(neuron) + " is out of range, layer \"" + layer.name + "\" has " +
                                std::to_string(layer.neurons));
}

std::size_t sense_count(const Robot& robot) {
  std::size_t count = 0;
  for (const Sensor& sensor : robot.sensors) count += description_of(sensor.kind).width;
  return count;
}

// Elements of a vector that a layer reads.
std::size_t size_of(std::size_t senses, const Layers& layers, const std::string& from, const std::string& where) {
  return from == "senses" ? senses : layers.require(from, where).neurons;
}

void require_finite(float number, const std::string& where) {
  if (!std::isfinite(number)) throw InputError(where, "must be a finite number");
}

void validate_sensor(const Robot& robot, const std::vector<Actuator>& actuators, const Layers* layers,
                     std::size_t index) {
  const Sensor& sensor = robot.sensors[index];
  const SensorDescription& kind = description_of(sensor.kind);
  const std::string where = numbered("/sensors/", index);
  try {
    check_parameters(sensor);
  } catch (const ParameterError& error) {
    throw InputError(where + "/" + error.parameter(), error.problem());
  }
  const int places = !sensor.actuator.empty() + !sensor.springs.empty() + !sensor.masses.empty();
  if (places > 1) throw InputError(where, "has more than one of actuator, springs and masses; give one of them");
  if (places > 0 && (kind.place == SensorPlace::body || kind.place == SensorPlace::none))
    throw InputError(where, std::string(kind.name) + " has no place; leave out actuator, springs and masses");
  if (!sensor.masses.empty() && kind.place == SensorPlace::springs)
    throw InputError(where + "/masses", std::string(kind.name) + " is of springs; give an actuator or springs");
  const bool per_actuator = robot.brain && robot.brain->per_actuator;
  if (!sensor.actuator.empty() && !(per_actuator && sensor.actuator == "self") &&
      find_actuator(actuators, sensor.actuator) == actuators.size())
    unknown_actuator(where + "/actuator", sensor.actuator, actuators);
  for (const std::uint32_t spring : sensor.springs)
    if (spring >= robot.springs.size())
      throw InputError(where + "/springs", "spring " + std::to_string(spring) + " is out of range, the robot has " +
                                               std::to_string(robot.springs.size()));
  for (const std::uint16_t mass : sensor.masses)
    if (mass >= robot.masses.size())
      throw InputError(where + "/masses", "mass " + std::to_string(mass) + " is out of range, the robot has " +
                                              std::to_string(robot.masses.size()));
  if ((sensor.kind == SensorKind::neuron) != !sensor.layer.empty())
    throw InputError(where, sensor.layer.empty() ? "a sensor of a neuron names its layer"
                                                 : std::string(kind.name) + " is of no layer");
  if (sensor.kind != SensorKind::neuron && sensor.neuron != 0)
    throw InputError(where, std::string(kind.name) + " is of no neuron");
  if (sensor.kind == SensorKind::neuron) {
    if (!layers) throw InputError(where, "is of a neuron, and the robot has no brain");
    require_neuron(layers->require(sensor.layer, where + "/layer"), sensor.neuron, where + "/neuron");
  }
  if (sensor.kind == SensorKind::neighbors && !per_actuator)
    throw InputError(where, "neighbors are of a brain per actuator");
}

void validate_input(const Robot& robot, const Layers& layers, std::size_t senses, const NeuronLayer& layer,
                    const NeuronInput& input, const std::string& where) {
  const std::size_t size = size_of(senses, layers, input.from, where + "/from");
  if (size == 0) throw InputError(where + "/from", "the robot has no sensors");
  if (input.edges.empty() && input.weights.size() != layer.neurons * size)
    throw InputError(where + "/weights", std::to_string(input.weights.size()) + " weights; " +
                                             std::to_string(layer.neurons) + " neurons with " + std::to_string(size) +
                                             " inputs have " + std::to_string(layer.neurons * size));
  if (!input.edges.empty() && !input.weights.empty())
    throw InputError(where, "has both weights and edges; give one of them");
  for (const float weight : input.weights) require_finite(weight, where + "/weights");
  for (std::size_t k = 0; k < input.edges.size(); ++k) {
    const NeuronEdge& edge = input.edges[k];
    const std::string place = where + "/edges/" + std::to_string(k);
    require_finite(edge.weight, place);
    if (edge.to >= layer.neurons)
      throw InputError(place, "neuron " + std::to_string(edge.to) + " is out of range, the layer has " +
                                  std::to_string(layer.neurons));
    if (edge.from >= size)
      throw InputError(place,
                       "input " + std::to_string(edge.from) + " is out of range, there are " + std::to_string(size));
  }
  if (!(std::isfinite(input.rate) && input.rate >= 0 && input.rate <= 1))
    throw InputError(where + "/rate", "a rate is 0 to 1");
  if (input.rate > 0 && robot.brain->per_actuator)
    throw InputError(where + "/rate", "the copies of a brain per actuator share their weights, which cannot learn");
}

void validate_gates(const Layers& layers, const NeuronLayer& layer, const std::string& where) {
  const auto require_layer = [&](const std::string& name, const std::string& place) {
    if (name.empty()) return;
    const std::uint32_t neurons = layers.require(name, place).neurons;
    if (neurons != layer.neurons)
      throw InputError(place, "layer \"" + name + "\" has " + std::to_string(neurons) + " neurons, this layer " +
                                  std::to_string(layer.neurons) + "; they need as many");
  };
  require_layer(layer.gate, where + "/gate");
  require_layer(layer.keep_layer, where + "/keep");
  if (!layer.gate.empty() && !layer.alpha.empty())
    throw InputError(where, "has both alpha and a gate, which takes its place; give one of them");
  if (!layer.keep_layer.empty() && !layer.keep.empty())
    throw InputError(where + "/keep", "is both numbers and a layer; give one of them");
  for (const float keep : layer.keep)
    if (!(keep >= 0 && keep <= 1)) throw InputError(where + "/keep", "a keep is 0 to 1, or the name of a layer");
}

void validate_layer(const Robot& robot, const Layers& layers, std::size_t senses, std::size_t index) {
  const NeuronLayer& layer = robot.brain->layers[index];
  const std::string where = numbered("/brain/layers/", index);
  if (layer.name.empty() || layer.name == "senses" || layer.name.find('\0') != std::string::npos)
    throw InputError(where, "a layer needs a name other than \"senses\", without NUL characters");
  for (std::size_t k = 0; k < index; ++k)
    if (robot.brain->layers[k].name == layer.name)
      throw InputError(where, "has the name of layer " + std::to_string(k));
  if (layer.neurons == 0) throw InputError(where, "a layer needs at least one neuron");
  if (layer.inputs.size() > max_inputs)
    throw InputError(where + "/inputs", std::to_string(layer.inputs.size()) + " inputs, at most 256 are accepted");
  const auto require_count = [&](const std::vector<float>& numbers, const char* name, bool one_for_all) {
    if (!numbers.empty() && numbers.size() != layer.neurons && !(one_for_all && numbers.size() == 1))
      throw InputError(where + name, std::to_string(numbers.size()) + " numbers, the layer has " +
                                         std::to_string(layer.neurons) + " neurons");
  };
  require_count(layer.alpha, "/alpha", true);
  require_count(layer.keep, "/keep", true);
  require_count(layer.bias, "/bias", false);
  for (const float alpha : layer.alpha)
    if (!(alpha > 0 && alpha <= 1)) throw InputError(where + "/alpha", "an alpha is above 0 and at most 1");
  for (const float bias : layer.bias) require_finite(bias, where + "/bias");
  validate_gates(layers, layer, where);
  for (std::size_t k = 0; k < layer.inputs.size(); ++k)
    validate_input(robot, layers, senses, layer, layer.inputs[k], where + "/inputs/" + std::to_string(k));
}

void validate_outputs(const Robot& robot, const Layers& layers, const std::vector<Actuator>& actuators) {
  const Brain& brain = *robot.brain;
  const NeuronLayer& last = brain.layers.back();
  if (brain.per_actuator) {
    if (!brain.outputs.empty())
      throw InputError("/brain/outputs", "a brain per actuator drives each of them; leave it out");
    if (last.neurons != 1)
      throw InputError(numbered("/brain/layers/", brain.layers.size() - 1),
                       "the last layer of a brain per actuator has one neuron, not " + std::to_string(last.neurons));
    return;
  }
  if (brain.outputs.empty() && last.neurons != actuators.size())
    throw InputError(numbered("/brain/layers/", brain.layers.size() - 1),
                     "the last layer has " + std::to_string(last.neurons) + " neurons, the robot has " +
                         std::to_string(actuators.size()) + " actuators; name outputs, or make them equal");
  std::vector<bool> driven(actuators.size());
  for (std::size_t i = 0; i < brain.outputs.size(); ++i) {
    const NeuronOutput& output = brain.outputs[i];
    const std::string where = numbered("/brain/outputs/", i);
    require_neuron(layers.require(output.layer, where + "/layer"), output.neuron, where + "/neuron");
    const std::size_t actuator = find_actuator(actuators, output.actuator);
    if (actuator == actuators.size()) unknown_actuator(where + "/actuator", output.actuator, actuators);
    if (driven[actuator]) throw InputError(where + "/actuator", "is driven by an earlier output, too");
    driven[actuator] = true;
  }
}

// Calls visit(weight) for each weight, in the order of BrainLayout.
template <class ABrain, class Visit>
void for_each_weight(ABrain& brain, const Visit& visit) {
  for (auto& layer : brain.layers) {
    for (auto& bias : layer.bias) visit(bias);
    for (auto& input : layer.inputs) {
      for (auto& weight : input.weights) visit(weight);
      for (auto& edge : input.edges) visit(edge.weight);
    }
  }
}

std::vector<std::uint16_t> ends_of(const Robot& robot, const std::vector<std::uint32_t>& springs) {
  std::vector<std::uint16_t> masses;
  for (const std::uint32_t spring : springs) {
    masses.push_back(robot.springs[spring].a);
    masses.push_back(robot.springs[spring].b);
  }
  std::ranges::sort(masses);
  masses.erase(std::unique(masses.begin(), masses.end()), masses.end());
  return masses;
}

std::vector<std::uint32_t> springs_of(const Robot& robot, const Actuator& actuator) {
  std::array<bool, max_materials> wanted{};
  for (const MaterialId id : actuator.materials) wanted[id] = true;
  std::vector<std::uint32_t> springs;
  for (std::size_t i = 0; i < robot.springs.size(); ++i)
    if (wanted[robot.springs[i].material]) springs.push_back(static_cast<std::uint32_t>(i));
  return springs;
}

class PlanMaker {
 public:
  explicit PlanMaker(const Robot& robot)
      : robot_(robot), brain_(*robot.brain), layers_(brain_), actuators_(actuators_of(robot)),
        copies_(brain_.per_actuator ? actuators_.size() : 1), senses_per_copy_(sense_count(robot)) {}

  BrainPlan make() {
    plan_.period = brain_.period;
    plan_.seed = brain_.seed;
    plan_.weights = weights_of(brain_);
    std::size_t neurons = 0;
    for (const NeuronLayer& layer : brain_.layers) {
      first_.push_back(neurons);
      neurons += copies_ * layer.neurons;
    }
    plan_.places.emplace_back();  // the whole body
    place_of_actuator_.assign(actuators_.size(), BrainPlan::none);
    place_of_sensor_.assign(robot_.sensors.size(), BrainPlan::none);
    for (std::size_t copy = 0; copy < copies_; ++copy)
      for (std::size_t i = 0; i < robot_.sensors.size(); ++i) add_senses(i, copy);
    std::size_t weight = 0;
    for (std::size_t i = 0; i < brain_.layers.size(); ++i) weight = add_layer(i, weight);
    add_outputs();
    for (const BrainPlan::Sense& sense : plan_.senses) {
      plan_.samples = std::max(plan_.samples, std::size_t{sense.delay} + 1);
      plan_.uses_state |= description_of(sense.kind).place != SensorPlace::none;
      plan_.places[sense.place].measures |= measures_of(sense.kind);
      plan_.uses_frame |= needs_frame(sense.kind);
      plan_.uses_turn_rate |= sense.kind == SensorKind::turn_rate;
    }
    if (plan_.uses_frame) plan_.places[0].measures |= measure_center;
    if (plan_.uses_turn_rate) plan_.places[0].measures |= measure_velocity;
    return std::move(plan_);
  }

 private:
  static std::uint32_t index(std::size_t number) { return static_cast<std::uint32_t>(number); }

  std::uint32_t neuron_of(const std::string& layer, std::size_t neuron, std::size_t copy) const {
    const std::size_t found = layers_.index(layer);
    return index(first_[found] + copy * brain_.layers[found].neurons + neuron);
  }

  // The place of a sensor; those of the same actuator, and of the copies of a brain, share it.
  std::uint32_t place_of(std::size_t number, std::size_t copy) {
    const Sensor& sensor = robot_.sensors[number];
    if (!sensor.actuator.empty()) {
      const bool is_self = brain_.per_actuator && sensor.actuator == "self";
      const std::size_t actuator = is_self ? copy : find_actuator(actuators_, sensor.actuator);
      std::uint32_t& place = place_of_actuator_[actuator];
      if (place == BrainPlan::none) place = add_place(springs_of(robot_, actuators_[actuator]), {});
      return place;
    }
    if (sensor.springs.empty() && sensor.masses.empty()) return 0;
    std::uint32_t& place = place_of_sensor_[number];
    if (place == BrainPlan::none) place = add_place(sensor.springs, sensor.masses);
    return place;
  }

  std::uint32_t add_place(std::vector<std::uint32_t> springs, std::vector<std::uint16_t> masses) {
    if (masses.empty()) masses = ends_of(robot_, springs);
    plan_.places.push_back({std::move(springs), std::move(masses), 0});
    return index(plan_.places.size() - 1);
  }

  void add_senses(std::size_t number, std::size_t copy) {
    const Sensor& sensor = robot_.sensors[number];
    BrainPlan::Sense sense{.kind = sensor.kind,
                           .component = 0,
                           .gain = sensor.gain,
                           .noise = sensor.noise,
                           .frequency = sensor.frequency,
                           .phase = sensor.phase,
                           .delay = index(static_cast<std::size_t>(std::lround(sensor.delay / brain_.period)))};
    if (sensor.kind == SensorKind::neuron) sense.neuron = neuron_of(sensor.layer, sensor.neuron, copy);
    sense.place = place_of(number, copy);
    for (std::size_t k = 0; k < description_of(sensor.kind).width; ++k) {
      sense.component = index(k);
      if (sensor.kind == SensorKind::neighbors) {
        const std::size_t neighbor = k == 0 ? copy - 1 : copy + 1;  // wraps around to a large number before the first
        sense.neuron = neighbor < copies_ ? neuron_of(brain_.layers.back().name, 0, neighbor) : BrainPlan::none;
      }
      plan_.senses.push_back(sense);
    }
  }

  // Returns the first weight after the layer's.
  std::size_t add_layer(std::size_t number, std::size_t first_weight) {
    const NeuronLayer& layer = brain_.layers[number];
    BrainPlan::Layer added{.first = index(first_[number]),
                           .count = index(copies_ * layer.neurons),
                           .first_learning = index(plan_.learnings.size()),
                           .learnings = 0,
                           .first_gate = layer.is_gated() ? index(plan_.gates.size()) : BrainPlan::none};
    std::size_t weight = first_weight;
    edges_by_neuron_.clear();
    for (const NeuronInput& input : layer.inputs) {
      auto& by_neuron = edges_by_neuron_.emplace_back(input.edges.size());
      std::iota(by_neuron.begin(), by_neuron.end(), 0u);
      std::ranges::stable_sort(by_neuron, {}, [&](std::uint32_t k) { return input.edges[k].to; });
    }
    for (std::size_t copy = 0; copy < copies_; ++copy)
      for (std::size_t i = 0; i < layer.neurons; ++i) {
        weight = first_weight + layer.bias.size();
        BrainPlan::Neuron neuron{.first_run = index(plan_.runs.size()),
                                 .runs = 0,
                                 .bias = layer.bias.empty() ? BrainPlan::none : index(first_weight + i),
                                 .alpha = number_of(layer.alpha, i, 1),
                                 .activation = layer.activation};
        for (std::size_t k = 0; k < layer.inputs.size(); ++k) weight = add_runs(layer, k, added.first, copy, i, weight);
        neuron.runs = index(plan_.runs.size()) - neuron.first_run;
        plan_.neurons.push_back(neuron);
        if (layer.is_gated()) plan_.gates.push_back(gate_of(layer, copy, i));
      }
    added.learnings = index(plan_.learnings.size()) - added.first_learning;
    plan_.layers.push_back(added);
    return weight;
  }

  // Of a neuron in a list that has one number per neuron, one for all, or none.
  static float number_of(const std::vector<float>& numbers, std::size_t neuron, float otherwise) {
    return numbers.empty() ? otherwise : numbers[numbers.size() == 1 ? 0 : neuron];
  }

  BrainPlan::Gate gate_of(const NeuronLayer& layer, std::size_t copy, std::size_t neuron) const {
    const auto of = [&](const std::string& name, std::uint32_t otherwise) {
      return name.empty() ? otherwise : neuron_of(name, neuron, copy);
    };
    return {.gate = of(layer.gate, BrainPlan::none),
            .keep = of(layer.keep_layer, layer.keep.empty() ? BrainPlan::Gate::rest : BrainPlan::none),
            .constant = number_of(layer.keep, neuron, 0)};
  }

  std::size_t add_runs(const NeuronLayer& layer, std::size_t number, std::uint32_t first_neuron, std::size_t copy,
                       std::size_t neuron, std::size_t weight) {
    const NeuronInput& input = layer.inputs[number];
    const bool of_senses = input.from == "senses";
    const std::size_t size = of_senses ? senses_per_copy_ : brain_.layers[layers_.index(input.from)].neurons;
    const std::size_t source =
        of_senses ? copy * senses_per_copy_ : copies_ * senses_per_copy_ + neuron_of(input.from, 0, copy);
    const auto learn = [&](std::size_t from, std::size_t of) {
      if (input.rate > 0)
        plan_.learnings.push_back(
            {index(first_neuron + copy * layer.neurons + neuron), index(from), index(of), input.rate});
    };
    if (input.edges.empty()) {
      plan_.runs.push_back({index(source), index(size), index(weight + neuron * size)});
      for (std::size_t k = 0; k < size; ++k) learn(source + k, weight + neuron * size + k);
      return weight + input.weights.size();
    }
    const auto to = [&](std::uint32_t k) { return input.edges[k].to; };
    const std::vector<std::uint32_t>& order = edges_by_neuron_[number];
    for (auto k = std::ranges::lower_bound(order, index(neuron), {}, to); k != order.end() && to(*k) == neuron; ++k) {
      plan_.runs.push_back({index(source + input.edges[*k].from), 1, index(weight + *k)});
      learn(source + input.edges[*k].from, weight + *k);
    }
    return weight + input.edges.size();
  }

  void add_outputs() {
    for (const NeuronOutput& output : brain_.outputs)
      plan_.outputs.push_back(
          {index(find_actuator(actuators_, output.actuator)), neuron_of(output.layer, output.neuron, 0)});
    if (!brain_.outputs.empty()) return;
    const std::string& last = brain_.layers.back().name;
    for (std::size_t i = 0; i < actuators_.size(); ++i)
      plan_.outputs.push_back({index(i), brain_.per_actuator ? neuron_of(last, 0, i) : neuron_of(last, i, 0)});
  }

  const Robot& robot_;
  const Brain& brain_;
  const Layers layers_;
  const std::vector<Actuator> actuators_;
  const std::size_t copies_, senses_per_copy_;
  std::vector<std::size_t> first_;  // neuron of each layer
  std::vector<std::uint32_t> place_of_actuator_, place_of_sensor_;
  std::vector<std::vector<std::uint32_t>> edges_by_neuron_;  // of each input of a layer, sorted
  BrainPlan plan_;
};

// "x", "y", "z", or what else a sensor's numbers are.
std::string component_name(SensorKind kind, std::size_t component) {
  constexpr const char* axes[] = {" x", " y", " z"};
  const std::size_t width = description_of(kind).width;
  if (width == 3) return axes[component];
  if (kind == SensorKind::clock) return component == 0 ? " sine" : " cosine";
  if (kind == SensorKind::neighbors) return component == 0 ? " previous" : " next";
  return "";
}

}  // namespace

void validate_brain(const Robot& robot) {
  if (robot.sensors.empty() && !robot.brain) return;
  const std::vector<Actuator> actuators = actuators_of(robot);
  std::optional<Layers> layers;
  if (robot.brain) layers.emplace(*robot.brain);
  for (std::size_t i = 0; i < robot.sensors.size(); ++i)
    validate_sensor(robot, actuators, layers ? &*layers : nullptr, i);
  if (!robot.brain) return;
  const Brain& brain = *robot.brain;
  if (!(std::isfinite(brain.period) && brain.period > 0)) throw InputError("/brain/period", "must be above 0 s");
  if (brain.layers.empty()) throw InputError("/brain/layers", "a brain needs at least one layer");
  if (actuators.empty()) throw InputError("/brain", "the robot has no actuator that it could drive");
  const std::size_t copies = brain.per_actuator ? actuators.size() : 1;
  std::size_t neurons = 0, weights = 0;
  for (const NeuronLayer& layer : brain.layers) {
    neurons += copies * layer.neurons;
    weights += layer.bias.size();
    for (const NeuronInput& input : layer.inputs) weights += input.weights.size() + input.edges.size();
  }
  const auto require_few = [](std::size_t count, std::size_t most, const char* what) {
    if (count > most)
      throw InputError("/brain",
                       std::to_string(count) + " " + what + ", at most " + std::to_string(most) + " are accepted");
  };
  require_few(copies * sense_count(robot), max_senses, "senses");
  require_few(neurons, max_neurons, "neurons");
  require_few(weights, max_weights, "weights");
  for (std::size_t i = 0; i < brain.layers.size(); ++i) validate_layer(robot, *layers, sense_count(robot), i);
  validate_outputs(robot, *layers, actuators);
  constexpr float longest = 10000;
  for (std::size_t i = 0; i < robot.sensors.size(); ++i)
    if (robot.sensors[i].delay / brain.period > longest)
      throw InputError(numbered("/sensors/", i) + "/delay", "is more than 10000 periods of the brain");
}

std::vector<float> weights_of(const Brain& brain) {
  std::vector<float> weights;
  for_each_weight(brain, [&](const float& weight) { weights.push_back(weight); });
  return weights;
}

void set_weights(Brain& brain, const std::vector<float>& weights) {
  if (weights_of(brain).size() != weights.size())
    throw std::invalid_argument(std::to_string(weights.size()) + " weights, the brain has " +
                                std::to_string(weights_of(brain).size()));
  std::size_t next = 0;
  for_each_weight(brain, [&](float& weight) { weight = weights[next++]; });
}

BrainState state_at_start(const BrainPlan& plan) {
  return {.neurons = std::vector<float>(plan.neurons.size()),
          .senses = std::vector<float>(plan.samples * plan.senses.size()),
          .weights = plan.weights,
          .thoughts = 0};
}

BrainState brain_at_start(const Robot& robot) {
  return robot.brain ? state_at_start(make_brain_plan(robot)) : BrainState{};
}

BrainPlan make_brain_plan(const Robot& robot) { return PlanMaker(robot).make(); }

BrainLayout brain_layout(const Robot& robot) {
  BrainLayout layout;
  if (!robot.brain) return layout;
  const BrainPlan plan = make_brain_plan(robot);
  const std::vector<Actuator> actuators = actuators_of(robot);
  const std::size_t copies = robot.brain->per_actuator ? actuators.size() : 1;
  const auto of_copy = [&](std::size_t copy) {
    return robot.brain->per_actuator ? " of " + actuators[copy].name : std::string();
  };
  for (std::size_t copy = 0; copy < copies; ++copy)
    for (const Sensor& sensor : robot.sensors)
      for (std::size_t k = 0; k < description_of(sensor.kind).width; ++k) {
        std::string name(description_of(sensor.kind).name);
        if (!sensor.actuator.empty() && sensor.actuator != "self") name += " " + sensor.actuator;
        if (sensor.kind == SensorKind::neuron) name = sensor.layer + " " + std::to_string(sensor.neuron);
        layout.senses.push_back(name + component_name(sensor.kind, k) + of_copy(copy));
      }
  for (const NeuronLayer& layer : robot.brain->layers)
    for (std::size_t copy = 0; copy < copies; ++copy)
      for (std::size_t i = 0; i < layer.neurons; ++i)
        layout.neurons.push_back(layer.name + " " + std::to_string(i) + of_copy(copy));
  layout.weights = plan.weights.size();
  for (const BrainPlan::Output& output : plan.outputs) {
    layout.outputs.push_back(output.neuron);
    layout.driven.push_back(output.actuator);
  }
  return layout;
}

bool seeks_target(const Robot& robot) {
  return std::ranges::any_of(robot.sensors, [](const Sensor& sensor) {
    return sensor.kind == SensorKind::target_direction || sensor.kind == SensorKind::target_distance;
  });
}

bool seeks_light(const Robot& robot) { return std::ranges::count(robot.sensors, SensorKind::light, &Sensor::kind) > 0; }

std::vector<std::vector<std::uint16_t>> touch_places(const Robot& robot) {
  std::vector<std::vector<std::uint16_t>> places;
  if (!robot.brain || !std::ranges::count(robot.sensors, SensorKind::touch, &Sensor::kind)) return places;
  const BrainPlan plan = make_brain_plan(robot);
  for (const BrainPlan::Place& place : plan.places) {
    if (!(place.measures & measure_touch)) continue;
    std::vector<std::uint16_t>& masses = places.emplace_back(place.masses);
    if (&place != &plan.places.front()) continue;
    masses.resize(robot.masses.size());  // the whole robot
    std::iota(masses.begin(), masses.end(), std::uint16_t{0});
  }
  return places;
}

}  // namespace mercury
