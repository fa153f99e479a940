// SPDX-License-Identifier: Apache-2.0
#include "app/export/output_stream.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "robots/file/whole_file.h"

namespace mercury {

OutputStream::OutputStream(const std::filesystem::path& target)
    : target_(target), unfinished_(target),
      descriptor_(::open(unfinished_.path().c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) fail(target, errno);
}

OutputStream::~OutputStream() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputStream::flush() {
  const char* next = buffer_.data();
  std::size_t left = buffer_.size();
  while (left > 0) {
    const ssize_t written = ::write(descriptor_, next, left);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(target_, errno);
    next += written;
    left -= static_cast<std::size_t>(written);
  }
  written_ += buffer_.size();
  buffer_.clear();
}

void OutputStream::close() {
  flush();
  if (::fsync(descriptor_) != 0 && errno != EINVAL) fail(target_, errno);
  // Some file systems report a full disk only now.
  if (::close(std::exchange(descriptor_, -1)) != 0) fail(target_, errno);
}

void OutputStream::keep() {
  try {
    unfinished_.keep();
  } catch (const std::filesystem::filesystem_error& error) {
    fail(target_, error.code().value());
  }
}

void OutputStreams::keep() {
  for (OutputStream& file : files_) file.close();
  for (OutputStream& file : files_) file.keep();
}

}  // namespace mercury
