// SPDX-License-Identifier: Apache-2.0
// The genome of a painted voxel robot as the JSON text of its origin.
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>

#include "mercury/cppn.h"
#include "mercury/error.h"
#include "mercury/origin.h"
#include "robots/document.h"

namespace mercury {
namespace {

// Real numbers are parsed as floats: parsed as doubles and rounded again, the shortest decimals of a float could come
// back one bit off.
using Json = nlohmann::basic_json<std::map, std::vector, std::string, bool, std::int64_t, std::uint64_t, float>;

constexpr std::array<std::string_view, 4> mirror_names{"none", "x", "y", "z"};

void write(std::string& out, float value) {
  std::array<char, 32> room;
  out.append(room.data(), std::to_chars(room.data(), room.data() + room.size(), value).ptr);
  if (value == 0 && std::signbit(value)) out += ".0";  // "-0" would be read as a whole number and lose its sign
}

[[noreturn]] void refuse(const std::string& place, const std::string& what) {
  throw InputError("/origin" + place, what);
}

const Json& member(const Json& origin, const char* key) {
  const auto found = origin.find(key);
  if (found == origin.end()) refuse(std::string("/") + key, "is missing");
  return *found;
}

// The items of a list of at most `most`, each a list of three.
template <class Read>
void read_triples(const Json& origin, const char* key, std::size_t most, Read read) {
  const Json& list = member(origin, key);
  const std::string place = std::string("/") + key;
  if (!list.is_array()) refuse(place, "an array is expected");
  if (list.size() > most) refuse(place, "at most " + std::to_string(most) + " are accepted");
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list[i].is_array() || list[i].size() != 3)
      refuse(place + "/" + std::to_string(i), "a list of three is expected");
    read(list[i], place + "/" + std::to_string(i));
  }
}

std::uint32_t natural(const Json& value, const std::string& place) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > UINT32_MAX)
    refuse(place, "a whole number >= 0 is expected");
  return value.get<std::uint32_t>();
}

int small_natural(const Json& value, const std::string& place) {
  return static_cast<int>(std::min<std::uint32_t>(natural(value, place), INT32_MAX));
}

float number(const Json& value, const std::string& place) {
  if (!value.is_number()) refuse(place, "a number is expected");
  return value.get<float>();
}

template <std::size_t n>
std::size_t word(const Json& value, const std::array<std::string_view, n>& words, const std::string& place) {
  if (value.is_string()) {
    const auto found = std::ranges::find(words, value.get<std::string>());
    if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  }
  std::string accepted;
  for (std::size_t i = 0; i < n; ++i) accepted += (i == 0 ? "" : i + 1 == n ? " or " : ", ") + std::string(words[i]);
  refuse(place, "give " + accepted);
}

Cppn read_network(const Json& origin) {
  Cppn network;
  read_triples(origin, "nodes", max_cppn_nodes, [&](const Json& node, const std::string& place) {
    network.nodes.push_back({natural(node[0], place + "/0"), natural(node[1], place + "/1"),
                             static_cast<CppnFunction>(word(node[2], cppn_function_names, place + "/2"))});
  });
  read_triples(origin, "edges", max_cppn_edges, [&](const Json& edge, const std::string& place) {
    network.edges.push_back(
        {natural(edge[0], place + "/0"), natural(edge[1], place + "/1"), number(edge[2], place + "/2")});
  });
  return network;
}

CppnGenome read_genome(const Json& origin) {
  CppnGenome genome;
  const Json& size = member(origin, "size");
  if (!size.is_array() || size.size() != 3) refuse("/size", "three whole numbers are expected");
  genome.nx = small_natural(size[0], "/size/0");
  genome.ny = small_natural(size[1], "/size/1");
  genome.nz = small_natural(size[2], "/size/2");
  genome.edge = number(member(origin, "edge"), "/edge");
  genome.mirror = static_cast<Mirror>(word(member(origin, "mirror"), mirror_names, "/mirror"));
  genome.frequencies = small_natural(member(origin, "frequencies"), "/frequencies");
  genome.frequency = number(member(origin, "frequency"), "/frequency");
  genome.amplitude = number(member(origin, "amplitude"), "/amplitude");
  genome.network = read_network(origin);
  return genome;
}

}  // namespace

std::string to_origin(const CppnGenome& genome) {
  std::string out = R"({"kind":"cppn","size":[)" + std::to_string(genome.nx) + "," + std::to_string(genome.ny) + "," +
                    std::to_string(genome.nz) + "],\"edge\":";
  write(out, genome.edge);
  out += ",\"mirror\":\"" + std::string(mirror_names[static_cast<std::size_t>(genome.mirror)]) +
         "\",\"frequencies\":" + std::to_string(genome.frequencies) + ",\"frequency\":";
  write(out, genome.frequency);
  out += ",\"amplitude\":";
  write(out, genome.amplitude);
  if (!genome.environment.empty()) out += ",\"environment\":" + json_text(genome.environment);
  out += ",\"nodes\":[";
  const auto begin_item = [&] { out += out.back() == '[' ? "[" : ",["; };
  for (const auto& [id, place, function] : genome.network.nodes) {
    begin_item();
    out.append(std::to_string(id)).append(",").append(std::to_string(place)).append(",\"");
    out.append(cppn_function_names[static_cast<std::size_t>(function)]).append("\"]");
  }
  out += "],\"edges\":[";
  for (const auto& [from, to, weight] : genome.network.edges) {
    begin_item();
    out.append(std::to_string(from)).append(",").append(std::to_string(to)).append(",");
    write(out, weight);
    out += ']';
  }
  return out += "]}";
}

std::optional<CppnGenome> cppn_genome_of(const Robot& robot) {
  if (robot.origin.empty()) return std::nullopt;
  const Json origin = Json::parse(robot.origin, nullptr, false);
  if (!origin.is_object()) refuse("", "a JSON object is expected");
  if (kind_of(robot) != "cppn") return std::nullopt;
  CppnGenome genome = read_genome(origin);
  genome.environment = environment_of(robot);
  try {
    validate(genome);
  } catch (const InputError& error) {
    throw InputError("/origin" + std::string(error.what()));
  }
  return genome;
}

}  // namespace mercury
