// SPDX-License-Identifier: Apache-2.0
#include "app/video/picture_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "app/base/interrupt.h"
#include "app/video/frame_writer.h"
#include "mercury/error.h"
#include "mercury/file_links.h"
#include "render/png.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, int error) { throw VideoError(file.string() + ": " + reason_of(error)); }

// Returns 0, or the error.
int write_all(int descriptor, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return 0;
}

// `name`: of the file in messages, which knows nothing of temporary names.
void write_into(const fs::path& file, int flags, std::span<const std::uint8_t> bytes, const fs::path& name) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC | flags, 0666);
  if (descriptor < 0) fail(name, errno);
  int error = write_all(descriptor, bytes);
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error != 0) fail(name, error);
}

}  // namespace

void write_picture(const fs::path& file, const render::Image& image, std::string_view comment, double dpi) {
  write_picture_bytes(file, render::png_bytes(image, comment, dpi));
}

void write_picture_bytes(const fs::path& file, std::span<const std::uint8_t> bytes) {
  if (is_device_or_pipe(file)) return write_into(file, 0, bytes, file);
  UnfinishedFile unfinished(file);
  write_into(unfinished.path(), O_CREAT | O_EXCL, bytes, file);
  try {
    unfinished.keep();
  } catch (const fs::filesystem_error& failure) {
    fail(file, failure.code().value());
  }
}

}  // namespace mercury
