// SPDX-License-Identifier: Apache-2.0
// Random voxel robots as an entry of the registry.
#include <cmath>

#include "mercury/error.h"
#include "mercury/muscle_laws.h"
#include "mercury/origin.h"
#include "mercury/random.h"
#include "mercury/random_voxel.h"
#include "mercury/voxel_evolution.h"
#include "robots/parameter_table.h"

namespace mercury {
namespace {

const ParameterTable<RandomVoxelOptions>& table() {
  using Options = RandomVoxelOptions;
  static const ParameterTable<Options> rows{
      parameter(&Options::smallest, &Options::largest,
                {.name = "voxels",
                 .help = "Size in voxels, or smallest and largest",
                 .unit = "voxels",
                 .lowest = 1,
                 .usual_highest = 24}),
      parameter(&Options::edge, {.name = "edge",
                                 .help = "Side of a voxel",
                                 .unit = "m",
                                 .lowest = 0.001,
                                 .usual_highest = 0.5,
                                 .advanced = true}),
      parameter(&Options::air, {.name = "air",
                                .help = "Share of the voxels that are air",
                                .highest = 1,
                                .below_highest = true,
                                .usual_highest = 0.9}),
      parameter(&Options::mirror, {.name = "symmetry",
                                   .help = "Axis along which the halves mirror each other",
                                   .words = {"none", "x", "y", "z"}}),
      parameter(&Options::patch, {.name = "patch",
                                  .help = "Size of the regions of one material",
                                  .unit = "voxels",
                                  .lowest = 1,
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
                                        .lowest = 1,
                                        .highest = voxel_frequencies,
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
Robot crossed(const Robot& a, const Robot& b, std::uint64_t seed, const std::string& name) {
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
                  .title = "Voxel robots",
                  .noun = "a voxel robot",
                  .help = "Random voxel robots",
                  .example = {.name = "eel", .seed = 4, .values = {{"voxels", "12x2x3"}}},
                  .regrow = regrow,
                  .mutate = mutant,
                  .cross = crossed};
  return with_parameters(std::move(voxel), table(), random_voxel_robot);
}

}  // namespace mercury
