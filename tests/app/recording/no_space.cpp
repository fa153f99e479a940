// SPDX-License-Identifier: Apache-2.0
// Preload this into a program. Its writes fail, as on a full disk, beyond the first NO_SPACE_AFTER bytes of a file.
#include <dlfcn.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

namespace {

template <class Write>
ssize_t write_while_there_is_space(const char* name, int file, const void* bytes, size_t count, off64_t at) {
  static const auto write = reinterpret_cast<Write>(dlsym(RTLD_NEXT, name));
  const char* limit = std::getenv("NO_SPACE_AFTER");
  if (limit && at + static_cast<off64_t>(count) > std::atoll(limit)) {
    errno = ENOSPC;
    return -1;
  }
  return write(file, bytes, count, at);
}

}  // namespace

extern "C" ssize_t pwrite64(int file, const void* bytes, size_t count, off64_t at) {
  return write_while_there_is_space<ssize_t (*)(int, const void*, size_t, off64_t)>("pwrite64", file, bytes, count, at);
}

extern "C" ssize_t pwrite(int file, const void* bytes, size_t count, off_t at) {
  return write_while_there_is_space<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite", file, bytes, count, at);
}
