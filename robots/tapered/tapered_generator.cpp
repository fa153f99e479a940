// SPDX-License-Identifier: Apache-2.0
// How tapered robots change, random ones, and the generator that makes them.
#include <string>
#include <utility>

#include "mercury/error.h"
#include "mercury/random.h"
#include "robots/genome_table.h"
#include "robots/tapered/tapered.h"

namespace mercury {

struct GenesKind;
const GenesKind& tapered_genes();

namespace {

const std::vector<std::string> bendings{"sideways", "up-down"};

// A number of an array as a row of the table.
template <std::size_t n>
TableRow<TaperedGenome> element(std::array<double, n> TaperedGenome::*member, std::size_t index, const char* name,
                                double lowest, double highest) {
  return row_of<TaperedGenome>(
      {.name = name + std::to_string(index + 1), .accepts = Accepts::between(lowest, highest)},
      [=](const TaperedGenome& genome) { return (genome.*member)[index]; },
      [=](TaperedGenome& genome, const ParameterValue& value) { (genome.*member)[index] = std::get<double>(value); });
}

TaperedGenome genome_in(const Robot& robot) {
  std::optional<TaperedGenome> genome = tapered_genome_of(robot);
  if (!genome) throw InputError("/origin", "holds no tapered robot");
  return *std::move(genome);
}

Robot mutated_tapered(const Robot& parent, const MutationRequest& request, const std::string& name) {
  TaperedGenome genome = mutate(genome_in(parent), request.strength, request.seed, is_of_body);
  return grow(mutate(genome, request.muscles, seed_of(request.seed, 0), is_of_muscles), name);
}

Robot crossed_tapered(const Robot& a, const Robot& b, std::uint64_t seed, const std::string& name) {
  return grow(crossover(genome_in(a), genome_in(b), seed), name);
}

const ParameterTable<TaperedOptions>& tapered_table() {
  using Options = TaperedOptions;
  static const ParameterTable<Options> rows{
      parameter(&Options::bending, {.name = "bending", .help = "How the bodies bend", .words = bendings}),
      parameter(&Options::volume, {.name = "volume",
                                   .help = "Volume of the bodies",
                                   .unit = "liters",
                                   .accepts = Accepts::between(0.1, 1e5),
                                   .usual_highest = 100}),
      parameter(&Options::stations, {.name = "stations",
                                     .help = "Cells from nose to tail",
                                     .accepts = Accepts::between(4, 100),
                                     .usual_highest = 40}),
      parameter(&Options::layers, {.name = "layers",
                                   .help = "Cells from one edge to the other",
                                   .accepts = Accepts::between(1, 10),
                                   .usual_highest = 6,
                                   .advanced = true})};
  return rows;
}

}  // namespace

const ParameterTable<TaperedGenome>& tapered_genome_table() {
  using G = TaperedGenome;
  static const ParameterTable<G> rows = [] {
    const auto number = [](auto member, const char* name, double lowest, double highest) {
      return parameter(member, {.name = name, .accepts = Accepts::between(lowest, highest)});
    };
    ParameterTable<G> made{parameter(&G::bending, {.name = "bending", .words = bendings}),
                           number(&G::stations, "stations", 4, 100),
                           number(&G::layers, "layers", 1, 10),
                           number(&G::segments, "segments", 2, 30),
                           number(&G::volume, "volume", 0.1, 1e5),
                           number(&G::width, "width", 0.1, 2),
                           number(&G::edge, "edge", 0.1, 1),
                           number(&G::frequency, "frequency", 0.1, 5),
                           number(&G::waves, "waves", -3, 3)};
    for (std::size_t i = 0; i < G::depth_places.size(); ++i)
      made.push_back(element(&G::depths, i, "depth_", 0.01, 0.5));
    for (std::size_t i = 0; i < G::contraction_places.size(); ++i)
      made.push_back(element(&G::contractions, i, "contraction_", 0, 0.4));
    return made;
  }();
  return rows;
}

bool is_of_body(std::string_view number) {
  return number == "width" || number == "edge" || number.starts_with("depth_");
}

bool is_of_muscles(std::string_view number) {
  return number == "frequency" || number == "waves" || number.starts_with("contraction_");
}

TaperedGenome mutate(const TaperedGenome& genome, double strength, std::uint64_t seed, bool (*chosen)(std::string_view),
                     int tail) {
  constexpr double step = usual_step, share = 1.0 / 3;
  Random random(seed_of(seed, 1));
  const auto moves = [&](std::string_view number) { return random.chance(share) && chosen(number); };
  // What moves where everything else is at the end of its range.
  const auto nudged = chosen("width") ? &TaperedGenome::width : &TaperedGenome::frequency;
  const auto [lowest, highest] = chosen("width") ? std::pair(0.1, 2.0) : std::pair(0.1, 5.0);
  return surely_moved(genome, tapered_genome_table(), step * strength, seed, moves, nudged, lowest, highest, tail);
}

TaperedGenome mutate(const TaperedGenome& genome, double strength, std::uint64_t seed) {
  return mutate(genome, strength, seed,
                [](std::string_view number) { return is_of_body(number) || is_of_muscles(number); });
}

TaperedGenome crossover(const TaperedGenome& a, const TaperedGenome& b, std::uint64_t seed) {
  Random random(seed);
  TaperedGenome child = a;
  for (const auto& row : tapered_genome_table()) {
    const bool of_b = random.chance(0.5);
    if (of_b && (is_of_body(row.description.name) || is_of_muscles(row.description.name))) row.set(child, row.get(b));
  }
  return child;
}

void validate(const TaperedOptions& options) { check_each(tapered_table(), options); }

TaperedGenome random_tapered_genome(const TaperedOptions& options, std::uint64_t seed, std::uint64_t index) {
  validate(options);
  Random random(seed_of(seed, index));
  TaperedGenome genome;
  genome.bending = options.bending;
  genome.volume = options.volume;
  genome.stations = options.stations;
  genome.layers = options.layers;
  genome.environment = options.environment;
  const double deepest = random.uniform(0.07, 0.2);
  for (double& depth : genome.depths) depth *= deepest / 0.1 * random.uniform(0.8, 1.2);
  genome.width = random.uniform(0.4, 0.8);
  genome.edge = random.uniform(0.4, 0.8);
  genome.frequency = random.uniform(1, 2.5);
  genome.waves = random.uniform(1, 2);
  const double strongest = random.uniform(0.1, 0.25);
  for (double& contraction : genome.contractions) contraction = strongest * random.uniform(0.6, 1.2);
  // Muscles that run from the tail to the nose carry a body along the ground.
  if (options.bending == TaperedBending::up_down && options.environment == "land") genome.waves = -genome.waves;
  return genome;
}

Robot random_tapered_robot(const TaperedOptions& options, std::uint64_t seed, std::uint64_t index) {
  return grow(random_tapered_genome(options, seed, index),
              "tapered-" + std::to_string(seed) + "-" + std::to_string(index));
}

Generator tapered_generator() {
  Generator tapered{.kind = "tapered",
                    .word = "tapered",
                    .title = "Tapered robots",
                    .noun = "a tapered robot",
                    .help = "Bodies with a nose and a tail that bend in a wave, like fish and worms",
                    .note = "They are made for --physics real. A file keeps the numbers that a body is built from.",
                    .environment = "water",
                    .example = {.name = "trout", .seed = 1, .values = {{"physics", "real"}, {"modulus", "2e6"}}},
                    .regrow = [](const Robot& robot) { return grow(genome_in(robot), robot.name); },
                    .mutate = mutated_tapered,
                    .cross = crossed_tapered,
                    .cells = tapered_cells,
                    .genes = &tapered_genes()};
  return with_parameters(std::move(tapered), tapered_table(), random_tapered_robot);
}

}  // namespace mercury
