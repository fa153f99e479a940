// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>

#include "evolution/bytes.h"
#include "evolution/run_folder/checksum.h"
#include "evolution/run_folder/journal.h"
#include "evolution/run_folder/journal_header.h"
#include "mercury/error.h"

namespace mercury {

JournalReader::JournalReader(const std::filesystem::path& path) : path_(path), file_(path, O_RDONLY) {
  const std::string header = file_.read(0, journal_header_size);
  if (!header.starts_with(journal_mark)) fail("is not a journal of genomes");
  if (header.size() < journal_header_size) fail("is cut off in its header");
  ByteReader reader(std::string_view(header).substr(journal_mark.size()));
  const auto version = reader.read<std::uint32_t>();
  if (version > journal_version)
    fail("version " + std::to_string(version) + " is newer than this program, which reads up to version " +
         std::to_string(journal_version));
  reader.read<std::uint32_t>();
  fingerprint_ = reader.read<std::uint64_t>();
  const std::string_view checked = std::string_view(header).substr(0, journal_header_size - sizeof(std::uint64_t));
  if (reader.read<std::uint64_t>() != checksum_of(checked) || version == 0) fail("the header is damaged");
  end_ = journal_header_size;
}

void JournalReader::fail(const std::string& problem) const { throw InputError(path_.string(), problem); }

// The head of the record at the end of what was read; nothing if that record is not, or not yet, written to its end.
std::optional<RecordHead> JournalReader::whole_record(std::uint64_t size) const {
  const std::optional<RecordHead> head = decode_head(file_.read(end_, RecordHead::size));
  const auto damaged = [&] {
    fail("generation " + std::to_string(next_number_) + " is damaged (at byte " + std::to_string(end_) + ")");
  };
  if (!head) {
    if (has_sound_head_after(end_, size)) damaged();
    return std::nullopt;
  }
  const std::uint64_t room = size - end_ - RecordHead::size;
  if (head->index_size > room || head->genomes_size > room - head->index_size) return std::nullopt;
  const std::uint64_t index_at = end_ + RecordHead::size;
  const bool is_last = head->index_size + head->genomes_size == room;
  const auto matches = [&](std::uint64_t at, std::uint64_t count, std::uint64_t checksum) {
    return checksum_of(file_.read(at, count)) == checksum;
  };
  // The genomes of earlier records were on the disk before the next record was begun.
  if (matches(index_at, head->index_size, head->index_checksum) &&
      (!is_last || matches(index_at + head->index_size, head->genomes_size, head->genomes_checksum)))
    return head;
  if (!is_last) damaged();
  return std::nullopt;
}

bool JournalReader::has_sound_head_after(std::uint64_t offset, std::uint64_t size) const {
  constexpr std::size_t portion = 1 << 20;
  for (std::uint64_t at = offset + 1; at < size; at += portion) {
    const std::string bytes = file_.read(at, portion + RecordHead::size - 1);
    for (std::size_t i = bytes.find(head_mark); i < bytes.size(); i = bytes.find(head_mark, i + 1))
      if (decode_head(std::string_view(bytes).substr(i))) return true;
  }
  return false;
}

std::optional<GenerationRecord> JournalReader::next() {
  const std::uint64_t size = file_.size();
  if (size < end_) fail("is shorter than it was; something else wrote to it");
  if (size - end_ < RecordHead::size) return std::nullopt;
  const std::optional<RecordHead> head = whole_record(size);
  if (!head) return std::nullopt;
  const std::uint64_t genomes_at = end_ + RecordHead::size + head->index_size;
  try {
    GenerationRecord record =
        decode_index(file_.read(end_ + RecordHead::size, head->index_size), next_number_, next_id_, head->genomes_size);
    for (StoredGenome& genome : record.genomes) genome.offset += genomes_at;
    end_ = genomes_at + head->genomes_size;
    next_id_ += record.generation.born.size();
    ++next_number_;
    return record;
  } catch (const DamagedBytes& error) {
    fail("generation " + std::to_string(next_number_) + ": " + error.what());
  }
}

std::string JournalReader::bytes_of(const StoredGenome& genome, std::uint64_t id) const {
  std::string bytes = file_.read(genome.offset, genome.size);
  if (bytes.size() != genome.size || short_checksum_of(bytes) != genome.checksum)
    fail("the genome of individual " + std::to_string(id) + " is damaged");
  return bytes;
}

void JournalReader::check_not_replaced() const {
  struct stat here {
  }, there{};
  if (::fstat(file_.get(), &here) != 0 || ::stat(path_.c_str(), &there) != 0 || here.st_ino != there.st_ino ||
      here.st_dev != there.st_dev)
    fail("the run was replaced, moved or removed; open it again");
}

}  // namespace mercury
