// SPDX-License-Identifier: Apache-2.0
// What this process writes to files with pwrite() and ftruncate(), as HDF5 does, in order.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace mercury::test {

// Records while it lives, one at a time. All operations are taken to be on one file.
class FileOperations {
 public:
  FileOperations();
  ~FileOperations();
  FileOperations(const FileOperations&) = delete;
  FileOperations& operator=(const FileOperations&) = delete;

  std::size_t size() const;
  std::size_t length(std::size_t operation) const;  // bytes that it writes
  // Where the kernel may stop when the program is killed while it writes: after the last byte of a page of the file.
  // Bytes from the operation's first.
  std::vector<std::size_t> breaks(std::size_t operation) const;
  // Does the operation to the content of a file: at most the first `most` bytes of it.
  void apply(std::size_t operation, std::string& content, std::size_t most = std::string::npos) const;
};

}  // namespace mercury::test
