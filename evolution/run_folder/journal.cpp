// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <utility>

#include "mercury/error.h"
#include "robots/bytes.h"
#include "robots/file/whole_file.h"

namespace mercury {

FileDescriptor::FileDescriptor(const std::filesystem::path& path, int flags)
    : path_(path), descriptor_(::open(path.c_str(), flags | O_CLOEXEC | O_NONBLOCK, 0666)) {
  if (descriptor_ < 0) fail(errno);
  struct stat status {};
  const int error = ::fstat(descriptor_, &status) != 0 ? errno : 0;
  if (error == 0 && S_ISREG(status.st_mode)) return;
  ::close(std::exchange(descriptor_, -1));
  if (error != 0) fail(error);
  throw InputError(path.string(), "not a regular file");
}

FileDescriptor::~FileDescriptor() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

FileDescriptor::FileDescriptor(FileDescriptor&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

std::uint64_t FileDescriptor::size() const {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) fail(errno);
  return static_cast<std::uint64_t>(status.st_size);
}

std::string FileDescriptor::read(std::uint64_t offset, std::size_t size) const {
  const std::uint64_t all = this->size();
  std::string bytes(offset < all ? std::min<std::uint64_t>(size, all - offset) : 0, '\0');
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got =
        ::pread(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(errno);
    if (got == 0) break;  // it became shorter
    done += static_cast<std::size_t>(got);
  }
  bytes.resize(done);
  return bytes;
}

void FileDescriptor::fail(int error) const { mercury::fail(path_, error); }

void sync_folder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) fail(folder, errno);
  const int error = ::fsync(descriptor) == 0 || errno == EINVAL ? 0 : errno;
  ::close(descriptor);
  if (error != 0) fail(folder, error);
}

JournalReader::JournalReader(const std::filesystem::path& path) : path_(path), file_(path, O_RDONLY) {
  const std::string header = file_.read(0, journal_header_size);
  if (!header.starts_with(journal_mark)) fail("is not a journal of genomes");
  if (header.size() < journal_header_size) fail("is cut off in its header");
  ByteReader reader(std::string_view(header).substr(journal_mark.size()));
  version_ = reader.read<std::uint32_t>();
  if (version_ > journal_version)
    fail("version " + std::to_string(version_) + " is newer than this program, which reads up to version " +
         std::to_string(journal_version));
  reader.read<std::uint32_t>();
  fingerprint_ = reader.read<std::uint64_t>();
  const std::string_view checked = std::string_view(header).substr(0, journal_header_size - sizeof(std::uint64_t));
  if (reader.read<std::uint64_t>() != checksum_of(checked) || version_ == 0) fail("the header is damaged");
  end_ = journal_header_size;
}

void JournalReader::fail(const std::string& problem) const { throw InputError(path_.string(), problem); }

// The head of the record at the end of what was read; nothing if that record is not, or not yet, written to its end.
std::optional<RecordHead> JournalReader::whole_record(std::uint64_t size, Check check) const {
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
      (!is_last || check == Check::index ||
       matches(index_at + head->index_size, head->genomes_size, head->genomes_checksum)))
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

std::optional<GenerationRecord> JournalReader::next(Check check) {
  const std::uint64_t size = file_.size();
  if (size < end_) fail("is shorter than it was; something else wrote to it");
  if (size - end_ < RecordHead::size) return std::nullopt;
  const std::optional<RecordHead> head = whole_record(size, check);
  if (!head) return std::nullopt;
  const std::uint64_t genomes_at = end_ + RecordHead::size + head->index_size;
  try {
    GenerationRecord record = decode_index(file_.read(end_ + RecordHead::size, head->index_size), next_number_,
                                           next_id_, head->genomes_size, version_);
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

void JournalWriter::append(const GenerationRecord& record, std::string_view genomes, std::uint32_t version) {
  const std::string index = encode_index(record, version);
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
