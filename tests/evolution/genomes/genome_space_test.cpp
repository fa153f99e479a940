// SPDX-License-Identifier: Apache-2.0
// What holds for the genomes of every kind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "mercury/error.h"
#include "mercury/generator.h"
#include "mercury/genome.h"
#include "mercury/muscle_laws.h"
#include "mercury/origin.h"
#include "mercury/random.h"
#include "mercury/random_voxel.h"
#include "mercury/real_body.h"
#include "mercury/voxel.h"
#include "robots/brain_genes.h"
#include "robots/bytes.h"
#include "tests/fuzz/mutation.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

using testing::HasSubstr;

// A kind and what may change. "given" = given robots whose bodies stay.
struct Case {
  std::string kind;
  Genes genes;
  MuscleMutation muscles{};
  BrainGrowth growth{};
};

constexpr BrainGrowth growing{.brain_growth = true, .new_neurons = 0.1, .new_connections = 0.1};

// Steps that adapt themselves, from Cauchy's distribution.
constexpr MuscleMutation adaptive{.muscle_adaptation = true, .muscle_tail = 1};

Robot given_robot() {
  Robot robot = random_voxel_robot({.smallest = {4, 3, 3}, .largest = {4, 3, 3}}, 3);
  robot.origin.clear();
  return robot;
}

Robot thinking_voxels() {
  Robot robot = given_robot();
  give_brain_per_actuator(robot, 3);
  set_weights(*robot.brain, random_brain_genes(*robot.brain, 1).weights);
  return robot;
}

GenomeSpaceRequest request_for(const Case& chosen) {
  if (chosen.kind == "given")
    return {.genes = chosen.genes,
            .founders = {chosen.genes == Genes::muscles ? given_robot() : thinking_voxels()},
            .muscles = chosen.muscles,
            .growth = chosen.growth};
  GenomeSpaceRequest request{.kind = chosen.kind,
                             .environment = "land",
                             .genes = chosen.genes,
                             .muscles = chosen.muscles,
                             .growth = chosen.growth};
  if (chosen.kind == "nn") request.values = {{"points", std::int64_t{64}}, {"hidden", std::vector<int>{8, 8}}};
  return request;
}

class EveryGenome : public testing::TestWithParam<Case> {
 protected:
  std::unique_ptr<GenomeSpace> space_ = make_genome_space(request_for(GetParam()));
};

// `mercury mutate --muscles` and `evolve --genes muscles` give the same children.
TEST(GivenBody, MutatesAsMutateRobotDoes) {
  const Robot parent = given_robot();
  const auto space = make_genome_space({.genes = Genes::muscles, .founders = {parent}});
  const GenomePointer founder = space->random(1, 0);
  for (const double strength : {0.1, 1.0, 4.0})
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      Robot child = mutate_robot(parent, {.seed = seed, .muscles = strength}, "child");
      EXPECT_EQ(ancestry_of(child)->parents, std::vector{parent.name});
      child.origin = parent.origin;
      EXPECT_EQ(child, founder->mutate(strength, seed)->grow("child"));
    }
}

TEST_P(EveryGenome, ComesBackFromItsBytes) {
  for (std::uint64_t index = 0; index < 10; ++index) {
    const GenomePointer genome = space_->random(1, index)->mutate(2, index);
    const std::string bytes = genome->encode();
    const GenomePointer again = space_->decode(bytes);
    EXPECT_EQ(again->encode(), bytes);
    EXPECT_EQ(again->identity(), genome->identity());
    EXPECT_EQ(again->grow("robot"), genome->grow("robot"));
    EXPECT_EQ(again->mutate(1, 7)->encode(), genome->mutate(1, 7)->encode());
  }
}

TEST_P(EveryGenome, GrowsRobotsThatTheirGeneratorKnows) {
  for (std::uint64_t index = 0; index < 5; ++index) {
    const Robot robot = space_->random(2, index)->mutate(1, index)->grow("offspring");
    EXPECT_NO_THROW(validate(robot));
    EXPECT_EQ(robot.name, "offspring");
    if (GetParam().kind == "given") continue;
    EXPECT_EQ(environment_of(robot), "land");
    ASSERT_EQ(generator_of(robot), find_generator(GetParam().kind));
    EXPECT_EQ(generator_of(robot)->regrow(robot), robot);
  }
}

TEST_P(EveryGenome, IsTriedAsTheRobotThatItGrows) {
  for (std::uint64_t index = 0; index < 5; ++index) {
    const GenomePointer genome = space_->random(2, index)->mutate(1, index);
    const Robot robot = genome->grow("robot");
    Robot tried = genome->grow_for_trial("robot");
    EXPECT_EQ(kind_of(tried), kind_of(robot));
    tried.origin = robot.origin;
    EXPECT_EQ(tried, robot);
  }
}

TEST_P(EveryGenome, DependsOnItsSeedsAlone) {
  EXPECT_EQ(space_->random(5, 3)->encode(), make_genome_space(request_for(GetParam()))->random(5, 3)->encode());
  EXPECT_NE(space_->random(5, 3)->encode(), space_->random(5, 4)->encode());
  EXPECT_NE(space_->random(5, 3)->encode(), space_->random(6, 3)->encode());
}

TEST_P(EveryGenome, ChildrenDifferFromTheirParentsAndFromEachOther) {
  const GenomePointer a = space_->random(1, 1), b = space_->random(1, 2);
  std::set<std::uint64_t> identities{a->identity(), b->identity()};
  ASSERT_EQ(identities.size(), 2u);
  int alike = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const GenomePointer child = a->mutate(1, seed);
    EXPECT_NE(child->identity(), a->identity()) << seed;
    alike += identities.insert(child->identity()).second ? 0 : 1;
    const GenomePointer cross = a->cross(*b, seed);
    EXPECT_EQ(cross->encode(), a->cross(*b, seed)->encode());
    EXPECT_NO_THROW(space_->decode(cross->encode()));
  }
  EXPECT_LE(alike, 2);
  EXPECT_EQ(a->mutate(0, 3)->encode(), a->encode());
  EXPECT_NO_THROW(a->mutate(1000, 3)->encode());
}

TEST_P(EveryGenome, RobotsOfOneIdentityAreTheSame) {
  std::map<std::uint64_t, Robot> grown;
  const GenomePointer parent = space_->random(1, 1);
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const GenomePointer child = parent->mutate(0.2, seed);
    Robot robot = child->grow("robot");
    robot.origin.clear();
    const auto [before, is_new] = grown.try_emplace(child->identity(), robot);
    if (is_new) continue;
    EXPECT_EQ(before->second.masses, robot.masses);
    EXPECT_EQ(before->second.springs, robot.springs);
  }
}

TEST_P(EveryGenome, ChangesOnlyWhatMayChange) {
  const GenomePointer parent = space_->random(1, 1);
  const Robot before = parent->grow("robot");
  bool body_changed = false, muscles_changed = false, brain_changed = false;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Robot after = parent->mutate(1, seed)->grow("robot");
    const bool same_muscles = std::ranges::equal(materials_of(before), materials_of(after));
    body_changed |= after.masses != before.masses || after.springs != before.springs;
    muscles_changed |= !same_muscles;
    brain_changed |= after.brain && before.brain && after.brain != before.brain;
    if (!contains(GetParam().genes, Genes::body)) {
      EXPECT_EQ(after.masses, before.masses);
      EXPECT_EQ(after.faces, before.faces);
    }
    // A shell lists the muscles that it needs.
    if (!contains(GetParam().genes, Genes::muscles) && GetParam().kind != "shell") {
      EXPECT_TRUE(same_muscles) << seed;
    }
  }
  EXPECT_EQ(body_changed, contains(GetParam().genes, Genes::body) || GetParam().kind == "shell");
  EXPECT_EQ(muscles_changed, contains(GetParam().genes, Genes::muscles) || GetParam().kind == "shell");
  EXPECT_EQ(brain_changed, contains(GetParam().genes, Genes::brain));
}

TEST_P(EveryGenome, RefusesBytesThatBreakOffOrGoOn) {
  const std::string bytes = space_->random(1, 1)->encode();
  for (std::size_t length = 0; length < bytes.size(); length += 1 + bytes.size() / 500)
    EXPECT_THROW(space_->decode(std::string_view(bytes).substr(0, length)), InputError) << length;
  EXPECT_EQ(refusal([&] { space_->decode(bytes + "x"); }), "genome: 1 bytes follow its end");
  std::string newer = bytes;
  newer[1] = 2;
  EXPECT_EQ(refusal([&] { space_->decode(newer); }), "genome: has version 2; this program reads version 1");
  newer[0] = 77;
  EXPECT_EQ(refusal([&] { space_->decode(newer); }), "genome: is not of the kind that the run evolves");
}

// Bytes are a genome that has these bytes, or they are refused in one line.
TEST_P(EveryGenome, DamagedBytesGiveAGenomeOrALine) {
  const std::string sound = space_->random(1, 1)->mutate(1, 1)->encode();
  int used = 0, refused = 0;
  for (std::uint64_t seed = 0; seed < 5000; ++seed) {
    Random random(seed);
    const std::size_t begin = random.chance(0.5) ? std::min<std::size_t>(sound.size(), 64) : sound.size();
    const std::string bytes = fuzz::mutated(sound.substr(0, begin), sound, random) + sound.substr(begin);
    try {
      const GenomePointer genome = space_->decode(bytes);
      ASSERT_EQ(genome->encode(), bytes) << seed;
      ++used;
    } catch (const InputError& error) {
      const std::string message = error.what();
      ASSERT_LT(message.size(), 250u);
      ASSERT_EQ(message.find('\n'), std::string::npos);
      ++refused;
    }
  }
  EXPECT_GT(used, 100);
  EXPECT_GT(refused, 100);
}

// Numbers for CMA-ES: all genomes of a space have as many, they give the genome back, and any numbers give one.
TEST_P(EveryGenome, NumbersGiveTheGenomeBack) {
  const GenomePointer start = space_->random(1, 0);
  const std::vector<double> numbers = start->numbers();
  const bool is_list = (GetParam().kind == "given" || GetParam().kind == "tapered") && !GetParam().growth.brain_growth;
  EXPECT_EQ(!numbers.empty(), is_list);
  if (!is_list) return;
  for (std::uint64_t index = 0; index < 10; ++index) {
    const GenomePointer genome = space_->random(1, index)->mutate(3, index);
    const std::vector<double> its_own = genome->numbers();
    ASSERT_EQ(its_own.size(), numbers.size());
    const std::vector<double> again = start->with_numbers(its_own)->numbers();
    for (std::size_t i = 0; i < numbers.size(); ++i)
      EXPECT_NEAR(again[i], its_own[i], 1e-4 * std::max(1.0, std::abs(its_own[i])));
  }
  Random random(1);
  for (const double size : {1.0, 100.0, 1e6}) {
    std::vector<double> any = numbers;
    for (double& number : any) number += size * random.normal();
    const GenomePointer genome = start->with_numbers(any);
    EXPECT_EQ(space_->decode(genome->encode())->identity(), genome->identity());
    EXPECT_EQ(genome->numbers().size(), numbers.size());
  }
}

std::vector<Case> cases() {
  std::vector<Case> all{{"given", Genes::muscles}, {"given", Genes::brain}, {"given", Genes::muscles | Genes::brain}};
  for (const std::string kind : {"voxel", "cppn", "shell", "nn", "tapered"})
    for (const Genes genes : all_gene_sets())
      if (genes != Genes::brain && (kind != "nn" || MERCURY_NN)) all.push_back({kind, genes});
  const std::vector<Case> fixed = all;
  for (const Case& each : fixed)
    if (contains(each.genes, Genes::muscles)) all.push_back({each.kind, each.genes, adaptive});
  for (const Case& each : fixed)
    if (contains(each.genes, Genes::brain)) all.push_back({each.kind, each.genes, {}, growing});
  return all;
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryGenome, testing::ValuesIn(cases()), [](const auto& parameter) {
  std::string name = parameter.param.kind + "_" + name_of(parameter.param.genes);
  std::ranges::replace(name, ',', '_');
  return name + (parameter.param.muscles == adaptive ? "_adaptive" : "") +
         (parameter.param.growth.brain_growth ? "_growing" : "");
});

// A step that adapts itself is 8 bytes of the genome; without it, genomes have the bytes that they always had.
TEST(MuscleSteps, AreStoredOnlyWhereTheyAdapt) {
  for (const char* kind : {"voxel", "cppn", "shell", "tapered"}) {
    const auto size = [&](const MuscleMutation& muscles) {
      return make_genome_space({.kind = kind, .genes = Genes::muscles, .muscles = muscles})
          ->random(1, 0)
          ->encode()
          .size();
    };
    EXPECT_EQ(size({.muscle_tail = 3}), size({})) << kind;
    EXPECT_EQ(size({.muscle_adaptation = true}), size({}) + sizeof(double)) << kind;
  }
}

// The step of an adaptive genome by its bytes, after kind and version.
double step_of(const Genome& genome) {
  const std::string bytes = genome.encode();
  return ByteReader(std::string_view(bytes).substr(2)).read<double>();
}

TEST(MuscleSteps, AreInheritedAndAverageInCrossovers) {
  for (const bool given : {true, false}) {
    GenomeSpaceRequest request{.genes = Genes::muscles, .muscles = {.muscle_adaptation = true}};
    if (given) request.founders = {given_robot()};
    const auto space = make_genome_space(request);
    const GenomePointer parent = space->random(1, 0);
    EXPECT_EQ(step_of(*parent), 1);
    const GenomePointer a = parent->mutate(1, 1), b = a->mutate(1, 2);
    EXPECT_NE(step_of(*a), 1);
    EXPECT_NE(step_of(*a), step_of(*b));
    EXPECT_NEAR(step_of(*a->cross(*b, 3)), std::sqrt(step_of(*a) * step_of(*b)), 1e-12);
    EXPECT_EQ(step_of(*space->decode(b->encode())), step_of(*b));
    std::string bytes = a->encode();
    bytes.replace(2, 8, std::string(8, '\xff'));
    EXPECT_EQ(refusal([&] { space->decode(bytes); }), "genome: the step of its muscles is out of range");
  }
}

TEST(MuscleSteps, OfMusclesThatDoNotChangeAreRefused) {
  const auto refused = [](GenomeSpaceRequest request) { return refusal([&] { make_genome_space(request); }); };
  EXPECT_EQ(refused({.muscles = {.muscle_adaptation = true}}),
            "muscle_adaptation: the muscles do not change; give muscles among the genes");
  EXPECT_EQ(refused({.muscles = {.muscle_tail = 2}}),
            "muscle_tail: the muscles do not change; give muscles among the genes");
  EXPECT_THAT(refused({.genes = Genes::both, .muscles = {.muscle_tail = -1}}), testing::StartsWith("muscle_tail: -1"));
  EXPECT_EQ(refused({.genes = Genes::both, .muscles = adaptive}), "");
}

// Evolution strategies come near to an optimum where fixed steps stay as far away as they are long: an elitist search
// of the muscles of a body that should have given amplitudes, by the median of five seeds.
double distance_left(const MuscleMutation& muscles, std::uint64_t seed) {
  const auto space = make_genome_space({.genes = Genes::muscles, .founders = {given_robot()}, .muscles = muscles});
  const auto distance = [&](const Genome& genome) {
    const Robot robot = genome.grow("");
    double sum = 0;
    for (const Material& material : base_materials_of(robot))
      if (material.amplitude != 0) sum += std::pow(static_cast<double>(material.amplitude) - 0.05, 2);
    return std::sqrt(sum);
  };
  std::vector<std::pair<double, GenomePointer>> parents{{0, space->random(seed, 0)}};
  parents[0].first = distance(*parents[0].second);
  for (std::uint64_t generation = 1; generation <= 120; ++generation) {
    std::vector<std::pair<double, GenomePointer>> children;
    for (std::uint64_t i = 0; i < 20; ++i) {
      const GenomePointer& parent = parents[i % parents.size()].second;
      GenomePointer child = parent->mutate(1, seed_of(seed_of(seed, generation), i));
      const double left = distance(*child);
      children.emplace_back(left, std::move(child));
    }
    std::ranges::sort(children, {}, &std::pair<double, GenomePointer>::first);
    children.resize(4);
    parents = std::move(children);
  }
  return parents.front().first;
}
TEST(MuscleSteps, ComeNearerToAnOptimumThanFixedOnes) {
  std::vector<double> gains;
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    gains.push_back(distance_left({}, seed) / distance_left({.muscle_adaptation = true}, seed));
  std::ranges::sort(gains);
  EXPECT_GT(gains[2], 3) << gains[0] << " to " << gains[4];
}

TEST(GenomeSpaces, EveryGeneratorHasOne) {
  for (const Generator& generator : generators())
    EXPECT_NO_THROW(make_genome_space({.kind = generator.kind})) << generator.kind;
}

TEST(GenomeSpaces, BeginWithTheFoundersAndThenTheirMutants) {
  const Robot first = random_voxel_robot({.environment = "land"}, 1), second = random_voxel_robot({}, 2);
  for (const Genes genes : {Genes::body, Genes::muscles, Genes::both}) {
    const auto space = make_genome_space({.genes = genes, .founders = {first, second}});
    ASSERT_EQ(space->founders(), 2u);
    for (const std::uint64_t seed : {1u, 2u}) {
      EXPECT_EQ(space->random(seed, 0)->grow("a").springs, first.springs);
      EXPECT_EQ(space->random(seed, 1)->grow("a").springs, second.springs);
      std::set<std::uint64_t> identities;
      for (std::uint64_t i = 0; i < 20; ++i) identities.insert(space->random(seed, i)->identity());
      EXPECT_EQ(identities.size(), 20u);
    }
    EXPECT_EQ(environment_of(space->random(1, 0)->grow("a")), "land");
  }
}

TEST(GenomeSpaces, FoundersKeepTheirOwnMaterials) {
  Robot founder = random_voxel_robot({}, 1);
  std::vector<Material> bases = base_materials_of(founder);
  bases[4].amplitude = 0.3f;
  founder = with_base_materials(founder, bases);
  const auto space = make_genome_space({.founders = {founder}});
  EXPECT_EQ(space->random(1, 0)->grow("a").materials, founder.materials);
  EXPECT_EQ(space->random(1, 5)->grow("a").materials, founder.materials);
  EXPECT_EQ(space->decode(space->random(1, 0)->encode())->grow("a").materials, founder.materials);
  bases[4].half_wave = bases[20].half_wave = true;
  bases[4].relaxation_time = 0.02f;
  bases[7].relaxation_time = 0.5f;
  const Robot half = with_base_materials(founder, bases);
  const auto halves = make_genome_space({.genes = Genes::both, .founders = {half}});
  EXPECT_EQ(halves->random(1, 0)->grow("a").materials, half.materials);
  EXPECT_EQ(halves->decode(halves->random(1, 0)->encode())->grow("a").materials, half.materials);
  EXPECT_TRUE(halves->random(1, 0)->mutate(2, 3)->grow("a").materials[5].half_wave);
  EXPECT_EQ(halves->random(1, 0)->mutate(2, 3)->grow("a").materials[5].relaxation_time, 0.02f);
  // A table in which pairs have materials of their own.
  founder.materials[100].frequency = 17;
  const auto other = make_genome_space({.genes = Genes::both, .founders = {founder}});
  EXPECT_EQ(other->random(1, 0)->grow("a").materials, founder.materials);
  EXPECT_EQ(other->decode(other->random(1, 0)->encode())->grow("a").materials, founder.materials);
}

TEST(GenomeSpaces, GivenBodiesKeepTheirActuators) {
  Robot founder = given_robot();
  founder.actuators = actuators_of(founder);
  founder.actuators.front().name = "mine";
  const auto space = make_genome_space({.genes = Genes::muscles, .founders = {founder}});
  EXPECT_EQ(space->random(1, 5)->mutate(2, 3)->grow("a").actuators, founder.actuators);
}

TEST(GenomeSpaces, RefuseFoundersThatCannotBeUsed) {
  const Robot voxel = random_voxel_robot({}, 1), unknown = given_robot();
  const auto refused = [](GenomeSpaceRequest request) { return refusal([&] { make_genome_space(request); }); };
  EXPECT_THAT(refused({.founders = {voxel, unknown}}), HasSubstr("does not say how its body was made"));
  EXPECT_EQ(refused({.genes = Genes::muscles, .founders = {voxel, unknown}}), "");
  const Robot shell = generator_named("shell").make({}, "", 1, 0);
  EXPECT_EQ(refused({.founders = {voxel, shell}}),
            "robot shell-1-0: is a shell robot, and voxel-1-0 a voxel robot; give robots of one kind");
  Robot edited = voxel;
  edited.springs.pop_back();
  EXPECT_EQ(refused({.founders = {edited}}),
            "robot voxel-1-0: /origin: leads to another robot; evolve its muscles alone");
  Robot heavy = voxel;
  heavy.mass.assign(heavy.masses.size(), 2);
  EXPECT_EQ(refused({.founders = {heavy}}),
            "robot voxel-1-0: /origin: leads to another robot; evolve its muscles alone");
  EXPECT_EQ(make_genome_space({.genes = Genes::muscles, .founders = {heavy}})->random(1, 0)->grow("a").mass,
            heavy.mass);
  Robot stiff = make_voxel_robot(VoxelGrid(2, 2, 2, bone), {.name = "rock"});
  EXPECT_EQ(refused({.genes = Genes::muscles, .founders = {stiff}}), "robot rock: has no muscles that could change");
  EXPECT_THAT(refused({.kind = "fish"}), HasSubstr("kind: \"fish\" is not a kind of robot"));
  EXPECT_THAT(refused({.kind = "voxel", .values = {{"air", 7.0}}}), HasSubstr("air: 7 is not accepted"));
  EXPECT_THAT(refused({.environment = "moon"}), HasSubstr("moon"));
}

TEST(GeneSets, HaveNamesThatFilesKeep) {
  EXPECT_EQ(name_of(Genes::body), "body");
  EXPECT_EQ(name_of(Genes::muscles), "muscles");
  EXPECT_EQ(name_of(Genes::both), "both");
  EXPECT_EQ(name_of(Genes::brain), "brain");
  EXPECT_EQ(name_of(Genes::muscles | Genes::brain), "muscles,brain");
  EXPECT_EQ(name_of(Genes::both | Genes::brain), "body,muscles,brain");
  for (const Genes genes : all_gene_sets()) EXPECT_EQ(genes_named(name_of(genes)), genes);
  EXPECT_EQ(genes_named("brain,both"), Genes::both | Genes::brain);
  EXPECT_EQ(genes_named("muscles,body"), Genes::both);
  for (const std::string name : {"all", "", "body,", ",body", "body, brain", "body,soul"})
    EXPECT_EQ(refusal([&] { genes_named(name); }),
              "genes: \"" + name +
                  "\" is not accepted; give body, muscles, both, brain, or several of them with commas between them");
}

// A muscle of a real tapered robot is several materials, since its springs are of several stiffnesses.
TEST(GenomeSpaces, MusclesOfTaperedFoundersStayWhole) {
  const Robot founder = with_real_body(generator_named("tapered").make({}, "water", 1, 0), {.modulus = 1e6f});
  const auto space = make_genome_space({.genes = Genes::muscles, .founders = {founder}});
  EXPECT_EQ(space->random(1, 0)->grow(founder.name).springs, founder.springs);
  EXPECT_EQ(space->random(1, 0)->grow(founder.name).materials, founder.materials);
  const Robot child = space->random(1, 5)->grow("child");
  EXPECT_EQ(child.masses, founder.masses);
  EXPECT_EQ(child.mass, founder.mass);
  EXPECT_EQ(child.springs, founder.springs);
  EXPECT_NE(child.materials, founder.materials);
  std::map<std::string, std::set<std::pair<float, float>>> movements;  // by the muscle's name
  for (std::size_t id = 1; id < child.materials.size(); ++id)
    movements[child.material_names[id]].emplace(child.materials[id].amplitude, child.materials[id].phase);
  for (const auto& [name, different] : movements) EXPECT_EQ(different.size(), 1u) << name;
}

TEST(GenomeIdentity, IsThatOfTheBodyThatGrows) {
  VoxelGrid grid(5, 2, 2, 3);
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 2; ++y) grid.cell(3, y, z) = air;
  const Robot with_loose_part = make_voxel_robot(grid);
  const Robot without = make_voxel_robot(largest_body(grid));
  const auto space = make_genome_space({.founders = {with_loose_part, without}});
  EXPECT_EQ(space->random(1, 0)->identity(), space->random(1, 1)->identity());
  EXPECT_NE(space->random(1, 0)->encode(), space->random(1, 1)->encode());
  // A muscle that the body does not have makes no difference; one that it has does.
  const auto with_amplitude = [&](std::size_t muscle) {
    std::vector<Material> bases = base_materials_of(without);
    bases[muscle - 1].amplitude = 0.2f;
    return make_genome_space({.founders = {with_base_materials(without, bases)}})->random(1, 0)->identity();
  };
  EXPECT_EQ(with_amplitude(7), space->random(1, 1)->identity());
  EXPECT_NE(with_amplitude(3), space->random(1, 1)->identity());
  const auto by_half_waves = [&](std::size_t muscle) {
    std::vector<Material> bases = base_materials_of(without);
    bases[muscle - 1].half_wave = true;
    return make_genome_space({.founders = {with_base_materials(without, bases)}})->random(1, 0)->identity();
  };
  EXPECT_EQ(by_half_waves(7), space->random(1, 1)->identity());
  EXPECT_NE(by_half_waves(3), space->random(1, 1)->identity());
  std::vector<Material> bases = base_materials_of(without);
  bases[2].relaxation_time = 0.1f;
  const auto relaxing = make_genome_space({.founders = {with_base_materials(without, bases)}});
  EXPECT_NE(relaxing->random(1, 0)->identity(), space->random(1, 1)->identity());
}

}  // namespace
}  // namespace mercury
