// SPDX-License-Identifier: Apache-2.0
#include "mercury/voxel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "mercury/error.h"
#include "robots/file/document.h"

namespace mercury {
namespace {

constexpr const char* place = "voxel grid";
constexpr double longest = 2e6;  // [m], so that no mass is farther than 1e6 m from the middle

std::string shown_size(const VoxelGrid& grid) {
  return std::to_string(grid.nx) + "x" + std::to_string(grid.ny) + "x" + std::to_string(grid.nz);
}

// nx * ny * nz, or some number above max_cells if that would overflow.
std::uint64_t cell_count(const VoxelGrid& grid) {
  const auto x = static_cast<std::uint64_t>(grid.nx), y = static_cast<std::uint64_t>(grid.ny),
             z = static_cast<std::uint64_t>(grid.nz);
  if (x * y > VoxelGrid::max_cells) return x * y;
  return x * y * z;  // below 2^26 * 2^31
}

void validate_size(const VoxelGrid& grid) {
  if (grid.nx < 1 || grid.ny < 1 || grid.nz < 1)
    throw InputError(place, "size " + shown_size(grid) + " is not accepted; give at least 1 voxel each way");
  if (cell_count(grid) > VoxelGrid::max_cells)
    throw InputError(place, "size " + shown_size(grid) + " is not accepted; give at most " +
                                std::to_string(VoxelGrid::max_cells) + " voxels");
}

// The body with a rim of air around it, and numbers for its corners. The rim saves bounds checks.
class Lattice {
 public:
  explicit Lattice(const VoxelGrid& body)
      : nx_(body.nx), ny_(body.ny), nz_(body.nz), row_(static_cast<std::size_t>(nx_) + 2),
        layer_(row_ * (static_cast<std::size_t>(ny_) + 2)), voxels_(layer_ * (static_cast<std::size_t>(nz_) + 2), air),
        masses_(voxels_.size(), 0) {
    for (int z = 0; z < nz_; ++z)
      for (int y = 0; y < ny_; ++y)
        std::copy_n(body.cells.begin() + static_cast<std::ptrdiff_t>(body.index(0, y, z)), nx_,
                    voxels_.begin() + static_cast<std::ptrdiff_t>(at(1, y + 1, z + 1)));
  }

  // Voxel (x, y, z) stands at at(x + 1, y + 1, z + 1). The voxels around corner (x, y, z) are those from at(x, y, z)
  // to at(x + 1, y + 1, z + 1), so a corner's index is that of its lowest voxel.
  std::size_t at(int x, int y, int z) const {
    return static_cast<std::size_t>(x) + row_ * static_cast<std::size_t>(y) + layer_ * static_cast<std::size_t>(z);
  }
  // Unsigned: a step backward wraps around, and wraps back when it is added to an index.
  std::size_t step(int x, int y, int z) const { return at(x, y, z); }

  std::size_t size() const { return voxels_.size(); }
  MaterialId voxel(std::size_t index) const { return voxels_[index]; }
  std::uint16_t mass(std::size_t corner) const { return masses_[corner]; }

  template <class Visit>  // visit(x, y, z, index) for each corner of a voxel, x fastest
  void for_each_corner(Visit visit) const {
    for (int z = 0; z <= nz_; ++z)
      for (int y = 0; y <= ny_; ++y)
        for (int x = 0; x <= nx_; ++x)
          if (const std::size_t i = at(x, y, z); is_corner(i)) visit(x, y, z, i);
  }
  template <class Visit>  // visit(x, y, z, index) for each voxel that is not air
  void for_each_voxel(Visit visit) const {
    for (int z = 0; z < nz_; ++z)
      for (int y = 0; y < ny_; ++y)
        for (int x = 0; x < nx_; ++x)
          if (const std::size_t i = at(x + 1, y + 1, z + 1); voxels_[i] != air) visit(x, y, z, i);
  }

  std::size_t count_corners() const {
    std::size_t count = 0;
    for_each_corner([&](int, int, int, std::size_t) { ++count; });
    return count;
  }
  void number_masses() {
    std::uint16_t next = 0;
    for_each_corner([&](int, int, int, std::size_t i) { masses_[i] = next++; });
  }

 private:
  bool is_corner(std::size_t i) const {
    const std::size_t j = i + row_, k = i + layer_, l = k + row_;
    return (voxels_[i] | voxels_[i + 1] | voxels_[j] | voxels_[j + 1] | voxels_[k] | voxels_[k + 1] | voxels_[l] |
            voxels_[l + 1]) != air;
  }

  int nx_, ny_, nz_;
  std::size_t row_, layer_;
  std::vector<MaterialId> voxels_;
  std::vector<std::uint16_t> masses_;
};

// The step from one corner of a voxel to another, for half of all pairs: (x, y, z) > (0, 0, 0), z first.
struct Direction {
  std::size_t step = 0;                 // to the other mass
  std::array<std::size_t, 4> voxels{};  // the voxels that hold both masses, as steps from the first mass's corner
  std::size_t voxel_count = 0;
  float length = 0;  // [m]
};

std::array<Direction, 13> directions_of(const Lattice& lattice, float edge) {
  std::array<Direction, 13> directions;
  std::size_t next = 0;
  for (int z = 0; z <= 1; ++z)
    for (int y = z == 0 ? 0 : -1; y <= 1; ++y)
      for (int x = z == 0 && y == 0 ? 1 : -1; x <= 1; ++x) {
        Direction& direction = directions[next++];
        direction.step = lattice.step(x, y, z);
        direction.length = static_cast<float>(static_cast<double>(edge) * std::sqrt(x * x + y * y + z * z));
        for (int w = z > 0 ? 1 : 0; w <= (z < 0 ? 0 : 1); ++w)
          for (int v = y > 0 ? 1 : 0; v <= (y < 0 ? 0 : 1); ++v)
            for (int u = x > 0 ? 1 : 0; u <= (x < 0 ? 0 : 1); ++u)
              direction.voxels[direction.voxel_count++] = lattice.step(u, v, w);
      }
  return directions;
}

// combine(i, j) of all base materials.
using Combinations = std::array<std::array<MaterialId, base_material_count + 1>, base_material_count + 1>;

const Combinations& combinations() {
  static const Combinations all = [] {
    Combinations table{};
    for (MaterialId i = 1; i <= base_material_count; ++i)
      for (MaterialId j = 1; j <= base_material_count; ++j) table[i][j] = combine(i, j);
    return table;
  }();
  return all;
}

// The two most common of three or four materials, combined; ties go to the lower id.
MaterialId combine_most_common(const std::array<MaterialId, 4>& materials, std::size_t count,
                               const Combinations& combined) {
  // Voxels of each material, where it comes first; the rest is 0.
  std::array<int, 4> voxels{};
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t first = 0;
    while (materials[first] != materials[i]) ++first;
    ++voxels[first];
  }
  const auto take_most_common = [&](MaterialId otherwise) {
    std::size_t most = 4;
    for (std::size_t i = 0; i < count; ++i)
      if (voxels[i] > 0 &&
          (most == 4 || voxels[i] > voxels[most] || (voxels[i] == voxels[most] && materials[i] < materials[most])))
        most = i;
    if (most == 4) return otherwise;
    voxels[most] = 0;
    return materials[most];
  };
  const MaterialId first = take_most_common(air);
  return combined[first][take_most_common(first)];
}

void add_masses(const Lattice& lattice, const VoxelGrid& grid, Robot& robot) {
  lattice.for_each_corner([&](int x, int y, int z, std::size_t) {
    const auto place_of = [&](int corner, int voxels) {
      return static_cast<float>((corner - voxels / 2.0) * static_cast<double>(grid.edge));
    };
    robot.masses.push_back({place_of(x, grid.nx), place_of(y, grid.ny), place_of(z, grid.nz)});
  });
}

void add_springs(const Lattice& lattice, float edge, Robot& robot) {
  const auto directions = directions_of(lattice, edge);
  const Combinations& combined = combinations();
  std::vector<Spring> springs(robot.masses.size() * directions.size());
  std::size_t next = 0;
  lattice.for_each_corner([&](int, int, int, std::size_t corner) {
    for (const Direction& direction : directions) {
      std::array<MaterialId, 4> materials{};
      std::size_t count = 0;
      for (std::size_t i = 0; i < direction.voxel_count; ++i) {
        const MaterialId material = materials[count] = lattice.voxel(corner + direction.voxels[i]);
        count += material != air ? 1 : 0;
      }
      if (count == 0) continue;
      const MaterialId material = count == 1   ? materials[0]
                                  : count == 2 ? combined[materials[0]][materials[1]]
                                               : combine_most_common(materials, count, combined);
      springs[next++] = {lattice.mass(corner), lattice.mass(corner + direction.step), material, direction.length};
    }
  });
  robot.springs.assign(springs.begin(), springs.begin() + static_cast<std::ptrdiff_t>(next));
}

void add_faces(const Lattice& lattice, Robot& robot) {
  constexpr int axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  lattice.for_each_voxel([&](int x, int y, int z, std::size_t voxel) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (int outward = 0; outward <= 1; ++outward) {
        const auto& n = axes[axis];
        const std::size_t to_neighbor = lattice.step(n[0], n[1], n[2]);
        if (lattice.voxel(outward != 0 ? voxel + to_neighbor : voxel - to_neighbor) != air) continue;
        const auto& u = axes[(axis + 1) % 3];
        const auto& v = axes[(axis + 2) % 3];
        const std::size_t first = lattice.at(x, y, z) + (outward != 0 ? to_neighbor : 0);
        const std::size_t along_u = lattice.step(u[0], u[1], u[2]), along_v = lattice.step(v[0], v[1], v[2]);
        std::uint16_t a = lattice.mass(first), b = lattice.mass(first + along_u),
                      c = lattice.mass(first + along_u + along_v), d = lattice.mass(first + along_v);
        if (outward == 0) std::swap(b, d);
        // Diagonals join corners of even x + y + z, so that the skin's triangles favor no direction.
        if ((x + y + z + outward) % 2 == 0) {
          robot.faces.push_back({a, b, c});
          robot.faces.push_back({a, c, d});
        } else {
          robot.faces.push_back({a, b, d});
          robot.faces.push_back({b, c, d});
        }
      }
  });
}

using Json = nlohmann::json;

[[noreturn]] void refuse(const std::string& what) { throw InputError("/origin", what); }

int size_of(const Json& size, std::size_t axis) {
  const Json& value = size[axis];
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() == 0 ||
      value.get<std::uint64_t>() > VoxelGrid::max_cells)
    refuse("size must be three whole numbers of at least 1");
  return value.get<int>();
}

VoxelGrid grid_of(const Json& origin) {
  const auto size = origin.find("size"), edge = origin.find("edge"), cells = origin.find("cells");
  if (size == origin.end() || !size->is_array() || size->size() != 3)
    refuse("size must be three whole numbers of at least 1");
  if (edge == origin.end() || !edge->is_number() || !(std::abs(edge->get<double>()) <= 1e6))
    refuse("edge must be a number of meters");
  if (cells == origin.end() || !cells->is_array()) refuse("cells must be an array of materials");
  VoxelGrid grid;
  grid.nx = size_of(*size, 0);
  grid.ny = size_of(*size, 1);
  grid.nz = size_of(*size, 2);
  grid.edge = edge->get<float>();
  grid.cells.reserve(cells->size());
  for (const Json& cell : *cells) {
    if (!cell.is_number_unsigned() || cell.get<std::uint64_t>() > base_material_count)
      refuse("cells must be 0 (air) or base materials (1 to 22)");
    grid.cells.push_back(cell.get<MaterialId>());
  }
  return grid;
}

// {"kind":"voxel","size":[nx,ny,nz],"edge":0.1,"environment":"ocean","seed":1,"index":2,"cells":[...]}. The cells are
// in the order of VoxelGrid; environment, seed and index appear only if they are known.
std::string voxel_origin(const VoxelGrid& grid, const VoxelRobotOptions& options) {
  std::string origin = R"({"kind":"voxel","size":[)" + std::to_string(grid.nx) + "," + std::to_string(grid.ny) + "," +
                       std::to_string(grid.nz) + "],\"edge\":";
  std::array<char, 32> room;
  origin += to_text(real_number(grid.edge, room));
  if (!options.environment.empty()) origin += ",\"environment\":" + json_text(options.environment);
  if (options.seed) origin += ",\"seed\":" + std::to_string(*options.seed);
  if (options.index) origin += ",\"index\":" + std::to_string(*options.index);
  origin += ",\"cells\":[";
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    if (i > 0) origin += ',';
    origin += std::to_string(grid.cells[i]);
  }
  return origin += "]}";
}

}  // namespace

VoxelGrid::VoxelGrid(int size_x, int size_y, int size_z, MaterialId fill) : nx(size_x), ny(size_y), nz(size_z) {
  validate_size(*this);
  cells.assign(cell_count(*this), fill);
}

void validate(const VoxelGrid& grid) {
  validate_size(grid);
  if (grid.cells.size() != cell_count(grid))
    throw InputError(place, "size " + shown_size(grid) + " needs " + std::to_string(cell_count(grid)) + " cells, not " +
                                std::to_string(grid.cells.size()));
  for (std::size_t i = 0; i < grid.cells.size(); ++i)
    if (grid.cells[i] > base_material_count)
      throw InputError(place, "cell " + std::to_string(i) + " is of material " + std::to_string(grid.cells[i]) +
                                  "; give 0 (air) or a base material (1 to 22)");
  const double side = static_cast<double>(grid.edge) * std::max({grid.nx, grid.ny, grid.nz});
  if (!(grid.edge >= min_rest_length && side <= longest))
    throw InputError(place, "a voxel edge of " + std::to_string(grid.edge) +
                                " m is not accepted; give at least 0.001 m and a grid of at most 2e6 m");
}

VoxelGrid largest_body(const VoxelGrid& grid) {
  validate(grid);
  const Lattice lattice(grid);
  const std::size_t row = lattice.step(0, 1, 0), layer = lattice.step(0, 0, 1);
  constexpr std::uint32_t unseen = 0xffffffff;
  std::vector<std::uint32_t> body_of(lattice.size(), 0);  // 0 = air
  lattice.for_each_voxel([&](int, int, int, std::size_t i) { body_of[i] = unseen; });
  std::vector<std::size_t> open;
  std::size_t largest_size = 0;
  std::uint32_t bodies = 0, largest = 0;
  lattice.for_each_voxel([&](int, int, int, std::size_t start) {
    if (body_of[start] != unseen) return;
    body_of[start] = ++bodies;
    open.assign(1, start);
    std::size_t size = 0;
    while (!open.empty()) {
      const std::size_t i = open.back();
      open.pop_back();
      ++size;
      for (const std::size_t neighbor : {i - 1, i + 1, i - row, i + row, i - layer, i + layer}) {
        if (body_of[neighbor] != unseen) continue;
        body_of[neighbor] = bodies;
        open.push_back(neighbor);
      }
    }
    if (size > largest_size) {
      largest_size = size;
      largest = bodies;
    }
  });
  VoxelGrid body = grid;
  lattice.for_each_voxel([&](int x, int y, int z, std::size_t i) {
    if (body_of[i] != largest) body.cells[body.index(x, y, z)] = air;
  });
  return body;
}

Robot make_voxel_robot(const VoxelGrid& grid, const VoxelRobotOptions& options) {
  if (!options.materials.empty() && options.materials.size() < default_material_count)
    throw InputError("/materials", "a voxel robot's table needs the base materials and their pairs, 254 in all, not " +
                                       std::to_string(options.materials.size()));
  Lattice lattice(largest_body(grid));
  const std::size_t masses = lattice.count_corners();
  if (masses == 0) throw InputError(place, "all voxels are air, a robot needs at least one that is not");
  if (masses > max_masses)
    throw InputError(place, "the body has " + std::to_string(masses) + " masses, at most 65535 are accepted");
  lattice.number_masses();
  Robot robot;
  robot.name = options.name;
  robot.materials = options.materials;
  robot.material_names = options.material_names;
  robot.origin = voxel_origin(grid, options);
  robot.masses.reserve(masses);
  add_masses(lattice, grid, robot);
  add_springs(lattice, grid.edge, robot);
  add_faces(lattice, robot);
  robot.faces.shrink_to_fit();
  return robot;
}

std::optional<VoxelGrid> voxel_grid_of(const Robot& robot) {
  if (robot.origin.empty()) return std::nullopt;
  const Json origin = Json::parse(robot.origin, nullptr, false);
  if (!origin.is_object()) refuse("must be a JSON object");
  const auto kind = origin.find("kind");
  if (kind == origin.end() || *kind != "voxel") return std::nullopt;
  VoxelGrid grid = grid_of(origin);
  try {
    validate(grid);
  } catch (const InputError& error) {
    refuse(error.what());
  }
  return grid;
}

}  // namespace mercury
