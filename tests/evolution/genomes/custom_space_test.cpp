// SPDX-License-Identifier: Apache-2.0
// Custom genomes, objectives and algorithms, as far as they are without their program.
#include <gtest/gtest.h>

#include <algorithm>

#include "mercury/custom.h"
#include "mercury/error.h"
#include "mercury/objective.h"
#include "mercury/quantity.h"
#include "mercury/random_voxel.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

Robot some_robot(std::uint64_t seed) { return random_voxel_robot({.smallest = {3, 2, 2}, .largest = {3, 2, 2}}, seed); }

// A genome is a number: the seed of its robot.
CustomOperators numbers() {
  const auto genes = [](std::uint64_t number) {
    return CustomGenes{.text = std::to_string(number), .robot = some_robot(number), .problem = ""};
  };
  return {.random = [=](std::uint64_t seed, std::uint64_t index) { return genes(10 * seed + index); },
          .mutate = [=](const CustomGenes& parent, double,
                        std::uint64_t seed) { return genes(std::stoull(parent.text) + seed); },
          .cross = [=](const CustomGenes& mother, const CustomGenes& father,
                       std::uint64_t) { return genes(std::stoull(mother.text) * std::stoull(father.text)); }};
}

TEST(CustomSpaces, GrowTheRobotOfTheProgramAlsoWithoutTheProgram) {
  const CustomSpace space("python:numbers", numbers());
  const GenomePointer genome = space.random(1, 2);
  Robot wanted = some_robot(12);
  wanted.name = "twelve";
  EXPECT_EQ(genome->grow("twelve"), wanted);
  const auto without = make_genome_space({.kind = "python:numbers"});
  const GenomePointer read = without->decode(genome->encode());
  EXPECT_EQ(read->grow("twelve"), wanted);
  EXPECT_EQ(read->identity(), genome->identity());
  EXPECT_EQ(custom_genes_of(*read).text, "12");
  EXPECT_NE(space.random(1, 3)->identity(), genome->identity());
  EXPECT_THROW(read->mutate(1, 1), InputError);
  EXPECT_THROW(read->cross(*read, 1), InputError);
  EXPECT_THROW(without->random(1, 0), InputError);
}

TEST(CustomSpaces, ChangeGenomesByTheProgram) {
  const CustomSpace space("python:numbers", numbers());
  const GenomePointer mutant = space.random(1, 2)->mutate(1, 5), child = mutant->cross(*space.random(0, 2), 1);
  EXPECT_EQ(custom_genes_of(*mutant).text, "17");
  EXPECT_EQ(custom_genes_of(*child).text, "34");
  const auto other = make_genome_space({.kind = "voxel"});
  EXPECT_THROW(mutant->cross(*other->random(1, 0), 1), InputError);
}

TEST(CustomSpaces, KeepWhyAGenomeHasNoRobot) {
  const CustomSpace space("python:numbers");
  const GenomePointer genome = space.genome({.text = "7", .robot = {}, .problem = "seven has none"});
  const GenomePointer read = space.decode(genome->encode());
  EXPECT_EQ(refusal([&] { read->grow("seven"); }), "seven has none");
  Robot broken = some_robot(1);
  broken.springs[0].a = 9999;
  EXPECT_THROW(space.genome({.text = "1", .robot = broken, .problem = ""}), InputError);
}

TEST(CustomSpaces, RefuseDamagedBytes) {
  const CustomSpace space("python:numbers", numbers());
  const std::string bytes = space.random(1, 2)->encode();
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(space.decode(bytes.substr(0, size)), InputError) << size;
  EXPECT_THROW(space.decode(bytes + "x"), InputError);
}

TEST(CustomParts, HaveNamesOfLettersAndDigits) {
  for (const char* wrong : {"python:", "python:a b", "python:a\nb", "worm", ""})
    EXPECT_THROW(CustomSpace{wrong}, ParameterError) << wrong;
  EXPECT_THROW(CustomSpace{"python:" + std::string(101, 'a')}, ParameterError);
  EXPECT_NO_THROW(CustomSpace{"python:Worm-1.2_x"});
}

TEST(CustomParts, AreNamedInARun) {
  EvolutionSettings settings;
  EXPECT_EQ(custom_parts(settings, {}), "");
  settings.algorithm.name = "python:pycma";
  settings.objectives = {"distance", "python:light"};
  EXPECT_EQ(custom_parts(settings, {.kind = "python:Worm"}),
            "the algorithm python:pycma, the objective python:light and the genomes python:Worm");
  EXPECT_EQ(custom_parts(settings, {.kind = "python:Worm", .founders = {some_robot(1)}}),
            "the algorithm python:pycma and the objective python:light");
}

Individual individual(std::uint64_t id, std::vector<double> scores, double masses) {
  Individual one{.id = id};
  one.assessment = {.fate = Fate::sound, .scores = std::move(scores)};
  one.assessment.values.assign(quantities().size(), 0);
  one.assessment.values[*find_quantity("masses")] = masses;
  return one;
}

TEST(CustomAlgorithms, LetTheBestOrTheBestOfEachCellLive) {
  const std::vector<Individual> pool{individual(0, {1}, 5), individual(1, {3}, 5), individual(2, {2}, 15)};
  AlgorithmSettings settings{.name = "python:mine", .population = 2};
  EXPECT_EQ(make_algorithm(settings)->survivors(pool, 1), (std::vector<std::size_t>{1, 2}));
  EXPECT_FALSE(algorithm_of(settings).has_map);
  settings.population = 1;
  settings.axes = {{.quantity = "masses", .lowest = 0, .highest = 20, .cells = 2}};
  EXPECT_EQ(make_algorithm(settings)->survivors(pool, 1), (std::vector<std::size_t>{1, 2}));
  EXPECT_TRUE(algorithm_of(settings).has_map);
  Random random(1);
  EXPECT_THROW(make_algorithm(settings)->plan(pool, 3, random), InputError);
}

TEST(CustomAlgorithms, KeepTheFrontOfSeveralObjectives) {
  const std::vector<Individual> pool{individual(0, {1, 1}, 5), individual(1, {3, 0}, 5), individual(2, {0, 3}, 5)};
  const AlgorithmSettings settings{.name = "python:mine", .population = 3};
  std::vector<std::size_t> living = make_algorithm({.name = "python:mine", .population = 2})->survivors(pool, 0);
  std::ranges::sort(living);
  EXPECT_EQ(living, (std::vector<std::size_t>{1, 2}));  // the ends of the front are farthest from others
  EXPECT_EQ(make_algorithm(settings)->survivors(pool, 0).size(), 3u);
}

TEST(CustomObjectives, AreNoFormulas) {
  const Objective objective("python:light");
  EXPECT_TRUE(objective.is_custom());
  EXPECT_FALSE(Objective("distance").is_custom());
  EXPECT_TRUE(objective.uses().empty());
  EXPECT_THROW((void)objective.score(std::vector<double>(quantities().size())), std::logic_error);
  EXPECT_EQ(objective.undefined_text(), "the objective \"python:light\" is not a finite number");
}

}  // namespace
}  // namespace mercury
