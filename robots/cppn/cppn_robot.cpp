// SPDX-License-Identifier: Apache-2.0
// From a genome to a painted grid, and to a robot.
#include "mercury/cppn.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mercury/error.h"
#include "mercury/muscle_laws.h"
#include "mercury/names.h"
#include "robots/cppn/cppn_graph.h"
#include "robots/file/document.h"
#include "robots/origin_json.h"
#include "robots/portable_math.h"

namespace mercury {
namespace {

// From -1 to 1, exactly opposite for opposite voxels.
double coordinate(int i, int n) { return static_cast<double>(2 * i + 1 - n) / n; }

std::vector<CppnEvaluator::Point> points_of(const CppnGenome& genome) {
  std::vector<CppnEvaluator::Point> points;
  const auto seen = [&](int i, int n, Mirror axis) {
    const double at = coordinate(i, n);
    return genome.mirror == axis ? std::abs(at) : at;
  };
  for (int k = 0; k < genome.nz; ++k)
    for (int j = 0; j < genome.ny; ++j)
      for (int i = 0; i < genome.nx; ++i) {
        const double x = seen(i, genome.nx, Mirror::x), y = seen(j, genome.ny, Mirror::y),
                     z = seen(k, genome.nz, Mirror::z);
        points.push_back({x, y, z, 2 * std::sqrt((x * x + y * y + z * z) / 3) - 1});
      }
  return points;
}

MaterialId material_of(const CppnEvaluator::Outputs& outputs, int frequencies) {
  if (!(outputs[presence_output] > 0)) return air;
  if (!(outputs[kind_output] > -1)) return bone;
  if (!(outputs[kind_output] > 0)) return tissue;
  const int phases = muscle_count / frequencies;
  const double turns = outputs[phase_output] - std::floor(outputs[phase_output]);
  const int phase = static_cast<int>(std::floor(turns * phases + 0.5)) % phases;
  const double share = (std::clamp(outputs[frequency_output], -1., 1.) + 1) / 2;
  const int frequency = std::min(static_cast<int>(std::floor(share * frequencies)), frequencies - 1);
  return static_cast<MaterialId>(frequency * phases + phase + 1);
}

// How a base muscle oscillates: its phase is p / phases of a turn.
struct Oscillation {
  int frequency, phase;
};
Oscillation oscillation_of(int muscle, int frequencies, int phases) {
  return {std::min((muscle - 1) / phases, frequencies - 1), (muscle - 1) % phases};
}

float radians(double turns) { return static_cast<float>(2 * std::numbers::pi * (turns - std::floor(turns))); }

// The mean of A sin(wt + a) and A sin(wt + b) is A cos((a - b) / 2) sin(wt + (a + b) / 2). Of two frequencies the mean
// is no sine; such a pair keeps the amplitude, between the two frequencies and phases.
void combine_muscles(const Oscillation& a, const Oscillation& b, int phases, Material& pair) {
  int steps = (b.phase - a.phase + phases) % phases;  // the shorter way around the circle
  if (2 * steps > phases) steps -= phases;
  pair.phase = radians((2 * a.phase + steps) / (2. * phases));
  if (a.frequency != b.frequency) return;
  pair.amplitude *= static_cast<float>(wave(steps / (2. * phases)).cosine);
  if (2 * steps == phases) pair.amplitude = pair.frequency = pair.phase = 0;
}

void require(bool holds, const char* where, const std::string& what) {
  if (!holds) throw InputError(where, what);
}

}  // namespace

void validate(const CppnGenome& genome) {
  validate(genome.network);
  std::uint64_t cells = 1;
  for (const int n : {genome.nx, genome.ny, genome.nz}) {
    require(n >= 1, "/size", "give at least 1 voxel each way");
    cells *= static_cast<std::uint64_t>(n);
    require(cells <= max_cppn_cells, "/size", "give at most " + std::to_string(max_cppn_cells) + " voxels");
  }
  require(genome.edge >= min_rest_length && genome.edge <= 1, "/edge", "give 0.001 to 1 m");
  require(genome.mirror >= Mirror::none && genome.mirror <= Mirror::z, "/mirror", "give none, x, y or z");
  require(genome.frequencies >= 1 && genome.frequencies <= voxel_frequencies, "/frequencies", "give 1 to 5");
  require(genome.frequency >= 0 && genome.frequency <= max_muscle_frequency, "/frequency", "give 0 to 20 rad/s");
  require(genome.amplitude >= 0 && genome.amplitude <= max_muscle_amplitude, "/amplitude", "give 0 to 0.4");
}

std::vector<CppnEvaluator::Outputs> outputs_of(const CppnGenome& genome) {
  const std::vector<CppnEvaluator::Point> points = points_of(genome);
  std::vector<CppnEvaluator::Outputs> outputs(points.size());
  CppnEvaluator evaluator(genome.network);
  for (std::size_t first = 0; first < points.size(); first += CppnEvaluator::group) {
    const std::size_t count = std::min(CppnEvaluator::group, points.size() - first);
    evaluator(std::span(points).subspan(first, count), std::span(outputs).subspan(first, count));
  }
  return outputs;
}

VoxelGrid paint(const CppnGenome& genome) {
  validate(genome);
  VoxelGrid grid(genome.nx, genome.ny, genome.nz);
  grid.edge = genome.edge;
  std::ranges::transform(outputs_of(genome), grid.cells.begin(), [&](const CppnEvaluator::Outputs& outputs) {
    return material_of(outputs, genome.frequencies);
  });
  return grid;
}

std::vector<Material> cppn_materials(int frequencies, float frequency, float amplitude) {
  const int phases = muscle_count / frequencies;
  std::array<Material, base_material_count> bases;
  for (MaterialId id = 1; id <= base_material_count; ++id) {
    bases[id - 1u] = default_materials()[id];
    if (id > muscle_count) continue;
    const auto [level, phase] = oscillation_of(id, frequencies, phases);
    bases[id - 1u].amplitude = amplitude;
    bases[id - 1u].frequency = frequency * static_cast<float>(level + 1) / static_cast<float>(frequencies);
    bases[id - 1u].phase = radians(static_cast<double>(phase) / phases);
  }
  std::vector<Material> table = material_table(bases);
  for (MaterialId i = 1; i <= muscle_count; ++i)
    for (MaterialId j = i + 1; j <= muscle_count; ++j)
      combine_muscles(oscillation_of(i, frequencies, phases), oscillation_of(j, frequencies, phases), phases,
                      table[combine(i, j)]);
  return table;
}

Robot grow(const CppnGenome& genome, const std::string& name) {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (int id = 0; id < default_material_count; ++id)
      all.push_back(default_material_name(static_cast<MaterialId>(id)));
    return all;
  }();
  Robot robot = make_voxel_robot(paint(genome),
                                 {.name = name,
                                  .materials = cppn_materials(genome.frequencies, genome.frequency, genome.amplitude),
                                  .material_names = names});
  robot.origin = to_origin(genome);
  return robot;
}

// The genome of a painted voxel robot as the JSON text of its origin.
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
  refuse_origin(place, "give " + list_of({words.begin(), words.end()}, " or "));
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
  if (text_in(origin, "kind") != "cppn") return std::nullopt;
  CppnGenome genome = read_genome(origin);
  genome.environment = text_in(origin, "environment");
  try {
    validate(genome);
  } catch (const InputError& error) {
    throw InputError("/origin" + std::string(error.what()));
  }
  return genome;
}

}  // namespace mercury
