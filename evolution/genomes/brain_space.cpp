// SPDX-License-Identifier: Apache-2.0
// Genomes of robots with brains: the genome of a body, whatever its kind, and the weights of a brain.
//
// Brains are those of the founders, each with its own sensors, layers and connections, which stay. Robots without a
// brain get one per actuator. A genome names its brain by number. A body that its brain does not fit any more is grown
// without it; the genome keeps the weights, so that its children may fit again.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evolution/genomes/spaces.h"
#include "mercury/error.h"
#include "mercury/generator.h"
#include "mercury/random.h"
#include "robots/brain_genes.h"
#include "robots/carried_points.h"
#include "robots/genes.h"

namespace mercury {
namespace {

constexpr std::uint8_t brain_tag = 7;

// Where a brain comes from: what a robot that has it takes over.
struct Donor {
  Robot robot;
  std::size_t structure = 0;  // equal for brains that differ in weights alone
  bool is_random = false;     // robots of generation 0 have random weights
};

// What all genomes of a space share.
struct BrainContext {
  std::vector<Donor> donors;
  bool bodies_change = false, weights_change = false;
};

// Streams of random numbers that are not those of the body's genome.
std::uint64_t seed_of_brain(std::uint64_t seed) { return seed_of(seed, 0x627261696e); }
std::uint64_t seed_of_choice(std::uint64_t seed) { return seed_of(seed, 0x63686f696365); }

class BrainGenome : public Genome {
 public:
  BrainGenome(GenomePointer body, std::size_t donor, BrainGenes brain, std::shared_ptr<const BrainContext> context)
      : body_(std::move(body)), donor_(donor), brain_(std::move(brain)), context_(std::move(context)) {}

  Robot grow(const std::string& name) const override { return with_brain(body_->grow(name)); }
  Robot grow_for_trial(const std::string& name) const override { return with_brain(body_->grow_for_trial(name)); }

  // Where bodies change too: one of them or both, a third each. A brain needs time to get used to a new body.
  GenomePointer mutate(double strength, std::uint64_t seed) const override {
    const std::uint64_t choice = Random(seed_of_choice(seed)).below(3);
    const bool both_may = context_->bodies_change && context_->weights_change;
    const bool body = context_->bodies_change && !(both_may && choice == 0);
    const bool weights = context_->weights_change && !(both_may && choice == 1) && strength != 0;
    return make(body ? body_->mutate(strength, seed) : body_,
                weights ? brain_.mutated(strength, seed_of_brain(seed)) : brain_);
  }

  GenomePointer cross(const Genome& other, std::uint64_t seed) const override {
    const auto* mate = dynamic_cast<const BrainGenome*>(&other);
    if (!mate) throw InputError("crossover", "two genomes of one space are needed");
    const bool alike = donor().structure == mate->donor().structure;
    return make(context_->bodies_change ? body_->cross(*mate->body_, seed) : body_,
                context_->weights_change && alike
                    ? brain_.crossed(mate->brain_, *donor().robot.brain, seed_of_brain(seed))
                    : brain_);
  }

  std::uint64_t identity() const override {
    IdentityHash hash;
    hash.add(body_->identity());
    hash.add(static_cast<std::uint32_t>(donor().structure));
    for (const float weight : brain_.weights) hash.add(weight);
    return hash.value();
  }

  // The brain first: it has the same length in all relatives.
  std::string encode() const override {
    ByteWriter writer;
    write_head(writer, brain_tag);
    writer.add(static_cast<std::uint32_t>(donor_));
    if (context_->weights_change) brain_.write(writer);
    writer.text(body_->encode());
    return std::move(writer).take();
  }

  // Those of the body, then the weights, whose unit is the first step of a mutation.
  std::vector<double> numbers() const override {
    std::vector<double> numbers;
    if (context_->bodies_change) numbers = body_->numbers();
    if (context_->bodies_change && numbers.empty()) return {};
    if (context_->weights_change)
      for (const float weight : brain_.weights) numbers.push_back(weight / BrainGenes::first_step);
    return numbers;
  }
  GenomePointer with_numbers(std::span<const double> numbers) const override {
    BrainGenes brain = brain_;
    const std::size_t weights = context_->weights_change ? brain.weights.size() : 0;
    const std::size_t of_body = numbers.size() - weights;
    for (std::size_t i = 0; i < weights; ++i)
      brain.weights[i] = BrainGenes::limited_weight(numbers[of_body + i] * BrainGenes::first_step);
    return make(of_body > 0 ? body_->with_numbers(numbers.first(of_body)) : body_, std::move(brain));
  }

 private:
  Robot with_brain(Robot robot) const {
    robot.sensors.clear();
    robot.brain.reset();
    carry_control(donor().robot, robot);
    if (robot.brain) set_weights(*robot.brain, brain_.weights);
    return robot;
  }

  const Donor& donor() const { return context_->donors[donor_]; }
  GenomePointer make(GenomePointer body, BrainGenes brain) const {
    return std::make_shared<BrainGenome>(std::move(body), donor_, std::move(brain), context_);
  }

  GenomePointer body_;
  std::size_t donor_;
  BrainGenes brain_;
  std::shared_ptr<const BrainContext> context_;
};

class BrainSpace : public GenomeSpace {
 public:
  BrainSpace(const GenomeSpaceRequest& request, std::unique_ptr<GenomeSpace> bodies) : bodies_(std::move(bodies)) {
    auto context = std::make_shared<BrainContext>();
    context->bodies_change = contains(request.genes, Genes::both);
    context->weights_change = contains(request.genes, Genes::brain);
    for (const Robot& founder : request.founders) context->donors.push_back(donor_of(founder, request.genes));
    if (context->donors.empty()) context->donors.push_back(donor_of_random_robots());
    for (std::size_t i = 0; i < context->donors.size(); ++i) {
      std::size_t first = 0;
      while (first < i && !same_brain_structure(context->donors[first].robot, context->donors[i].robot)) ++first;
      context->donors[i].structure = first;
    }
    context_ = std::move(context);
  }

  // The brain is that of the founder whose body it is, as the spaces of bodies count them.
  GenomePointer random(std::uint64_t seed, std::uint64_t index) const override {
    const std::size_t donor = index % context_->donors.size();
    const bool is_founder = index < founders();
    GenomePointer body = bodies_->random(seed, context_->bodies_change ? index : donor);
    const std::uint64_t its_own = seed_of_brain(is_founder ? index : seed_of(seed, index));
    BrainGenes brain = first_genes(donor, its_own);
    if (context_->weights_change && !is_founder && !context_->donors[donor].is_random) {
      Random random(its_own);
      const double strength = random.uniform(1, strongest_at_first);
      brain = brain.mutated(strength, random.bits());
    }
    return std::make_shared<BrainGenome>(std::move(body), donor, std::move(brain), context_);
  }

  std::size_t founders() const override { return bodies_->founders(); }

  GenomePointer decode(std::string_view bytes) const override try {
    ByteReader reader(bytes);
    read_head(reader, brain_tag);
    const auto donor = reader.read<std::uint32_t>();
    if (donor >= context_->donors.size())
      throw InputError("genome",
                       "has brain " + std::to_string(donor) + " of " + std::to_string(context_->donors.size()));
    BrainGenes brain = genes_of(donor);
    if (context_->weights_change) brain = BrainGenes::read(reader, brain.weights.size());
    GenomePointer body = bodies_->decode(reader.text());
    reader.end();
    return std::make_shared<BrainGenome>(std::move(body), donor, std::move(brain), context_);
  } catch (const DamagedBytes& error) {
    throw InputError("genome", error.what());
  }

 private:
  static Donor donor_of(const Robot& founder, Genes genes) {
    Donor donor{.robot = founder};
    if (!founder.brain && contains(genes, Genes::brain)) {
      give_brain_per_actuator(donor.robot, mean_muscle_frequency(founder));
      donor.is_random = true;
    } else if (founder.brain && contains(genes, Genes::muscles) && founder.actuators.empty()) {
      donor.robot.actuators = actuators_of(founder);  // muscles that moved alike may not do so any more
    }
    if (!donor.is_random) validate_brain(donor.robot);
    if (contains(genes, Genes::brain) && weights_of(*donor.robot.brain).empty())
      throw InputError("robot " + founder.name, "its brain has no weights that could change");
    return donor;
  }

  Donor donor_of_random_robots() const {
    Donor donor{.is_random = true};
    give_brain_per_actuator(donor.robot, frequency_of_random_robots());
    return donor;
  }
  // Of the first of them that can be made.
  float frequency_of_random_robots() const {
    constexpr std::uint64_t tries = 16;
    for (std::uint64_t index = 0; index < tries; ++index) {
      try {
        return mean_muscle_frequency(bodies_->random(0, index)->grow(""));
      } catch (const InputError&) {  // there is no such robot
      }
    }
    return mean_muscle_frequency(Robot{});
  }

  BrainGenes genes_of(std::size_t donor) const {
    const Robot& robot = context_->donors[donor].robot;
    return {.weights = robot.brain ? weights_of(*robot.brain) : std::vector<float>{}};
  }
  BrainGenes first_genes(std::size_t donor, std::uint64_t seed) const {
    const Donor& given = context_->donors[donor];
    return given.is_random ? random_brain_genes(*given.robot.brain, seed) : genes_of(donor);
  }

  std::unique_ptr<GenomeSpace> bodies_;
  std::shared_ptr<const BrainContext> context_;
};

}  // namespace

void require_brains(const GenomeSpaceRequest& request) {
  if (request.genes != Genes::brain) return;
  const auto refuse = [](const std::string& whose) {
    throw ParameterError("genes", "brain alone needs robots that have one, and " + whose +
                                      "; start from sample:hunter or a file with a brain, or give body,brain or "
                                      "muscles,brain");
  };
  if (request.founders.empty()) refuse(request.kind + " robots have none");
  for (const Robot& founder : request.founders)
    if (!founder.brain) refuse("robot " + founder.name + " has none");
}

std::unique_ptr<GenomeSpace> make_brain_space(const GenomeSpaceRequest& request, std::unique_ptr<GenomeSpace> bodies) {
  return std::make_unique<BrainSpace>(request, std::move(bodies));
}

}  // namespace mercury
