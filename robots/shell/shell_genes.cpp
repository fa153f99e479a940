// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "mercury/error.h"
#include "mercury/shell.h"
#include "robots/genes.h"

namespace mercury {
namespace {

// The numbers of a shell in the order of its encoding, which is kept.
constexpr std::array whole_numbers{&ShellGenome::segments, &ShellGenome::lobes, &ShellGenome::waves_around};
constexpr std::array real_numbers{&ShellGenome::diameter,   &ShellGenome::thickness,   &ShellGenome::height,
                                  &ShellGenome::opening,    &ShellGenome::squareness,  &ShellGenome::flare,
                                  &ShellGenome::lobe_depth, &ShellGenome::lappets,     &ShellGenome::twist,
                                  &ShellGenome::active,     &ShellGenome::waves_along, &ShellGenome::contraction,
                                  &ShellGenome::bending,    &ShellGenome::frequency};
constexpr std::array numbers_of_muscles{&ShellGenome::contraction, &ShellGenome::bending, &ShellGenome::frequency};

ShellGenome with_muscles_of(ShellGenome body, const ShellGenome& muscles) {
  for (const auto number : numbers_of_muscles) body.*number = muscles.*number;
  return body;
}

// The muscle laws are amplitudes and frequency; the waves of the muscles are part of the body.
struct ShellGenes {
  static constexpr std::uint8_t tag = 4;
  ShellGenome genome;

  static ShellGenes of(const Robot& robot) {
    std::optional<ShellGenome> genome = shell_genome_of(robot);
    if (!genome) throw InputError("/origin", "holds no shell");
    genome->environment.clear();
    return {*std::move(genome)};
  }

  ShellGenes mutated(Genes genes, const GeneMutation& mutation, std::uint64_t seed) const {
    ShellGenome child = genes == Genes::muscles ? genome : mutate(genome, mutation.strength, seed);
    if (genes == Genes::body) return {with_muscles_of(std::move(child), genome)};
    if (genes == Genes::both && mutation.is_uniform()) return {std::move(child)};
    return {with_muscles_of(std::move(child), mutate_muscles(genome, mutation.muscles, seed, mutation.tail))};
  }

  static std::size_t muscle_numbers() { return numbers_of_muscles.size(); }

  ShellGenes crossed(const ShellGenes& other, Genes genes, std::uint64_t seed) const {
    ShellGenome child = crossover(genome, other.genome, seed);
    if (genes == Genes::body) child = with_muscles_of(std::move(child), genome);
    if (genes == Genes::muscles) child = with_muscles_of(genome, child);
    return {std::move(child)};
  }

  Robot grown(const std::string& name, const std::string& environment) const {
    ShellGenome whole = genome;
    whole.environment = environment;
    return grow(whole, name);
  }

  void write(ByteWriter& writer) const {
    writer.add(static_cast<std::uint8_t>(genome.form));
    for (const auto number : whole_numbers) writer.add(static_cast<std::uint32_t>(genome.*number));
    for (const auto number : real_numbers) writer.add(genome.*number);
  }

  static ShellGenes read(ByteReader& reader) {
    ShellGenes genes;
    const auto form = reader.read<std::uint8_t>();
    if (form > static_cast<std::uint8_t>(ShellForm::pod)) throw InputError("genome", "has no known form");
    genes.genome.form = static_cast<ShellForm>(form);
    for (const auto number : whole_numbers) genes.genome.*number = static_cast<int>(reader.read<std::uint32_t>());
    for (const auto number : real_numbers) genes.genome.*number = reader.read<double>();
    validate(genes.genome);
    return genes;
  }
};

}  // namespace

const GenesKind& shell_genes() {
  static constexpr GenesKind kind = genes_kind<ShellGenes>();
  return kind;
}

}  // namespace mercury
