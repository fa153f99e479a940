// SPDX-License-Identifier: Apache-2.0
#include "robots/genes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "mercury/error.h"
#include "mercury/muscle_laws.h"

namespace mercury {
namespace {

constexpr std::array<std::pair<Genes, std::string_view>, 4> genes_words{
    {{Genes::body, "body"}, {Genes::muscles, "muscles"}, {Genes::brain, "brain"}, {Genes::both, "both"}}};

MaterialGenes filled_in(const MaterialGenes& genes) { return genes.empty() ? base_materials_of(Robot{}) : genes; }

}  // namespace

MaterialGenes material_genes_of(const Robot& robot) {
  return robot.materials.empty() ? MaterialGenes{} : base_materials_of(robot);
}

std::vector<Material> table_of(const MaterialGenes& genes) {
  std::vector<Material> table;
  if (genes.size() == base_material_count) {
    table = material_table(std::span(genes).first<base_material_count>());
    if (std::ranges::equal(table, default_materials())) table.clear();
  } else if (!genes.empty()) {
    table.push_back({});
    table.insert(table.end(), genes.begin(), genes.end());
  }
  return table;
}

MaterialGenes mutated(const MaterialGenes& genes, const GeneMutation& mutation, std::uint64_t seed,
                      const std::vector<bool>& in_use) {
  return mutate_muscle_laws(filled_in(genes), mutation.muscles, seed, in_use, mutation.tail);
}

std::size_t muscle_numbers_of(const MaterialGenes& genes, const std::vector<bool>& in_use) {
  const MaterialGenes all = filled_in(genes);
  std::size_t muscles = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    muscles += all[i].amplitude != 0 && (in_use.empty() || (i < in_use.size() && in_use[i]));
  return 3 * muscles;
}

MaterialGenes crossed(const MaterialGenes& a, const MaterialGenes& b, std::uint64_t seed) {
  if (a == b) return a;
  const MaterialGenes of_a = filled_in(a), of_b = filled_in(b);
  return of_a.size() == of_b.size() ? cross_muscle_laws(of_a, of_b, seed) : a;
}

// Announces a relaxation time. No stiffness is infinite, so older programs refuse it.
constexpr float relaxation_mark = std::numeric_limits<float>::infinity();

// A stiffness has no sign, so its sign says that the material moves by half waves. A relaxation time stands before it,
// after its mark. Genomes without such materials have the bytes that they had before there were any.
void write(ByteWriter& writer, const MaterialGenes& genes) {
  writer.add(static_cast<std::uint8_t>(genes.size()));
  for (const Material& gene : genes) {
    if (gene.relaxation_time != 0) writer.add(relaxation_mark), writer.add(gene.relaxation_time);
    const float stiffness = std::copysign(gene.stiffness, gene.half_wave ? -1.f : 1.f);
    for (const float number : {stiffness, gene.amplitude, gene.frequency, gene.phase}) writer.add(number);
  }
}

MaterialGenes read_material_genes(ByteReader& reader) {
  const auto count = reader.read<std::uint8_t>();
  reader.expect(count, 4 * sizeof(float));
  MaterialGenes genes(count);
  for (std::size_t i = 0; i < genes.size(); ++i) {
    genes[i].stiffness = reader.read<float>();
    if (genes[i].stiffness == relaxation_mark) {
      genes[i].relaxation_time = reader.read<float>();
      genes[i].stiffness = reader.read<float>();
    }
    for (float* number : {&genes[i].amplitude, &genes[i].frequency, &genes[i].phase}) *number = reader.read<float>();
    genes[i].half_wave = std::signbit(genes[i].stiffness);
    genes[i].stiffness = std::abs(genes[i].stiffness);
    validate(genes[i], "genome: base material " + std::to_string(i + 1));
  }
  return genes;
}

void require_known_count(const MaterialGenes& genes) {
  const std::size_t count = genes.size();
  if (count != 0 && count != base_material_count && count + 1 < default_material_count)
    throw InputError("genome", std::to_string(count) + " materials are not accepted; give 22, or 253 or more");
}

void add_identity(IdentityHash& hash, const MaterialGenes& genes, const std::vector<bool>& in_use) {
  const MaterialGenes all = filled_in(genes);
  const bool only_used = all.size() == base_material_count && !in_use.empty();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (only_used && !in_use[i]) continue;
    for (const float number : {all[i].stiffness, all[i].amplitude, all[i].frequency, all[i].phase}) hash.add(number);
    if (all[i].half_wave) hash.add(std::uint8_t{1});
    if (all[i].relaxation_time != 0) hash.add(std::uint8_t{2}), hash.add(all[i].relaxation_time);
  }
}

std::vector<Genes> all_gene_sets() {
  return {Genes::body,
          Genes::muscles,
          Genes::both,
          Genes::brain,
          Genes::body | Genes::brain,
          Genes::muscles | Genes::brain,
          Genes::both | Genes::brain};
}

std::string name_of(Genes genes) {
  if (genes == Genes::both) return "both";
  std::string name;
  for (const auto& [gene, word] : genes_words)
    if (gene != Genes::both && contains(genes, gene)) name.append(name.empty() ? "" : ",").append(word);
  return name;
}

Genes genes_named(std::string_view name) {
  std::optional<Genes> genes;
  for (std::string_view rest = name;;) {
    const std::string_view word = rest.substr(0, rest.find(','));
    const auto found = std::ranges::find(genes_words, word, &std::pair<Genes, std::string_view>::second);
    if (found == genes_words.end())
      throw ParameterError("genes", std::string("\"").append(name.substr(0, 80)) +
                                        "\" is not accepted; give body, muscles, both, brain, or several of them with "
                                        "commas between them");
    genes = genes ? *genes | found->first : found->first;
    if (word.size() == rest.size()) return *genes;
    rest.remove_prefix(word.size() + 1);
  }
}

Changes changes_of(Genes genes, std::uint64_t seed) {
  const std::uint64_t choice = Random(seed_of(seed, 1)).below(3);
  return {.body = genes == Genes::body || (genes == Genes::both && choice != 0),
          .muscles = genes == Genes::muscles || (genes == Genes::both && choice != 1)};
}

}  // namespace mercury
