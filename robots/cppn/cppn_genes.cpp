// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "mercury/cppn.h"
#include "mercury/error.h"
#include "mercury/random.h"
#include "robots/cppn/cppn_graph.h"
#include "robots/genes.h"

namespace mercury {
namespace {

// A robot's phases are part of its body. Its muscles have one amplitude, and frequencies that follow from one.
struct CppnGenes {
  static constexpr std::uint8_t tag = 2;
  static constexpr unsigned fields_bit = 0x80;  // beside the mirror
  CppnGenome genome;

  static CppnGenes of(const Robot& robot) {
    std::optional<CppnGenome> genome = cppn_genome_of(robot);
    if (!genome) throw InputError("/origin", "holds no painting network");
    genome->environment.clear();
    return {*std::move(genome)};
  }

  CppnGenes mutated(Genes genes, const GeneMutation& mutation, std::uint64_t seed) const {
    CppnGenes child = *this;
    const Changes changes = changes_of(genes, seed);
    if (changes.body) child.genome = mutate(child.genome, mutation.strength, seed);
    if (changes.muscles) child.genome = mutate_muscles(child.genome, mutation.muscles, seed_of(seed, 0), mutation.tail);
    return child;
  }

  static std::size_t muscle_numbers() { return 2; }

  CppnGenes crossed(const CppnGenes& other, Genes genes, std::uint64_t seed) const {
    CppnGenes child{crossover(genome, other.genome, seed)};
    if (genes == Genes::muscles) child.genome.network = genome.network;
    if (genes == Genes::body) {
      child.genome.frequency = genome.frequency;
      child.genome.amplitude = genome.amplitude;
    }
    return child;
  }

  Robot grown(const std::string& name, const std::string& environment) const {
    CppnGenome whole = genome;
    whole.environment = environment;
    return grow(whole, name);
  }

  void write(ByteWriter& writer) const {
    for (const int n : {genome.nx, genome.ny, genome.nz}) writer.add(static_cast<std::uint32_t>(n));
    writer.add(genome.edge);
    writer.add(static_cast<std::uint8_t>(static_cast<unsigned>(genome.mirror) |
                                         (has_fields(genome.network) ? fields_bit : 0u)));
    writer.add(static_cast<std::uint8_t>(genome.frequencies));
    writer.add(genome.frequency);
    writer.add(genome.amplitude);
    writer.add(static_cast<std::uint16_t>(genome.network.nodes.size()));
    writer.add(static_cast<std::uint16_t>(genome.network.edges.size()));
    for (const auto& [id, place, function] : genome.network.nodes) {
      writer.add(id);
      writer.add(place);
      writer.add(static_cast<std::uint8_t>(function));
    }
    for (const auto& [from, to, weight] : genome.network.edges) {
      writer.add(from);
      writer.add(to);
      writer.add(weight);
    }
  }

  static CppnGenes read(ByteReader& reader) {
    CppnGenes genes;
    CppnGenome& genome = genes.genome;
    for (int* n : {&genome.nx, &genome.ny, &genome.nz})
      *n = static_cast<int>(std::min<std::uint32_t>(reader.read<std::uint32_t>(), INT32_MAX));
    genome.edge = reader.read<float>();
    const unsigned mirror = reader.read<std::uint8_t>();
    genome.mirror = static_cast<Mirror>(mirror & ~fields_bit);
    if (mirror & fields_bit) genome.network.outputs = cppn_outputs;
    genome.frequencies = reader.read<std::uint8_t>();
    genome.frequency = reader.read<float>();
    genome.amplitude = reader.read<float>();
    const auto nodes = reader.read<std::uint16_t>(), edges = reader.read<std::uint16_t>();
    reader.expect(nodes, 9);
    for (std::size_t i = 0; i < nodes; ++i) {
      CppnNode& node = genome.network.nodes.emplace_back();
      node.id = reader.read<std::uint32_t>();
      node.place = reader.read<std::uint32_t>();
      node.function = static_cast<CppnFunction>(reader.read<std::uint8_t>());
    }
    reader.expect(edges, 12);
    for (std::size_t i = 0; i < edges; ++i) {
      CppnEdge& edge = genome.network.edges.emplace_back();
      edge.from = reader.read<std::uint32_t>();
      edge.to = reader.read<std::uint32_t>();
      edge.weight = reader.read<float>();
    }
    validate(genome);
    return genes;
  }

  void add_identity(IdentityHash& hash) const {
    const auto [body, values] = painted_body(genome);
    for (const int n : {body.nx, body.ny, body.nz}) hash.add(static_cast<std::uint32_t>(n));
    hash.add(body.edge);
    hash.add(body.cells);
    for (const FieldValue& value : values)
      for (const double number : {value.stiffness, value.cosine, value.sine, static_cast<double>(value.frequency)})
        hash.add(std::bit_cast<std::uint64_t>(number));
    hash.add(static_cast<std::uint8_t>(genome.frequencies));
    hash.add(genome.frequency);
    hash.add(genome.amplitude);
  }
};

}  // namespace

const GenesKind& cppn_genes() {
  static constexpr GenesKind kind = genes_kind<CppnGenes>();
  return kind;
}

}  // namespace mercury
