// SPDX-License-Identifier: Apache-2.0
#include "mercury/voxel_evolution.h"

#include <algorithm>
#include <array>
#include <utility>

#include "mercury/error.h"
#include "mercury/origin.h"
#include "mercury/random.h"

namespace mercury {
namespace {

using Place = std::array<int, 3>;

Place size_of(const VoxelGrid& grid) { return {grid.nx, grid.ny, grid.nz}; }

template <class Visit>
void for_each(const Place& size, Visit visit) {
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x) visit(Place{x, y, z});
}

// The place in the lower half whose mirror image this is, or the place itself.
Place folded(Place place, const Place& size, Mirror mirror) {
  const std::size_t axis = static_cast<std::size_t>(mirror) - 1;
  place[axis] = std::min(place[axis], size[axis] - 1 - place[axis]);
  return place;
}

MaterialId& cell(VoxelGrid& grid, const Place& at) { return grid.cell(at[0], at[1], at[2]); }
MaterialId cell(const VoxelGrid& grid, const Place& at) { return grid.at(at[0], at[1], at[2]); }

class MaterialSource {
 public:
  MaterialSource(const VoxelGrid& parent, const VoxelMutation& mutation)
      : choices_(mutation.materials), air_(mutation.air), own_alone_(!choices_.empty()) {
    if (own_alone_) return;
    choices_ = parent.cells;
    std::sort(choices_.begin(), choices_.end());
    choices_.erase(std::unique(choices_.begin(), choices_.end()), choices_.end());
    std::erase(choices_, air);
  }
  // Everything but air that a voxel can become.
  std::vector<MaterialId> all() const {
    std::vector<MaterialId> materials = choices_;
    if (!own_alone_)
      for (MaterialId id = 1; id <= base_material_count; ++id) materials.push_back(id);
    return materials;
  }
  MaterialId draw(Random& random) const {
    if (random.chance(air_)) return air;
    if (choices_.empty() || (!own_alone_ && random.chance(0.25)))
      return static_cast<MaterialId>(1 + random.below(base_material_count));
    return choices_[static_cast<std::size_t>(random.below(choices_.size()))];
  }

 private:
  std::vector<MaterialId> choices_;
  double air_;
  bool own_alone_;
};

// Swaps the contents of two boxes of one size, anywhere in the grid, voxel by voxel.
void swap_patches(VoxelGrid& grid, Random& random, int largest) {
  const Place size = size_of(grid);
  Place box, a, b;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto draw = [&](int n) { return static_cast<int>(random.below(static_cast<std::uint64_t>(n))); };
    box[axis] = 1 + draw(std::min(largest, size[axis]));
    a[axis] = draw(size[axis] - box[axis] + 1);
    b[axis] = draw(size[axis] - box[axis] + 1);
  }
  for_each(box, [&](const Place& at) {
    std::swap(cell(grid, {a[0] + at[0], a[1] + at[1], a[2] + at[2]}),
              cell(grid, {b[0] + at[0], b[1] + at[1], b[2] + at[2]}));
  });
}

void mirror_halves(VoxelGrid& grid, Mirror mirror) {
  if (mirror == Mirror::none) return;
  const Place size = size_of(grid);
  for_each(size, [&](const Place& at) { cell(grid, at) = cell(grid, folded(at, size, mirror)); });
}

void keep_alive(VoxelGrid& child, const VoxelGrid& parent) {
  if (std::any_of(child.cells.begin(), child.cells.end(), [](MaterialId m) { return m != air; })) return;
  child.cells = parent.cells;
}

VoxelGrid changed_once(const VoxelGrid& parent, const MaterialSource& source, const VoxelMutation& mutation,
                       std::uint64_t seed) {
  Random random(seed);
  VoxelGrid child = parent;
  for (MaterialId& material : child.cells)
    if (random.chance(mutation.flip)) material = source.draw(random);
  for (int i = 0; i < mutation.swaps; ++i) swap_patches(child, random, mutation.patch);
  mirror_halves(child, mutation.mirror);
  keep_alive(child, parent);
  return child;
}

// The parent with one voxel of its body (and with a mirror, that voxel's image) of another material; the parent itself
// if none can be.
VoxelGrid forced_change(const VoxelGrid& parent, const VoxelGrid& body, const MaterialSource& source, Mirror mirror,
                        std::uint64_t seed) {
  Random random(seed);
  const std::vector<MaterialId> materials = source.all();
  const std::size_t first_cell = random.below(body.cells.size()), first_material = random.below(materials.size());
  for (std::size_t i = 0; i < body.cells.size(); ++i) {
    const std::size_t voxel = (first_cell + i) % body.cells.size();
    if (body.cells[voxel] == air) continue;
    for (std::size_t m = 0; m < materials.size(); ++m) {
      VoxelGrid child = parent;
      child.cells[voxel] = materials[(first_material + m) % materials.size()];
      mirror_halves(child, mirror);
      if (largest_body(child) != body) return child;
    }
  }
  return parent;
}

VoxelGrid grid_of(const Robot& robot) {
  auto grid = voxel_grid_of(robot);
  if (!grid) throw InputError("robot " + robot.name, "not a voxel robot, its origin holds no grid");
  return *std::move(grid);
}

Robot robot_of(const VoxelGrid& grid, const Robot& parent, std::uint64_t seed, const std::string& name) {
  return make_voxel_robot(grid, {.name = name,
                                 .environment = environment_of(parent),
                                 .seed = seed,
                                 .materials = parent.materials,
                                 .material_names = parent.material_names});
}

void validate_patch(int patch) {
  if (patch < 1) throw ParameterError("patch", "give at least 1 voxel");
}

}  // namespace

void validate(const VoxelMutation& mutation) {
  if (!(mutation.flip >= 0 && mutation.flip <= 1)) throw ParameterError("flip", "give a chance between 0 and 1");
  if (!(mutation.air >= 0 && mutation.air <= 1)) throw ParameterError("air", "give a chance between 0 and 1");
  if (mutation.swaps < 0) throw ParameterError("swaps", "give 0 or more");
  validate_patch(mutation.patch);
  for (const MaterialId material : mutation.materials)
    if (material < 1 || material > base_material_count)
      throw ParameterError("materials", std::to_string(material) + " is not a base material; give 1 to 22");
}

Mirror mirror_of(const VoxelGrid& grid) {
  const Place size = size_of(grid);
  for (const Mirror mirror : {Mirror::y, Mirror::x, Mirror::z}) {
    bool alike = true;
    for_each(size, [&](const Place& at) { alike = alike && cell(grid, at) == cell(grid, folded(at, size, mirror)); });
    if (alike) return mirror;
  }
  return Mirror::none;
}

VoxelGrid mutate(const VoxelGrid& parent, const VoxelMutation& mutation, std::uint64_t seed) {
  validate(parent);
  validate(mutation);
  const MaterialSource source(parent, mutation);
  const VoxelGrid body = largest_body(parent);
  if (mutation.flip == 0 && mutation.swaps == 0) return changed_once(parent, source, mutation, seed);
  constexpr std::uint64_t attempts = 30;
  for (std::uint64_t attempt = 0; attempt < attempts; ++attempt) {
    VoxelGrid child = changed_once(parent, source, mutation, attempt == 0 ? seed : seed_of(seed, attempt));
    if (largest_body(child) != body) return child;
  }
  return forced_change(parent, body, source, mutation.mirror, seed);
}

VoxelGrid cross(const VoxelGrid& a, const VoxelGrid& b, std::uint64_t seed, int patch, Mirror mirror) {
  validate(a);
  validate(b);
  validate_patch(patch);
  Random random(seed);
  const Place size = size_of(a), other = size_of(b);
  Place blocks;
  for (std::size_t axis = 0; axis < 3; ++axis) blocks[axis] = (size[axis] - 1) / patch + 1;
  std::vector<bool> from_b;
  for_each(blocks, [&](const Place&) { from_b.push_back(random.chance(0.5)); });
  VoxelGrid child = a;
  for_each(size, [&](const Place& at) {
    const auto block =
        static_cast<std::size_t>(at[0] / patch + blocks[0] * (at[1] / patch + blocks[1] * (at[2] / patch)));
    if (!from_b[block]) return;
    Place in_b;
    // Rounds down, also below 0, so that b lies in the middle of a.
    for (std::size_t axis = 0; axis < 3; ++axis) in_b[axis] = at[axis] - ((size[axis] - other[axis]) >> 1);
    if (b.contains(in_b[0], in_b[1], in_b[2])) cell(child, at) = cell(b, in_b);
  });
  mirror_halves(child, mirror);
  keep_alive(child, a);
  return child;
}

Robot mutate_voxel_robot(const Robot& parent, const VoxelMutation& mutation, std::uint64_t seed,
                         const std::string& name) {
  return robot_of(mutate(grid_of(parent), mutation, seed), parent, seed, name);
}

Robot cross_voxel_robots(const Robot& a, const Robot& b, std::uint64_t seed, const std::string& name, int patch,
                         Mirror mirror) {
  return robot_of(cross(grid_of(a), grid_of(b), seed, patch, mirror), a, seed, name);
}

}  // namespace mercury
