// SPDX-License-Identifier: Apache-2.0
// Network robots as an entry of the registry.
#include "mercury/nn_robot.h"

#include <algorithm>

#include "mercury/error.h"
#include "mercury/muscle_laws.h"
#include "mercury/random.h"
#include "robots/make_all.h"
#include "robots/muscle_fields.h"
#include "robots/parameter_table.h"

namespace mercury {

const GenesKind& nn_genes();

namespace {

const ParameterTable<NnOptions>& table() {
  using Options = NnOptions;
  static const ParameterTable<Options> rows{
      parameter(&Options::points, {.name = "points",
                                   .help = "Points of the cloud",
                                   .accepts = Accepts::between(min_cloud_points, max_masses),
                                   .usual_highest = 8192}),
      parameter(&Options::hidden, {.name = "hidden",
                                   .help = "Neurons of the hidden layers",
                                   .accepts = Accepts::between(min_hidden_width, max_network_width),
                                   .most_numbers = max_network_layers - 1,
                                   .advanced = true}),
      parameter(&Options::alpha,
                {.name = "alpha",
                 .help = "Radius of the alpha shape; 0 takes the smallest that gives one body holding all points",
                 .unit = "m",
                 .usual_highest = 1,
                 .advanced = true}),
      parameter(&Options::spacing,
                {.name = "spacing",
                 .help = "Least distance of two points, by their mean spacing; nearer ones are thinned or pushed apart",
                 .accepts = Accepts::between(0, 1)}),
      parameter(&Options::mirrored, {.name = "mirrored",
                                     .help = "Share of the robots that have a left and a right",
                                     .accepts = Accepts::between(0, 1)}),
      parameter(&Options::muscles, {.name = "network_muscles",
                                    .help = "Muscles of 20 kinds, or fields: any phase, amplitude and stiffness",
                                    .words = {"kinds", "fields"},
                                    .advanced = true}),
      parameter(&Options::frequencies, {.name = "network_frequencies",
                                        .help = "Muscle frequencies in one robot with fields",
                                        .accepts = Accepts::between(1, max_field_frequencies),
                                        .advanced = true}),
      parameter(&Options::frequency, {.name = "network_frequency",
                                      .help = "Highest muscle frequency in robots with fields",
                                      .unit = "rad/s",
                                      .accepts = Accepts::between(0, max_muscle_frequency),
                                      .advanced = true})};
  return rows;
}

NnGenome genome_in(const Robot& robot) {
  std::optional<NnGenome> genome = nn_genome_of(robot);
  if (!genome) throw InputError("/origin", "holds no network");
  return *std::move(genome);
}

// The robot of a genome with the materials of another, as its parent or the robot itself.
Robot grown(const NnGenome& genome, const Robot& owner, const std::string& name) {
  if (genome.network.has_fields()) return grow(genome, name);
  if (!owner.materials.empty() && owner.materials.size() < default_material_count)
    throw InputError("/materials",
                     "a network robot's table needs the base materials and their pairs, 254 in all, not " +
                         std::to_string(owner.materials.size()));
  Robot robot = grow(genome, name);
  robot.materials = owner.materials;
  robot.material_names = owner.material_names;
  return robot;
}

Robot regrow(const Robot& robot) { return grown(genome_in(robot), robot, robot.name); }

Robot mutant(const Robot& parent, const MutationRequest& request, const std::string& name) {
  const double rate = 0.1, size = 0.3 * request.strength;
  const NnGenome genome = genome_in(parent);
  if (genome.network.has_fields())
    return grow(mutate_muscles(mutate(genome, rate, size, request.seed), request.muscles, seed_of(request.seed, 0)),
                name);
  return with_mutated_muscles(grown(mutate(genome, rate, size, request.seed), parent, name), request.muscles,
                              seed_of(request.seed, 0));
}

Robot crossed_networks(const Robot& a, const Robot& b, std::uint64_t seed, const std::string& name) {
  const NnGenome of_a = genome_in(a), of_b = genome_in(b), child = crossover(of_a, of_b, seed);
  if (child.network.has_fields()) return grow(cross_muscles(child, of_b, seed_of(seed, 0)), name);
  return with_crossed_muscles(grown(child, a, name), b, seed_of(seed, 0));
}

}  // namespace

NnOptions nn_options_in(const ParameterValues& values);  // nn_genes.cpp
NnOptions nn_options_in(const ParameterValues& values) { return options_from(table(), values); }

void validate(const NnOptions& options) { check_each(table(), options); }

Generator nn_generator() {
  Generator nn{.kind = "nn",
               .word = "network",
               .title = "Network robots",
               .noun = "an nn robot",
               .help = "Robots grown by random neural networks",
               .note = "A file keeps the network, so that the robot can be changed and grown again.",
               .smooth = true,
               .may_be_tiny = true,
               .example = {.name = "blob", .seed = 4, .values = {{"points", "1000"}}},
               .regrow = regrow,
               .mutate = mutant,
               .cross = crossed_networks,
               .genes = &nn_genes()};
  return with_parameters(std::move(nn), table(), random_nn_robot);
}

Robot random_nn_robot(const NnOptions& options, std::uint64_t seed, std::uint64_t index) {
  return grow(random_nn_genome(options, seed, index), "nn-" + std::to_string(seed) + "-" + std::to_string(index));
}

std::vector<Robot> random_nn_robots(const NnOptions& options, std::uint64_t seed, std::size_t count,
                                    std::uint64_t first, std::vector<FailedRobot>* failed) {
  validate(options);
  return make_all(
      "nn", seed, count, first, [&](std::uint64_t index) { return random_nn_robot(options, seed, index); }, failed);
}

}  // namespace mercury
