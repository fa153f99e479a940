// SPDX-License-Identifier: Apache-2.0
// Genomes and genome spaces from the genes of body_genes.h. They need nothing else, so a further kind of robot is a
// struct there and a line in genome_space.cpp.
#pragma once

#include <algorithm>
#include <atomic>
#include <string>
#include <utility>
#include <vector>

#include "evolution/genomes/body_genes.h"
#include "evolution/genomes/genome_head.h"
#include "mercury/error.h"
#include "mercury/random.h"

namespace mercury {

// What all genomes of a space share.
struct GenomeContext {
  Genes genes = Genes::body;
  std::string environment;
};

template <class BodyGenes>
class BodyGenome : public Genome {
 public:
  BodyGenome(BodyGenes genes, std::shared_ptr<const GenomeContext> context)
      : genes_(std::move(genes)), context_(std::move(context)) {}

  Robot grow(const std::string& name) const override { return genes_.grown(name, context_->environment); }
  GenomePointer mutate(double strength, std::uint64_t seed) const override {
    if (strength == 0) return std::make_shared<BodyGenome>(genes_, context_);
    return std::make_shared<BodyGenome>(genes_.mutated(context_->genes, strength, seed), context_);
  }
  GenomePointer cross(const Genome& other, std::uint64_t seed) const override {
    const auto* mate = dynamic_cast<const BodyGenome*>(&other);
    if (!mate) throw InputError("crossover", "two genomes of one space are needed");
    return std::make_shared<BodyGenome>(genes_.crossed(mate->genes_, context_->genes, seed), context_);
  }
  std::uint64_t identity() const override {
    std::uint64_t identity = identity_.load(std::memory_order_relaxed);
    if (identity != 0) return identity;
    IdentityHash hash;
    genes_.add_identity(hash);
    identity_.store(identity = hash.value(), std::memory_order_relaxed);
    return identity;
  }
  std::string encode() const override {
    ByteWriter writer;
    write_head(writer, BodyGenes::tag);
    genes_.write(writer);
    return std::move(writer).take();
  }

 private:
  BodyGenes genes_;
  std::shared_ptr<const GenomeContext> context_;
  mutable std::atomic<std::uint64_t> identity_{0};  // 0 = not computed yet
};

// Random robots of a generator, or the founders and mutants of them.
template <class BodyGenes>
class BodySpace : public GenomeSpace {
 public:
  BodySpace(const Generator& generator, const GenomeSpaceRequest& request)
      : generator_(generator), values_(request.values),
        context_(std::make_shared<GenomeContext>(GenomeContext{request.genes, request.environment})) {
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
    BodyGenes genes = BodyGenes::of(generator_.make(values_, context_->environment, seed, index));
    if (context_->genes != Genes::body) genes = genes.mutated(Genes::muscles, strongest_at_first, mutation_seed);
    return genome(std::move(genes));
  }
  std::size_t founders() const override { return founders_.size(); }
  GenomePointer decode(std::string_view bytes) const override try {
    ByteReader reader(bytes);
    read_head(reader, BodyGenes::tag);
    BodyGenes genes = BodyGenes::read(reader);
    reader.end();
    return genome(std::move(genes));
  } catch (const DamagedBytes& error) {
    throw InputError("genome", error.what());
  }

 private:
  static constexpr double strongest_at_first = 4;  // mutation of the robots that a run begins with

  GenomePointer genome(BodyGenes genes) const {
    return std::make_shared<BodyGenome<BodyGenes>>(std::move(genes), context_);
  }
  // A body or materials that were changed by hand would be lost without a word.
  BodyGenes genes_of(const Robot& founder) const try {
    BodyGenes genes = BodyGenes::of(founder);
    const Robot grown = genes.grown(founder.name, "");
    if (!std::ranges::equal(materials_of(grown).subspan(1), materials_of(founder).subspan(1)) ||
        grown.springs != founder.springs || grown.masses != founder.masses)
      throw InputError("/origin", "leads to another robot; evolve its muscles alone");
    return genes;
  } catch (const InputError& error) {
    throw InputError("robot " + founder.name, error.what());
  }

  const Generator& generator_;
  ParameterValues values_;
  std::shared_ptr<const GenomeContext> context_;
  std::vector<BodyGenes> founders_;
};

}  // namespace mercury
