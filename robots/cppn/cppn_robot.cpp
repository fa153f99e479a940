// SPDX-License-Identifier: Apache-2.0
// From a genome to a painted grid, and to a robot.
#include "mercury/cppn.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "mercury/error.h"
#include "mercury/muscle_laws.h"
#include "mercury/names.h"
#include "robots/cppn/cppn_graph.h"
#include "robots/file/document.h"
#include "robots/muscle_fields.h"
#include "robots/origin_json.h"
#include "robots/portable_math.h"
#include "robots/voxel/spring_cells.h"

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

constexpr MaterialId first_muscle = 1;

MaterialId kind_of(const CppnEvaluator::Outputs& outputs) {
  if (!(outputs[presence_output] > 0)) return air;
  if (!(outputs[kind_output] > -1)) return bone;
  if (!(outputs[kind_output] > 0)) return tissue;
  return first_muscle;
}

MaterialId material_of(const CppnEvaluator::Outputs& outputs, int frequencies) {
  const MaterialId kind = kind_of(outputs);
  if (kind != first_muscle) return kind;
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
  const bool fields = has_fields(genome.network);
  require(genome.frequencies >= 1 && genome.frequencies <= (fields ? max_field_frequencies : voxel_frequencies),
          "/frequencies", fields ? "give 1 or 2 with fields" : "give 1 to 5");
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

namespace {

VoxelGrid grid_of(const CppnGenome& genome, std::span<const CppnEvaluator::Outputs> outputs) {
  VoxelGrid grid(genome.nx, genome.ny, genome.nz);
  grid.edge = genome.edge;
  std::ranges::transform(outputs, grid.cells.begin(), [&](const CppnEvaluator::Outputs& of_voxel) {
    return has_fields(genome.network) ? kind_of(of_voxel) : material_of(of_voxel, genome.frequencies);
  });
  return grid;
}

FieldMuscles muscles_of(const CppnGenome& genome) { return {genome.frequencies, genome.frequency, genome.amplitude}; }

}  // namespace

VoxelGrid paint(const CppnGenome& genome) {
  validate(genome);
  return grid_of(genome, outputs_of(genome));
}

bool PaintedBody::is_empty() const {
  return std::ranges::all_of(grid.cells, [](MaterialId cell) { return cell == air; });
}

PaintedBody painted_body(const CppnGenome& genome) {
  validate(genome);
  const std::vector<CppnEvaluator::Outputs> outputs = outputs_of(genome);
  PaintedBody body{.grid = largest_body(grid_of(genome, outputs)), .values = {}};
  if (!has_fields(genome.network)) return body;
  body.values.resize(outputs.size());
  for (std::size_t i = 0; i < outputs.size(); ++i)
    if (body.grid.cells[i] != air)
      body.values[i] = field_value(body.grid.cells[i],
                                   {.phase = outputs[i][phase_output],
                                    .frequency = outputs[i][frequency_output],
                                    .amplitude = outputs[i][amplitude_output],
                                    .stiffness = outputs[i][stiffness_output]},
                                   muscles_of(genome));
  return body;
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

namespace {

// A real body (real_body.h) needs up to seven materials per material of its voxels: springs along edges of one to four
// voxels, across sides of one or two, and through the middle of one.
constexpr std::size_t most_voxel_values = (max_materials - 1) / 7;

// Voxels that are alike share a value. So do springs between different voxels, in the room that is left of the table.
class FieldSprings {
 public:
  explicit FieldSprings(const PaintedBody& body) : grid_(body.grid), of_voxel_(body.grid.cells.size(), none) {
    std::vector<std::size_t> voxels;
    std::vector<FieldValue> values;
    for (std::size_t i = 0; i < body.values.size(); ++i) {
      if (body.grid.cells[i] == air) continue;
      voxels.push_back(i);
      values.push_back(body.values[i]);
    }
    FieldPalette palette = palette_of(values, most_voxel_values);
    for (std::size_t i = 0; i < voxels.size(); ++i) of_voxel_[voxels[i]] = palette.of[i];
    values_ = std::move(palette.values);
  }

  MaterialId material_of_voxel(std::size_t cell) const {
    return of_voxel_[cell] == none ? air : static_cast<MaterialId>(of_voxel_[cell] + 1);
  }

  // Sets the table of a robot of this grid and the materials of its springs.
  void set(Robot& robot, const FieldMuscles& muscles) {
    const std::size_t pure = values_.size();
    const SpringCells cells(robot, {grid_.nx, grid_.ny, grid_.nz}, grid_.edge);
    std::vector<std::size_t> of_spring;  // a value of voxels, or after these a mixture
    for (const Spring& spring : robot.springs) of_spring.push_back(value_of_cells(cells.of(spring)));
    std::vector<FieldValue> mixed;
    for (const Mixture& mixture : mixtures_) mixed.push_back(mean_of(mixture));
    const FieldPalette palette = palette_of(mixed, max_materials - 1 - pure);
    for (std::size_t s = 0; s < robot.springs.size(); ++s) {
      const std::size_t value = of_spring[s] < pure ? of_spring[s] : pure + palette.of[of_spring[s] - pure];
      robot.springs[s].material = static_cast<MaterialId>(value + 1);
    }
    values_.insert(values_.end(), palette.values.begin(), palette.values.end());
    FieldTable table = table_of(values_, muscles);
    robot.materials = std::move(table.materials);
    robot.material_names = std::move(table.names);
  }

 private:
  static constexpr std::uint8_t none = 255;
  using Mixture = std::array<std::uint8_t, 4>;  // values in their order, then none

  std::size_t value_of_cells(const std::vector<std::size_t>& cells) {
    Mixture mixture;
    mixture.fill(none);
    for (std::size_t i = 0; i < cells.size(); ++i) mixture[i] = of_voxel_[cells[i]];
    std::ranges::sort(mixture);
    const auto voxels = static_cast<std::size_t>(std::ranges::find(mixture, none) - mixture.begin());
    if (mixture[0] == mixture[voxels - 1]) return mixture[0];
    const auto [entry, is_new] = numbers_.try_emplace(mixture, values_.size() + mixtures_.size());
    if (is_new) mixtures_.push_back(mixture);
    return entry->second;
  }

  FieldValue mean_of(const Mixture& mixture) const {
    std::vector<FieldValue> values;
    for (const std::uint8_t value : mixture)
      if (value != none) values.push_back(values_[value]);
    return mean_value(values);
  }

  const VoxelGrid& grid_;
  std::vector<std::uint8_t> of_voxel_;
  std::vector<FieldValue> values_;
  std::vector<Mixture> mixtures_;
  std::map<Mixture, std::size_t> numbers_;
};

Robot grow_with_fields(const CppnGenome& genome, const std::string& name) {
  const PaintedBody body = painted_body(genome);
  Robot robot = make_voxel_robot(body.grid, {.name = name});
  FieldSprings(body).set(robot, muscles_of(genome));
  robot.origin = to_origin(genome);
  return robot;
}

}  // namespace

VoxelGrid painted_voxels(const CppnGenome& genome) {
  const PaintedBody body = painted_body(genome);
  VoxelGrid voxels = body.grid;
  if (!has_fields(genome.network)) return voxels;
  const FieldSprings springs(body);
  for (std::size_t i = 0; i < voxels.cells.size(); ++i) voxels.cells[i] = springs.material_of_voxel(i);
  return voxels;
}

Robot grow_part(const CppnGenome& genome, const VoxelGrid& part, const std::string& name) {
  const Robot whole = grow(genome, name);
  Robot robot = make_voxel_robot(part, {.name = name});
  robot.materials = whole.materials;
  robot.material_names = whole.material_names;
  if (!has_fields(genome.network)) return robot;
  const std::array<int, 3> size{part.nx, part.ny, part.nz};
  const SpringCells of_whole(whole, size, part.edge), of_part(robot, size, part.edge);
  using Ends = std::pair<std::array<int, 3>, std::array<int, 3>>;
  std::map<Ends, MaterialId> materials;
  for (const Spring& spring : whole.springs)
    materials.emplace(Ends(of_whole.corner(spring.a), of_whole.corner(spring.b)), spring.material);
  for (Spring& spring : robot.springs) {
    const auto found = materials.find(Ends(of_part.corner(spring.a), of_part.corner(spring.b)));
    if (found == materials.end()) throw InputError("voxel grid", "holds a voxel that the body lacks");
    spring.material = found->second;
  }
  return robot;
}

Robot grow(const CppnGenome& genome, const std::string& name) {
  if (has_fields(genome.network)) return grow_with_fields(genome, name);
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
  if (const auto outputs = origin.find("outputs"); outputs != origin.end())
    genome.network.outputs = natural(*outputs, "/outputs");
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
  if (has_fields(genome.network)) out += ",\"outputs\":" + std::to_string(genome.network.outputs);
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
