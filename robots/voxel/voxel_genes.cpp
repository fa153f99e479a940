// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "mercury/error.h"
#include "mercury/random.h"
#include "mercury/voxel.h"
#include "mercury/voxel_evolution.h"
#include "robots/genes.h"

namespace mercury {
namespace {

std::vector<bool> materials_in(const VoxelGrid& body) {
  std::vector<bool> in_use(base_material_count, false);
  for (const MaterialId cell : body.cells)
    if (cell != air) in_use[cell - 1u] = true;
  return in_use;
}

VoxelGrid mutated_grid(const VoxelGrid& grid, double strength, std::uint64_t seed) {
  VoxelMutation mutation;
  mutation.flip = std::min(1.0, strength * mutation.flip);
  mutation.swaps = static_cast<int>(std::lround(std::min(1000.0, strength * mutation.swaps)));
  mutation.mirror = mirror_of(grid);  // a symmetric parent has symmetric children
  return mutate(grid, mutation, seed);
}

VoxelGrid crossed_grids(const VoxelGrid& a, const VoxelGrid& b, std::uint64_t seed) {
  const Mirror mirror = mirror_of(a);
  return cross(a, b, seed, 2, mirror == mirror_of(b) ? mirror : Mirror::none);
}

struct VoxelGenes {
  static constexpr std::uint8_t tag = 1;
  VoxelGrid grid;
  MaterialGenes materials;

  static VoxelGenes of(const Robot& robot) {
    std::optional<VoxelGrid> grid = voxel_grid_of(robot);
    if (!grid) throw InputError("/origin", "holds no voxel grid");
    return {*std::move(grid), material_genes_of(robot)};
  }

  VoxelGenes mutated(Genes genes, const GeneMutation& mutation, std::uint64_t seed) const {
    VoxelGenes child = *this;
    const Changes changes = changes_of(genes, seed);
    if (changes.body) child.grid = mutated_grid(grid, mutation.strength, seed);
    if (changes.muscles)
      child.materials = mercury::mutated(materials, mutation, seed_of(seed, 0), materials_in(largest_body(child.grid)));
    return child;
  }

  std::size_t muscle_numbers() const { return muscle_numbers_of(materials, materials_in(largest_body(grid))); }

  VoxelGenes crossed(const VoxelGenes& other, Genes genes, std::uint64_t seed) const {
    VoxelGenes child = *this;
    if (genes != Genes::muscles) child.grid = crossed_grids(grid, other.grid, seed);
    if (genes != Genes::body) child.materials = mercury::crossed(materials, other.materials, seed_of(seed, 0));
    return child;
  }

  Robot grown(const std::string& name, const std::string& environment) const {
    return make_voxel_robot(grid, {.name = name, .environment = environment, .materials = table_of(materials)});
  }

  void write(ByteWriter& writer) const {
    for (const int n : {grid.nx, grid.ny, grid.nz}) writer.add(static_cast<std::uint32_t>(n));
    writer.add(grid.edge);
    writer.append(grid.cells);
    mercury::write(writer, materials);
  }

  static VoxelGenes read(ByteReader& reader) {
    VoxelGenes genes;
    std::uint64_t cells = 1;
    for (int* n : {&genes.grid.nx, &genes.grid.ny, &genes.grid.nz}) {
      const std::uint64_t size = std::min<std::uint64_t>(reader.read<std::uint32_t>(), VoxelGrid::max_cells + 1);
      *n = static_cast<int>(size);
      cells = std::min<std::uint64_t>(cells * size, VoxelGrid::max_cells + 1);
    }
    genes.grid.edge = reader.read<float>();
    const std::string_view bytes = reader.take(cells);
    genes.grid.cells.assign(bytes.begin(), bytes.end());
    validate(genes.grid);
    if (std::ranges::all_of(genes.grid.cells, [](MaterialId cell) { return cell == air; }))
      throw InputError("genome", "all voxels are air");
    genes.materials = read_material_genes(reader);
    require_known_count(genes.materials);
    return genes;
  }

  void add_identity(IdentityHash& hash) const {
    const VoxelGrid body = largest_body(grid);
    for (const int n : {grid.nx, grid.ny, grid.nz}) hash.add(static_cast<std::uint32_t>(n));
    hash.add(grid.edge);
    hash.add(body.cells);
    mercury::add_identity(hash, materials, materials_in(body));
  }
};

}  // namespace

const GenesKind& voxel_genes() {
  static constexpr GenesKind kind = genes_kind<VoxelGenes>();
  return kind;
}

}  // namespace mercury
