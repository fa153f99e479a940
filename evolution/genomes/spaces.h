// SPDX-License-Identifier: Apache-2.0
// What the genome spaces share.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "mercury/genome.h"
#include "robots/bytes.h"
#include "robots/genes.h"

namespace mercury {

// Mutation of the robots that a run begins with, at most.
inline constexpr double strongest_at_first = 4;

// The first two bytes of every genome: its kind and the version of its encoding.
void write_head(ByteWriter& writer, std::uint8_t tag);
// Throws InputError unless the bytes are of this kind, and of a version that this program knows.
void read_head(ByteReader& reader, std::uint8_t tag);

// A hash that is computed when it is asked for first, by whatever thread.
class CachedIdentity {
 public:
  std::uint64_t value(auto add_to) const {
    std::uint64_t value = value_.load(std::memory_order_relaxed);
    if (value != 0) return value;
    IdentityHash hash;
    add_to(hash);
    value_.store(value = hash.value(), std::memory_order_relaxed);
    return value;
  }

 private:
  mutable std::atomic<std::uint64_t> value_{0};  // 0 = not computed yet
};

// The step by which the muscles of a genome move, in units of their usual one. Files have it only where it adapts
// itself; elsewhere it is 1.
class MuscleStep {
 public:
  // The mutation that makes a child of such a genome, whose muscles have `numbers` numbers, and the child's step.
  struct Child;
  Child child(const MuscleMutation& how, std::size_t numbers, double strength, std::uint64_t seed) const;
  MuscleStep crossed(MuscleStep other) const;

  void write(ByteWriter& writer, const MuscleMutation& how) const;
  // Throws InputError for a step that child() cannot give.
  static MuscleStep read(ByteReader& reader, const MuscleMutation& how);

 private:
  double value_ = 1;
};
struct MuscleStep::Child {
  GeneMutation mutation;
  MuscleStep step;
};

// Genomes of brains, each with one of these bodies, which may change as well: what the request says.
std::unique_ptr<GenomeSpace> make_brain_space(const GenomeSpaceRequest& request, std::unique_ptr<GenomeSpace> bodies);
// Throws ParameterError if brains alone should change and a robot has none.
void require_brains(const GenomeSpaceRequest& request);

// Genomes of the muscles of given bodies: robots of any kind, whose materials alone change, or
// nothing at all: then its random genomes are the founders, by number.
std::unique_ptr<GenomeSpace> make_given_body_space(const GenomeSpaceRequest& request);

}  // namespace mercury
