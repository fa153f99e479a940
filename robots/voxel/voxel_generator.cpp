// SPDX-License-Identifier: Apache-2.0
#include "mercury/random_voxel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "mercury/error.h"
#include "mercury/muscle_laws.h"
#include "mercury/origin.h"
#include "mercury/random.h"
#include "mercury/voxel_evolution.h"
#include "robots/make_all.h"
#include "robots/parameter_table.h"

namespace mercury {

const GenesKind& voxel_genes();

namespace {

constexpr int phases = muscle_count / voxel_frequencies;  // of the base muscles

// A box of random numbers in [0, 1), read between its points by linear interpolation: smooth noise.
class Noise {
 public:
  Noise(Random& random, const VoxelGrid& grid, int spacing)
      : spacing_(spacing), nx_(grid.nx / spacing + 2), ny_(grid.ny / spacing + 2),
        values_(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_) *
                static_cast<std::size_t>(grid.nz / spacing + 2)) {
    for (double& value : values_) value = random.uniform();
  }

  double operator()(int x, int y, int z) const {
    const auto [i, u] = split(x);
    const auto [j, v] = split(y);
    const auto [k, w] = split(z);
    const auto along_x = [&, i = i, u = u](int b, int c) { return mix(at(i, b, c), at(i + 1, b, c), u); };
    const auto along_y = [&, j = j, v = v](int c) { return mix(along_x(j, c), along_x(j + 1, c), v); };
    return mix(along_y(k), along_y(k + 1), w);
  }

 private:
  struct Place {
    int cell;
    double rest;
  };
  Place split(int x) const { return {x / spacing_, (x % spacing_ + 0.5) / spacing_}; }
  static double mix(double a, double b, double t) { return a + t * (b - a); }
  double at(int i, int j, int k) const {
    return values_[static_cast<std::size_t>(i) +
                   static_cast<std::size_t>(nx_) *
                       (static_cast<std::size_t>(j) + static_cast<std::size_t>(ny_) * static_cast<std::size_t>(k))];
  }

  int spacing_, nx_, ny_;
  std::vector<double> values_;
};

// Draws the materials of one robot.
class Palette {
 public:
  Palette(Random& random, const RandomVoxelOptions& options) : options_(options) {
    std::iota(frequencies_.begin(), frequencies_.end(), 0);
    for (std::size_t i = frequencies_.size() - 1; i > 0; --i)
      std::swap(frequencies_[i], frequencies_[static_cast<std::size_t>(random.below(i + 1))]);
  }

  MaterialId draw(Random& random) const {
    double at = random.uniform() * (options_.muscle + options_.tissue + options_.bone);
    const auto choices = static_cast<std::uint64_t>(options_.frequencies);
    const int frequency = frequencies_[static_cast<std::size_t>(random.below(choices))];
    const auto phase = static_cast<int>(random.below(phases));
    if ((at -= options_.muscle) < 0) return static_cast<MaterialId>(frequency * phases + phase + 1);
    if ((at -= options_.tissue) < 0) return tissue;
    return options_.bone > 0 ? bone : options_.tissue > 0 ? tissue : MaterialId{1};
  }

 private:
  const RandomVoxelOptions& options_;
  std::array<int, voxel_frequencies> frequencies_{};
};

// Regions of one material. Each block of patch^3 voxels has one site; a voxel takes the material of the nearest site.
class Patches {
 public:
  Patches(Random& random, const Palette& palette, const VoxelGrid& grid, int patch)
      : patch_(patch), nx_((grid.nx - 1) / patch + 1), ny_((grid.ny - 1) / patch + 1), nz_((grid.nz - 1) / patch + 1) {
    sites_.reserve(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_) * static_cast<std::size_t>(nz_));
    const auto draw = [&](int block) { return (block + random.uniform()) * patch_; };
    for (int k = 0; k < nz_; ++k)
      for (int j = 0; j < ny_; ++j)
        for (int i = 0; i < nx_; ++i) {
          const double x = draw(i), y = draw(j), z = draw(k);
          sites_.push_back({x, y, z, palette.draw(random)});
        }
  }

  MaterialId at(int x, int y, int z) const {
    const int i = x / patch_, j = y / patch_, k = z / patch_;
    if (patch_ == 1) return site(i, j, k).material;
    double nearest = std::numeric_limits<double>::infinity();
    MaterialId material = air;
    for (int c = std::max(k - 1, 0); c <= std::min(k + 1, nz_ - 1); ++c)
      for (int b = std::max(j - 1, 0); b <= std::min(j + 1, ny_ - 1); ++b)
        for (int a = std::max(i - 1, 0); a <= std::min(i + 1, nx_ - 1); ++a) {
          const Site& candidate = site(a, b, c);
          const double dx = candidate.x - x - 0.5, dy = candidate.y - y - 0.5, dz = candidate.z - z - 0.5;
          const double distance = dx * dx + dy * dy + dz * dz;
          if (distance >= nearest) continue;
          nearest = distance;
          material = candidate.material;
        }
    return material;
  }

 private:
  struct Site {
    double x, y, z;
    MaterialId material;
  };
  const Site& site(int i, int j, int k) const {
    return sites_[static_cast<std::size_t>(i) +
                  static_cast<std::size_t>(nx_) *
                      (static_cast<std::size_t>(j) + static_cast<std::size_t>(ny_) * static_cast<std::size_t>(k))];
  }

  int patch_, nx_, ny_, nz_;
  std::vector<Site> sites_;
};

// The voxels of the drawn part that become air: those far from the middle, with dents and bays where the noise is high.
std::vector<bool> carve(Random& random, const VoxelGrid& grid, const std::array<int, 3>& drawn,
                        const RandomVoxelOptions& options) {
  const Noise noise(random, grid, std::max(options.patch, 2));
  struct Score {
    double value;
    std::size_t cell;
  };
  std::vector<Score> scores;
  const auto from_middle = [](int x, int n) {
    const double d = (2 * x + 1 - n) / static_cast<double>(n);
    return d * d;
  };
  for (int z = 0; z < drawn[2]; ++z)
    for (int y = 0; y < drawn[1]; ++y)
      for (int x = 0; x < drawn[0]; ++x)
        scores.push_back(
            {from_middle(x, grid.nx) + from_middle(y, grid.ny) + from_middle(z, grid.nz) + 2.5 * noise(x, y, z),
             grid.index(x, y, z)});
  const auto removed =
      std::min(static_cast<std::size_t>(options.air * static_cast<double>(scores.size()) + 0.5), scores.size() - 1);
  const auto middle = scores.begin() + static_cast<std::ptrdiff_t>(removed);
  std::nth_element(scores.begin(), middle, scores.end(), [](const Score& a, const Score& b) {
    return a.value != b.value ? a.value > b.value : a.cell < b.cell;
  });
  std::vector<bool> is_air(grid.cells.size(), false);
  for (auto score = scores.begin(); score != middle; ++score) is_air[score->cell] = true;
  return is_air;
}

}  // namespace

VoxelGrid random_voxel_grid(const RandomVoxelOptions& options, std::uint64_t seed, std::uint64_t index) {
  validate(options);
  Random random(seed_of(seed, index));
  std::array<int, 3> size;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int range = options.largest[axis] - options.smallest[axis];
    size[axis] = options.smallest[axis] + static_cast<int>(random.below(static_cast<std::uint64_t>(range) + 1));
  }
  VoxelGrid grid(size[0], size[1], size[2]);
  grid.edge = options.edge;
  std::array<int, 3> drawn = size;
  if (options.mirror != Mirror::none) {
    int& half = drawn[static_cast<std::size_t>(options.mirror) - 1];
    half = (half + 1) / 2;
  }
  const std::vector<bool> is_air = carve(random, grid, drawn, options);
  const Palette palette(random, options);
  const Patches patches(random, palette, grid, options.patch);
  const auto drawn_at = [&](int x, std::size_t axis) { return x < drawn[axis] ? x : size[axis] - 1 - x; };
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x) {
        const int u = drawn_at(x, 0), v = drawn_at(y, 1), w = drawn_at(z, 2);
        grid.cell(x, y, z) = is_air[grid.index(u, v, w)] ? air : patches.at(u, v, w);
      }
  return grid;
}

Robot random_voxel_robot(const RandomVoxelOptions& options, std::uint64_t seed, std::uint64_t index) {
  return make_voxel_robot(random_voxel_grid(options, seed, index),
                          {.name = "voxel-" + std::to_string(seed) + "-" + std::to_string(index),
                           .environment = options.environment,
                           .seed = seed,
                           .index = index});
}

std::vector<Robot> random_voxel_robots(const RandomVoxelOptions& options, std::uint64_t seed, std::size_t count,
                                       std::uint64_t first) {
  validate(options);
  return make_all(
      "voxel", seed, count, first, [&](std::uint64_t index) { return random_voxel_robot(options, seed, index); },
      nullptr);
}

// Random voxel robots as an entry of the registry.
namespace {

const ParameterTable<RandomVoxelOptions>& table() {
  using Options = RandomVoxelOptions;
  static const ParameterTable<Options> rows{
      parameter(&Options::smallest, &Options::largest,
                {.name = "voxels",
                 .help = "Size in voxels, or smallest and largest",
                 .unit = "voxels",
                 .accepts = Accepts::at_least(1),
                 .usual_highest = 24}),
      parameter(&Options::edge, {.name = "edge",
                                 .help = "Side of a voxel",
                                 .unit = "m",
                                 .accepts = Accepts::between(0.001, 1000),
                                 .usual_highest = 0.5,
                                 .advanced = true}),
      parameter(&Options::air, {.name = "air",
                                .help = "Share of the voxels that are air",
                                .accepts = Accepts::share_below_one(),
                                .usual_highest = 0.9}),
      parameter(&Options::mirror, {.name = "symmetry",
                                   .help = "Axis along which the halves mirror each other",
                                   .words = {"none", "x", "y", "z"}}),
      parameter(&Options::patch, {.name = "patch",
                                  .help = "Size of the regions of one material",
                                  .unit = "voxels",
                                  .accepts = Accepts::at_least(1),
                                  .usual_highest = 8,
                                  .advanced = true}),
      parameter(&Options::muscle, {.name = "muscle",
                                   .help = "Share of muscle among the regions",
                                   .unit = "share",
                                   .usual_highest = 1,
                                   .advanced = true}),
      parameter(&Options::tissue,
                {.name = "tissue", .help = "Share of tissue", .unit = "share", .usual_highest = 1, .advanced = true}),
      parameter(&Options::bone,
                {.name = "bone", .help = "Share of bone", .unit = "share", .usual_highest = 1, .advanced = true}),
      parameter(&Options::frequencies, {.name = "frequencies",
                                        .help = "Muscle frequencies in one robot",
                                        .accepts = Accepts::between(1, voxel_frequencies),
                                        .advanced = true})};
  return rows;
}

VoxelGrid grid_in(const Robot& robot) {
  std::optional<VoxelGrid> grid = voxel_grid_of(robot);
  if (!grid) throw InputError("/origin", "holds no voxel grid");
  return *std::move(grid);
}

Robot regrow(const Robot& robot) {
  return make_voxel_robot(grid_in(robot), {.name = robot.name,
                                           .environment = environment_of(robot),
                                           .materials = robot.materials,
                                           .material_names = robot.material_names});
}

// A symmetric parent has symmetric children.
Robot mutant(const Robot& parent, const MutationRequest& request, const std::string& name) {
  VoxelMutation mutation;
  mutation.flip = std::min(1.0, request.strength * mutation.flip);
  mutation.swaps = static_cast<int>(std::lround(std::min(1000.0, request.strength * mutation.swaps)));
  mutation.mirror = mirror_of(grid_in(parent));
  return with_mutated_muscles(mutate_voxel_robot(parent, mutation, request.seed, name), request.muscles,
                              seed_of(request.seed, 0));
}

// Two symmetric parents have symmetric children.
Robot crossed_voxels(const Robot& a, const Robot& b, std::uint64_t seed, const std::string& name) {
  const Mirror mirror = mirror_of(grid_in(a));
  const bool alike = mirror == mirror_of(grid_in(b));
  Robot child = cross_voxel_robots(a, b, seed, name, 2, alike ? mirror : Mirror::none);
  return with_crossed_muscles(std::move(child), b, seed_of(seed, 0));
}

}  // namespace

void validate(const RandomVoxelOptions& options) {
  check_each(table(), options);
  if (!(options.muscle + options.tissue + options.bone > 0))
    throw ParameterError("muscle, tissue, bone", "all are 0; give at least one share above 0");
}

Generator voxel_generator() {
  Generator voxel{.kind = "voxel",
                  .word = "voxel",
                  .title = "Voxel robots",
                  .noun = "a voxel robot",
                  .help = "Random voxel robots",
                  .example = {.name = "eel", .seed = 4, .values = {{"voxels", "12x2x3"}}},
                  .regrow = regrow,
                  .mutate = mutant,
                  .cross = crossed_voxels,
                  .genes = &voxel_genes()};
  return with_parameters(std::move(voxel), table(), random_voxel_robot);
}

}  // namespace mercury
