// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/generation_record.h"

#include <algorithm>
#include <cstring>

namespace mercury {
namespace {

// Equal bytes between two changes that are stored as changed: two numbers cost as much.
constexpr std::size_t shortest_copy = 3;

void put(std::string& bytes, std::size_t value) {
  for (; value >= 0x80; value >>= 7) bytes.push_back(static_cast<char>(value | 0x80));
  bytes.push_back(static_cast<char>(value));
}

std::size_t take_number(ByteReader& reader) {
  std::size_t value = 0;
  for (int shift = 0; shift < 63; shift += 7) {
    const auto byte = reader.read<std::uint8_t>();
    value |= static_cast<std::size_t>(byte & 0x7f) << shift;
    if (byte < 0x80) return value;
  }
  throw DamagedBytes("a number of a difference is too large");
}

}  // namespace

std::string difference_of(std::string_view base, std::string_view target) {
  const std::size_t common = std::min(base.size(), target.size());
  const auto differs = [&](std::size_t i) { return i >= common || base[i] != target[i]; };
  std::string difference;
  put(difference, target.size());
  std::size_t done = 0;
  for (std::size_t i = 0; i < target.size(); ++i) {
    if (i + 8 <= common && std::memcmp(base.data() + i, target.data() + i, 8) == 0) i += 7;
    if (!differs(i)) continue;
    std::size_t end = i + 1;
    for (std::size_t k = end; k < target.size() && k - end < shortest_copy; ++k)
      if (differs(k)) end = k + 1;
    put(difference, i - done);
    put(difference, end - i);
    difference.append(target.substr(i, end - i));
    done = end;
    i = end - 1;
  }
  return difference;
}

std::string with_difference(std::string_view base, std::string_view difference) {
  ByteReader reader(difference);
  const std::size_t size = take_number(reader);
  if (size > base.size() + difference.size()) throw DamagedBytes("a difference gives more bytes than it has");
  std::string target;
  target.reserve(size);
  const auto copy = [&](std::size_t count) {
    if (count > 0 && (target.size() > base.size() || count > base.size() - target.size()))
      throw DamagedBytes("a difference copies what its base does not have");
    target.append(base.substr(std::min(target.size(), base.size()), count));
  };
  while (!reader.is_at_end()) {
    copy(take_number(reader));
    target.append(reader.take(take_number(reader)));
  }
  if (target.size() > size) throw DamagedBytes("a difference gives more bytes than it says");
  copy(size - target.size());
  return target;
}

namespace {

constexpr std::size_t smallest_assessment = 25;  // bytes

}  // namespace

void encode(ByteWriter& writer, const Assessment& assessment, std::uint32_t version) {
  writer.add(static_cast<std::uint8_t>(assessment.fate));
  writer.text(assessment.problem);
  writer.numbers(assessment.scores);
  writer.numbers(assessment.values);
  writer.numbers(assessment.interim_scores);
  writer.add(assessment.hash);
  if (version < 2) return;
  writer.numbers(assessment.lower_quartiles);
  writer.numbers(assessment.upper_quartiles);
  writer.add(assessment.violation);
}

Assessment decode_assessment(ByteReader& reader, std::uint32_t version) {
  Assessment assessment;
  const auto fate = reader.read<std::uint8_t>();
  if (fate > static_cast<std::uint8_t>(last_fate)) throw DamagedBytes("an individual has an unknown fate");
  assessment.fate = static_cast<Fate>(fate);
  assessment.problem = reader.text();
  assessment.scores = reader.numbers<double>();
  assessment.values = reader.numbers<double>();
  assessment.interim_scores = reader.numbers<double>();
  assessment.hash = reader.read<std::uint64_t>();
  if (version < 2) return assessment;
  assessment.lower_quartiles = reader.numbers<double>();
  assessment.upper_quartiles = reader.numbers<double>();
  assessment.violation = reader.read<double>();
  return assessment;
}

void encode(ByteWriter& writer, const std::vector<Assessment>& assessments) {
  writer.count(assessments.size());
  for (const Assessment& assessment : assessments) encode(writer, assessment);
}

std::vector<Assessment> decode_assessments(ByteReader& reader, std::uint32_t version) {
  std::vector<Assessment> assessments(reader.count(smallest_assessment));
  for (Assessment& assessment : assessments) assessment = decode_assessment(reader, version);
  return assessments;
}

const std::string_view head_mark = "GENERATN";

namespace {

enum class Form : std::uint8_t { whole, difference };

void encode(ByteWriter& writer, const Individual& individual, const StoredGenome& genome, std::uint32_t version) {
  writer.numbers(individual.parents);
  writer.add(static_cast<std::uint32_t>(individual.line_began));
  writer.add(individual.seed);
  if (version >= 3) {
    writer.add(individual.island);
    writer.add(static_cast<std::uint8_t>(individual.is_migrant));
  }
  encode(writer, individual.assessment, version);
  writer.add(static_cast<std::uint8_t>(genome.base == StoredGenome::none ? Form::whole : Form::difference));
  writer.add(genome.size);
  writer.add(genome.checksum);
}

Individual decode_individual(ByteReader& reader, int generation, std::uint64_t first_id, std::uint32_t version) {
  Individual individual;
  individual.generation = generation;
  individual.parents = reader.numbers<std::uint64_t>();
  for (const std::uint64_t parent : individual.parents)
    if (parent >= first_id) throw DamagedBytes("a parent was not born before its child");
  const auto line_began = reader.read<std::uint32_t>();
  if (line_began > static_cast<std::uint32_t>(generation)) throw DamagedBytes("a line begins after its individual");
  individual.line_began = static_cast<int>(line_began);
  individual.seed = reader.read<std::uint64_t>();
  if (version >= 3) {
    individual.island = reader.read<std::uint16_t>();
    const auto migrant = reader.read<std::uint8_t>();
    if (migrant > 1) throw DamagedBytes("an individual is neither a migrant nor none");
    individual.is_migrant = migrant == 1;
    if (individual.is_migrant && individual.parents.size() != 1) throw DamagedBytes("a migrant has not one parent");
  }
  individual.assessment = decode_assessment(reader, version);
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

std::string encode_index(const GenerationRecord& record, std::uint32_t version) {
  ByteWriter writer;
  const Generation& generation = record.generation;
  writer.add(static_cast<std::uint32_t>(generation.number));
  writer.add(record.first_id);
  writer.add(record.times.seconds);
  writer.text(record.times.device);
  writer.count(generation.born.size());
  for (std::size_t i = 0; i < generation.born.size(); ++i)
    encode(writer, generation.born[i], record.genomes[i], version);
  writer.numbers(generation.living);
  return writer.bytes();
}

GenerationRecord decode_index(std::string_view index, int number, std::uint64_t first_id, std::uint64_t genomes_size,
                              std::uint32_t version) {
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
    Individual& individual = record.generation.born.emplace_back(decode_individual(reader, number, first_id, version));
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
