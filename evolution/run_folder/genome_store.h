// SPDX-License-Identifier: Apache-2.0
// The encoded genomes of a journal, read when somebody asks for them.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "evolution/run_folder/journal.h"

namespace mercury {

class GenomeStore {
 public:
  using Bytes = std::shared_ptr<const std::string>;

  // The journal must outlive the store.
  explicit GenomeStore(const JournalReader& journal) : journal_(journal) {}

  // The genomes of the individuals that follow, in the order of ids. Throws InputError if they cannot be as stored.
  void add(std::span<const StoredGenome> genomes);
  // The differences that lie between a genome and one that is stored whole.
  int chain_of(std::uint64_t id) const { return chains_[id]; }
  // The encoded genome. Several threads may call it. Throws InputError if the journal is damaged there.
  Bytes bytes(std::uint64_t id) const;

 private:
  Bytes cached(std::uint64_t id) const;
  void cache(std::uint64_t id, Bytes bytes) const;

  const JournalReader& journal_;
  std::vector<StoredGenome> genomes_;  // by id
  std::vector<std::uint8_t> chains_;   // by id
  mutable std::mutex mutex_;
  mutable std::unordered_map<std::uint64_t, Bytes> cache_;
  mutable std::size_t cached_bytes_ = 0;
};

}  // namespace mercury
