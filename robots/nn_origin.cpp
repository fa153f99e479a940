// SPDX-License-Identifier: Apache-2.0
// The genome of a network robot as the JSON text of its origin.
#include <nlohmann/json.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <map>

#include "mercury/error.h"
#include "mercury/nn_robot.h"
#include "mercury/origin.h"
#include "robots/document.h"

namespace mercury {
namespace {

// Real numbers are parsed as floats: parsed as doubles and rounded again, the shortest decimals of a float could come
// back one bit off.
using Json = nlohmann::basic_json<std::map, std::vector, std::string, bool, std::int64_t, std::uint64_t, float>;

void write(std::string& out, float value) {
  std::array<char, 32> room;
  const auto end = std::to_chars(room.data(), room.data() + room.size(), value).ptr;
  out.append(room.data(), end);
  if (value == 0 && std::signbit(value)) out += ".0";  // "-0" would be read as a whole number and lose its sign
}

// [a, b, c], each written by `write_item`.
template <typename Items, typename WriteItem>
void write_list(std::string& out, const Items& items, WriteItem write_item) {
  out += '[';
  bool first = true;
  for (const auto& item : items) {
    if (!first) out += ',';
    first = false;
    write_item(item);
  }
  out += ']';
}

void write_numbers(std::string& out, std::span<const float> numbers) {
  write_list(out, numbers, [&](float number) { write(out, number); });
}

void write_rows(std::string& out, const Layer& layer) {
  const auto inputs = static_cast<std::size_t>(layer.inputs);
  std::vector<std::span<const float>> rows;
  for (std::size_t begin = 0; begin < layer.weights.size(); begin += inputs)
    rows.push_back(std::span(layer.weights).subspan(begin, inputs));
  write_list(out, rows, [&](std::span<const float> row) { write_numbers(out, row); });
}

[[noreturn]] void refuse(const std::string& place, const std::string& what) {
  throw InputError("/origin" + place, what);
}

const Json& member(const Json& origin, const char* key) {
  const auto found = origin.find(key);
  if (found == origin.end()) refuse(std::string("/") + key, "is missing");
  return *found;
}

const Json& list(const Json& value, const std::string& place) {
  if (!value.is_array()) refuse(place, "an array is expected");
  return value;
}

std::uint64_t natural(const Json& origin, const char* key) {
  const Json& value = member(origin, key);
  if (!value.is_number_unsigned()) refuse(std::string("/") + key, "a whole number >= 0 is expected");
  return value.get<std::uint64_t>();
}

void append_numbers(std::vector<float>& numbers, const Json& value, const std::string& place) {
  for (const Json& number : list(value, place)) {
    if (!number.is_number()) refuse(place, "numbers are expected");
    numbers.push_back(number.get<float>());
  }
}

Layer read_layer(const Json& rows, const Json& biases, std::size_t index) {
  const std::string weights_place = "/weights/" + std::to_string(index);
  Layer layer;
  for (const Json& row : list(rows, weights_place)) {
    const std::size_t before = layer.weights.size();
    append_numbers(layer.weights, row, weights_place + "/" + std::to_string(layer.outputs++));
    const auto inputs = static_cast<int>(layer.weights.size() - before);
    if (layer.outputs > 1 && inputs != layer.inputs) refuse(weights_place, "rows of equal length are expected");
    layer.inputs = inputs;
  }
  append_numbers(layer.biases, biases, "/biases/" + std::to_string(index));
  return layer;
}

Network read_network(const Json& origin) {
  const Json& weights = list(member(origin, "weights"), "/weights");
  const Json& biases = list(member(origin, "biases"), "/biases");
  if (weights.size() != biases.size()) refuse("/biases", "as many lists as there are layers of weights are expected");
  Network network;
  for (std::size_t i = 0; i < weights.size(); ++i) network.layers.push_back(read_layer(weights[i], biases[i], i));
  const Json& sizes = list(member(origin, "sizes"), "/sizes");
  const std::vector<int> found = sizes_of(network);
  bool same = sizes.size() == found.size();
  for (std::size_t i = 0; same && i < found.size(); ++i)
    same = sizes[i].is_number_unsigned() && sizes[i].get<std::uint64_t>() == static_cast<std::uint64_t>(found[i]);
  if (!same) refuse("/sizes", "the sizes of the layers in weights are expected");
  return network;
}

}  // namespace

std::string to_origin(const NnGenome& genome) {
  std::string out = R"({"kind":"nn","cloud_seed":)" + std::to_string(genome.cloud_seed) +
                    ",\"points\":" + std::to_string(genome.points) +
                    ",\"mirrored\":" + (genome.mirrored ? "true" : "false") + ",\"alpha\":";
  write(out, genome.alpha);
  if (genome.spacing != 0) {
    out += ",\"spacing\":";
    write(out, genome.spacing);
  }
  constexpr std::size_t usual_length = 13;  // of a number and its comma
  std::size_t numbers = 0;
  for (const Layer& layer : genome.network.layers) numbers += layer.weights.size() + layer.biases.size();
  out.reserve(out.size() + 256 + usual_length * numbers);
  if (!genome.environment.empty()) out += ",\"environment\":" + json_text(genome.environment);
  out += ",\"sizes\":";
  write_list(out, sizes_of(genome.network), [&](int size) { out += std::to_string(size); });
  out += ",\"weights\":";
  write_list(out, genome.network.layers, [&](const Layer& layer) { write_rows(out, layer); });
  out += ",\"biases\":";
  write_list(out, genome.network.layers, [&](const Layer& layer) { write_numbers(out, layer.biases); });
  return out += '}';
}

std::optional<NnGenome> nn_genome_of(const Robot& robot) {
  if (robot.origin.empty()) return std::nullopt;
  const Json origin = Json::parse(robot.origin, nullptr, false);
  if (!origin.is_object()) refuse("", "a JSON object is expected");
  if (kind_of(robot) != "nn") return std::nullopt;
  NnGenome genome;
  genome.network = read_network(origin);
  genome.cloud_seed = natural(origin, "cloud_seed");
  genome.points = natural(origin, "points");
  const Json& mirrored = member(origin, "mirrored");
  if (!mirrored.is_boolean()) refuse("/mirrored", "true or false is expected");
  genome.mirrored = mirrored.get<bool>();
  const Json& alpha = member(origin, "alpha");
  if (!alpha.is_number()) refuse("/alpha", "a number of metres is expected");
  genome.alpha = alpha.get<float>();
  if (const auto spacing = origin.find("spacing"); spacing != origin.end()) {  // files before 0.3.0 lack it
    if (!spacing->is_number()) refuse("/spacing", "a share of the mean spacing is expected");
    genome.spacing = spacing->get<float>();
  }
  genome.environment = environment_of(robot);
  try {
    validate(genome);
  } catch (const InputError& error) {
    refuse("", error.what());
  }
  return genome;
}

}  // namespace mercury
