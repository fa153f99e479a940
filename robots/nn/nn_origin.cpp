// SPDX-License-Identifier: Apache-2.0
// The genome of a network robot as the JSON text of its origin.

#include <algorithm>
#include <cstdint>

#include "mercury/error.h"
#include "mercury/nn_robot.h"
#include "robots/file/document.h"
#include "robots/origin_json.h"

namespace mercury {
namespace {

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

const OriginJson& list(const OriginJson& value, const std::string& place) {
  if (!value.is_array()) refuse_origin(place, "an array is expected");
  return value;
}

std::uint64_t natural(const OriginJson& origin, const char* key) {
  const OriginJson& value = origin_member(origin, key);
  if (!value.is_number_unsigned()) refuse_origin(std::string("/") + key, "a whole number >= 0 is expected");
  return value.get<std::uint64_t>();
}

float number(const OriginJson& origin, const char* key, const char* expected) {
  const OriginJson& value = origin_member(origin, key);
  if (!value.is_number()) refuse_origin(std::string("/") + key, expected);
  return value.get<float>();
}

void append_numbers(std::vector<float>& numbers, const OriginJson& value, const std::string& place) {
  for (const OriginJson& number : list(value, place)) {
    if (!number.is_number()) refuse_origin(place, "numbers are expected");
    numbers.push_back(number.get<float>());
  }
}

Layer read_layer(const OriginJson& rows, const OriginJson& biases, std::size_t index) {
  const std::string weights_place = "/weights/" + std::to_string(index);
  Layer layer;
  for (const OriginJson& row : list(rows, weights_place)) {
    const std::size_t before = layer.weights.size();
    append_numbers(layer.weights, row, weights_place + "/" + std::to_string(layer.outputs++));
    const auto inputs = static_cast<int>(layer.weights.size() - before);
    if (layer.outputs > 1 && inputs != layer.inputs) refuse_origin(weights_place, "rows of equal length are expected");
    layer.inputs = inputs;
  }
  append_numbers(layer.biases, biases, "/biases/" + std::to_string(index));
  return layer;
}

Network read_network(const OriginJson& origin) {
  const OriginJson& weights = list(origin_member(origin, "weights"), "/weights");
  const OriginJson& biases = list(origin_member(origin, "biases"), "/biases");
  if (weights.size() != biases.size())
    refuse_origin("/biases", "as many lists as there are layers of weights are expected");
  Network network;
  for (std::size_t i = 0; i < weights.size(); ++i) network.layers.push_back(read_layer(weights[i], biases[i], i));
  const OriginJson& sizes = list(origin_member(origin, "sizes"), "/sizes");
  const std::vector<int> found = sizes_of(network);
  bool same = sizes.size() == found.size();
  for (std::size_t i = 0; same && i < found.size(); ++i)
    same = sizes[i].is_number_unsigned() && sizes[i].get<std::uint64_t>() == static_cast<std::uint64_t>(found[i]);
  if (!same) refuse_origin("/sizes", "the sizes of the layers in weights are expected");
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
  if (genome.network.has_fields()) {
    out += ",\"frequencies\":" + std::to_string(genome.frequencies) + ",\"frequency\":";
    write(out, genome.frequency);
    out += ",\"amplitude\":";
    write(out, genome.amplitude);
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
  const OriginJson origin = OriginJson::parse(robot.origin, nullptr, false);
  if (!origin.is_object()) refuse_origin("", "a JSON object is expected");
  if (text_in(origin, "kind") != "nn") return std::nullopt;
  NnGenome genome;
  genome.network = read_network(origin);
  genome.cloud_seed = natural(origin, "cloud_seed");
  genome.points = natural(origin, "points");
  const OriginJson& mirrored = origin_member(origin, "mirrored");
  if (!mirrored.is_boolean()) refuse_origin("/mirrored", "true or false is expected");
  genome.mirrored = mirrored.get<bool>();
  genome.alpha = number(origin, "alpha", "a number of meters is expected");
  if (genome.network.has_fields()) {
    genome.frequencies = static_cast<int>(std::min<std::uint64_t>(natural(origin, "frequencies"), INT32_MAX));
    genome.frequency = number(origin, "frequency", "a number of rad/s is expected");
    genome.amplitude = number(origin, "amplitude", "a number is expected");
  }
  if (const auto spacing = origin.find("spacing"); spacing != origin.end()) {  // files before 0.3.0 lack it
    if (!spacing->is_number()) refuse_origin("/spacing", "a share of the mean spacing is expected");
    genome.spacing = spacing->get<float>();
  }
  genome.environment = text_in(origin, "environment");
  try {
    validate(genome);
  } catch (const InputError& error) {
    refuse_origin("", error.what());
  }
  return genome;
}

}  // namespace mercury
