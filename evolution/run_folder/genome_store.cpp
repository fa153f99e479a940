// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/genome_store.h"

#include "evolution/bytes.h"
#include "evolution/run_folder/byte_difference.h"
#include "mercury/error.h"

namespace mercury {
namespace {

constexpr std::size_t most_cached_bytes = std::size_t{128} << 20;

}  // namespace

void GenomeStore::add(std::span<const StoredGenome> genomes) {
  for (const StoredGenome& genome : genomes) {
    const int chain = genome.base == StoredGenome::none ? 0 : chains_.at(genome.base) + 1;
    if (chain > longest_chain)
      throw InputError(journal_.path().string(),
                       "the genome of individual " + std::to_string(genomes_.size()) + " has too many differences");
    genomes_.push_back(genome);
    chains_.push_back(static_cast<std::uint8_t>(chain));
  }
}

GenomeStore::Bytes GenomeStore::bytes(std::uint64_t id) const {
  std::vector<std::uint64_t> differences;  // to be applied, the last one first
  Bytes bytes = cached(id);
  for (; !bytes; bytes = cached(id)) {
    const StoredGenome& genome = genomes_.at(id);
    if (genome.base == StoredGenome::none) {
      bytes = std::make_shared<const std::string>(journal_.bytes_of(genome, id));
      cache(id, bytes);
      break;
    }
    differences.push_back(id);
    id = genome.base;
  }
  for (; !differences.empty(); differences.pop_back()) {
    const std::uint64_t next = differences.back();
    try {
      bytes = std::make_shared<const std::string>(with_difference(*bytes, journal_.bytes_of(genomes_[next], next)));
    } catch (const DamagedBytes& error) {
      throw InputError(journal_.path().string(),
                       "the genome of individual " + std::to_string(next) + ": " + error.what());
    }
    cache(next, bytes);
  }
  return bytes;
}

GenomeStore::Bytes GenomeStore::cached(std::uint64_t id) const {
  const std::lock_guard lock(mutex_);
  const auto found = cache_.find(id);
  return found == cache_.end() ? nullptr : found->second;
}

void GenomeStore::cache(std::uint64_t id, Bytes bytes) const {
  const std::lock_guard lock(mutex_);
  if (cached_bytes_ > most_cached_bytes) {
    cache_.clear();
    cached_bytes_ = 0;
  }
  const std::size_t size = bytes->size();
  if (cache_.emplace(id, std::move(bytes)).second) cached_bytes_ += size;
}

}  // namespace mercury
