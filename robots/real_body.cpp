// SPDX-License-Identifier: Apache-2.0
#include "mercury/real_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mercury/error.h"
#include "mercury/number_text.h"
#include "mercury/random.h"
#include "mercury/voxels.h"
#include "robots/hexahedra.h"
#include "robots/origin_member.h"

namespace mercury {
namespace {

using Json = nlohmann::json;

constexpr const char* member = "real";

// The median stiffness of the muscles among these materials, one per spring or voxel; 50 N/m as in the paper if none
// moves.
double muscle_stiffness(std::span<const Material> table, const std::vector<MaterialId>& ids) {
  std::vector<float> moving;
  for (const MaterialId id : ids)
    if (table[id].amplitude != 0 && table[id].stiffness > 0) moving.push_back(table[id].stiffness);
  if (moving.empty()) return 50;
  const auto middle = moving.begin() + static_cast<std::ptrdiff_t>(moving.size() / 2);
  std::ranges::nth_element(moving, middle);
  return static_cast<double>(*middle);
}

// Sorts keys whose upper halves name pairs of the masses, as pair_of() does. Few have the first mass in common.
void sort_by_pair(std::vector<std::uint64_t>& keys, std::size_t masses) {
  const auto first_mass = [](std::uint64_t key) { return static_cast<std::size_t>(key >> 48); };
  std::vector<std::size_t> ends(masses + 1);
  for (const std::uint64_t key : keys) ++ends[first_mass(key) + 1];
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<std::uint64_t> sorted(keys.size());
  for (const std::uint64_t key : keys) sorted[ends[first_mass(key)]++] = key;
  std::size_t begin = 0;
  for (std::size_t mass = 0; mass < masses; begin = ends[mass++])
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin),
              sorted.begin() + static_cast<std::ptrdiff_t>(ends[mass]));
  keys.swap(sorted);
}

// Faces of a sealed cavity show into it: their shell, joined edge by edge, has a negative volume.
void drop_cavities(Robot& robot) {
  std::vector<std::size_t> shell(robot.faces.size());
  for (std::size_t f = 0; f < shell.size(); ++f) shell[f] = f;
  const auto root = [&](std::size_t f) {
    while (shell[f] != f) f = shell[f] = shell[shell[f]];
    return f;
  };
  std::vector<std::uint64_t> sides;  // edge, face
  sides.reserve(3 * robot.faces.size());
  for (std::size_t f = 0; f < robot.faces.size(); ++f) {
    const auto [a, b, c] = robot.faces[f];
    for (const std::uint64_t edge : {pair_of(a, b), pair_of(b, c), pair_of(c, a)}) sides.push_back(edge << 32 | f);
  }
  sort_by_pair(sides, robot.masses.size());
  const auto face_of = [&](std::size_t side) { return static_cast<std::size_t>(sides[side] & 0xffffffff); };
  // Where more than two faces meet, shells touch without being one.
  for (std::size_t first = 0, end = 0; first < sides.size(); first = end) {
    while (end < sides.size() && sides[end] >> 32 == sides[first] >> 32) ++end;
    if (end - first == 2) shell[root(face_of(first))] = root(face_of(first + 1));
  }
  bool is_one_shell = true;
  for (std::size_t f = 0; f < shell.size(); ++f) is_one_shell = is_one_shell && root(f) == root(0);
  if (is_one_shell) return;
  std::map<std::size_t, Robot> shells;
  for (std::size_t f = 0; f < robot.faces.size(); ++f) shells[root(f)].faces.push_back(robot.faces[f]);
  std::set<std::size_t> cavities;
  for (auto& [first, part] : shells) {
    part.masses = robot.masses;
    if (skin_volume(part) < 0) cavities.insert(first);
  }
  std::vector<Face> outer;
  for (std::size_t f = 0; f < robot.faces.size(); ++f)
    if (!cavities.contains(root(f))) outer.push_back(robot.faces[f]);
  robot.faces = std::move(outer);
}

// Of what a material of the robot's table is made, by id: [Pa], [kg/m3], [s].
struct Substance {
  double modulus = 0, density = 0, relaxation_time = 0;
};

// `ids`: the materials of all voxels or springs.
std::vector<Substance> substances_of(const Robot& robot, const RealMaterial& material,
                                     const std::vector<MaterialId>& ids) {
  const std::span<const Material> table = materials_of(robot);
  std::vector<Substance> substances;
  for (const auto& [modulus, density, relaxation_time] : material.each)
    substances.push_back(
        {static_cast<double>(modulus), static_cast<double>(density), static_cast<double>(relaxation_time)});
  if (!substances.empty()) return substances;
  const double modulus_per_stiffness = static_cast<double>(material.modulus) / muscle_stiffness(table, ids);
  for (const Material& own : table)
    substances.push_back({modulus_per_stiffness * static_cast<double>(own.stiffness),
                          static_cast<double>(material.density), static_cast<double>(material.relaxation_time)});
  return substances;
}

// Actuators of materials that are now several: pairs of a material and one made of it.
void rename_materials(std::vector<Actuator>& actuators, std::span<const std::pair<MaterialId, MaterialId>> made) {
  for (Actuator& actuator : actuators) {
    std::vector<MaterialId> mine;
    for (const auto& [of, id] : made)
      if (std::ranges::find(actuator.materials, of) != actuator.materials.end()) mine.push_back(id);
    std::ranges::sort(mine);
    actuator.materials = std::move(mine);
  }
  // Those of materials that no voxel has, such as of springs along one axis alone.
  std::erase_if(actuators, [](const Actuator& actuator) { return actuator.materials.empty(); });
}

void set_voxel_springs(const Robot& robot, const Voxels& voxels, const RealMaterial& material, Robot& real) {
  // By the number of axes along which a spring runs: an edge, a diagonal across a side, one through the middle.
  constexpr std::array<double, 4> share{0, 0.15, 0.10, 0.15};
  constexpr std::array<const char*, 4> kind{"", "edge", "side", "middle"};
  constexpr std::array<unsigned, 8> axes_between{0, 1, 1, 2, 1, 2, 2, 3};  // of two corners, by the bits that differ
  std::vector<MaterialId> of_voxels;
  for (const Voxel& voxel : voxels.all) of_voxels.push_back(voxel.material);
  const std::vector<Substance> substances = substances_of(robot, material, of_voxels);
  // The springs of single voxels: pair of masses, material, axes. Those of several voxels that lie between the same
  // masses become one per material.
  std::vector<std::uint64_t> parts;
  parts.reserve(28 * voxels.all.size());
  std::vector<double> density_at(robot.masses.size());  // of all voxels there
  for (const auto& [corners, id] : voxels.all) {
    for (const std::uint16_t corner : corners) density_at[corner] += substances[id].density;
    for_each_pair_of_corners([&, &corners = corners, id = id](std::size_t i, std::size_t j) {
      const std::uint64_t pair = pair_of(corners[i], corners[j]);
      parts.push_back(pair << 32 | static_cast<std::uint64_t>(id) << 8 | axes_between[i ^ j]);
    });
  }
  sort_by_pair(parts, robot.masses.size());
  const double edge = static_cast<double>(voxels.edge);
  real.mass.clear();
  for (const double density : density_at) real.mass.push_back(static_cast<float>(density * edge * edge * edge / 8));
  const std::span<const Material> table = materials_of(robot);
  real.materials.assign(1, Material{});
  real.material_names.assign(1, "air");
  constexpr std::size_t most_shared = 4;                          // an edge, by the voxels around it
  std::array<MaterialId, max_materials * 3 * most_shared> ids{};  // [material][axes - 1][shared - 1]; 0 = none yet
  std::vector<std::pair<MaterialId, MaterialId>> made;
  std::array<float, 4> length{};  // by axes
  for (std::size_t axes = 1; axes < length.size(); ++axes)
    length[axes] = static_cast<float>(edge * std::sqrt(static_cast<double>(axes)));
  real.springs.clear();
  for (auto part = parts.begin(); part != parts.end();) {
    const std::uint64_t first = *part;
    const auto pair = static_cast<std::uint32_t>(first >> 32);
    const auto id = static_cast<MaterialId>(first >> 8 & 0xff);
    const auto axes = static_cast<std::size_t>(first & 0xff);
    std::size_t shared = 0;  // by as many voxels
    for (; part != parts.end() && *part == first; ++part) ++shared;
    MaterialId& own_id = ids[(id * std::size_t{3} + axes - 1) * most_shared + shared - 1];
    if (own_id == 0) {
      if (real.materials.size() == max_materials)
        throw InputError("/materials", "the voxels have too many materials for one table of springs");
      Material own = table[id];
      const Substance& substance = substances[id];
      own.stiffness = static_cast<float>(static_cast<double>(shared) * share[axes] * substance.modulus * edge);
      own.relaxation_time = static_cast<float>(substance.relaxation_time);
      own_id = static_cast<MaterialId>(real.materials.size());
      made.emplace_back(id, own_id);
      real.materials.push_back(own);
      real.material_names.push_back(name_of_material(robot, id) + ", " + std::to_string(shared) + " x " + kind[axes]);
    }
    real.springs.push_back(
        {static_cast<std::uint16_t>(pair >> 16), static_cast<std::uint16_t>(pair & 0xffff), own_id, length[axes]});
  }
  rename_materials(real.actuators, made);
}

// Springs are as stiff as others of their material within some percent, since a table has at most 255 materials.
void set_hexahedra_springs(const Robot& robot, std::span<const Hexahedron> cells, const RealMaterial& material,
                           Robot& real) {
  std::vector<MaterialId> of_springs;
  for (const Spring& spring : robot.springs) of_springs.push_back(spring.material);
  const std::vector<Substance> substances = substances_of(robot, material, of_springs);
  std::vector<double> modulus, density;
  for (const Substance& substance : substances) {
    modulus.push_back(substance.modulus);
    density.push_back(substance.density);
  }
  auto [mass, stiffness] = sum_hexahedra(robot, cells, modulus, density);
  real.mass.assign(mass.begin(), mass.end());
  // A few short springs across a thin fin would need a step of time that is far shorter than the rest of the body does.
  double length = 0;
  for (const Hexahedron& cell : cells) length += static_cast<double>(rest_distance(robot, cell[0], cell[1]));
  length /= static_cast<double>(cells.size());
  for (std::size_t s = 0; s < stiffness.size(); ++s) {
    const auto& [a, b, id, rest_length] = robot.springs[s];
    const double most = 0.35 * modulus[id] / (density[id] * length * length) * std::min(mass[a], mass[b]);
    stiffness[s] = std::min(stiffness[s], most);
  }
  const std::span<const Material> table = materials_of(robot);
  for (double step = 1.04;; step *= 1.04) {
    struct Sum {
      double stiffness = 0;
      int springs = 0;
    };
    std::map<std::pair<MaterialId, long>, Sum> kinds;
    std::vector<std::pair<MaterialId, long>> kind_of_spring;
    for (std::size_t s = 0; s < stiffness.size(); ++s) {
      const long level = std::lround(portable_log(stiffness[s]) / portable_log(step));
      kind_of_spring.emplace_back(robot.springs[s].material, level);
      Sum& sum = kinds[kind_of_spring.back()];
      sum.stiffness += stiffness[s];
      ++sum.springs;
    }
    if (kinds.size() >= max_materials) {
      if (step > 10) throw InputError("/materials", "the cells have too many materials for one table of springs");
      continue;
    }
    real.materials.assign(1, Material{});
    real.material_names.assign(1, "air");
    std::map<std::pair<MaterialId, long>, MaterialId> ids;
    std::vector<std::pair<MaterialId, MaterialId>> made;
    for (const auto& [kind, sum] : kinds) {
      const auto id = static_cast<MaterialId>(real.materials.size());
      Material own = table[kind.first];
      own.stiffness = static_cast<float>(sum.stiffness / sum.springs);
      own.relaxation_time = static_cast<float>(substances[kind.first].relaxation_time);
      real.materials.push_back(own);
      real.material_names.push_back(name_of_material(robot, kind.first));
      ids.emplace(kind, id);
      made.emplace_back(kind.first, id);
    }
    for (std::size_t s = 0; s < real.springs.size(); ++s) real.springs[s].material = ids[kind_of_spring[s]];
    rename_materials(real.actuators, made);
    return;
  }
}

void set_network_springs(const Robot& robot, const RealMaterial& material, Robot& real) {
  const double volume = skin_volume(real);
  if (!(volume > 0)) throw InputError("/faces", "a real body needs a skin around a volume; this one encloses none");
  if (robot.springs.empty()) throw InputError("/springs", "a real body needs springs");
  const std::span<const Material> table = materials_of(robot);
  std::vector<MaterialId> of_springs;
  for (const Spring& spring : robot.springs) of_springs.push_back(spring.material);
  const std::vector<Substance> substances = substances_of(robot, material, of_springs);
  double sum = 0, mass = 0;
  std::vector<double> share(robot.masses.size());  // of the mass, times twice the sum
  for (const Spring& spring : robot.springs) {
    const double squared = static_cast<double>(spring.rest_length) * static_cast<double>(spring.rest_length);
    const double of_spring = substances[spring.material].density * volume * squared;
    share[spring.a] += of_spring;
    share[spring.b] += of_spring;
    mass += of_spring;
    sum += squared;
  }
  // A mass that no spring holds has a hundredth of the mean.
  const double least = 0.01 * mass / (sum * static_cast<double>(share.size()));
  real.mass.clear();
  for (const double s : share) real.mass.push_back(static_cast<float>(std::max(least, s / (2 * sum))));
  real.materials.assign(table.begin(), table.end());
  for (std::size_t id = 0; id < real.materials.size(); ++id) {
    Material& own = real.materials[id];
    own.stiffness = static_cast<float>(6 * substances[id].modulus * volume / sum);
    own.relaxation_time = own.stiffness > 0 ? static_cast<float>(substances[id].relaxation_time) : 0;
  }
  if (robot.material_names.empty() && robot.materials.empty())
    for (std::size_t id = 0; id < table.size(); ++id)
      real.material_names.push_back(default_material_name(static_cast<MaterialId>(id)));
}

// [[stiffness, amplitude, frequency, phase, half wave], ...]
std::string text_of(std::span<const Material> materials) {
  std::string text = "[";
  for (const Material& own : materials) {
    if (text.size() > 1) text += ',';
    text += '[';
    for (const float value : {own.stiffness, own.amplitude, own.frequency, own.phase})
      text.append(shortest_text(value)).append(",");
    text.append(own.half_wave ? "true]" : "false]");
  }
  return text + "]";
}

// [[modulus, density, relaxation time], ...]
std::string text_of(const std::vector<RealMaterial::Own>& each) {
  std::string text;
  for (const auto& [modulus, density, relaxation_time] : each)
    text.append(text.empty() ? "[[" : ",[")
        .append(shortest_text(modulus) + "," + shortest_text(density) + "," + shortest_text(relaxation_time) + "]");
  return text + "]";
}

[[noreturn]] void refuse(const std::string& place, const std::string& what) {
  throw InputError("/origin/real" + place, what);
}

std::optional<Json> real_in(const Robot& robot) {
  const std::optional<Json> real = origin_member(robot, member);
  if (real && !real->is_object()) refuse("", "a JSON object is expected");
  return real;
}

}  // namespace

Robot with_real_body(const Robot& robot, const RealMaterial& material) {
  check_parameters(material);
  if (!material.each.empty() && material.each.size() != materials_of(robot).size())
    throw InputError("/materials", "a real body needs what each of them is made of");
  if (real_material_of(robot)) throw InputError("/origin/real", "the robot has a real body already");
  Robot real = robot;
  drop_cavities(real);
  Voxels voxels = voxels_of(robot);
  if (voxels.shares_pairs) voxels.all.clear();
  const Generator* generator = generator_of(robot);
  if (generator && generator->cells)
    set_hexahedra_springs(robot, generator->cells(robot), material, real);
  else if (voxels.all.empty())
    set_network_springs(robot, material, real);
  else
    set_voxel_springs(robot, voxels, material, real);
  std::string record = "{\"modulus\":" + shortest_text(material.modulus) +
                       ",\"density\":" + shortest_text(material.density) +
                       ",\"relaxation_time\":" + shortest_text(material.relaxation_time);
  if (!material.each.empty()) record.append(",\"each\":").append(text_of(material.each));
  if (!robot.materials.empty()) record.append(",\"materials\":").append(text_of(robot.materials));
  if (!robot.material_names.empty()) record.append(",\"material_names\":").append(Json(robot.material_names).dump());
  real.origin = with_origin_member(robot.origin, member, record + "}");
  return real;
}

std::optional<RealMaterial> real_material_of(const Robot& robot) {
  const std::optional<Json> real = real_in(robot);
  if (!real) return std::nullopt;
  const auto number = [&](const char* key) {
    const auto found = real->find(key);
    if (found == real->end() || !found->is_number()) refuse(std::string("/") + key, "a number is expected");
    return found->get<float>();
  };
  RealMaterial material{number("modulus"), number("density"), number("relaxation_time"), {}};
  if (const auto each = real->find("each"); each != real->end()) {
    const auto is_amount = [](const Json& value) { return value.is_number() && value.get<float>() >= 0; };
    if (!each->is_array() || each->size() > max_materials) refuse("/each", "an array of at most 256 is expected");
    for (const Json& own : *each) {
      if (!own.is_array() || own.size() != 3 || !std::ranges::all_of(own, is_amount))
        refuse("/each", "[modulus, density, relaxation_time] is expected, all at least 0");
      material.each.push_back({own[0].get<float>(), own[1].get<float>(), own[2].get<float>()});
    }
  }
  try {
    check_parameters(material);
  } catch (const ParameterError& error) {
    refuse("", error.what());
  }
  return material;
}

Physics physics_of(const Robot& robot) {
  // An origin may be long, and every real body has masses.
  return !robot.mass.empty() && real_material_of(robot) ? Physics::real : Physics::paper;
}

Robot without_real_body(const Robot& robot) {
  const std::optional<Json> real = real_in(robot);
  if (!real) return robot;
  Robot paper = robot;
  paper.mass.clear();
  paper.materials.clear();
  paper.material_names.clear();
  paper.actuators.clear();
  paper.origin = with_origin_member(robot.origin, member, "");
  if (const auto table = real->find("materials"); table != real->end()) {
    if (!table->is_array() || table->size() > max_materials)
      refuse("/materials", "an array of at most 256 is expected");
    for (const Json& own : *table) {
      const auto is_row = [](const Json& row) {
        return row.is_array() && row.size() == 5 && row[4].is_boolean() &&
               std::all_of(row.begin(), row.begin() + 4, [](const Json& value) { return value.is_number(); });
      };
      if (!is_row(own)) refuse("/materials", "[stiffness, amplitude, frequency, phase, half_wave] is expected");
      paper.materials.push_back(
          {own[0].get<float>(), own[1].get<float>(), own[2].get<float>(), own[3].get<float>(), own[4].get<bool>()});
      validate(paper.materials.back(), "/origin/real/materials/" + std::to_string(paper.materials.size() - 1));
    }
  }
  if (const auto names = real->find("material_names"); names != real->end()) {
    if (!names->is_array() || names->size() != paper.materials.size())
      refuse("/material_names", "one per material is expected");
    for (const Json& name : *names) {
      if (!name.is_string()) refuse("/material_names", "texts are expected");
      paper.material_names.push_back(name.get<std::string>());
    }
  }
  return paper;
}

}  // namespace mercury
