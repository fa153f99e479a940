// SPDX-License-Identifier: Apache-2.0
// Genomes of robots with brains: the genome of a body, whatever its kind, and a brain (brain_part.h).
//
// Brains begin with those of the founders, each with its own sensors and layers, which stay. Robots without a brain get
// one per actuator; where brains grow and there are sensors, one that joins these to all actuators. A genome names its
// founder's brain by number. A body that its brain does not fit any more is grown without it; the genome keeps the
// brain, so that its children may fit again.
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evolution/genomes/brain_part.h"
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
  std::size_t structure = 0;  // equal for brains that can cross
  bool is_random = false;     // robots of generation 0 have random brains
  std::unique_ptr<BrainFamily> family{};
};

// What all genomes of a space share.
struct BrainContext {
  std::vector<Donor> donors;
  bool bodies_change = false, brains_change = false;
};

// Streams of random numbers that are not those of the body's genome.
std::uint64_t seed_of_brain(std::uint64_t seed) { return seed_of(seed, 0x627261696e); }
std::uint64_t seed_of_choice(std::uint64_t seed) { return seed_of(seed, 0x63686f696365); }

class BrainGenome : public Genome {
 public:
  BrainGenome(GenomePointer body, std::size_t donor, BrainPartPointer brain,
              std::shared_ptr<const BrainContext> context)
      : body_(std::move(body)), donor_(donor), brain_(std::move(brain)), context_(std::move(context)) {}

  Robot grow(const std::string& name) const override { return with_brain(body_->grow(name)); }
  Robot grow_for_trial(const std::string& name) const override { return with_brain(body_->grow_for_trial(name)); }

  // Where bodies change too: one of them or both, a third each. A brain needs time to get used to a new body.
  GenomePointer mutate(double strength, std::uint64_t seed) const override {
    const std::uint64_t choice = Random(seed_of_choice(seed)).below(3);
    const bool both_may = context_->bodies_change && context_->brains_change;
    const bool body = context_->bodies_change && !(both_may && choice == 0);
    const bool brain = context_->brains_change && !(both_may && choice == 1) && strength != 0;
    return make(body ? body_->mutate(strength, seed) : body_,
                brain ? brain_->mutated(strength, seed_of_brain(seed)) : brain_);
  }

  GenomePointer cross(const Genome& other, std::uint64_t seed) const override {
    return cross_by_fitness(other, std::partial_ordering::unordered, seed);
  }
  GenomePointer cross_by_fitness(const Genome& other, std::partial_ordering fitness,
                                 std::uint64_t seed) const override {
    const auto* mate = dynamic_cast<const BrainGenome*>(&other);
    if (!mate) throw InputError("crossover", "two genomes of one space are needed");
    return make(context_->bodies_change ? body_->cross_by_fitness(*mate->body_, fitness, seed) : body_,
                context_->brains_change && is_like(*mate) ? brain_->crossed(*mate->brain_, fitness, seed_of_brain(seed))
                                                          : brain_);
  }

  // That of the brains.
  std::optional<double> distance(const Genome& other) const override {
    const auto* mate = dynamic_cast<const BrainGenome*>(&other);
    if (!mate) throw InputError("distance", "two genomes of one space are needed");
    if (!brain_->distance(*brain_)) return std::nullopt;
    return is_like(*mate) ? brain_->distance(*mate->brain_) : std::numeric_limits<double>::infinity();
  }

  std::uint64_t identity() const override {
    IdentityHash hash;
    hash.add(body_->identity());
    hash.add(static_cast<std::uint32_t>(donor().structure));
    brain_->add_identity(hash);
    return hash.value();
  }

  // The brain first: it has the same length in all relatives.
  std::string encode() const override {
    ByteWriter writer;
    write_head(writer, brain_tag);
    writer.add(static_cast<std::uint32_t>(donor_));
    if (context_->brains_change) brain_->write(writer);
    writer.text(body_->encode());
    return std::move(writer).take();
  }

  // Those of the body, then those of the brain.
  std::vector<double> numbers() const override {
    std::vector<double> numbers;
    if (context_->bodies_change && (numbers = body_->numbers()).empty()) return {};
    if (!context_->brains_change) return numbers;
    const std::vector<double> of_brain = brain_->numbers();
    if (of_brain.empty()) return {};
    numbers.insert(numbers.end(), of_brain.begin(), of_brain.end());
    return numbers;
  }
  GenomePointer with_numbers(std::span<const double> numbers) const override {
    const std::size_t of_body = numbers.size() - (context_->brains_change ? brain_->numbers().size() : 0);
    return make(of_body > 0 ? body_->with_numbers(numbers.first(of_body)) : body_,
                context_->brains_change ? brain_->with_numbers(numbers.subspan(of_body)) : brain_);
  }

 private:
  Robot with_brain(Robot robot) const {
    robot.sensors.clear();
    robot.brain.reset();
    carry_control(donor().robot, robot);
    if (robot.brain) brain_->put_into(robot);
    return robot;
  }

  const Donor& donor() const { return context_->donors[donor_]; }
  bool is_like(const BrainGenome& other) const { return donor().structure == other.donor().structure; }
  GenomePointer make(GenomePointer body, BrainPartPointer brain) const {
    return std::make_shared<BrainGenome>(std::move(body), donor_, std::move(brain), context_);
  }

  GenomePointer body_;
  std::size_t donor_;
  BrainPartPointer brain_;
  std::shared_ptr<const BrainContext> context_;
};

class BrainSpace : public GenomeSpace {
 public:
  BrainSpace(const GenomeSpaceRequest& request, std::unique_ptr<GenomeSpace> bodies) : bodies_(std::move(bodies)) {
    auto context = std::make_shared<BrainContext>();
    context->bodies_change = contains(request.genes, Genes::both);
    context->brains_change = contains(request.genes, Genes::brain);
    for (const Robot& founder : request.founders) context->donors.push_back(donor_of(founder, request));
    if (context->donors.empty()) context->donors.push_back(donor_of_random_robots(request));
    for (std::size_t i = 0; i < context->donors.size(); ++i) {
      std::size_t first = 0;
      const auto alike = grows(request) ? grow_alike : same_brain_structure;
      while (first < i && !alike(context->donors[first].robot, context->donors[i].robot)) ++first;
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
    const Donor& given = context_->donors[donor];
    BrainPartPointer brain = given.is_random ? given.family->random(its_own) : given.family->first();
    if (context_->brains_change && !is_founder && !given.is_random) {
      Random random(its_own);
      const double strength = random.uniform(1, strongest_at_first);
      brain = brain->mutated(strength, random.bits());
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
    const BrainFamily& family = *context_->donors[donor].family;
    BrainPartPointer brain = context_->brains_change ? family.read(reader) : family.first();
    GenomePointer body = bodies_->decode(reader.text());
    reader.end();
    return std::make_shared<BrainGenome>(std::move(body), donor, std::move(brain), context_);
  } catch (const DamagedBytes& error) {
    throw InputError("genome", error.what());
  }

 private:
  static bool grows(const GenomeSpaceRequest& request) { return request.growth.brain_growth; }

  static Donor donor_of(const Robot& founder, const GenomeSpaceRequest& request) try {
    const bool changes = contains(request.genes, Genes::brain);
    Donor donor{.robot = founder};
    donor.is_random = changes && !founder.brain;
    const bool is_whole = founder.brain || (donor.is_random && grows(request) && !founder.sensors.empty());
    if (is_whole && contains(request.genes, Genes::muscles) && founder.actuators.empty())
      donor.robot.actuators = actuators_of(founder);  // muscles that moved alike may not do so any more
    if (donor.is_random && is_whole)
      give_layer_of_outputs(donor.robot);
    else if (donor.is_random)
      give_brain_per_actuator(donor.robot, mean_muscle_frequency(founder));
    if (is_whole) validate_brain(donor.robot);
    if (changes && !grows(request) && weights_of(*donor.robot.brain).empty())
      throw InputError("its brain has no weights that could change");
    return with_family(std::move(donor), request);
  } catch (const InputError& error) {
    throw InputError("robot " + founder.name, error.what());
  }

  Donor donor_of_random_robots(const GenomeSpaceRequest& request) const {
    Donor donor{.robot = {}, .is_random = true};
    give_brain_per_actuator(donor.robot, frequency_of_random_robots());
    return with_family(std::move(donor), request);
  }

  // Brains that grow begin without hidden neurons where they are random.
  static Donor with_family(Donor donor, const GenomeSpaceRequest& request) {
    if (grows(request) && donor.is_random) {
      std::vector<NeuronLayer>& layers = donor.robot.brain->layers;
      layers.erase(layers.begin(), layers.end() - 1);
      layers.front().inputs.clear();
    }
    donor.family = grows(request) ? make_growing_brains(donor.robot, request.growth) : make_fixed_brains(donor.robot);
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

  std::unique_ptr<GenomeSpace> bodies_;
  std::shared_ptr<const BrainContext> context_;
};

}  // namespace

void require_brains(const GenomeSpaceRequest& request) {
  if (request.genes != Genes::brain) return;
  const bool grows = request.growth.brain_growth;
  const auto refuse = [&](const std::string& whose) {
    throw ParameterError("genes", std::string("brain alone needs robots that have one") +
                                      (grows ? " or sensors, and " : ", and ") + whose +
                                      "; start from sample:hunter or a file with a brain, or give body,brain or "
                                      "muscles,brain");
  };
  if (request.founders.empty()) refuse(request.kind + " robots have none");
  for (const Robot& founder : request.founders)
    if (!founder.brain && !(grows && !founder.sensors.empty())) refuse("robot " + founder.name + " has none");
}

std::unique_ptr<GenomeSpace> make_brain_space(const GenomeSpaceRequest& request, std::unique_ptr<GenomeSpace> bodies) {
  return std::make_unique<BrainSpace>(request, std::move(bodies));
}

}  // namespace mercury
