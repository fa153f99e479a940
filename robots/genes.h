// SPDX-License-Identifier: Apache-2.0
// What evolution changes in robots of a kind. A kind describes its genes in a struct of its own, with
//
//   tag                     the first byte of its encoding
//   of(robot)               the genes of a robot, from its origin; throws InputError if it has none
//   mutated, crossed        children; `genes` says what may change, the mutation by how much
//   grown                   the robot
//   grown_for_trial         the same, whose origin need not hold the genes; only kinds that gain by it
//   write, read             the encoding without its head; read() throws InputError
//   add_identity            what makes the robot what it is; without it, all that write() writes
//   muscle_numbers          how many numbers of the muscles a mutation moves; only kinds that have some
//   random                  those of a random robot that grows, without a robot whose origin holds them; only kinds
//   that
//                           gain by it
//   numbers, with_numbers   as of Genome (mercury/genome.h), for these genes; only kinds that are a list of numbers
//
// and names genes_kind<its struct>() in its entry of the registry (Generator::genes). Nothing else knows it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mercury/fnv.h"
#include "mercury/generator.h"
#include "mercury/material.h"
#include "mercury/random.h"
#include "mercury/robot.h"
#include "robots/bytes.h"

namespace mercury {

// Adds up what makes a genome's robot what it is.
class IdentityHash : public Fnv1a {
 public:
  std::uint64_t value() const { return seed_of(Fnv1a::value(), 0); }
};

// By how much a mutation changes genes.
struct GeneMutation {
  double strength = 1;  // of changes of the body
  double muscles = 1;   // of changes of the muscles
  int tail = 0;         // of these: degrees of freedom of Student's t; 0 = normal numbers (mutation_step.h)

  static GeneMutation of_strength(double strength) { return {.strength = strength, .muscles = strength}; }
  // Whether muscles move as the body does.
  bool is_uniform() const { return muscles == strength && tail == 0; }
};

class BodyGenes {
 public:
  virtual ~BodyGenes() = default;
  virtual std::shared_ptr<const BodyGenes> mutated(Genes genes, const GeneMutation& mutation,
                                                   std::uint64_t seed) const = 0;
  // With genes of the same kind.
  virtual std::shared_ptr<const BodyGenes> crossed(const BodyGenes& other, Genes genes, std::uint64_t seed) const = 0;
  virtual Robot grown(const std::string& name, const std::string& environment) const = 0;
  virtual Robot grown_for_trial(const std::string& name) const = 0;
  virtual void write(ByteWriter& writer) const = 0;
  virtual void add_identity(IdentityHash& hash) const = 0;
  virtual std::size_t muscle_numbers() const { return 0; }
  virtual std::vector<double> numbers(Genes) const { return {}; }
  virtual std::shared_ptr<const BodyGenes> with_numbers(Genes, std::span<const double>) const { return nullptr; }
};

struct GenesKind {
  std::uint8_t tag;
  std::shared_ptr<const BodyGenes> (*of)(const Robot& robot);
  std::shared_ptr<const BodyGenes> (*read)(ByteReader& reader);
  // Of the index-th robot of a seed, as of(generator.make(...)).
  std::shared_ptr<const BodyGenes> (*random)(const Generator& generator, const ParameterValues& values,
                                             std::uint64_t seed, std::uint64_t index);
};

template <class Values>
class GenesOf : public BodyGenes {
 public:
  explicit GenesOf(Values values) : values_(std::move(values)) {}
  std::shared_ptr<const BodyGenes> mutated(Genes genes, const GeneMutation& mutation,
                                           std::uint64_t seed) const override {
    return std::make_shared<GenesOf>(values_.mutated(genes, mutation, seed));
  }
  std::shared_ptr<const BodyGenes> crossed(const BodyGenes& other, Genes genes, std::uint64_t seed) const override {
    return std::make_shared<GenesOf>(values_.crossed(static_cast<const GenesOf&>(other).values_, genes, seed));
  }
  Robot grown(const std::string& name, const std::string& environment) const override {
    return values_.grown(name, environment);
  }
  Robot grown_for_trial(const std::string& name) const override {
    if constexpr (requires { values_.grown_for_trial(name); })
      return values_.grown_for_trial(name);
    else
      return values_.grown(name, {});
  }
  void write(ByteWriter& writer) const override { values_.write(writer); }
  void add_identity(IdentityHash& hash) const override {
    if constexpr (requires { values_.add_identity(hash); }) {
      values_.add_identity(hash);
    } else {
      ByteWriter writer;
      values_.write(writer);
      hash.add(std::move(writer).take());
    }
  }
  std::size_t muscle_numbers() const override {
    if constexpr (requires { values_.muscle_numbers(); }) return values_.muscle_numbers();
    return 0;
  }
  std::vector<double> numbers(Genes genes) const override {
    if constexpr (requires { values_.numbers(genes); }) return values_.numbers(genes);
    return {};
  }
  std::shared_ptr<const BodyGenes> with_numbers(Genes genes, std::span<const double> numbers) const override {
    if constexpr (requires { values_.with_numbers(genes, numbers); })
      return std::make_shared<GenesOf>(values_.with_numbers(genes, numbers));
    return nullptr;
  }

 private:
  Values values_;
};

template <class Values>
constexpr GenesKind genes_kind() {
  return {.tag = Values::tag,
          .of = [](const Robot& robot) -> std::shared_ptr<const BodyGenes> {
            return std::make_shared<GenesOf<Values>>(Values::of(robot));
          },
          .read = [](ByteReader& reader) -> std::shared_ptr<const BodyGenes> {
            return std::make_shared<GenesOf<Values>>(Values::read(reader));
          },
          .random = [](const Generator& generator, const ParameterValues& values, std::uint64_t seed,
                       std::uint64_t index) -> std::shared_ptr<const BodyGenes> {
            if constexpr (requires { Values::random(values, seed, index); })
              return std::make_shared<GenesOf<Values>>(Values::random(values, seed, index));
            else
              return std::make_shared<GenesOf<Values>>(Values::of(generator.make(values, {}, seed, index)));
          }};
}

// Which of the genes a mutation changes. With Genes::both it is the body, the muscle laws, or both, a third each.
struct Changes {
  bool body = false, muscles = false;
};
Changes changes_of(Genes genes, std::uint64_t seed);

// The materials of a robot as genes are its base materials (muscle_laws.h).
// Base materials from id 1 on: 22 whose pairs follow from them, or a whole table without air. Empty = the defaults.
using MaterialGenes = std::vector<Material>;

MaterialGenes material_genes_of(const Robot& robot);
// The table for Robot::materials; empty for the defaults.
std::vector<Material> table_of(const MaterialGenes& genes);

// As mutate_muscle_laws and cross_muscle_laws. Genes of different numbers of materials are not mixed: the child has
// a's.
MaterialGenes mutated(const MaterialGenes& genes, const GeneMutation& mutation, std::uint64_t seed,
                      const std::vector<bool>& in_use);
MaterialGenes crossed(const MaterialGenes& a, const MaterialGenes& b, std::uint64_t seed);

// Amplitude, frequency and phase of each muscle in use; all with an empty list.
std::size_t muscle_numbers_of(const MaterialGenes& genes, const std::vector<bool>& in_use);

void write(ByteWriter& writer, const MaterialGenes& genes);
// Throws InputError for materials that are not valid.
MaterialGenes read_material_genes(ByteReader& reader);
// Throws InputError unless they are none, the base materials, or a whole table.
void require_known_count(const MaterialGenes& genes);

// Adds the materials in use; all with an empty list or in a whole table, whose pairs are materials of their own.
void add_identity(IdentityHash& hash, const MaterialGenes& genes, const std::vector<bool>& in_use);

}  // namespace mercury
