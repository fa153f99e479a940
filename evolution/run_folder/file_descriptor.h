// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

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
  // Throws the path and the system's reason (robots/whole_file.h).
  [[noreturn]] void fail(int error) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

// Makes names in a folder durable: files that were made, renamed or removed in it.
void sync_folder(const std::filesystem::path& folder);

}  // namespace mercury
