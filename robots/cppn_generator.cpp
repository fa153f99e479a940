// SPDX-License-Identifier: Apache-2.0
// Painted voxel robots as an entry of the registry.
#include "mercury/cppn.h"
#include "mercury/error.h"
#include "robots/cppn_evolution.h"
#include "robots/parameter_table.h"

namespace mercury {
namespace {

const ParameterTable<CppnOptions>& table() {
  using Options = CppnOptions;
  static const ParameterTable<Options> rows{
      parameter(&Options::smallest, &Options::largest,
                {.name = "canvas",
                 .help = "Size in voxels, or smallest and largest",
                 .unit = "voxels",
                 .lowest = 1,
                 .usual_highest = 24}),
      parameter(&Options::edge, {.name = "canvas_edge",
                                 .help = "Side of a voxel",
                                 .unit = "m",
                                 .lowest = 0.001,
                                 .highest = 1,
                                 .usual_highest = 0.5,
                                 .advanced = true}),
      parameter(&Options::filled,
                {.name = "filled", .help = "Smallest share of the grid that is painted", .highest = 1}),
      parameter(&Options::mirror, {.name = "canvas_symmetry",
                                   .help = "Axis along which the halves mirror each other",
                                   .words = {"none", "x", "y", "z"}}),
      parameter(&Options::hidden,
                {.name = "nodes", .help = "Hidden nodes that a network begins with", .highest = 60, .advanced = true}),
      parameter(&Options::frequencies, {.name = "muscle_frequencies",
                                        .help = "Muscle frequencies in one robot",
                                        .lowest = 1,
                                        .highest = voxel_frequencies,
                                        .advanced = true}),
      parameter(&Options::frequency,
                {.name = "muscle_frequency", .help = "Highest muscle frequency", .unit = "rad/s", .highest = 20})};
  return rows;
}

}  // namespace

void validate(const CppnOptions& options) {
  check_each(table(), options);
  std::uint64_t cells = 1;
  for (const int n : options.largest) {
    cells *= static_cast<std::uint64_t>(n);
    if (cells > max_cppn_cells)
      throw ParameterError("canvas",
                           "more than " + std::to_string(max_cppn_cells) + " voxels are not accepted; give fewer");
  }
}

Generator cppn_generator() {
  Generator cppn{.kind = "cppn",
                 .title = "Painted voxel robots",
                 .noun = "a painted voxel robot",
                 .help = "Voxel robots painted by a small network (CPPN)",
                 .note = "A file keeps the network, so that the robot can be changed and grown again.",
                 .example = {.name = "ripple", .seed = 4, .values = {{"canvas", "10x4x4"}}},
                 .regrow = [](const Robot& robot) { return grow(cppn_genome_in(robot), robot.name); },
                 .mutate = mutate_cppn_robot,
                 .cross = cross_cppn_robots};
  return with_parameters(std::move(cppn), table(), random_cppn_robot);
}

}  // namespace mercury
