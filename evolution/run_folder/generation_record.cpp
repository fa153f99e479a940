// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/generation_record.h"

#include "evolution/bytes.h"
#include "evolution/run_folder/assessment_bytes.h"
#include "evolution/run_folder/checksum.h"

namespace mercury {

const std::string_view head_mark = "GENERATN";

namespace {

enum class Form : std::uint8_t { whole, difference };

void encode(ByteWriter& writer, const Individual& individual, const StoredGenome& genome) {
  writer.numbers(individual.parents);
  writer.add(static_cast<std::uint32_t>(individual.line_began));
  writer.add(individual.seed);
  encode(writer, individual.assessment);
  writer.add(static_cast<std::uint8_t>(genome.base == StoredGenome::none ? Form::whole : Form::difference));
  writer.add(genome.size);
  writer.add(genome.checksum);
}

Individual decode_individual(ByteReader& reader, int generation, std::uint64_t first_id) {
  Individual individual;
  individual.generation = generation;
  individual.parents = reader.numbers<std::uint64_t>();
  for (const std::uint64_t parent : individual.parents)
    if (parent >= first_id) throw DamagedBytes("a parent was not born before its child");
  const auto line_began = reader.read<std::uint32_t>();
  if (line_began > static_cast<std::uint32_t>(generation)) throw DamagedBytes("a line begins after its individual");
  individual.line_began = static_cast<int>(line_began);
  individual.seed = reader.read<std::uint64_t>();
  individual.assessment = decode_assessment(reader);
  return individual;
}

StoredGenome decode_genome(ByteReader& reader, const Individual& individual) {
  StoredGenome genome;
  const auto form = reader.read<std::uint8_t>();
  if (form > static_cast<std::uint8_t>(Form::difference)) throw DamagedBytes("a genome has an unknown form");
  if (form == static_cast<std::uint8_t>(Form::difference)) {
    if (individual.parents.empty()) throw DamagedBytes("a genome without parents differs from one");
    genome.base = individual.parents.front();
  }
  genome.size = reader.read<std::uint32_t>();
  genome.checksum = reader.read<std::uint32_t>();
  return genome;
}

}  // namespace

std::string encode_head(const RecordHead& head) {
  ByteWriter writer;
  writer.append(head_mark);
  writer.add(head.index_size);
  writer.add(head.genomes_size);
  writer.add(head.index_checksum);
  writer.add(head.genomes_checksum);
  writer.add(checksum_of(writer.bytes()));
  return writer.bytes();
}

std::optional<RecordHead> decode_head(std::string_view bytes) {
  if (bytes.size() < RecordHead::size || !bytes.starts_with(head_mark)) return std::nullopt;
  ByteReader reader(bytes.substr(head_mark.size()));
  RecordHead head;
  head.index_size = reader.read<std::uint64_t>();
  head.genomes_size = reader.read<std::uint64_t>();
  head.index_checksum = reader.read<std::uint64_t>();
  head.genomes_checksum = reader.read<std::uint64_t>();
  const std::string_view checked = bytes.substr(0, RecordHead::size - sizeof(std::uint64_t));
  if (reader.read<std::uint64_t>() != checksum_of(checked)) return std::nullopt;
  return head;
}

std::string encode_index(const GenerationRecord& record) {
  ByteWriter writer;
  const Generation& generation = record.generation;
  writer.add(static_cast<std::uint32_t>(generation.number));
  writer.add(record.first_id);
  writer.add(record.times.seconds);
  writer.text(record.times.device);
  writer.count(generation.born.size());
  for (std::size_t i = 0; i < generation.born.size(); ++i) encode(writer, generation.born[i], record.genomes[i]);
  writer.numbers(generation.living);
  return writer.bytes();
}

GenerationRecord decode_index(std::string_view index, int number, std::uint64_t first_id, std::uint64_t genomes_size) {
  constexpr std::size_t smallest_individual = 50;  // bytes
  ByteReader reader(index);
  GenerationRecord record;
  if (reader.read<std::uint32_t>() != static_cast<std::uint32_t>(number))
    throw DamagedBytes("the record is of another generation");
  record.generation.number = number;
  record.first_id = first_id;
  if (reader.read<std::uint64_t>() != first_id) throw DamagedBytes("the ids do not go on where they ended");
  record.times.seconds = reader.read<double>();
  record.times.device = reader.text();
  const std::size_t born = reader.count(smallest_individual);
  record.generation.born.reserve(born);
  record.genomes.reserve(born);
  std::uint64_t offset = 0;
  for (std::size_t i = 0; i < born; ++i) {
    Individual& individual = record.generation.born.emplace_back(decode_individual(reader, number, first_id));
    individual.id = first_id + i;
    StoredGenome& genome = record.genomes.emplace_back(decode_genome(reader, individual));
    genome.offset = offset;
    offset += genome.size;
  }
  if (offset != genomes_size) throw DamagedBytes("the genomes have another length");
  record.generation.living = reader.numbers<std::uint64_t>();
  for (const std::uint64_t id : record.generation.living)
    if (id >= first_id + born) throw DamagedBytes("someone lives who was not born");
  reader.end();
  return record;
}

}  // namespace mercury
