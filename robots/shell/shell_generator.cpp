// SPDX-License-Identifier: Apache-2.0
#include "mercury/shell.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "mercury/error.h"
#include "mercury/random.h"
#include "robots/genome_table.h"
#include "robots/shell/shell_genome.h"

namespace mercury {

const GenesKind& shell_genes();

namespace {

const std::vector<std::string> form_names{"bell", "tube", "ring", "pod"};
constexpr double step = 0.04;  // of a mutation, over the range of a number

}  // namespace

const ParameterTable<ShellGenome>& shell_genome_table() {
  using G = ShellGenome;
  const auto number = [](auto member, const char* name, double lowest, double highest) {
    return parameter(member, {.name = name, .accepts = Accepts::between(lowest, highest)});
  };
  static const ParameterTable<G> rows{parameter(&G::form, {.name = "form", .words = form_names}),
                                      number(&G::segments, "segments", 12, 128),
                                      number(&G::lobes, "lobes", 3, 16),
                                      number(&G::waves_around, "waves_around", -4, 4),
                                      number(&G::diameter, "diameter", 0.2, 20),
                                      number(&G::thickness, "thickness", 0.01, 5),
                                      number(&G::height, "height", 0.2, 3),
                                      number(&G::opening, "opening", 0, 1),
                                      number(&G::squareness, "squareness", -0.1, 0.15),
                                      number(&G::flare, "flare", 0, 0.5),
                                      number(&G::lobe_depth, "lobe_depth", 0, 0.3),
                                      number(&G::lappets, "lappets", 0, 0.4),
                                      number(&G::twist, "twist", -0.5, 0.5),
                                      number(&G::active, "active", 0, 1),
                                      number(&G::contraction, "contraction", -0.4, 0.4),
                                      number(&G::bending, "bending", -0.4, 0.4),
                                      number(&G::frequency, "frequency", 0, 20),
                                      number(&G::waves_along, "waves_along", -3, 3)};
  return rows;
}

static ShellGenome shell_genome_in(const Robot& robot) {
  std::optional<ShellGenome> genome = shell_genome_of(robot);
  if (!genome) throw InputError("/origin", "holds no shell");
  return *std::move(genome);
}

ShellGenome mutate(const ShellGenome& genome, double strength, std::uint64_t seed) {
  const auto chosen = [](const std::string& name) {
    return name != "diameter" && name != "thickness" && name != "segments";
  };
  return surely_moved(genome, shell_genome_table(), step * strength, seed, chosen, &ShellGenome::height, 0.2, 3);
}

ShellGenome mutate_muscles(const ShellGenome& genome, double strength, std::uint64_t seed, int tail) {
  const auto chosen = [](const std::string& name) {
    return name == "waves_around" || name == "waves_along" || name == "active" || name == "contraction" ||
           name == "bending" || name == "frequency";
  };
  return surely_moved(genome, shell_genome_table(), step * strength, seed, chosen, &ShellGenome::frequency, 0, 20,
                      tail);
}

ShellGenome crossover(const ShellGenome& a, const ShellGenome& b, std::uint64_t seed) {
  Random random(seed);
  ShellGenome child = a;
  for (const auto& row : shell_genome_table()) {
    const bool of_b = random.chance(0.5);
    const std::string& name = row.description.name;
    if (of_b && name != "form" && name != "segments") row.set(child, row.get(b));
  }
  child.thickness = std::min(child.thickness, child.diameter / 4);
  return child;
}

static Robot mutate_shell_robot(const Robot& parent, const MutationRequest& request, const std::string& name) {
  ShellGenome genome = mutate(shell_genome_in(parent), request.strength, request.seed);
  if (request.muscles > 0) genome = mutate_muscles(genome, request.muscles, seed_of(request.seed, 0));
  return grow(genome, name);
}

static Robot cross_shell_robots(const Robot& a, const Robot& b, std::uint64_t seed, const std::string& name) {
  return grow(crossover(shell_genome_in(a), shell_genome_in(b), seed), name);
}

// Random shells, and the generator that makes them.
namespace {

const ParameterTable<ShellOptions>& option_table() {
  using Options = ShellOptions;
  static const ParameterTable<Options> rows{
      parameter(&Options::form,
                {.name = "form", .help = "Form of the shells", .words = {"any", "bell", "tube", "ring", "pod"}}),
      parameter(&Options::diameter, {.name = "diameter",
                                     .help = "Diameter at the widest place",
                                     .unit = "m",
                                     .accepts = Accepts::between(0.2, 20),
                                     .usual_highest = 4}),
      parameter(&Options::segments, {.name = "segments",
                                     .help = "Masses of a layer around the widest place",
                                     .accepts = Accepts::between(12, 128),
                                     .usual_highest = 64}),
      parameter(&Options::thickness, {.name = "thickness",
                                      .help = "Distance of the two layers",
                                      .unit = "m",
                                      .accepts = Accepts::between(0.01, 5),
                                      .usual_highest = 0.4,
                                      .advanced = true}),
      parameter(&Options::opening, {.name = "opening",
                                    .help = "Mouth of bells, ends of tubes, holes of rings: 0 narrow, 1 wide",
                                    .accepts = Accepts::between(0, 1)}),
      parameter(&Options::lobes, {.name = "lobes",
                                  .help = "Lobes around the axis; 0 draws them for each robot",
                                  .accepts = Accepts::between(0, 16)}),
      parameter(&Options::active, {.name = "active",
                                   .help = "Share of the springs along the surface that are muscles",
                                   .accepts = Accepts::between(0, 1),
                                   .advanced = true})};
  return rows;
}

}  // namespace

void validate(const ShellOptions& options) {
  check_each(option_table(), options);
  check_shell_thickness(options.thickness, options.diameter);
  if (options.lobes == 1 || options.lobes == 2)
    throw ParameterError("lobes", std::to_string(options.lobes) + " is not accepted; give 3 to 16, or 0");
}

ShellGenome random_shell_genome(const ShellOptions& options, std::uint64_t seed, std::uint64_t index) {
  validate(options);
  Random random(seed_of(seed, index));
  const auto maybe = [&](double chance, double low, double high) {
    const double value = random.uniform(low, high);
    return random.chance(chance) ? value : 0;
  };
  // Bells swim best: half of all are bells.
  constexpr ShellForm drawn[] = {ShellForm::bell, ShellForm::bell, ShellForm::bell,
                                 ShellForm::tube, ShellForm::ring, ShellForm::pod};
  ShellGenome g;
  g.form = drawn[random.below(std::size(drawn))];
  if (options.form != ShellOptions::Form::any) g.form = static_cast<ShellForm>(static_cast<int>(options.form) - 1);
  g.environment = options.environment;
  g.segments = options.segments;
  g.diameter = options.diameter;
  g.thickness = options.thickness;
  g.active = options.active;
  g.lobes = 4 + static_cast<int>(random.below(7));
  if (options.lobes > 0) g.lobes = options.lobes;
  const auto sign = [&] { return random.chance(0.5) ? 1. : -1.; };
  g.opening = std::clamp(options.opening + random.uniform(-0.3, 0.2), 0., 1.);
  g.squareness = random.uniform(-0.04, 0.1);
  g.flare = random.uniform(0.05, 0.35);
  g.lobe_depth = maybe(0.8, 0.03, 0.15);
  g.lappets = maybe(0.6, 0.05, 0.25);
  g.twist = maybe(0.4, -0.2, 0.2);
  g.contraction = random.uniform(0.28, 0.36);
  g.bending = random.uniform(0, 0.15);
  g.frequency = random.uniform(2.5, 3.4);
  // Ranges in which shells swim, found by simulation.
  switch (g.form) {
    case ShellForm::bell:
      g.height = random.uniform(0.8, 1.6);
      g.waves_along = sign() * random.uniform(0.9, 1.4);
      break;
    case ShellForm::tube:
      g.height = random.uniform(1.2, 1.8);
      g.lappets /= 2;
      g.waves_along = sign() * random.uniform(1.2, 1.7);
      break;
    case ShellForm::ring:
      g.height = random.uniform(0.4, 0.7);
      g.waves_along = 1;
      g.waves_around = static_cast<int>(sign()) * (2 + static_cast<int>(random.below(2)));
      g.lobe_depth /= 2;
      break;
    case ShellForm::pod:
      g.height = random.uniform(0.8, 1.3);
      g.waves_along = random.uniform(1.2, 2);
      g.waves_around = static_cast<int>(random.below(3));
      g.squareness /= 2;
      break;
  }
  return g;
}

Robot random_shell_robot(const ShellOptions& options, std::uint64_t seed, std::uint64_t index) {
  return grow(random_shell_genome(options, seed, index), "shell-" + std::to_string(seed) + "-" + std::to_string(index));
}

Generator shell_generator() {
  Generator shell{.kind = "shell",
                  .word = "shell",
                  .title = "Shell robots",
                  .noun = "a shell robot",
                  .help = "Thin hollow bodies that pulse: bells, tubes, rings and pods",
                  .note = "A file keeps the numbers that a shell is built from, so that it can be changed.",
                  .environment = "ocean",
                  .smooth = true,
                  .example = {.name = "medusa", .seed = 4, .values = {{"form", "bell"}, {"lobes", "8"}}},
                  .regrow = [](const Robot& robot) { return grow(shell_genome_in(robot), robot.name); },
                  .mutate = mutate_shell_robot,
                  .cross = cross_shell_robots,
                  .genes = &shell_genes()};
  return with_parameters(std::move(shell), option_table(), random_shell_robot);
}

}  // namespace mercury
