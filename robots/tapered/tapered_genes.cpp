// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mercury/error.h"
#include "robots/genes.h"
#include "robots/genome_table.h"
#include "robots/tapered/tapered.h"

namespace mercury {
namespace {

struct TaperedGenes {
  static constexpr std::uint8_t tag = 6;
  TaperedGenome genome;

  static bool changes(Genes genes, std::string_view number) {
    return (genes != Genes::muscles && is_of_body(number)) || (genes != Genes::body && is_of_muscles(number));
  }

  static TaperedGenes of(const Robot& robot) {
    std::optional<TaperedGenome> genome = tapered_genome_of(robot);
    if (!genome) throw InputError("/origin", "holds no tapered robot");
    genome->environment.clear();
    return {*std::move(genome)};
  }

  TaperedGenes mutated(Genes genes, const GeneMutation& mutation, std::uint64_t seed) const {
    if (genes == Genes::both && mutation.is_uniform()) return {mutate(genome, mutation.strength, seed)};
    TaperedGenome child = genome;
    if (genes != Genes::muscles) child = mutate(child, mutation.strength, seed, is_of_body);
    const std::uint64_t of_muscles = genes == Genes::both ? seed_of(seed, 0) : seed;
    if (genes != Genes::body) child = mutate(child, mutation.muscles, of_muscles, is_of_muscles, mutation.tail);
    return {std::move(child)};
  }

  static std::size_t muscle_numbers() {
    return static_cast<std::size_t>(std::ranges::count_if(
        tapered_genome_table(), [](const auto& row) { return is_of_muscles(row.description.name); }));
  }

  TaperedGenes crossed(const TaperedGenes& other, Genes genes, std::uint64_t seed) const {
    const TaperedGenome child = crossover(genome, other.genome, seed);
    TaperedGenome kept = genome;
    for (const auto& row : tapered_genome_table())
      if (changes(genes, row.description.name)) row.set(kept, row.get(child));
    return {std::move(kept)};
  }

  Robot grown(const std::string& name, const std::string& environment) const {
    TaperedGenome whole = genome;
    whole.environment = environment;
    return grow(whole, name);
  }

  std::vector<double> numbers(Genes genes) const {
    std::vector<double> numbers;
    for (const auto& row : tapered_genome_table())
      if (changes(genes, row.description.name))
        numbers.push_back(number_of(row.description, std::get<double>(row.get(genome))));
    return numbers;
  }
  TaperedGenes with_numbers(Genes genes, std::span<const double> numbers) const {
    TaperedGenes child = *this;
    auto number = numbers.begin();
    for (const auto& row : tapered_genome_table())
      if (changes(genes, row.description.name)) row.set(child.genome, value_of(row.description, *number++));
    return child;
  }

  // The bending, then each number in the order of the table, which is kept.
  void write(ByteWriter& writer) const {
    writer.add(static_cast<std::uint8_t>(genome.bending));
    for (const auto& row : tapered_genome_table()) {
      const ParameterValue value = row.get(genome);
      if (const auto* whole = std::get_if<std::int64_t>(&value)) writer.add(static_cast<std::uint32_t>(*whole));
      if (const auto* number = std::get_if<double>(&value)) writer.add(*number);
    }
  }

  static TaperedGenes read(ByteReader& reader) {
    TaperedGenes genes;
    const auto bending = reader.read<std::uint8_t>();
    if (bending > static_cast<std::uint8_t>(TaperedBending::up_down))
      throw InputError("genome", "bends in no known direction");
    genes.genome.bending = static_cast<TaperedBending>(bending);
    for (const auto& row : tapered_genome_table()) {
      if (std::holds_alternative<std::int64_t>(row.description.initial))
        row.set(genes.genome, static_cast<std::int64_t>(reader.read<std::uint32_t>()));
      if (std::holds_alternative<double>(row.description.initial)) row.set(genes.genome, reader.read<double>());
    }
    validate(genes.genome);
    return genes;
  }
};

}  // namespace

const GenesKind& tapered_genes() {
  static constexpr GenesKind kind = genes_kind<TaperedGenes>();
  return kind;
}

}  // namespace mercury
