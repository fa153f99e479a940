// SPDX-License-Identifier: Apache-2.0
#include "robots/importers/voxel_body.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "mercury/cppn.h"
#include "mercury/error.h"
#include "mercury/origin.h"
#include "mercury/voxel.h"
#include "robots/file/document.h"
#include "robots/importers/calibration.h"

namespace mercury {
namespace {

using Json = nlohmann::json;

constexpr auto edge = static_cast<float>(imported_edge);

VoxelGrid grid_of(const VoxelBody& body) {
  VoxelGrid grid;
  grid.nx = body.nx;
  grid.ny = body.ny;
  grid.nz = body.nz;
  grid.edge = edge;
  grid.cells.reserve(body.cells.size());
  for (const std::uint32_t cell : body.cells) grid.cells.push_back(static_cast<MaterialId>(cell));
  return grid;
}

Json provenance_json(const Provenance& provenance) {
  return {{"file", provenance.file},
          {"format", provenance.format},
          {"length_scale", provenance.length_scale},
          {"time_scale", provenance.time_scale}};
}

// Numbers in the form that Mercury's own files have, so that the text is the same after a robot was read as CBOR.
std::string origin_text(const Json& json) {
  std::string cbor, text;
  CborWriter binary(cbor);
  read_json(json.dump(-1, ' ', false, Json::error_handler_t::replace), binary);
  JsonWriter writer(text);
  read_cbor(cbor, writer);
  return text;
}

std::string with_provenance(const std::string& origin, const Provenance& provenance) {
  Json json = Json::parse(origin);
  json["imported"] = provenance_json(provenance);
  return origin_text(json);
}

// The substances as base materials 1 to 22, and their pairs. Where the pairs of the default table are the mean
// substances too, as with muscles in one rhythm, the table is that of material_table(), so that searches know its
// order.
std::vector<Material> voxel_table(const std::vector<Substance>& substances) {
  std::array<Material, base_material_count> bases{};
  std::ranges::transform(substances, bases.begin(), material_of);
  std::vector<Material> table = material_table(bases);
  std::vector<Material> means = table;
  bool same = true;
  for (std::size_t i = 0; i < substances.size(); ++i)
    for (std::size_t j = i + 1; j < substances.size(); ++j) {
      const Substance mean = mean_substance(std::array{substance_of(bases[i]), substance_of(bases[j])});
      const MaterialId id = combine(static_cast<MaterialId>(i + 1), static_cast<MaterialId>(j + 1));
      means[id] = material_of(mean);
      const Substance usual = substance_of(table[id]);
      const auto movement = [](const Substance& substance) {
        return substance.amplitude * std::polar(1.0, substance.phase);
      };
      same = same && std::abs(movement(mean) - movement(usual)) < 1e-6 && mean.half_wave == usual.half_wave;
    }
  return same ? table : means;
}

std::vector<std::string> voxel_names(const std::vector<std::string>& names) {
  std::vector<std::string> all(default_material_count);
  all[air] = "air";
  for (std::size_t i = 0; i < names.size(); ++i) {
    all[i + 1] = names[i];
    for (std::size_t j = i + 1; j < names.size(); ++j)
      all[combine(static_cast<MaterialId>(i + 1), static_cast<MaterialId>(j + 1))] = names[i] + " + " + names[j];
  }
  for (std::size_t id = 1; id < all.size(); ++id)
    if (all[id].empty()) all[id] = "unused";
  return all;
}

Robot voxel_robot(const VoxelBody& body, const std::string& name, const Provenance& provenance) {
  Robot robot = make_voxel_robot(grid_of(body), {.name = name,
                                                 .environment = provenance.environment,
                                                 .materials = voxel_table(body.substances),
                                                 .material_names = voxel_names(body.names)});
  robot.origin = with_provenance(robot.origin, provenance);
  return robot;
}

// The body with as many substances as a grid of voxels can have.
VoxelBody with_fewer_substances(const VoxelBody& body, std::size_t most, Rounding& rounding) {
  std::vector<std::uint32_t> used(body.substances.size(), 0);
  for (const std::uint32_t cell : body.cells)
    if (cell > 0) used[cell - 1] = 1;
  std::vector<Substance> substances;
  std::vector<std::size_t> substance_of_used;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i] != 0) {
      substances.push_back(body.substances[i]);
      substance_of_used.push_back(i);
    }
  const SubstanceGroups groups = grouped(substances, most);
  rounding = groups.rounding;
  VoxelBody fewer{.nx = body.nx,
                  .ny = body.ny,
                  .nz = body.nz,
                  .cells = body.cells,
                  .substances = groups.substances,
                  .names = {},
                  .held = {}};
  fewer.names.resize(groups.substances.size());
  std::vector<std::uint32_t> group_of_substance(body.substances.size(), 0);
  for (std::size_t i = substances.size(); i-- > 0;) {
    group_of_substance[substance_of_used[i]] = static_cast<std::uint32_t>(groups.group_of[i] + 1);
    fewer.names[groups.group_of[i]] = body.names[substance_of_used[i]];
  }
  for (std::uint32_t& cell : fewer.cells)
    if (cell > 0) cell = group_of_substance[cell - 1];
  return fewer;
}

[[noreturn]] void refuse_origin(const std::string& what) { throw InputError("/origin", what); }

VoxelBody body_of_import(const Json& origin) {
  VoxelBody body;
  try {
    const auto size = origin.at("size").get<std::array<int, 3>>();
    body.nx = size[0];
    body.ny = size[1];
    body.nz = size[2];
    body.cells = origin.at("cells").get<std::vector<std::uint32_t>>();
    for (const Json& row : origin.at("materials")) {
      body.names.push_back(row.at("name").get<std::string>());
      body.substances.push_back({.stiffness = row.at("stiffness").get<double>(),
                                 .amplitude = row.value("amplitude", 0.0),
                                 .frequency = row.value("frequency", 0.0),
                                 .phase = row.value("phase", 0.0),
                                 .half_wave = row.value("half_wave", false),
                                 .size = row.value("size", 1.0)});
    }
  } catch (const Json::exception&) {
    refuse_origin("an imported robot needs size, cells and materials");
  }
  const auto positive = [](int n) { return n >= 1 && n <= 1 << 22; };
  if (!positive(body.nx) || !positive(body.ny) || !positive(body.nz) ||
      static_cast<double>(body.nx) * body.ny * body.nz != static_cast<double>(body.cells.size()))
    refuse_origin("the size does not go with the cells");
  for (const std::uint32_t cell : body.cells)
    if (cell > body.substances.size())
      refuse_origin(fmt::format("a cell is of material {}, there are {}", cell, body.substances.size()));
  return body;
}

VoxelBody body_of_grid(const VoxelGrid& grid, const Robot& robot) {
  VoxelBody body{.nx = grid.nx, .ny = grid.ny, .nz = grid.nz, .cells = {}, .substances = {}, .names = {}, .held = {}};
  body.cells.assign(grid.cells.begin(), grid.cells.end());
  const auto table = materials_of(robot);
  std::size_t last = *std::ranges::max_element(body.cells);
  for (std::size_t id = 1; id <= last; ++id) {
    if (id >= table.size()) refuse_origin(fmt::format("a cell is of material {}, the table ends before", id));
    body.substances.push_back(substance_of(table[id]));
    body.names.push_back(id < robot.material_names.size() ? robot.material_names[id]
                                                          : default_material_name(static_cast<MaterialId>(id)));
  }
  return body;
}

// The body of these voxels in a grid that just holds it.
VoxelBody cut_out(const VoxelBody& all, const std::vector<std::size_t>& members) {
  const auto nx = static_cast<std::size_t>(all.nx), ny = static_cast<std::size_t>(all.ny);
  const auto place = [&](std::size_t cell) {
    return std::array{static_cast<int>(cell % nx), static_cast<int>(cell / nx % ny), static_cast<int>(cell / nx / ny)};
  };
  std::array<int, 3> lowest = place(members.front()), highest = lowest;
  for (const std::size_t cell : members)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lowest[axis] = std::min(lowest[axis], place(cell)[axis]);
      highest[axis] = std::max(highest[axis], place(cell)[axis]);
    }
  VoxelBody body{.nx = highest[0] - lowest[0] + 1,
                 .ny = highest[1] - lowest[1] + 1,
                 .nz = highest[2] - lowest[2] + 1,
                 .cells = {},
                 .substances = all.substances,
                 .names = all.names,
                 .held = {}};
  body.cells.assign(
      static_cast<std::size_t>(body.nx) * static_cast<std::size_t>(body.ny) * static_cast<std::size_t>(body.nz), 0);
  for (const std::size_t cell : members) {
    const std::array<int, 3> at = place(cell);
    const std::size_t own = body.index(at[0] - lowest[0], at[1] - lowest[1], at[2] - lowest[2]);
    body.cells[own] = all.cells[cell];
    if (!all.held.empty()) {
      body.held.resize(body.cells.size());
      body.held[own] = all.held[cell];
    }
  }
  return body;
}

}  // namespace

std::vector<VoxelBody> separate_bodies(const VoxelBody& all) {
  std::vector<std::vector<std::size_t>> bodies;
  std::vector<bool> seen(all.cells.size(), false);
  const auto nx = static_cast<std::size_t>(all.nx), ny = static_cast<std::size_t>(all.ny);
  for (std::size_t start = 0; start < all.cells.size(); ++start) {
    if (all.cells[start] == 0 || seen[start]) continue;
    std::vector<std::size_t> members{start};
    seen[start] = true;
    const auto visit = [&](bool inside, std::size_t cell) {
      if (!inside || all.cells[cell] == 0 || seen[cell]) return;
      seen[cell] = true;
      members.push_back(cell);
    };
    for (std::size_t next = 0; next < members.size(); ++next) {
      const std::size_t cell = members[next], x = cell % nx, y = cell / nx % ny, z = cell / nx / ny;
      visit(x > 0, cell - 1);
      visit(x + 1 < nx, cell + 1);
      visit(y > 0, cell - nx);
      visit(y + 1 < ny, cell + nx);
      visit(z > 0, cell - nx * ny);
      visit(z + 1 < static_cast<std::size_t>(all.nz), cell + nx * ny);
    }
    bodies.push_back(std::move(members));
  }
  if (bodies.size() > most_bodies)
    throw InputError(
        fmt::format("the voxels form {} separate bodies; at most {} are accepted", bodies.size(), most_bodies));
  if (bodies.size() == 1) return {all};
  std::ranges::stable_sort(bodies, std::greater(), &std::vector<std::size_t>::size);
  std::vector<VoxelBody> separate;
  std::size_t cells = 0;
  for (const std::vector<std::size_t>& members : bodies) {
    separate.push_back(cut_out(all, members));
    cells += separate.back().cells.size();
    if (cells > 2 * most_imported_cells) throw InputError("the voxels form separate bodies that reach too far");
  }
  return separate;
}

void fix_masses(Robot& robot, const VoxelBody& body) {
  if (std::ranges::find(body.held, true) == body.held.end()) return;
  const std::array size{body.nx, body.ny, body.nz};
  for (std::size_t mass = 0; mass < robot.masses.size(); ++mass) {
    // The voxels that have it at a corner or in the middle: along each axis, two that meet there or the one around it.
    std::array<int, 3> first{}, last{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Vec3& at = robot.masses[mass];
      const double halves =
          std::round(2.0 * static_cast<double>(std::array{at.x, at.y, at.z}[axis]) / imported_edge) + size[axis];
      first[axis] = std::max(0, static_cast<int>(std::ceil(halves / 2)) - 1);
      last[axis] = std::min(size[axis] - 1, static_cast<int>(std::floor(halves / 2)));
    }
    bool is_held = false;
    for (int z = first[2]; z <= last[2]; ++z)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int x = first[0]; x <= last[0]; ++x) is_held = is_held || body.held[body.index(x, y, z)];
    if (is_held) robot.fixed.push_back(static_cast<std::uint16_t>(mass));
  }
}

Robot bare_robot(const VoxelBody& body, const std::string& name) {
  VoxelGrid grid = grid_of(body);
  for (std::size_t i = 0; i < grid.cells.size(); ++i) grid.cells[i] = body.cells[i] == 0 ? air : tissue;
  Robot robot = make_voxel_robot(grid, {.name = name});
  robot.origin.clear();
  return robot;
}

SpringVoxels::SpringVoxels(const Robot& robot, const VoxelBody& body)
    : SpringCells(robot, {body.nx, body.ny, body.nz}, edge), body_(body) {}

std::vector<std::size_t> SpringVoxels::of(const Spring& spring) const {
  std::vector<std::size_t> voxels = SpringCells::of(spring);
  std::erase_if(voxels, [&](std::size_t cell) { return body_.cells[cell] == 0; });
  return voxels;
}

void set_substances(Robot& robot, const std::vector<Substance>& substances, const std::vector<std::string>& names,
                    std::size_t most_materials, Rounding& rounding) {
  const SubstanceGroups groups = grouped(substances, most_materials);
  rounding = groups.rounding;
  robot.materials.assign(1, Material{});
  for (const Substance& substance : groups.substances) robot.materials.push_back(material_of(substance));
  robot.material_names.assign(robot.materials.size(), "air");
  for (std::size_t i = names.size(); i-- > 0;) robot.material_names[groups.group_of[i] + 1] = names[i];
  for (std::size_t i = 0; i < robot.springs.size(); ++i) {
    const std::size_t group = groups.group_of[i];
    robot.springs[i].material = static_cast<MaterialId>(group + 1);
    if (const double size = groups.substances[group].size; size != 1)
      robot.springs[i].rest_length = static_cast<float>(robot.springs[i].rest_length * size);
  }
}

std::string import_origin(const VoxelBody& body, const Provenance& provenance) {
  Json substances = Json::array();
  for (std::size_t i = 0; i < body.substances.size(); ++i) {
    const Substance& substance = body.substances[i];
    Json row{{"name", body.names[i]}, {"stiffness", substance.stiffness}};
    if (substance.amplitude != 0) {
      row["amplitude"] = substance.amplitude;
      row["frequency"] = substance.frequency;
      row["phase"] = substance.phase;
      if (substance.half_wave) row["half_wave"] = true;
    }
    if (substance.size != 1) row["size"] = substance.size;
    substances.push_back(std::move(row));
  }
  Json origin{{"kind", "import"},
              {"size", {body.nx, body.ny, body.nz}},
              {"edge", imported_edge},
              {"imported", provenance_json(provenance)},
              {"materials", std::move(substances)},
              {"cells", body.cells}};
  if (!provenance.environment.empty()) origin["environment"] = provenance.environment;
  return origin_text(origin);
}

namespace {

// Springs that a voxel adds, in stiffnesses of its beam, k = E edge, where its mass is 1 kg (docs/formats.md):
//
//   4 along each axis     1/6 each    edges
//   2 across each side    1/15        face diagonals
//   4 through it          1/5         space diagonals
//
// With them an endless body is the isotropic one with E and Poisson's ratio 1/4, the only one that springs can be, and
// a bar of one voxel resists torsion as the beam, k edge^2 / 15.
double spring_share(std::array<int, 3> direction) {
  constexpr std::array shares{1.0 / 6, 1.0 / 15, 1.0 / 5};
  const auto axes = std::ranges::count_if(direction, [](int step) { return step != 0; });
  return shares[static_cast<std::size_t>(axes) - 1];
}

// How many voxels in a row are at this one, along the axis on which there are fewest.
int thickness_at(const VoxelBody& body, std::array<int, 3> at) {
  const std::array size{body.nx, body.ny, body.nz};
  int thinnest = std::numeric_limits<int>::max();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    int count = 1;
    for (const int step : {-1, 1}) {
      std::array<int, 3> next = at;
      for (next[axis] += step; next[axis] >= 0 && next[axis] < size[axis]; next[axis] += step) {
        if (body.cells[body.index(next[0], next[1], next[2])] == 0) break;
        ++count;
      }
    }
    thinnest = std::min(thinnest, count);
  }
  return thinnest;
}

// By how much voxels are softer, so that a limb of n voxels across bends as n x n beams do. A voxel has its springs at
// its surface, so it bends 2.4 times as stiffly as a beam, (1/6 + 1/15 / 2) / (1/12); the stretch of its neighbors adds
// (n^2 - 1) / 12 per voxel to both. One entry per cell.
std::vector<double> bending_factors(const VoxelBody& body) {
  std::vector<double> factors(body.cells.size(), 1);
  for (int z = 0; z < body.nz; ++z)
    for (int y = 0; y < body.ny; ++y)
      for (int x = 0; x < body.nx; ++x)
        if (const std::size_t cell = body.index(x, y, z); body.cells[cell] != 0) {
          const double n = thickness_at(body, {x, y, z});
          factors[cell] = n * n / (n * n + 1.4);
        }
  return factors;
}

// The mass of each point [kg]: an eighth of each voxel, of 1 kg, that it is a corner of.
std::vector<float> shares_of_voxels(const Robot& robot, const VoxelBody& body) {
  const SpringVoxels lattice(robot, body);
  std::vector<float> mass;
  for (std::size_t i = 0; i < robot.masses.size(); ++i) {
    const auto [x, y, z] = lattice.corner(static_cast<std::uint16_t>(i));
    int voxels = 0;
    for (int k = 0; k < 8; ++k) {
      const int cx = x - (k & 1), cy = y - (k >> 1 & 1), cz = z - (k >> 2);
      if (cx < 0 || cy < 0 || cz < 0 || cx >= body.nx || cy >= body.ny || cz >= body.nz) continue;
      if (body.cells[body.index(cx, cy, cz)] != 0) ++voxels;
    }
    mass.push_back(static_cast<float>(voxels) / 8);
  }
  return mass;
}

}  // namespace

Robot voxel_body_robot(const VoxelBody& body, const std::string& name, const Provenance& provenance,
                       std::size_t most_materials, Rounding& rounding, SpringRule rule, double relaxation_time) {
  const VoxelBody used = with_fewer_substances(body, body.substances.size(), rounding);
  const bool has_sizes =
      std::ranges::any_of(used.substances, [](const Substance& substance) { return substance.size != 1; });
  const std::size_t most_substances = std::min<std::size_t>(most_materials, base_material_count);
  if (!has_sizes && most_materials <= base_material_count)
    return voxel_robot(with_fewer_substances(used, most_substances, rounding), name, provenance);
  // The palette of the file keeps its numbers, also those that no voxel has.
  if (!has_sizes && body.substances.size() <= most_substances) return voxel_robot(body, name, provenance);
  if (!has_sizes && used.substances.size() <= most_substances) return voxel_robot(used, name, provenance);
  if (rule == SpringRule::standing) {
    Robot robot = standing_body(body, name, relaxation_time, most_materials, rounding);
    robot.origin = import_origin(used, provenance);
    return robot;
  }
  Robot robot = bare_robot(body, name);
  const SpringVoxels voxels(robot, body);
  const std::vector<double> softness = rule == SpringRule::bending ? bending_factors(body) : std::vector<double>();
  std::vector<Substance> substances;
  std::vector<std::string> names;
  substances.reserve(robot.springs.size());
  names.reserve(robot.springs.size());
  for (const Spring& spring : robot.springs) {
    std::vector<Substance> shared;
    std::vector<double> stiffnesses;
    std::set<std::string> shared_names;
    for (const std::size_t cell : voxels.of(spring)) {
      shared.push_back(body.substances[body.cells[cell] - 1]);
      stiffnesses.push_back(shared.back().stiffness * (softness.empty() ? 1 : softness[cell]));
      shared_names.insert(body.names[body.cells[cell] - 1]);
    }
    if (rule == SpringRule::equal) {
      substances.push_back(mean_substance(shared));
    } else {
      // Springs side by side pull with the sum of their forces.
      substances.push_back(mean_substance(shared, stiffnesses));
      substances.back().stiffness = spring_share(voxels.direction(spring)) * slice_stiffness(BeamModel{}.thickness) *
                                    std::accumulate(stiffnesses.begin(), stiffnesses.end(), 0.0);
    }
    names.push_back(fmt::format("{}", fmt::join(shared_names, " + ")));
  }
  if (rule != SpringRule::equal) robot.mass = shares_of_voxels(robot, body);
  set_substances(robot, substances, names, most_materials, rounding);
  robot.origin = import_origin(used, provenance);
  return robot;
}

std::optional<VoxelBody> voxel_body_of(const Robot& robot) {
  if (robot.origin.empty()) return std::nullopt;
  if (const std::optional<VoxelGrid> grid = voxel_grid_of(robot)) return body_of_grid(*grid, robot);
  if (const std::optional<CppnGenome> genome = cppn_genome_of(robot))
    return body_of_grid(painted_voxels(*genome), robot);
  if (kind_of(robot) != "import") return std::nullopt;
  return body_of_import(Json::parse(robot.origin));
}

}  // namespace mercury
