// SPDX-License-Identifier: Apache-2.0
// What differs between two strings of bytes that are alike at the same places.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mercury/evolution.h"
#include "mercury/individual.h"
#include "mercury/run_folder.h"
#include "robots/bytes.h"

namespace mercury {

// Turns `base` into `target`: pairs of (how many bytes to copy from the base, new bytes that replace as many of it);
// then the rest of the base follows, up to the target's length. Numbers are LEB128.
std::string difference_of(std::string_view base, std::string_view target);

// The target. Throws DamagedBytes for bytes that are no difference from this base.
std::string with_difference(std::string_view base, std::string_view difference);

// Assessments as bytes: in the journal, in the files of shards, and between ranks. Version 1 has no quartiles and no
// violation. Of individuals, versions 1 and 2 have no islands: all are on island 0.
inline constexpr std::uint32_t record_version = 3;
void encode(ByteWriter& writer, const Assessment& assessment, std::uint32_t version = record_version);
// Throws DamagedBytes.
Assessment decode_assessment(ByteReader& reader, std::uint32_t version = record_version);

void encode(ByteWriter& writer, const std::vector<Assessment>& assessments);
std::vector<Assessment> decode_assessments(ByteReader& reader, std::uint32_t version = record_version);

// A generation as a record of the journal.
//
// A record is a head, an index and the genomes:
//
//     head     "GENERATN"; u64 bytes of the index; u64 bytes of the genomes; u64 checksum of the index;
//              u64 checksum of the genomes; u64 checksum of the head so far
//     index    number; times; everyone born, in the order of ids; ids of the living
//     genomes  one after another, in the order of ids: whole, or as the difference from the first parent's
//
// So a reader that does not need the genomes skips them.

// Genomes are read by applying at most as many differences one after another.
inline constexpr int longest_chain = 32;

// Where a genome is in the journal.
struct StoredGenome {
  static constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t offset = 0;    // in the file; in a new record, from the beginning of its genomes
  std::uint64_t base = none;   // id of the individual from whose genome this one is the difference
  std::uint32_t size = 0;      // bytes
  std::uint32_t checksum = 0;  // of these bytes
};

struct GenerationRecord {
  std::uint64_t first_id = 0;  // of those born; the others follow
  Generation generation;       // without genomes
  GenerationTimes times;
  std::vector<StoredGenome> genomes;  // of those born
};

struct RecordHead {
  static constexpr std::size_t size = 48;  // bytes
  std::uint64_t index_size = 0, genomes_size = 0, index_checksum = 0, genomes_checksum = 0;
};

std::string encode_head(const RecordHead& head);
// Nothing if the bytes are no head.
std::optional<RecordHead> decode_head(std::string_view bytes);
// What a head begins with.
extern const std::string_view head_mark;

std::string encode_index(const GenerationRecord& record, std::uint32_t version = record_version);
// Throws DamagedBytes unless it is generation `number`, whose first child has the id `first_id`, and its genomes have
// `genomes_size` bytes. Their offsets count from the beginning of the genomes.
GenerationRecord decode_index(std::string_view index, int number, std::uint64_t first_id, std::uint64_t genomes_size,
                              std::uint32_t version = record_version);

}  // namespace mercury
