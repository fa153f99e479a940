// SPDX-License-Identifier: Apache-2.0
#include "tests/app/recording/file_operations.h"

#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

namespace {

struct Operation {
  off64_t at;  // of the first byte; of the end, if the file is truncated
  std::string bytes;
  bool truncates;
};

std::vector<Operation> operations;
bool recording = false;

template <class Function>
Function original(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// These replace the functions of the C library, for libraries too.
extern "C" ssize_t pwrite64(int file, const void* bytes, size_t count, off64_t at) {
  static const auto write = original<ssize_t (*)(int, const void*, size_t, off64_t)>("pwrite64");
  if (recording) operations.push_back({at, std::string(static_cast<const char*>(bytes), count), false});
  return write(file, bytes, count, at);
}

extern "C" ssize_t pwrite(int file, const void* bytes, size_t count, off_t at) {
  return pwrite64(file, bytes, count, at);
}

extern "C" int ftruncate64(int file, off64_t length) noexcept {
  static const auto truncate = original<int (*)(int, off64_t)>("ftruncate64");
  if (recording) operations.push_back({length, "", true});
  return truncate(file, length);
}

extern "C" int ftruncate(int file, off_t length) noexcept { return ftruncate64(file, length); }

namespace mercury::test {

FileOperations::FileOperations() {
  operations.clear();
  recording = true;
}

FileOperations::~FileOperations() { recording = false; }

std::size_t FileOperations::size() const { return operations.size(); }

std::size_t FileOperations::length(std::size_t operation) const { return operations.at(operation).bytes.size(); }

std::vector<std::size_t> FileOperations::breaks(std::size_t operation) const {
  constexpr std::size_t page = 4096;
  const auto start = static_cast<std::size_t>(operations.at(operation).at);
  std::vector<std::size_t> breaks;
  for (std::size_t at = page - start % page; at < length(operation); at += page) breaks.push_back(at);
  return breaks;
}

void FileOperations::apply(std::size_t operation, std::string& content, std::size_t most) const {
  const auto& [at, bytes, truncates] = operations.at(operation);
  const auto start = static_cast<std::size_t>(at);
  if (truncates) return content.resize(start);
  const std::size_t count = std::min(most, bytes.size());
  if (content.size() < start + count) content.resize(start + count);
  std::copy_n(bytes.begin(), count, content.begin() + static_cast<std::ptrdiff_t>(start));
}

}  // namespace mercury::test
