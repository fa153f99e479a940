// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "evolution/run_folder/generation_record.h"
#include "mercury/run_folder.h"

namespace mercury {

// An open file, closed when this ends.
class FileDescriptor {
 public:
  FileDescriptor() = default;
  // Opens a file as open(2). Throws InputError with the path and the system's reason, and for what is not a regular
  // file.
  FileDescriptor(const std::filesystem::path& path, int flags);
  ~FileDescriptor();
  FileDescriptor(FileDescriptor&& other) noexcept;
  FileDescriptor& operator=(FileDescriptor&& other) noexcept;

  int get() const { return descriptor_; }
  std::uint64_t size() const;
  // Up to `size` bytes from `offset`; fewer at the file's end. Throws InputError if the system cannot read them.
  std::string read(std::uint64_t offset, std::size_t size) const;
  // Throws the path and the system's reason (robots/file/whole_file.h).
  [[noreturn]] void fail(int error) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

// Makes names in a folder durable: files that were made, renamed or removed in it.
void sync_folder(const std::filesystem::path& folder);

// The header of a journal: "mercury-genomes\n"; u32 version; u32 0; u64 fingerprint of the run's settings; u64 checksum
// of all that.
inline constexpr std::string_view journal_mark = "mercury-genomes\n";
inline constexpr std::size_t journal_header_size = 40;  // bytes

// The journal of a run, the file `genomes`: a header, then one record per generation (generation_record.h).
//
// A record is appended by one write and is on the disk before the next one is begun, so only the last record can be cut
// off (by kill -9, a power cut, a full disk). Readers ignore such a record, and the writer that goes on removes it. A
// damaged record with a sound one after it was not cut off: that is an error, and nothing is removed.
//
// The writer holds a lock (flock) on the file; readers need none, because what they have read does not change.
inline constexpr std::string_view journal_name = "genomes";       // in a run folder
inline constexpr std::uint32_t journal_version = record_version;  // a journal keeps the version it began with

class JournalReader {
 public:
  // Throws InputError for a file that cannot be read, is no journal, or is of a newer version.
  explicit JournalReader(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  std::uint32_t version() const { return version_; }
  std::uint64_t fingerprint() const { return fingerprint_; }  // of the run's settings, as given to create()
  // The next generation that is written to its end, with offsets of genomes in the file. Nothing if there is none
  // (yet). Throws InputError if the journal is damaged.
  // The genomes of the last record may be cut off after a crash; those that this process has just written are not.
  enum class Check { all, index };
  std::optional<GenerationRecord> next(Check check = Check::all);
  // Where the records that were read end.
  std::uint64_t end() const { return end_; }
  // Bytes of a genome, checked. Throws InputError.
  std::string bytes_of(const StoredGenome& genome, std::uint64_t id) const;
  // Throws InputError if the path has another file now.
  void check_not_replaced() const;

 private:
  [[noreturn]] void fail(const std::string& problem) const;
  std::optional<RecordHead> whole_record(std::uint64_t size, Check check) const;
  bool has_sound_head_after(std::uint64_t offset, std::uint64_t size) const;

  std::filesystem::path path_;
  FileDescriptor file_;
  std::uint32_t version_ = 0;
  std::uint64_t fingerprint_ = 0, end_ = 0, next_id_ = 0;
  int next_number_ = 0;
};

class JournalWriter {
 public:
  // Makes the file and locks it. Throws InputError if there is one.
  static JournalWriter create(const std::filesystem::path& path, std::uint64_t fingerprint);
  // Locks the file. Throws InputError if another process has it locked.
  static JournalWriter open(const std::filesystem::path& path);

  // Removes what is after `end`: a record that was cut off.
  void cut(std::uint64_t end);
  // The record is on the disk when this returns. If it cannot be written, throws InputError, and the file is as it was.
  // Offsets in record.genomes do not matter. `version` = of the journal.
  void append(const GenerationRecord& record, std::string_view genomes, std::uint32_t version = journal_version);

 private:
  JournalWriter(const std::filesystem::path& path, int flags);
  int write(std::string_view bytes, std::uint64_t offset) const;

  FileDescriptor file_;
};

// Throws InputError unless make_run_folder() may use the folder: it is new or empty, or, with `force`, holds a run.
// Makes nothing.
void require_new_folder(const std::filesystem::path& folder, bool force);

// Makes the folder with run.toml, founders/ and an empty journal, which it returns locked. Throws InputError if the
// folder exists and is not empty; with `force`, the files of a run in it are removed first, unless another process
// writes there. Everything that can be refused is refused before that.
JournalWriter make_run_folder(const std::filesystem::path& folder, const RunSettings& settings, bool force);

}  // namespace mercury
