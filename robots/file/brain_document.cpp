// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mercury/error.h"
#include "mercury/number_text.h"
#include "mercury/robot_file.h"
#include "robots/file/robot_document.h"

namespace mercury {
namespace {

using Json = nlohmann::json;

// A value and where it stands.
class Part {
 public:
  Part(const Json& value, std::string place) : value_(value), place_(std::move(place)) {}

  [[noreturn]] void refuse(const std::string& what) const { throw InputError(place_, what); }
  [[noreturn]] void wrong(const char* wanted) const {
    refuse(std::string("must be ") + wanted + ", not " + (value_.is_null() ? "null" : "a" + std::string(of_type())));
  }

  bool has(const char* key) const { return value_.contains(key); }
  Part at(const char* key) const {
    const auto found = value_.find(key);
    if (found == value_.end()) throw InputError(place_, std::string(key) + " is missing");
    return {*found, place_ + "/" + key};
  }
  const Part& object() const {
    if (!value_.is_object()) wrong("an object");
    return *this;
  }

  std::string text() const {
    if (!value_.is_string()) wrong("a text");
    return value_.get<std::string>();
  }
  // Of a layer, which has no empty one.
  std::string name() const {
    if (text().empty()) refuse("must name a layer");
    return text();
  }
  float number() const {
    if (!value_.is_number()) wrong("a number");
    const double number = value_.get<double>();
    if (!(std::fabs(number) <= static_cast<double>(std::numeric_limits<float>::max())))
      refuse("is not a finite 32-bit number");
    return static_cast<float>(number);
  }
  std::uint64_t whole(std::uint64_t most) const {
    if (!value_.is_number_unsigned()) wrong("a whole number");
    const auto number = value_.get<std::uint64_t>();
    if (number > most) refuse(std::to_string(number) + " is out of range, at most " + std::to_string(most));
    return number;
  }

  template <class Visit>
  void for_each(const Visit& visit) const {
    if (!value_.is_array()) wrong("an array");
    std::size_t index = 0;
    for (const Json& element : value_) visit(Part(element, place_ + "/" + std::to_string(index++)));
  }
  // The texts of places are made only where they are needed: a matrix has a million numbers.
  std::vector<float> numbers() const {
    if (!value_.is_array()) wrong("an array");
    std::vector<float> all;
    all.reserve(value_.size());
    for (const Json& element : value_) {
      const bool is_float = element.is_number() &&
                            std::fabs(element.get<double>()) <= static_cast<double>(std::numeric_limits<float>::max());
      all.push_back(is_float ? static_cast<float>(element.get<double>())
                             : Part(element, place_ + "/" + std::to_string(all.size())).number());
    }
    return all;
  }
  bool is_array() const { return value_.is_array(); }
  bool is_text() const { return value_.is_string(); }

 private:
  std::string_view of_type() const {
    switch (value_.type()) {
      case Json::value_t::object:
        return "n object";
      case Json::value_t::array:
        return "n array";
      case Json::value_t::string:
        return " text";
      case Json::value_t::boolean:
        return value_.get<bool>() ? " true" : " false";
      default:
        return " number";
    }
  }

  const Json& value_;
  std::string place_;
};

std::string text_or(const Part& part, const char* key, const char* otherwise) {
  return part.has(key) ? part.at(key).text() : otherwise;
}

template <class Names>
std::size_t index_of(const Part& part, const Names& names, const char* what) {
  const std::string given = part.text();
  std::string known;
  for (std::size_t i = 0; i < std::size(names); ++i) {
    if (names[i] == given) return i;
    known.append(i == 0 ? "" : ", ").append(names[i]);
  }
  part.refuse("\"" + given.substr(0, 40) + "\" is no " + what + "; there are " + known);
}

constexpr auto kind_names = [] {
  std::array<std::string_view, sensor_descriptions.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = sensor_descriptions[i].name;
  return names;
}();

Sensor sensor_of(const Part& part) {
  part.object();
  Sensor sensor;
  sensor.kind = sensor_descriptions[index_of(part.at("kind"), kind_names, "kind of sensor")].kind;
  sensor.actuator = text_or(part, "actuator", "");
  if (part.has("springs"))
    part.at("springs").for_each([&](const Part& spring) {
      sensor.springs.push_back(static_cast<std::uint32_t>(spring.whole(std::numeric_limits<std::uint32_t>::max())));
    });
  if (part.has("masses"))
    part.at("masses").for_each(
        [&](const Part& mass) { sensor.masses.push_back(static_cast<std::uint16_t>(mass.whole(max_masses - 1))); });
  sensor.layer = text_or(part, "layer", "");
  if (part.has("neuron")) sensor.neuron = static_cast<std::uint32_t>(part.at("neuron").whole(max_neurons));
  for_each_parameter(sensor, [&](const auto& parameter, float& value) {
    const std::string name(parameter.name);
    if (part.has(name.c_str())) value = part.at(name.c_str()).number();
  });
  return sensor;
}

NeuronInput input_of(const Part& part, std::size_t neurons) {
  part.object();
  NeuronInput input{.from = part.at("from").text(), .weights = {}, .edges = {}};
  if (part.has("rate")) input.rate = part.at("rate").number();
  if (part.has("weights")) {
    std::size_t rows = 0, width = 0;
    part.at("weights").for_each([&](const Part& row) {
      const std::vector<float> numbers = row.numbers();
      if (rows++ == 0) width = numbers.size();
      if (numbers.size() != width)
        row.refuse(std::to_string(numbers.size()) + " numbers, the rows before it have " + std::to_string(width));
      input.weights.insert(input.weights.end(), numbers.begin(), numbers.end());
      if (input.weights.size() > max_weights) row.refuse("more than 4194304 weights");
    });
    if (rows != neurons)
      part.at("weights").refuse(std::to_string(rows) + " rows, the layer has " + std::to_string(neurons) + " neurons");
  }
  if (part.has("edges"))
    part.at("edges").for_each([&](const Part& edge) {
      std::size_t column = 0;
      NeuronEdge read;
      edge.for_each([&](const Part& number) {
        if (column == 2) read.weight = number.number();
        if (column < 2) (column == 0 ? read.to : read.from) = static_cast<std::uint32_t>(number.whole(max_neurons));
        ++column;
      });
      if (column != 3) edge.refuse("an edge is [to, from, weight]");
      input.edges.push_back(read);
    });
  if (!part.has("weights") && !part.has("edges")) part.refuse("weights or edges are missing");
  return input;
}

NeuronLayer layer_of(const Part& part) {
  part.object();
  NeuronLayer layer;
  layer.name = part.at("name").text();
  layer.neurons = static_cast<std::uint32_t>(part.at("neurons").whole(max_neurons));
  if (part.has("activation"))
    layer.activation = static_cast<Activation>(index_of(part.at("activation"), activation_names, "activation"));
  if (part.has("alpha")) {
    const Part alpha = part.at("alpha");
    layer.alpha = alpha.is_array() ? alpha.numbers() : std::vector<float>{alpha.number()};
  }
  if (part.has("gate")) layer.gate = part.at("gate").name();
  if (part.has("keep")) {
    const Part keep = part.at("keep");
    if (keep.is_text())
      layer.keep_layer = keep.name();
    else
      layer.keep = keep.is_array() ? keep.numbers() : std::vector<float>{keep.number()};
    if (keep.is_array() && layer.keep.empty()) keep.refuse("an empty list; leave it out for 1 - gate");
  }
  if (part.has("bias")) layer.bias = part.at("bias").numbers();
  if (part.has("inputs"))
    part.at("inputs").for_each([&](const Part& input) { layer.inputs.push_back(input_of(input, layer.neurons)); });
  return layer;
}

// A robot's document has been read as JSON before; a recording may hold any text.
Json parsed(std::string_view text, const char* place) {
  Json document = Json::parse(text, nullptr, false);
  if (document.is_discarded()) throw InputError(place, "is not valid JSON");
  return document;
}

class Writer {
 public:
  explicit Writer(DocumentEvents& events) : events_(events) {}

  void key(std::string_view name) { events_.key(name); }
  // With a text that is this float also for who reads a double first, as the reader above does.
  void number(float value) {
    text_ = shortest_text(value);
    Number number = real_number(value, room_);
    if (value != 0) number.text = text_;
    events_.number(number);
  }
  void whole(std::uint64_t value) { events_.number(natural_number(value)); }
  void text(std::string_view name, std::string_view value) { key(name), events_.text(value); }
  void number(std::string_view name, float value) { key(name), number(value); }
  void whole(std::string_view name, std::uint64_t value) { key(name), whole(value); }

  template <class List, class Write>
  void list(const List& values, const Write& write) {
    events_.begin_array(std::size(values));
    for (const auto& value : values) write(value);
    events_.end_array();
  }
  template <class List, class Write>
  void list(std::string_view name, const List& values, const Write& write) {
    key(name);
    list(values, write);
  }
  void numbers(std::string_view name, std::span<const float> values) {
    list(name, values, [&](float value) { number(value); });
  }
  // One for all; nothing if there is none.
  void number_or_numbers(std::string_view name, std::span<const float> values) {
    if (values.size() == 1) number(name, values[0]);
    if (values.size() > 1) numbers(name, values);
  }
  template <class Write>
  void object(const Write& write) {
    events_.begin_object(unknown_length);
    write();
    events_.end_object();
  }

 private:
  DocumentEvents& events_;
  std::array<char, 32> room_{};
  std::string text_;
};

void write_input(const NeuronInput& input, std::size_t neurons, Writer& to) {
  to.object([&] {
    to.text("from", input.from);
    if (input.edges.empty()) {
      std::vector<std::span<const float>> rows;
      const std::size_t width = input.weights.size() / std::max<std::size_t>(1, neurons);
      for (std::size_t i = 0; i < neurons; ++i) rows.push_back(std::span(input.weights).subspan(i * width, width));
      to.list("weights", rows,
              [&](std::span<const float> row) { to.list(row, [&](float weight) { to.number(weight); }); });
    } else {
      to.list("edges", input.edges, [&](const NeuronEdge& edge) {
        to.list(std::array{0, 1, 2}, [&](int column) {
          if (column == 2) return to.number(edge.weight);
          to.whole(column == 0 ? edge.to : edge.from);
        });
      });
    }
    if (input.rate != 0) to.number("rate", input.rate);
  });
}

}  // namespace

void set_sensors(Robot& robot, std::string_view text) {
  const Json document = parsed(text, "/sensors");
  robot.sensors.clear();
  Part(document, "/sensors").for_each([&](const Part& sensor) {
    if (robot.sensors.size() == max_senses) sensor.refuse("more than 4096 sensors, at most 4096 are accepted");
    robot.sensors.push_back(sensor_of(sensor));
  });
}

void set_brain(Robot& robot, std::string_view text) {
  const Json document = parsed(text, "/brain");
  const Part part(document, "/brain");
  part.object();
  Brain& brain = robot.brain.emplace();
  if (part.has("period")) brain.period = part.at("period").number();
  constexpr std::array<std::string_view, 2> pers{"robot", "actuator"};
  if (part.has("per")) brain.per_actuator = index_of(part.at("per"), pers, "copy of a brain") == 1;
  if (part.has("seed")) brain.seed = part.at("seed").whole(std::numeric_limits<std::uint64_t>::max());
  part.at("layers").for_each([&](const Part& layer) {
    if (brain.layers.size() == max_neurons) layer.refuse("more than 4096 layers, at most 4096 are accepted");
    brain.layers.push_back(layer_of(layer));
  });
  if (!part.has("outputs")) return;
  part.at("outputs").for_each([&](const Part& output) {
    output.object();
    brain.outputs.push_back({.actuator = output.at("actuator").text(),
                             .layer = output.at("layer").text(),
                             .neuron = static_cast<std::uint32_t>(output.at("neuron").whole(max_neurons))});
  });
  if (brain.outputs.empty()) part.at("outputs").refuse("an empty list; leave it out for one output per actuator");
}

std::string sensors_as_json(const Robot& robot) {
  std::string text;
  JsonWriter json(text);
  write_sensors(robot, json);
  return text;
}

std::string brain_as_json(const Brain& brain) {
  std::string text;
  JsonWriter json(text);
  write_brain(brain, json);
  return text;
}

void write_sensors(const Robot& robot, DocumentEvents& events) {
  Writer to(events);
  to.list(robot.sensors, [&](const Sensor& sensor) {
    to.object([&] {
      to.text("kind", description_of(sensor.kind).name);
      if (!sensor.actuator.empty()) to.text("actuator", sensor.actuator);
      if (!sensor.springs.empty()) to.list("springs", sensor.springs, [&](std::uint32_t spring) { to.whole(spring); });
      if (!sensor.masses.empty()) to.list("masses", sensor.masses, [&](std::uint16_t mass) { to.whole(mass); });
      if (!sensor.layer.empty()) to.text("layer", sensor.layer), to.whole("neuron", sensor.neuron);
      for_each_parameter(sensor, [&](const auto& parameter, float value) {
        if (value != parameter.default_value()) to.number(parameter.name, value);
      });
    });
  });
}

void write_brain(const Brain& brain, DocumentEvents& events) {
  Writer to(events);
  to.object([&] {
    to.number("period", brain.period);
    if (brain.per_actuator) to.text("per", "actuator");
    if (brain.seed != 0) to.whole("seed", brain.seed);
    to.list("layers", brain.layers, [&](const NeuronLayer& layer) {
      to.object([&] {
        to.text("name", layer.name);
        to.whole("neurons", layer.neurons);
        to.text("activation", activation_names[static_cast<std::size_t>(layer.activation)]);
        to.number_or_numbers("alpha", layer.alpha);
        if (!layer.gate.empty()) to.text("gate", layer.gate);
        to.number_or_numbers("keep", layer.keep);
        if (!layer.keep_layer.empty()) to.text("keep", layer.keep_layer);
        if (!layer.bias.empty()) to.numbers("bias", layer.bias);
        if (!layer.inputs.empty())
          to.list("inputs", layer.inputs, [&](const NeuronInput& input) { write_input(input, layer.neurons, to); });
      });
    });
    if (!brain.outputs.empty())
      to.list("outputs", brain.outputs, [&](const NeuronOutput& output) {
        to.object([&] {
          to.text("actuator", output.actuator);
          to.text("layer", output.layer);
          to.whole("neuron", output.neuron);
        });
      });
  });
}

}  // namespace mercury
