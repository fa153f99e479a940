// SPDX-License-Identifier: Apache-2.0
// Genomes: what evolution changes. A robot is grown from a genome.
//
// Mercury brings genomes of voxel grids, painted grids, networks, shells, of the muscles of a given body, and of brains
// (make_genome_space below). A program may bring its own: it derives from Genome and GenomeSpace.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "mercury/generator.h"
#include "mercury/parameters.h"
#include "mercury/physics.h"
#include "mercury/robot.h"

namespace mercury {

class Genome;
using GenomePointer = std::shared_ptr<const Genome>;

// A genome does not change. All functions depend on the arguments alone, bit for bit on every machine, and may be
// called from several threads at the same time.
class Genome {
 public:
  virtual ~Genome() = default;

  // The robot. Its origin holds what generators know of it. Throws InputError if this genome has no robot.
  virtual Robot grow(const std::string& name) const = 0;
  // The same body and control, to be tried and thrown away: its origin need not say more than the kind.
  virtual Robot grow_for_trial(const std::string& name) const { return grow(name); }
  // A changed copy; `strength` 1 changes a little, as in a search.
  virtual GenomePointer mutate(double strength, std::uint64_t seed) const = 0;
  // A child of this genome and another one of its space.
  virtual GenomePointer cross(const Genome& other, std::uint64_t seed) const = 0;
  // The same for parents that have been tried; `fitness` compares this one with the other. Only kinds whose children
  // take after the fitter parent need it.
  virtual GenomePointer cross_by_fitness(const Genome& other, std::partial_ordering /*fitness*/,
                                         std::uint64_t seed) const {
    return cross(other, seed);
  }
  // Equal for genomes that grow the same robot, as far as that is known without growing it; otherwise almost always
  // different.
  virtual std::uint64_t identity() const = 0;
  // The genome as bytes that its space decodes, as few as is easy. Genomes that differ in little should have encodings
  // of the same length that differ in few bytes: a run folder stores what differs from the parent.
  virtual std::string encode() const = 0;

  // How far this genome and another one of its space are from being of one species, for algorithms that keep species:
  // 0 or more, the same in both directions. Nothing for kinds that do not know.
  virtual std::optional<double> distance(const Genome& /*other*/) const { return std::nullopt; }

  // The genome as numbers, for algorithms that search among these (CMA-ES): without bounds, and scaled so that 1 is
  // about the step of a mutation. As many for all genomes of a space, with one meaning. Empty where that is not
  // possible.
  virtual std::vector<double> numbers() const { return {}; }
  // The genome with other finite numbers, of which those that it has give this genome, up to rounding. Throws nothing
  // but lack of memory.
  virtual GenomePointer with_numbers(std::span<const double> /*numbers*/) const { return nullptr; }
};

// The genomes among which a run searches.
class GenomeSpace {
 public:
  virtual ~GenomeSpace() = default;

  // The index-th random genome of a seed; depends on both alone. The first founders() of them do not depend on the
  // seed: they are those that the user gave. Throws InputError if there is no such genome.
  virtual GenomePointer random(std::uint64_t seed, std::uint64_t index) const = 0;
  virtual std::size_t founders() const { return 0; }
  // The reverse of Genome::encode(). Throws InputError for bytes that are no genome of this space, before memory is
  // allocated from their numbers.
  virtual GenomePointer decode(std::string_view bytes) const = 0;
};

// How muscles move where they change. Bodies and brains have steps of their own kinds.
struct MuscleMutation {
  bool muscle_adaptation = false;  // whether each genome has a step for its muscles, which adapts itself
  int muscle_tail = 0;             // Student's t with that many degrees of freedom draws the steps; 0 = normal numbers
  friend bool operator==(const MuscleMutation&, const MuscleMutation&) = default;

  static constexpr std::tuple parameters{
      Parameter("muscle_adaptation", &MuscleMutation::muscle_adaptation,
                "Give each robot a step of its own for its muscles, which adapts itself"),
      Parameter("muscle_tail", &MuscleMutation::muscle_tail, "", Accepts::between(0, 100), {0, 10},
                "Draw steps of muscles from Student's t with that many degrees of freedom: 1 = Cauchy, 0 = normal")};
};

// How brains grow where they change: NEAT (Stanley and Miikkulainen 2002).
struct BrainGrowth {
  bool brain_growth = false;      // whether neurons and connections come and go; else weights alone change
  double new_neurons = 0.03;      // share of the mutations that split a connection by a neuron
  double new_connections = 0.05;  // share of the mutations that add a connection
  double recurrence = 0.2;        // share of these that feed back
  double first_connections = 1;   // share of the senses to which each output of a minimal brain is connected
  friend bool operator==(const BrainGrowth&, const BrainGrowth&) = default;

  static constexpr std::tuple parameters{
      Parameter("brain_growth", &BrainGrowth::brain_growth,
                "Let brains grow: neurons and connections come and go (NEAT)"),
      Parameter("new_neurons", &BrainGrowth::new_neurons, "", Accepts::between(0, 1), {0, 0.2f},
                "brain growth: share of the mutations that split a connection by a neuron")
          .with_form("0..1"),
      Parameter("new_connections", &BrainGrowth::new_connections, "", Accepts::between(0, 1), {0, 0.2f},
                "brain growth: share of the mutations that add a connection")
          .with_form("0..1"),
      Parameter("recurrence", &BrainGrowth::recurrence, "", Accepts::between(0, 1), {0, 1},
                "brain growth: share of the new connections that feed back")
          .with_form("0..1"),
      Parameter("first_connections", &BrainGrowth::first_connections, "", Accepts::between(0, 1), {0, 1},
                "brain growth: share of the senses to which each output of a minimal brain is connected")
          .with_form("0..1")};
};

// Which of Mercury's genome spaces.
struct GenomeSpaceRequest {
  std::string kind = "voxel";  // of a generator; ignored if there are founders
  ParameterValues values{};    // of that generator
  std::string environment{};   // for the origins of the robots; empty = none is named
  Genes genes = Genes::body;
  std::vector<Robot> founders;  // robots to start from, all of one kind; any kind if the body stays
  MuscleMutation muscles{};
  BrainGrowth growth{};
};

// What the robots of this space are made for.
Physics physics_of(const GenomeSpaceRequest& request);

// Throws InputError or ParameterError for a request that cannot be used: an unknown kind, values out of range, founders
// of several kinds, founders of a kind that no generator knows and whose body should change, a way to move muscles or
// to grow brains that do not change, a brain that cannot grow.
std::unique_ptr<GenomeSpace> make_genome_space(const GenomeSpaceRequest& request);

}  // namespace mercury
