// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "evolution/bytes.h"
#include "evolution/run_folder/checksum.h"
#include "evolution/run_folder/journal.h"
#include "evolution/run_folder/journal_header.h"
#include "mercury/error.h"

namespace mercury {

JournalWriter::JournalWriter(const std::filesystem::path& path, int flags) : file_(path, O_RDWR | flags) {
  if (::flock(file_.get(), LOCK_EX | LOCK_NB) == 0) return;
  if (errno == EWOULDBLOCK)
    throw InputError(path.parent_path().string(), "another process is evolving in this folder; give another one");
  file_.fail(errno);
}

JournalWriter JournalWriter::create(const std::filesystem::path& path, std::uint64_t fingerprint) {
  JournalWriter writer(path, O_CREAT | O_EXCL);
  ByteWriter header;
  header.append(journal_mark);
  header.add(journal_version);
  header.add(std::uint32_t{0});
  header.add(fingerprint);
  header.add(checksum_of(header.bytes()));
  if (const int error = writer.write(header.bytes(), 0); error != 0) {
    ::unlink(path.c_str());
    writer.file_.fail(error);
  }
  return writer;
}

JournalWriter JournalWriter::open(const std::filesystem::path& path) { return JournalWriter(path, 0); }

// Returns 0, or the error.
int JournalWriter::write(std::string_view bytes, std::uint64_t offset) const {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
  return ::fsync(file_.get()) == 0 ? 0 : errno;
}

void JournalWriter::cut(std::uint64_t end) {
  if (file_.size() <= end) return;
  if (::ftruncate(file_.get(), static_cast<off_t>(end)) != 0 || ::fsync(file_.get()) != 0) file_.fail(errno);
}

void JournalWriter::append(const GenerationRecord& record, std::string_view genomes) {
  const std::string index = encode_index(record);
  std::string bytes = encode_head({.index_size = index.size(),
                                   .genomes_size = genomes.size(),
                                   .index_checksum = checksum_of(index),
                                   .genomes_checksum = checksum_of(genomes)});
  bytes.append(index).append(genomes);
  const std::uint64_t end = file_.size();
  const int error = write(bytes, end);
  if (error == 0) return;
  cut(end);
  file_.fail(error);
}

}  // namespace mercury
