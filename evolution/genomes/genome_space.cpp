// SPDX-License-Identifier: Apache-2.0
// Which genome space a request is for.
#include <array>

#include "evolution/genomes/body_genome.h"
#include "evolution/genomes/given_body.h"
#include "mercury/configuration.h"
#include "mercury/error.h"
#include "mercury/origin.h"

namespace mercury {
namespace {

constexpr std::array<std::string_view, 3> genes_names{"body", "muscles", "both"};

template <class BodyGenes>
std::unique_ptr<GenomeSpace> make_space(const Generator& generator, const GenomeSpaceRequest& request) {
  return std::make_unique<BodySpace<BodyGenes>>(generator, request);
}

using MakeSpace = std::unique_ptr<GenomeSpace> (*)(const Generator&, const GenomeSpaceRequest&);

MakeSpace maker_of(std::string_view kind) {
  if (kind == "voxel") return make_space<VoxelGenes>;
  if (kind == "cppn") return make_space<CppnGenes>;
  if (kind == "nn") return make_space<NnGenes>;
  if (kind == "shell") return make_space<ShellGenes>;
  return nullptr;
}

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

}  // namespace

std::string_view name_of(Genes genes) { return genes_names[static_cast<std::size_t>(genes)]; }

Genes genes_named(std::string_view name) {
  for (std::size_t i = 0; i < genes_names.size(); ++i)
    if (genes_names[i] == name) return static_cast<Genes>(i);
  throw ParameterError("genes", "\"" + std::string(name) + "\" is not accepted; give body, muscles or both");
}

Changes changes_of(Genes genes, std::uint64_t seed) {
  const std::uint64_t choice = Random(seed_of(seed, 1)).below(3);
  return {.body = genes == Genes::body || (genes == Genes::both && choice != 0),
          .muscles = genes == Genes::muscles || (genes == Genes::both && choice != 1)};
}

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

std::unique_ptr<GenomeSpace> make_genome_space(const GenomeSpaceRequest& request) {
  if (!request.environment.empty()) environment_named(request.environment);  // or it throws
  if (!request.founders.empty() && request.genes == Genes::muscles) return make_given_body_space(request);
  const Generator& generator = generator_named(kind_for(request));
  const MakeSpace make = maker_of(generator.kind);
  if (!make) throw ParameterError("kind", generator.kind + " robots cannot be evolved");
  GenomeSpaceRequest whole = request;
  if (whole.environment.empty())
    whole.environment = request.founders.empty() ? generator.environment : environment_of(request.founders.front());
  return make(generator, whole);
}

}  // namespace mercury
