// SPDX-License-Identifier: Apache-2.0
#include "app/export/output_stream.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "mercury/file_links.h"
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
  if (descriptor_ < 0) return;
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

void OutputStreams::close(const std::vector<std::filesystem::path>& beside) {
  for (OutputStream& file : files_) file.close();
  const auto require_own = [](const std::filesystem::path& name) {
    if (is_taken(name)) throw NameTaken(name, name);
  };
  for (const OutputStream& file : files_) require_own(file.target());
  for (const std::filesystem::path& name : beside) require_own(name);
}

void OutputStreams::keep() {
  for (OutputStream& file : files_) file.close();
  for (OutputStream& file : files_) file.keep();
}

void write_together(const std::filesystem::path& path,
                    std::vector<std::filesystem::path> (*beside)(const std::filesystem::path&),
                    const std::function<void(const std::filesystem::path& path)>& write) {
  const auto succeeds = [&](const std::filesystem::path& name) {
    try {
      write(name);
      return true;
    } catch (const NameTaken&) {
      return false;
    }
  };
  if (succeeds(path)) return;
  for (int number = 2;; ++number) {
    const std::filesystem::path name = numbered(path, number);
    std::vector<std::filesystem::path> files = beside(name);
    files.push_back(name);
    std::error_code ignored;
    if (std::ranges::any_of(files, [&](const auto& file) { return std::filesystem::exists(file, ignored); })) continue;
    for (const std::filesystem::path& file : files) note_output(file, false);
    if (succeeds(name)) throw NameTaken(path, name);
  }
}

}  // namespace mercury
