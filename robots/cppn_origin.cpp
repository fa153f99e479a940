// SPDX-License-Identifier: Apache-2.0
// The genome of a painted voxel robot as the JSON text of its origin.

#include <algorithm>
#include <array>

#include "mercury/cppn.h"
#include "mercury/error.h"
#include "mercury/origin.h"
#include "robots/document.h"
#include "robots/origin_json.h"

namespace mercury {
namespace {

constexpr std::array<std::string_view, 4> mirror_names{"none", "x", "y", "z"};

// The items of a list of at most `most`, each a list of three.
template <class Read>
void read_triples(const OriginJson& origin, const char* key, std::size_t most, Read read) {
  const OriginJson& list = origin_member(origin, key);
  const std::string place = std::string("/") + key;
  if (!list.is_array()) refuse_origin(place, "an array is expected");
  if (list.size() > most) refuse_origin(place, "at most " + std::to_string(most) + " are accepted");
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list[i].is_array() || list[i].size() != 3)
      refuse_origin(place + "/" + std::to_string(i), "a list of three is expected");
    read(list[i], place + "/" + std::to_string(i));
  }
}

std::uint32_t natural(const OriginJson& value, const std::string& place) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > UINT32_MAX)
    refuse_origin(place, "a whole number >= 0 is expected");
  return value.get<std::uint32_t>();
}

int small_natural(const OriginJson& value, const std::string& place) {
  return static_cast<int>(std::min<std::uint32_t>(natural(value, place), INT32_MAX));
}

float number(const OriginJson& value, const std::string& place) {
  if (!value.is_number()) refuse_origin(place, "a number is expected");
  return value.get<float>();
}

template <std::size_t n>
std::size_t word(const OriginJson& value, const std::array<std::string_view, n>& words, const std::string& place) {
  if (value.is_string()) {
    const auto found = std::ranges::find(words, value.get<std::string>());
    if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  }
  std::string accepted;
  for (std::size_t i = 0; i < n; ++i) accepted += (i == 0 ? "" : i + 1 == n ? " or " : ", ") + std::string(words[i]);
  refuse_origin(place, "give " + accepted);
}

Cppn read_network(const OriginJson& origin) {
  Cppn network;
  read_triples(origin, "nodes", max_cppn_nodes, [&](const OriginJson& node, const std::string& place) {
    network.nodes.push_back({natural(node[0], place + "/0"), natural(node[1], place + "/1"),
                             static_cast<CppnFunction>(word(node[2], cppn_function_names, place + "/2"))});
  });
  read_triples(origin, "edges", max_cppn_edges, [&](const OriginJson& edge, const std::string& place) {
    network.edges.push_back(
        {natural(edge[0], place + "/0"), natural(edge[1], place + "/1"), number(edge[2], place + "/2")});
  });
  return network;
}

CppnGenome read_genome(const OriginJson& origin) {
  CppnGenome genome;
  const OriginJson& size = origin_member(origin, "size");
  if (!size.is_array() || size.size() != 3) refuse_origin("/size", "three whole numbers are expected");
  genome.nx = small_natural(size[0], "/size/0");
  genome.ny = small_natural(size[1], "/size/1");
  genome.nz = small_natural(size[2], "/size/2");
  genome.edge = number(origin_member(origin, "edge"), "/edge");
  genome.mirror = static_cast<Mirror>(word(origin_member(origin, "mirror"), mirror_names, "/mirror"));
  genome.frequencies = small_natural(origin_member(origin, "frequencies"), "/frequencies");
  genome.frequency = number(origin_member(origin, "frequency"), "/frequency");
  genome.amplitude = number(origin_member(origin, "amplitude"), "/amplitude");
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
  const OriginJson origin = OriginJson::parse(robot.origin, nullptr, false);
  if (!origin.is_object()) refuse_origin("", "a JSON object is expected");
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
