// SPDX-License-Identifier: Apache-2.0
#include "evolution/genomes/brain_part.h"

#include <algorithm>
#include <utility>

#include "evolution/genomes/growing_brain.h"
#include "mercury/error.h"
#include "robots/brain_genes.h"

namespace mercury {
namespace {

class FixedBrains : public BrainFamily {
 public:
  explicit FixedBrains(const Robot& founder) : brain_(founder.brain) {}

  BrainPartPointer first() const override { return part({.weights = brain_ ? weights_of(*brain_) : Weights{}}); }
  BrainPartPointer random(std::uint64_t seed) const override { return part(random_brain_genes(*brain_, seed)); }
  BrainPartPointer read(ByteReader& reader) const override {
    return part(BrainGenes::read(reader, weights_of(*brain_).size()));
  }

 private:
  using Weights = std::vector<float>;

  class Part : public BrainPart {
   public:
    Part(BrainGenes genes, const FixedBrains& family) : genes_(std::move(genes)), family_(family) {}

    BrainPartPointer mutated(double strength, std::uint64_t seed) const override {
      return family_.part(genes_.mutated(strength, seed));
    }
    BrainPartPointer crossed(const BrainPart& other, std::partial_ordering, std::uint64_t seed) const override {
      return family_.part(genes_.crossed(static_cast<const Part&>(other).genes_, *family_.brain_, seed));
    }
    void put_into(Robot& robot) const override { set_weights(*robot.brain, genes_.weights); }
    void add_identity(IdentityHash& hash) const override {
      for (const float weight : genes_.weights) hash.add(weight);
    }
    void write(ByteWriter& writer) const override { genes_.write(writer); }

    // In units of the first step of a mutation.
    std::vector<double> numbers() const override {
      std::vector<double> numbers;
      for (const float weight : genes_.weights) numbers.push_back(weight / BrainGenes::first_step);
      return numbers;
    }
    BrainPartPointer with_numbers(std::span<const double> numbers) const override {
      BrainGenes genes = genes_;
      for (std::size_t i = 0; i < genes.weights.size(); ++i)
        genes.weights[i] = BrainGenes::limited_weight(numbers[i] * BrainGenes::first_step);
      return family_.part(std::move(genes));
    }

   private:
    const BrainGenes genes_;
    const FixedBrains& family_;
  };

  BrainPartPointer part(BrainGenes genes) const { return std::make_shared<Part>(std::move(genes), *this); }

  const std::optional<Brain> brain_;
};

void add(IdentityHash& hash, const Brain& brain) {
  for (const NeuronLayer& layer : brain.layers) {
    hash.add(layer.neurons);
    for (const float bias : layer.bias) hash.add(bias);
    for (const NeuronInput& input : layer.inputs) {
      hash.add(input.from);
      for (const float weight : input.weights) hash.add(weight);
      for (const NeuronEdge& edge : input.edges) hash.add(edge.to).add(edge.from).add(edge.weight);
    }
  }
}

class GrowingBrains : public BrainFamily {
 public:
  GrowingBrains(const Robot& founder, const BrainGrowth& growth)
      : frame_(founder), growth_(growth), first_(GrowingBrain::of(frame_, *founder.brain)) {}

  BrainPartPointer first() const override { return part(first_); }
  BrainPartPointer random(std::uint64_t seed) const override {
    return part(GrowingBrain::minimal(frame_, growth_, seed));
  }
  BrainPartPointer read(ByteReader& reader) const override { return part(GrowingBrain::read(reader, frame_)); }

 private:
  class Part : public BrainPart {
   public:
    Part(GrowingBrain genes, const GrowingBrains& family)
        : genes_(std::move(genes)), family_(family), brain_(genes_.grown(family.frame_)) {}

    BrainPartPointer mutated(double strength, std::uint64_t seed) const override {
      return family_.part(genes_.mutated(family_.frame_, family_.growth_, strength, seed));
    }
    BrainPartPointer crossed(const BrainPart& other, std::partial_ordering fitness, std::uint64_t seed) const override {
      return family_.part(genes_.crossed(static_cast<const Part&>(other).genes_, fitness, seed));
    }
    // The copies of a brain per actuator may have too many neurons in all.
    void put_into(Robot& robot) const override try {
      robot.brain = brain_;
      validate_brain(robot);
    } catch (const InputError&) {
      robot.sensors.clear();
      robot.brain.reset();
    }
    void add_identity(IdentityHash& hash) const override { add(hash, brain_); }
    void write(ByteWriter& writer) const override { genes_.write(writer, family_.frame_); }
    std::optional<double> distance(const BrainPart& other) const override {
      return genes_.distance(static_cast<const Part&>(other).genes_);
    }

   private:
    const GrowingBrain genes_;
    const GrowingBrains& family_;
    const Brain brain_;
  };

  BrainPartPointer part(GrowingBrain genes) const { return std::make_shared<Part>(std::move(genes), *this); }

  const BrainFrame frame_;
  const BrainGrowth growth_;
  const GrowingBrain first_;
};

}  // namespace

std::unique_ptr<BrainFamily> make_fixed_brains(const Robot& founder) { return std::make_unique<FixedBrains>(founder); }

std::unique_ptr<BrainFamily> make_growing_brains(const Robot& founder, const BrainGrowth& growth) {
  return std::make_unique<GrowingBrains>(founder, growth);
}

bool grow_alike(const Robot& a, const Robot& b) { return BrainFrame(a) == BrainFrame(b); }

}  // namespace mercury
