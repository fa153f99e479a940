// SPDX-License-Identifier: Apache-2.0
// A file that is written from its start to its end, piece by piece, and is kept whole or not at all.
#pragma once

#include <fmt/format.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iterator>
#include <list>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "app/base/interrupt.h"
#include "mercury/vec3.h"

namespace mercury {

static_assert(std::endian::native == std::endian::little, "the binary formats are little-endian");

// The file has a temporary name until keep(); without keep() nothing is left behind. All members throw as fail() of
// robots/file/whole_file.h: InputError if the file cannot be made, std::runtime_error if the disk is full.
class OutputStream {
 public:
  explicit OutputStream(const std::filesystem::path& target);
  ~OutputStream();
  OutputStream(const OutputStream&) = delete;
  OutputStream& operator=(const OutputStream&) = delete;

  // Numbers are written so that they read back to the same float.
  template <class... Values>
  void print(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(buffer_), format, std::forward<Values>(values)...);
    flush_if_full();
  }
  void text(std::string_view text) { bytes(text.data(), text.size()); }
  void bytes(const void* data, std::size_t size) {
    const char* first = static_cast<const char*>(data);
    buffer_.append(first, first + size);
    flush_if_full();
  }
  // The bytes of a number or of a list of them, as they are in memory.
  template <class Value>
  void raw(const Value& value) {
    static_assert(std::is_arithmetic_v<Value> || std::is_same_v<Value, Vec3>);
    bytes(&value, sizeof value);
  }
  template <class Value, std::size_t extent>
  void raw(std::span<const Value, extent> values) {
    bytes(values.data(), values.size_bytes());
  }

  const std::filesystem::path& target() const { return target_; }
  std::uint64_t size() const { return written_ + buffer_.size(); }  // so far [bytes]

  // Ends the file: all of it is on the disk.
  void close();
  // Gives the closed file its name.
  void keep();

 private:
  void flush_if_full() {
    if (buffer_.size() >= full) flush();
  }
  void flush();

  static constexpr std::size_t full = std::size_t{1} << 20;  // [bytes]
  std::filesystem::path target_;
  UnfinishedFile unfinished_;
  fmt::memory_buffer buffer_;
  std::uint64_t written_ = 0;
  int descriptor_ = -1;
};

// Several files that are kept together: none before all of them are on the disk.
class OutputStreams {
 public:
  OutputStream& add(const std::filesystem::path& target) { return files_.emplace_back(target); }
  // Ends all files of write_together(). Throws NameTaken if another program has taken the name of one, or of what goes
  // `beside` them.
  void close(const std::vector<std::filesystem::path>& beside = {});
  // Ends all files, then gives them their names in the order of add().
  void keep();

 private:
  std::list<OutputStream> files_;
};

// Writes files that name each other: `write` makes `path` and what goes `beside` it, such as a.obj and a.mtl. If
// another program has taken one of their names in the meantime, all are written again under other names, and NameTaken
// says so.
void write_together(const std::filesystem::path& path,
                    std::vector<std::filesystem::path> (*beside)(const std::filesystem::path&),
                    const std::function<void(const std::filesystem::path& path)>& write);

}  // namespace mercury
