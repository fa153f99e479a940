// SPDX-License-Identifier: Apache-2.0
#include "evolution/genomes/bytes.h"

#include "mercury/error.h"
#include "mercury/random.h"

namespace mercury {

std::string_view ByteReader::take(std::uint64_t count) {
  expect(count, 1);
  const std::string_view taken = bytes_.substr(0, static_cast<std::size_t>(count));
  bytes_.remove_prefix(taken.size());
  return taken;
}

void ByteReader::expect(std::uint64_t count, std::size_t bytes_each) const {
  if (count > bytes_.size() / bytes_each) throw InputError("genome", "breaks off");
}

void ByteReader::end() const {
  if (!bytes_.empty())
    throw InputError("genome", "is followed by " + std::to_string(bytes_.size()) + " bytes that are not of it");
}

std::uint64_t IdentityHash::value() const { return seed_of(hash_, 0); }

}  // namespace mercury
