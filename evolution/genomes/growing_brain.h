// SPDX-License-Identifier: Apache-2.0
// Brains that grow: the genes of NEAT (Stanley and Miikkulainen 2002, "Evolving Neural Networks through Augmenting
// Topologies").
//
// A genome has neurons and connections. Each has a marking, so that two genomes can be aligned whatever their ancestors
// were: where both have a gene of the same marking, it is the same gene. The paper counts markings up over a whole run;
// here they follow from the gene itself, so that they do not depend on who was made first, or where:
//
//   sense i                              marking of (sense, i)
//   neuron j of layer i of the frame     marking of (neuron, i, j)
//   neuron that split a -> b             marking of (split, a, b, k): the k-th time that this genome did so
//   connection a -> b                    marking of (connection, a, b)
//
// The frame is what all genomes of a family have: senses, and layers of neurons with their activations, alphas and
// outputs. A neuron that grows lies halfway between the two that it came between, and so has a depth, which follows
// from its history as the marking does:
//
//   depth      0          1/4         1/2               1
//           senses -----------------------------> last layer       a connection
//           senses ----------------> new -------> last layer       it was split
//           senses ----> newer ----> new -------> last layer       its first half was split
//
// Neurons of one depth are a layer of the brain, layers are in the order of their depths. So a connection that leads
// deeper acts within one thought, and every other one feeds back what was a thought ago: any set of connections is a
// brain, and a new neuron changes no other one's place.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mercury/brain.h"
#include "mercury/genome.h"
#include "mercury/robot.h"
#include "robots/brain_genes.h"
#include "robots/bytes.h"

namespace mercury {

using Marking = std::uint64_t;

Marking sense_marking(std::size_t sense);
Marking neuron_marking(std::size_t layer, std::size_t neuron);
Marking split_marking(Marking from, Marking to, std::uint64_t times_before);
Marking connection_marking(Marking from, Marking to);

struct NeuronGene {
  Marking marking = 0;
  double depth = 0;  // in (0, 1]
  float bias = 0;
  friend bool operator==(const NeuronGene&, const NeuronGene&) = default;
};

struct ConnectionGene {
  ConnectionGene(Marking from_, Marking to_, float weight_, bool enabled_ = true)
      : marking(connection_marking(from_, to_)), from(from_), to(to_), weight(weight_), enabled(enabled_) {}

  Marking marking, from, to;  // from a sense or a neuron to a neuron
  float weight;
  bool enabled;
  friend bool operator==(const ConnectionGene&, const ConnectionGene&) = default;
};

// What does not change: senses, and layers without what their neurons read.
class BrainFrame {
 public:
  // Of a robot with a brain that validate() accepts. Throws InputError, without the robot's name, if it cannot grow.
  explicit BrainFrame(const Robot& robot);

  const Brain& brain() const { return brain_; }  // without connections; biases are 0
  std::size_t senses() const { return senses_; }
  std::size_t neurons() const { return neurons_.size(); }  // layer after layer
  Marking sense(std::size_t i) const { return sense_markings_[i]; }
  Marking neuron(std::size_t i) const { return neurons_[i].marking; }
  double depth(std::size_t neuron) const { return neurons_[neuron].depth; }

  friend bool operator==(const BrainFrame& a, const BrainFrame& b) {
    return a.sensors_ == b.sensors_ && a.brain_ == b.brain_;
  }

 private:
  std::vector<Sensor> sensors_;
  Brain brain_;
  std::size_t senses_ = 0;
  std::vector<Marking> sense_markings_;
  std::vector<NeuronGene> neurons_;
};

struct GrowingBrain {
  static constexpr double smallest_step = 1e-4, largest_step = 10;
  // About how far all weights and biases of a minimal brain move at first, together: step times the root of their
  // number.
  static constexpr double first_length = 2;
  static constexpr std::size_t most_grown = 128;  // neurons, so that a brain has not more layers than it may

  std::vector<float> biases;                // of the frame's neurons
  std::vector<NeuronGene> neurons;          // that grew, in the order of their markings
  std::vector<ConnectionGene> connections;  // in the order of their markings
  double step = BrainGenes::first_step;     // [of a weight]
  friend bool operator==(const GrowingBrain&, const GrowingBrain&) = default;

  // The brain of a robot as it is: its connections, all enabled. Several between the same two are one.
  static GrowingBrain of(const BrainFrame& frame, const Brain& brain);
  // Without hidden neurons: each neuron of the last layer has connections from a share `first_connections` of the
  // senses, at least one, whose weights are normal numbers, as its bias is.
  static GrowingBrain minimal(const BrainFrame& frame, const BrainGrowth& growth, std::uint64_t seed);

  // One of these: a connection is split by a neuron, a connection is added, one is turned off or on, or all weights and
  // biases move by a step that adapts itself (robots/mutation_step.h), half of the time with one of them drawn again.
  // The paper draws a tenth of them again; of large brains that would be too many.
  GrowingBrain mutated(const BrainFrame& frame, const BrainGrowth& growth, double strength, std::uint64_t seed) const;
  // Genes that both have come from either one; those that one has come from the fitter parent, or, if neither is
  // fitter, each with a chance of one half. What is turned off in a parent is so in the child with a chance of 3/4.
  // `fitness` compares this one's with the other's.
  GrowingBrain crossed(const GrowingBrain& other, std::partial_ordering fitness, std::uint64_t seed) const;
  // The paper's equation 1 with N = 1, as the authors' own program has it, and c1 = c2, as in all its experiments:
  // genes that one has alone count alike, whether or not they are newer than all of the other's.
  //
  //   distance = connections that one has + 0.4 mean |difference| of the weights and biases that both have
  double distance(const GrowingBrain& other) const;

  // The brain: neurons from which no connection leads on are left out.
  Brain grown(const BrainFrame& frame) const;

  void write(ByteWriter& writer, const BrainFrame& frame) const;
  // Throws InputError for what is no brain of this frame.
  static GrowingBrain read(ByteReader& reader, const BrainFrame& frame);
};

}  // namespace mercury
