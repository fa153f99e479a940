// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <span>

#include "mercury/error.h"
#include "mercury/nn_robot.h"
#include "mercury/random.h"
#include "robots/genes.h"

namespace mercury {

NnOptions nn_options_in(const ParameterValues& values);

namespace {

struct NnGenes {
  static constexpr std::uint8_t tag = 3;
  NnGenome genome;
  MaterialGenes materials;

  static NnGenes of(const Robot& robot) {
    std::optional<NnGenome> genome = nn_genome_of(robot);
    if (!genome) throw InputError("/origin", "holds no network");
    genome->environment.clear();
    if (genome->network.has_fields()) return {*std::move(genome), {}};
    if (!robot.materials.empty() && robot.materials.size() < default_material_count)
      throw InputError("/materials", "the base materials and their pairs are needed, 254 in all, not " +
                                         std::to_string(robot.materials.size()));
    return {*std::move(genome), material_genes_of(robot)};
  }

  static NnGenes random(const ParameterValues& values, std::uint64_t seed, std::uint64_t index) {
    NnGenome genome = random_nn_genome(nn_options_in(values), seed, index);
    grow_without_genome(genome);  // throws if its cloud is degenerate
    return {std::move(genome), {}};
  }

  NnGenes mutated(Genes genes, const GeneMutation& mutation, std::uint64_t seed) const {
    const Changes changes = changes_of(genes, seed);
    constexpr double rate = 0.1, size = 0.3;
    NnGenes child{changes.body ? mutate(genome, rate, size * mutation.strength, seed) : genome, materials};
    if (changes.muscles && genome.network.has_fields())
      child.genome = mutate_muscles(child.genome, mutation.muscles, seed_of(seed, 0), mutation.tail);
    else if (changes.muscles)
      child.materials = mercury::mutated(materials, mutation, seed_of(seed, 0), {});
    return child;
  }

  std::size_t muscle_numbers() const { return genome.network.has_fields() ? 2 : muscle_numbers_of(materials, {}); }

  NnGenes crossed(const NnGenes& other, Genes genes, std::uint64_t seed) const {
    NnGenes child{genes != Genes::muscles ? crossover(genome, other.genome, seed) : genome, materials};
    if (genes != Genes::body && genome.network.has_fields())
      child.genome = cross_muscles(child.genome, other.genome, seed_of(seed, 0));
    else if (genes != Genes::body)
      child.materials = mercury::crossed(materials, other.materials, seed_of(seed, 0));
    return child;
  }

  Robot grown(const std::string& name, const std::string& environment) const {
    NnGenome whole = genome;
    whole.environment = environment;
    Robot robot = grow(whole, name);
    if (!genome.network.has_fields()) robot.materials = table_of(materials);
    return robot;
  }

  Robot grown_for_trial(const std::string& name) const {
    Robot robot = grow_without_genome(genome, name);
    if (!genome.network.has_fields()) robot.materials = table_of(materials);
    return robot;
  }

  void write(ByteWriter& writer) const {
    writer.add(genome.cloud_seed);
    writer.add(static_cast<std::uint32_t>(genome.points));
    writer.add(static_cast<std::uint8_t>(genome.mirrored ? 1 : 0));
    writer.add(genome.alpha);
    writer.add(genome.spacing);
    writer.add(static_cast<std::uint8_t>(genome.network.layers.size()));
    for (const Layer& layer : genome.network.layers) {
      writer.add(static_cast<std::uint16_t>(layer.inputs));
      writer.add(static_cast<std::uint16_t>(layer.outputs));
      writer.add(std::span(layer.weights));
      writer.add(std::span(layer.biases));
    }
    if (!genome.network.has_fields()) return mercury::write(writer, materials);
    writer.add(static_cast<std::uint8_t>(genome.frequencies));
    writer.add(genome.frequency);
    writer.add(genome.amplitude);
  }

  static NnGenes read(ByteReader& reader) {
    NnGenes genes;
    NnGenome& genome = genes.genome;
    genome.cloud_seed = reader.read<std::uint64_t>();
    genome.points = reader.read<std::uint32_t>();
    const auto mirrored = reader.read<std::uint8_t>();
    if (mirrored > 1) throw InputError("genome", "mirrored must be 0 or 1");
    genome.mirrored = mirrored == 1;
    genome.alpha = reader.read<float>();
    genome.spacing = reader.read<float>();
    const auto layers = reader.read<std::uint8_t>();
    for (std::size_t i = 0; i < layers; ++i) {
      Layer& layer = genome.network.layers.emplace_back();
      layer.inputs = reader.read<std::uint16_t>();
      layer.outputs = reader.read<std::uint16_t>();
      const auto outputs = static_cast<std::uint64_t>(layer.outputs);
      const std::uint64_t weights = outputs * static_cast<std::uint64_t>(layer.inputs);
      reader.expect(weights + outputs, sizeof(float));
      layer.weights.resize(weights);
      layer.biases.resize(outputs);
      for (float& weight : layer.weights) weight = reader.read<float>();
      for (float& bias : layer.biases) bias = reader.read<float>();
    }
    if (genome.network.has_fields()) {
      genome.frequencies = reader.read<std::uint8_t>();
      genome.frequency = reader.read<float>();
      genome.amplitude = reader.read<float>();
    }
    validate(genome);
    if (genome.network.has_fields()) return genes;
    genes.materials = read_material_genes(reader);
    require_known_count(genes.materials);
    return genes;
  }

  // Which weights matter is known only to the one who grows the robot.
  void add_identity(IdentityHash& hash) const {
    const auto add_all = [&](const std::vector<float>& numbers) {
      for (const float number : numbers) hash.step(std::bit_cast<std::uint32_t>(number));
    };
    hash.add(genome.cloud_seed);
    hash.add(static_cast<std::uint64_t>(genome.points));
    hash.step(genome.mirrored ? 1 : 0);
    hash.add(genome.alpha);
    hash.add(genome.spacing);
    for (const Layer& layer : genome.network.layers) {
      hash.step(static_cast<std::uint64_t>(layer.inputs));
      hash.step(static_cast<std::uint64_t>(layer.outputs));
      add_all(layer.weights);
      add_all(layer.biases);
    }
    if (!genome.network.has_fields()) return mercury::add_identity(hash, materials, {});
    hash.step(static_cast<std::uint64_t>(genome.frequencies));
    hash.add(genome.frequency);
    hash.add(genome.amplitude);
  }
};

}  // namespace

const GenesKind& nn_genes() {
  static constexpr GenesKind kind = genes_kind<NnGenes>();
  return kind;
}

}  // namespace mercury
