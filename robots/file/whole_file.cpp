// SPDX-License-Identifier: Apache-2.0
#include "robots/file/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <utility>

#include "mercury/error.h"
#include "mercury/file_links.h"

namespace mercury {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  ~Descriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return descriptor_; }
  bool is_open() const { return descriptor_ >= 0; }
  int release() { return std::exchange(descriptor_, -1); }
  // Some file systems report a full disk only now. Returns 0, or the error.
  int close() {
    const int result = ::close(descriptor_);
    descriptor_ = -1;
    return result == 0 ? 0 : errno;
  }

 private:
  int descriptor_;
};

// Returns 0, or the error.
int write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return ::fsync(descriptor) == 0 || errno == EINVAL ? 0 : errno;
}

void write_into(const std::filesystem::path& path, std::string_view content) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
  if (!file.is_open()) fail(path, errno);
  int error = write_all(file.get(), content);
  if (const int at_close = file.close(); error == 0) error = at_close;
  if (error != 0) fail(path, error);
}

// A name in the folder of `path` that no other writer uses.
std::filesystem::path temporary_name(const std::filesystem::path& path, int attempt) {
  std::string name(".");
  name.append(path.filename().string()).append(".").append(std::to_string(::getpid()));
  return path.parent_path() / name.append("-").append(std::to_string(attempt)).append(".tmp");
}

// Opening a FIFO would block until someone writes.
int open_regular_file(const std::filesystem::path& path) {
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file.is_open()) fail(path, errno);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) fail(path, errno);
  if (S_ISDIR(status.st_mode)) fail(path, EISDIR);
  if (!S_ISREG(status.st_mode)) throw InputError(path.string(), "not a regular file");
  return file.release();
}

}  // namespace

void fail(const std::filesystem::path& path, int error) {
  if (is_fault_of_machine(error)) throw std::runtime_error(path.string() + ": " + reason_of(error));
  throw InputError(path.string(), reason_of(error));
}

std::string read_whole_file(const std::filesystem::path& path) {
  const Descriptor file(open_regular_file(path));
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) fail(path, errno);
  std::string content(static_cast<std::size_t>(status.st_size) + 1, '\0');
  std::size_t size = 0;
  while (true) {
    const ssize_t got = ::read(file.get(), content.data() + size, content.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(path, errno);
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
    if (size == content.size()) content.resize(2 * size);  // it grew while being read
  }
  content.resize(size);
  return content;
}

void write_whole_file(const std::filesystem::path& path, std::string_view content) {
  if (is_device_or_pipe(path)) return write_into(path, content);
  const std::filesystem::path target = follow_links(path);
  std::filesystem::path temporary;
  int descriptor = -1;
  for (int attempt = 0; descriptor < 0; ++attempt) {
    temporary = temporary_name(target, attempt);
    descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno != EEXIST) fail(path, errno);
  }
  Descriptor file(descriptor);
  int error = write_all(file.get(), content);
  if (const int at_close = file.close(); error == 0) error = at_close;
  if (error == 0) try {
      return publish(temporary, target);
    } catch (const std::filesystem::filesystem_error& failure) {
      error = failure.code().value();
    }
  ::unlink(temporary.c_str());
  fail(path, error);
}

}  // namespace mercury
