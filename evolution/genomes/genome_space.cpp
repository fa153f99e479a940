// SPDX-License-Identifier: Apache-2.0
// Genomes and genome spaces of all kinds of robots that have genes (robots/genes.h), and which space a request is for.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "evolution/genomes/spaces.h"
#include "mercury/configuration.h"
#include "mercury/custom.h"
#include "mercury/error.h"
#include "mercury/genome.h"
#include "mercury/origin.h"
#include "mercury/random.h"
#include "mercury/real_body.h"
#include "robots/genes.h"
#include "robots/mutation_step.h"

namespace mercury {
namespace {

// What all genomes of a space share.
struct GenomeContext {
  const GenesKind& kind;
  Genes genes = Genes::body;
  std::string environment;
  std::optional<RealMaterial> material;  // of the robots' bodies; the genes say nothing of it
  MuscleMutation muscles;
};

using GenesPointer = std::shared_ptr<const BodyGenes>;

class BodyGenome : public Genome {
 public:
  BodyGenome(GenesPointer genes, MuscleStep step, std::shared_ptr<const GenomeContext> context)
      : genes_(std::move(genes)), step_(step), context_(std::move(context)) {}

  Robot grow(const std::string& name) const override { return real(genes_->grown(name, context_->environment)); }
  Robot grow_for_trial(const std::string& name) const override { return real(genes_->grown_for_trial(name)); }
  GenomePointer mutate(double strength, std::uint64_t seed) const override {
    if (strength == 0) return make(genes_, step_);
    const auto [mutation, step] = step_.child(context_->muscles, genes_->muscle_numbers(), strength, seed);
    return make(genes_->mutated(context_->genes, mutation, seed), step);
  }
  GenomePointer cross(const Genome& other, std::uint64_t seed) const override {
    const auto* mate = dynamic_cast<const BodyGenome*>(&other);
    if (!mate) throw InputError("crossover", "two genomes of one space are needed");
    return make(genes_->crossed(*mate->genes_, context_->genes, seed), step_.crossed(mate->step_));
  }
  std::uint64_t identity() const override {
    return identity_.value([&](IdentityHash& hash) { genes_->add_identity(hash); });
  }
  std::string encode() const override {
    ByteWriter writer;
    write_head(writer, context_->kind.tag);
    step_.write(writer, context_->muscles);
    genes_->write(writer);
    return std::move(writer).take();
  }

  std::vector<double> numbers() const override { return genes_->numbers(context_->genes); }
  GenomePointer with_numbers(std::span<const double> numbers) const override {
    return make(genes_->with_numbers(context_->genes, numbers), step_);
  }

 private:
  Robot real(Robot robot) const {
    return context_->material ? with_real_body(robot, *context_->material) : std::move(robot);
  }
  GenomePointer make(GenesPointer genes, MuscleStep step) const {
    return std::make_shared<BodyGenome>(std::move(genes), step, context_);
  }

  GenesPointer genes_;
  MuscleStep step_;
  std::shared_ptr<const GenomeContext> context_;
  CachedIdentity identity_;
};

// The real material of the founders, which is one, or that of the request.
std::optional<RealMaterial> material_of(const GenomeSpaceRequest& request) {
  std::optional<RealMaterial> material = real_material_in(request.values);
  for (const Robot& founder : request.founders) {
    const std::optional<RealMaterial> own = real_material_of(founder);
    if (!own) continue;
    if (material && *own != *material)
      throw InputError("robot " + founder.name, "has a real body of another material than the rest");
    material = own;
  }
  return material;
}

// Random robots of a generator, or the founders and mutants of them.
class BodySpace : public GenomeSpace {
 public:
  BodySpace(const Generator& generator, const GenomeSpaceRequest& request)
      : generator_(generator), values_(request.values),
        context_(std::make_shared<GenomeContext>(GenomeContext{*generator.genes, request.genes, request.environment,
                                                               material_of(request), request.muscles})) {
    values_.erase("physics");
    for (const Robot& founder : request.founders) founders_.push_back(genes_of(founder));
    if (founders_.empty()) generator_.validate(values_);
  }

  GenomePointer random(std::uint64_t seed, std::uint64_t index) const override {
    if (index < founders_.size()) return genome(founders_[index]);
    Random random(seed_of(seed, index));
    const std::uint64_t mutation_seed = random.bits();
    if (!founders_.empty()) {
      const double strength = random.uniform(1, strongest_at_first);
      return genome(founders_[index % founders_.size()])->mutate(strength, mutation_seed);
    }
    GenesPointer genes = context_->kind.random(generator_, values_, seed, index);
    if (contains(context_->genes, Genes::muscles))
      genes = genes->mutated(Genes::muscles, GeneMutation::of_strength(strongest_at_first), mutation_seed);
    return genome(std::move(genes));
  }
  std::size_t founders() const override { return founders_.size(); }
  GenomePointer decode(std::string_view bytes) const override try {
    ByteReader reader(bytes);
    read_head(reader, context_->kind.tag);
    const MuscleStep step = MuscleStep::read(reader, context_->muscles);
    GenesPointer genes = context_->kind.read(reader);
    reader.end();
    return std::make_shared<BodyGenome>(std::move(genes), step, context_);
  } catch (const DamagedBytes& error) {
    throw InputError("genome", error.what());
  }

 private:
  GenomePointer genome(GenesPointer genes) const {
    return std::make_shared<BodyGenome>(std::move(genes), MuscleStep(), context_);
  }
  // A body or materials that were changed by hand would be lost without a word.
  GenesPointer genes_of(const Robot& founder) const try {
    const bool real = real_material_of(founder).has_value();
    GenesPointer genes = context_->kind.of(real ? without_real_body(founder) : founder);
    Robot grown = genes->grown(founder.name, "");
    if (real) grown = with_real_body(grown, *real_material_of(founder));
    if (!std::ranges::equal(materials_of(grown).subspan(1), materials_of(founder).subspan(1)) ||
        grown.springs != founder.springs || grown.masses != founder.masses || grown.mass != founder.mass ||
        grown.velocity != founder.velocity || grown.fixed != founder.fixed)
      throw InputError("/origin", "leads to another robot; evolve its muscles alone");
    return genes;
  } catch (const InputError& error) {
    throw InputError("robot " + founder.name, error.what());
  }

  const Generator& generator_;
  ParameterValues values_;
  std::shared_ptr<const GenomeContext> context_;
  std::vector<GenesPointer> founders_;
};

// The kind of all founders, or that of the request.
std::string kind_for(const GenomeSpaceRequest& request) {
  if (request.founders.empty()) return request.kind;
  const Robot& first = request.founders.front();
  for (const Robot& founder : request.founders) {
    if (!generator_of(founder))
      throw InputError("robot " + founder.name,
                       "its origin does not say how its body was made; evolve its muscles alone, or give " +
                           generator_kinds() + " robots");
    if (kind_of(founder) != kind_of(first))
      throw InputError("robot " + founder.name, "is a " + kind_of(founder) + " robot, and " + first.name + " a " +
                                                    kind_of(first) + " robot; give robots of one kind");
  }
  return kind_of(first);
}

// A real body of hexahedra has several materials per muscle, which its genes move together.
bool moves_materials_together(const Robot& robot) {
  const Generator* generator = generator_of(robot);
  return generator && generator->cells && generator->genes;
}

}  // namespace

void write_head(ByteWriter& writer, std::uint8_t tag) {
  constexpr std::uint8_t version = 1;
  writer.add(tag);
  writer.add(version);
}

void read_head(ByteReader& reader, std::uint8_t tag) {
  const auto kind = reader.read<std::uint8_t>(), version = reader.read<std::uint8_t>();
  if (kind != tag) throw InputError("genome", "is not of the kind that the run evolves");
  if (version != 1)
    throw InputError("genome", "has version " + std::to_string(version) + "; this program reads version 1");
}

namespace {

constexpr StepRange muscle_steps{1e-3, 100};

std::uint64_t seed_of_muscle_step(std::uint64_t seed) { return seed_of(seed, 0x6d7573636c65); }

}  // namespace

MuscleStep::Child MuscleStep::child(const MuscleMutation& how, std::size_t numbers, double strength,
                                    std::uint64_t seed) const {
  Child child{.mutation = GeneMutation::of_strength(strength), .step = *this};
  child.mutation.tail = how.muscle_tail;
  if (!how.muscle_adaptation || numbers == 0) return child;
  Random random(seed_of_muscle_step(seed));
  child.step.value_ = adapted_step(value_, numbers, muscle_steps, random);
  child.mutation.muscles *= child.step.value_;
  return child;
}

MuscleStep MuscleStep::crossed(MuscleStep other) const {
  MuscleStep child;
  child.value_ = crossed_step(value_, other.value_, muscle_steps);
  return child;
}

void MuscleStep::write(ByteWriter& writer, const MuscleMutation& how) const {
  if (how.muscle_adaptation) writer.add(value_);
}

MuscleStep MuscleStep::read(ByteReader& reader, const MuscleMutation& how) {
  MuscleStep step;
  if (!how.muscle_adaptation) return step;
  step.value_ = reader.read<double>();
  if (!(step.value_ >= muscle_steps.smallest && step.value_ <= muscle_steps.largest))
    throw InputError("genome", "the step of its muscles is out of range");
  return step;
}

Physics physics_of(const GenomeSpaceRequest& request) {
  if (real_material_in(request.values)) return Physics::real;
  return request.founders.empty() ? Physics::paper : physics_of(request.founders.front());
}

namespace {

// Throws ParameterError for settings of the growth of brains that do not grow, or that do not change at all.
void require_growth(const GenomeSpaceRequest& request) {
  check_parameters(request.growth);
  const bool changes = contains(request.genes, Genes::brain);
  if (request.growth.brain_growth && !changes)
    throw ParameterError("brain_growth", "brains do not change; give brain among the genes");
  if (request.growth.brain_growth) return;
  BrainGrowth usual;
  for_each_parameter(usual, [&](const auto& parameter, const auto& value) {
    if (request.growth.*parameter.member != value)
      throw ParameterError(std::string(parameter.name), "goes with brain growth alone");
  });
}

// Of bodies and muscles, as far as these change.
std::unique_ptr<GenomeSpace> make_body_space(const GenomeSpaceRequest& request) {
  const bool bodies_stay = !contains(request.genes, Genes::body),
             muscles_stay = !contains(request.genes, Genes::muscles);
  if (!request.founders.empty() && bodies_stay &&
      (muscles_stay || !std::ranges::all_of(request.founders, moves_materials_together)))
    return make_given_body_space(request);
  const Generator& generator = generator_named(kind_for(request));
  if (!generator.genes) throw ParameterError("kind", generator.kind + " robots cannot be evolved");
  GenomeSpaceRequest whole = request;
  whole.genes = request.genes & Genes::both;
  if (whole.environment.empty())
    whole.environment = request.founders.empty() ? generator.environment : environment_of(request.founders.front());
  return std::make_unique<BodySpace>(generator, whole);
}

}  // namespace

std::unique_ptr<GenomeSpace> make_genome_space(const GenomeSpaceRequest& request) {
  if (!request.environment.empty()) environment_named(request.environment);  // or it throws
  check_parameters(request.muscles);
  if (request.muscles != MuscleMutation{} && !contains(request.genes, Genes::muscles))
    throw ParameterError(request.muscles.muscle_adaptation ? "muscle_adaptation" : "muscle_tail",
                         "the muscles do not change; give muscles among the genes");
  require_growth(request);
  if (request.founders.empty() && is_custom(request.kind)) return std::make_unique<CustomSpace>(request.kind);
  require_brains(request);
  std::unique_ptr<GenomeSpace> bodies = make_body_space(request);
  const bool has_brains =
      contains(request.genes, Genes::brain) ||
      std::ranges::any_of(request.founders, [](const Robot& robot) { return robot.brain.has_value(); });
  return has_brains ? make_brain_space(request, std::move(bodies)) : std::move(bodies);
}

}  // namespace mercury
