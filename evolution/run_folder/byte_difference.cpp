// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/byte_difference.h"

#include <algorithm>
#include <cstdint>

#include "evolution/bytes.h"

namespace mercury {
namespace {

// Equal bytes between two changes that are stored as changed: two numbers cost as much.
constexpr std::size_t shortest_copy = 3;

void put(std::string& bytes, std::size_t value) {
  for (; value >= 0x80; value >>= 7) bytes.push_back(static_cast<char>(value | 0x80));
  bytes.push_back(static_cast<char>(value));
}

std::size_t take_number(ByteReader& reader) {
  std::size_t value = 0;
  for (int shift = 0; shift < 63; shift += 7) {
    const auto byte = reader.read<std::uint8_t>();
    value |= static_cast<std::size_t>(byte & 0x7f) << shift;
    if (byte < 0x80) return value;
  }
  throw DamagedBytes("a number of a difference is too large");
}

}  // namespace

std::string difference_of(std::string_view base, std::string_view target) {
  const std::size_t common = std::min(base.size(), target.size());
  const auto differs = [&](std::size_t i) { return i >= common || base[i] != target[i]; };
  std::string difference;
  put(difference, target.size());
  std::size_t done = 0;
  for (std::size_t i = 0; i < target.size(); ++i) {
    if (!differs(i)) continue;
    std::size_t end = i + 1;
    for (std::size_t k = end; k < target.size() && k - end < shortest_copy; ++k)
      if (differs(k)) end = k + 1;
    put(difference, i - done);
    put(difference, end - i);
    difference.append(target.substr(i, end - i));
    done = end;
    i = end - 1;
  }
  return difference;
}

std::string with_difference(std::string_view base, std::string_view difference) {
  ByteReader reader(difference);
  const std::size_t size = take_number(reader);
  if (size > base.size() + difference.size()) throw DamagedBytes("a difference gives more bytes than it has");
  std::string target;
  target.reserve(size);
  const auto copy = [&](std::size_t count) {
    if (count > 0 && (target.size() > base.size() || count > base.size() - target.size()))
      throw DamagedBytes("a difference copies what its base does not have");
    target.append(base.substr(std::min(target.size(), base.size()), count));
  };
  while (!reader.is_at_end()) {
    copy(take_number(reader));
    target.append(reader.take(take_number(reader)));
  }
  if (target.size() > size) throw DamagedBytes("a difference gives more bytes than it says");
  copy(size - target.size());
  return target;
}

}  // namespace mercury
