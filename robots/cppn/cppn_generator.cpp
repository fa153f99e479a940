// SPDX-License-Identifier: Apache-2.0
// Random genomes of painted voxel robots.
//
// Most random networks paint nothing, or everything in one material. So each output is shifted and scaled until its
// values over the grid spread as wished: the grid is filled to a share that is drawn, most of the body is muscle, and
// the phase runs over a part of a turn or over some turns.
#include "mercury/cppn.h"

#include <algorithm>
#include <cmath>

#include "mercury/error.h"
#include "mercury/random.h"
#include "robots/cppn/cppn_graph.h"
#include "robots/parameter_table.h"

namespace mercury {

const GenesKind& cppn_genes();

namespace {

class RandomNetwork {
 public:
  RandomNetwork(const CppnOptions& options, CppnGenome& genome, Random& random)
      : options_(options), genome_(genome), network_(genome.network), random_(random) {}

  void draw() {
    network_ = {};
    if (options_.muscles == PaintedMuscles::fields) network_.outputs = cppn_outputs;
    add_edges();
    add_nodes();
    prune(network_);
    const double u = random_.uniform(), filled = options_.filled + (1 - options_.filled) * u * u;
    const double muscle = random_.uniform(0.6, 1);
    fit(presence_output, {.above_zero = filled, .range = 2});
    fit(kind_output, {.above_zero = muscle, .range = random_.uniform(0.5, 3)});
    fit(phase_output, {.above_zero = random_.uniform(), .range = random_.uniform(0.3, 1.3)});
    fit(frequency_output, {.above_zero = random_.uniform(0.3, 0.7), .range = random_.uniform(1, 3)});
    if (!has_fields(network_)) return;
    fit(amplitude_output, {.above_zero = random_.uniform(0.5, 1), .range = random_.uniform(0.3, 2)});
    fit(stiffness_output, {.above_zero = random_.uniform(0.3, 0.7), .range = random_.uniform(0.3, 2)});
  }

 private:
  float normal() { return static_cast<float>(random_.normal()); }

  void add_edges() {
    for (std::uint32_t output = 0; output < network_.outputs; ++output)
      for (std::uint32_t input = 0; input < cppn_inputs; ++input) {
        const float weight = normal();
        const bool joined = random_.chance(0.7) || input == bias_input;
        if (input == distance_input && output == presence_output)
          weight_of(network_, input, id_of(output)) = -1.5f * std::abs(weight);  // less is there far from the middle
        else if (joined)
          weight_of(network_, input, id_of(output)) = weight;
      }
  }
  void add_nodes() {
    for (int i = 0; i < options_.hidden; ++i) {
      const auto edge = static_cast<std::size_t>(random_.below(network_.edges.size()));
      const NewNode node{random_function(random_), 1.2f * normal(), 1.2f * normal()};
      split_edge(network_, edge, node);
      add_random_edge(network_, normal(), random_);
    }
  }

  struct Spread {
    double above_zero;  // share of the voxels
    double range;       // from the lowest to the highest value
  };
  // Outputs are weighted sums: a factor and a bias shift and scale them.
  void fit(CppnOutput output, const Spread& spread) {
    std::vector<double> values;
    for (const CppnEvaluator::Outputs& outputs : outputs_of(genome_)) values.push_back(outputs[output]);
    std::ranges::sort(values);
    const double range = values.back() - values.front();
    const auto below =
        static_cast<std::size_t>(std::round((1 - spread.above_zero) * static_cast<double>(values.size())));
    const std::size_t first_above = std::min(below, values.size() - 1);
    // Where all voxels are to be above zero, the lowest one is by as much as the next one exceeds it.
    double zero = first_above > 0 ? (values[first_above - 1] + values[first_above]) / 2 : values.front() - 0.05 * range;
    double factor = range > 0 ? spread.range / range : 1;
    if (range == 0) zero -= 1;
    factor = std::min(factor, 100.);
    for (CppnEdge& edge : network_.edges)
      if (edge.to == id_of(output)) edge.weight = scaled(edge.weight, factor);
    float& bias = weight_of(network_, bias_input, id_of(output));
    bias = scaled(1, static_cast<double>(bias) - factor * zero);
  }
  static float scaled(float weight, double factor) {
    return static_cast<float>(std::clamp(factor * static_cast<double>(weight), -100., 100.));
  }

  const CppnOptions& options_;
  CppnGenome& genome_;
  Cppn& network_;
  Random& random_;
};

struct Contents {
  double filled = 0;  // share of the grid
  double muscle = 0;  // share of the body
};
Contents contents_of(const VoxelGrid& body) {
  const auto count = [&](auto is_counted) {
    return static_cast<double>(std::ranges::count_if(body.cells, is_counted));
  };
  const double voxels = count([](MaterialId cell) { return cell != air; });
  const double muscles = count([](MaterialId cell) { return cell >= 1 && cell <= muscle_count; });
  return {voxels / static_cast<double>(body.cells.size()), voxels > 0 ? muscles / voxels : 0};
}

}  // namespace

CppnGenome random_cppn_genome(const CppnOptions& options, std::uint64_t seed, std::uint64_t index) {
  validate(options);
  Random random(seed_of(seed, index));
  const auto size = [&](std::size_t axis) {
    const int range = options.largest[axis] - options.smallest[axis];
    return options.smallest[axis] + static_cast<int>(random.below(static_cast<std::uint64_t>(range) + 1));
  };
  CppnGenome genome;
  genome.nx = size(0);
  genome.ny = size(1);
  genome.nz = size(2);
  genome.edge = options.edge;
  genome.mirror = options.mirror;
  genome.frequencies = options.frequencies;
  genome.frequency = options.frequency;
  genome.environment = options.environment;
  constexpr int tries = 30;
  CppnGenome best = genome;
  double largest = -1;
  for (int i = 0; i < tries; ++i) {
    RandomNetwork(options, genome, random).draw();
    const Contents body = contents_of(painted_body(genome).grid);
    if (body.filled >= 0.7 * options.filled && body.muscle >= 0.4) return genome;
    if (body.filled > largest) {
      largest = body.filled;
      best = genome;
    }
  }
  return best;
}

Robot random_cppn_robot(const CppnOptions& options, std::uint64_t seed, std::uint64_t index) {
  return grow(random_cppn_genome(options, seed, index), "cppn-" + std::to_string(seed) + "-" + std::to_string(index));
}

// Painted voxel robots as an entry of the registry.
namespace {

const ParameterTable<CppnOptions>& table() {
  using Options = CppnOptions;
  static const ParameterTable<Options> rows{
      parameter(&Options::smallest, &Options::largest,
                {.name = "canvas",
                 .help = "Size in voxels, or smallest and largest",
                 .unit = "voxels",
                 .accepts = Accepts::at_least(1),
                 .usual_highest = 24}),
      parameter(&Options::edge, {.name = "canvas_edge",
                                 .help = "Side of a voxel",
                                 .unit = "m",
                                 .accepts = Accepts::between(0.001, 1),
                                 .usual_highest = 0.5,
                                 .advanced = true}),
      parameter(
          &Options::filled,
          {.name = "filled", .help = "Smallest share of the grid that is painted", .accepts = Accepts::between(0, 1)}),
      parameter(&Options::mirror, {.name = "canvas_symmetry",
                                   .help = "Axis along which the halves mirror each other",
                                   .words = {"none", "x", "y", "z"}}),
      parameter(&Options::hidden, {.name = "nodes",
                                   .help = "Hidden nodes that a network begins with",
                                   .accepts = Accepts::between(0, 60),
                                   .advanced = true}),
      parameter(&Options::muscles, {.name = "painted_muscles",
                                    .help = "What of muscles is painted: phases alone, or amplitude and stiffness too",
                                    .words = {"phases", "fields"},
                                    .advanced = true}),
      parameter(&Options::frequencies, {.name = "muscle_frequencies",
                                        .help = "Muscle frequencies in one robot; 1 or 2 with fields",
                                        .accepts = Accepts::between(1, voxel_frequencies),
                                        .advanced = true}),
      parameter(&Options::frequency, {.name = "muscle_frequency",
                                      .help = "Highest muscle frequency",
                                      .unit = "rad/s",
                                      .accepts = Accepts::between(0, 20)})};
  return rows;
}

}  // namespace

void validate(const CppnOptions& options) {
  check_each(table(), options);
  if (options.muscles == PaintedMuscles::fields && options.frequencies > max_field_frequencies)
    throw ParameterError("muscle_frequencies",
                         std::to_string(options.frequencies) + " is not accepted with fields; give 1 or 2");
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
                 .word = "painted",
                 .title = "Painted voxel robots",
                 .noun = "a painted voxel robot",
                 .help = "Voxel robots painted by a small network (CPPN)",
                 .note = "A file keeps the network, so that the robot can be changed and grown again.",
                 .example = {.name = "ripple", .seed = 4, .values = {{"canvas", "10x4x4"}}},
                 .regrow = [](const Robot& robot) { return grow(cppn_genome_in(robot), robot.name); },
                 .mutate = mutate_cppn_robot,
                 .cross = cross_cppn_robots,
                 .genes = &cppn_genes()};
  return with_parameters(std::move(cppn), table(), random_cppn_robot);
}

}  // namespace mercury
